// Points and planes in exact homogeneous coordinates, for the cells of a receiver (cell.h).
//
// A point (x, y, z, w), w > 0, is the point (x, y, z) / w in integer units; a plane (a, b, c, d) holds the points with
// a x + b y + c z + d w = 0. Joining three points and cutting three planes are the same 3 x 3 minors.
//
// Each also has doubles for filters and for integration, in units of 2^shift integer units: then no coordinate of the
// scene exceeds 1. Every one of them has a relative error of at most u = 2^-53, up to one positive factor for a plane;
// an underflow adds at most 2^-1074. Four products carry at most 3u each and their sums at most 3u: the
// total is below 8u of the sum of the magnitudes, as certified_sign requires.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernel/filter.h"
#include "kernel/numbers.h"

namespace exactff::view_factors {

using kernel::Integer;
using Homogeneous = std::array<Integer, 4>;

// How the doubles of a scene become integers: coordinate * 2^-exponent; and the integers the doubles of filters.
struct Units {
  long exponent = 0;
  long shift = 0;

  [[nodiscard]] static Units of(std::span<const Vec3> vertices);
};

// Numbers of so many bits, or kManyBits. Doubles of few bits are exact, and so is what is computed from them.
inline constexpr int kManyBits = 1000;

struct Point {
  Homogeneous exact;
  Vec3 at;               // in units of 2^shift
  int bits = kManyBits;  // of x, y and z, if w is 1
};

struct Plane {
  Homogeneous exact;
  std::array<double, 4> rounded{};
  int bits = kManyBits;  // of all four
};

[[nodiscard]] Point point_of(const Vec3& vertex, const Units& units);
[[nodiscard]] Point make_point(Homogeneous exact, const Units& units);  // any w other than zero
[[nodiscard]] Plane make_plane(Homogeneous exact, const Units& units);

// The plane through three points; positive on the side from which they run counter-clockwise. All zero if they lie on
// one line.
[[nodiscard]] Homogeneous join(const Point& a, const Point& b, const Point& c);
// The point that three planes share; all zero if there is none, or more than one.
[[nodiscard]] Homogeneous meet(const Plane& a, const Plane& b, const Plane& c);
[[nodiscard]] bool is_zero(const Homogeneous& a);
[[nodiscard]] Homogeneous opposite(Homogeneous a);

// -1, 0, +1: the side of the plane on which the point lies.
[[nodiscard]] int side_of(const Plane& plane, const Point& point);

// A filter for the side of the plane through three points, before the plane is made exactly.
//
// With u = 2^-53: coordinates are at most 1 and rounded once, so each component of a difference of two points errs by
// at most e = 4u. Let A, B, C bound the components of the three differences and their true values: their largest
// magnitudes, plus e. Each of the six products of det(b - a, c - a, x - a) errs by at most e S, S = AB + BC + CA.
// Rounding the products and their sum adds at most 6u to each, 36u ABC <= 25u S, since A, B, C are below 2 + 2e. The
// total is at most 49u S, and the filter decides beyond 2^-46 S = 128u S. An underflow is negligible beside S >= 3 e^2.
//
// With coordinates of at most 15 bits nothing is rounded: the differences have 16 bits, the normal 33, each of the
// three last products 49, and their sum 51.
class RoundedPlane {
 public:
  RoundedPlane(const Point& a, const Point& b, const Point& c);

  // Up to rounding, a positive multiple of the distance.
  [[nodiscard]] double height(const Vec3& x) const;
  // kernel::kUncertain: the filter declines.
  [[nodiscard]] int side_of(const Point& x) const;
  // The point's height is certainly larger, on either side, than so many times its error.
  [[nodiscard]] bool is_beyond(const Vec3& x, double errors) const;

 private:
  [[nodiscard]] double error_at(const Vec3& from_origin) const;

  Vec3 origin_, normal_;
  double product_ = 0.0, sum_ = 0.0;  // AB and A + B
  bool is_exact_ = false;             // the normal
};

}  // namespace exactff::view_factors
