// The corners of one face as exact integer points, in space and in a plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/geometry.h"
#include "kernel/numbers.h"

namespace exactff {

// The corners of all rings of a face, one ring after the other, relative to the first one:
// vertex = first + at[i] * 2^exponent, exactly.
struct FacePoints {
  std::vector<std::uint32_t> vertex;
  std::vector<kernel::ExactVec3> at;
  long exponent = 0;
  std::vector<std::size_t> ring_start;  // ring_count + 1 entries

  std::size_t size() const { return at.size(); }
  std::size_t ring_count() const { return ring_start.size() - 1; }
};

// An edge from the point of that index to the next one of its ring.
using EdgeIndex = std::size_t;

// The index of the point that follows in its ring.
std::size_t next_in_ring(const FacePoints& points, std::size_t point);

FacePoints face_points(std::span<const Vec3> vertices, const std::vector<std::vector<std::uint32_t>>& rings);

// Twice the area vector of the closed polygon through the points first, ..., last - 1 (Newell's vector).
kernel::ExactVec3 newell(const FacePoints& points, std::size_t first, std::size_t last);
kernel::ExactVec3 newell(const FacePoints& points, std::span<const std::size_t> polygon);

// A normal of the plane through three points not on one line; zero if there are none.
kernel::ExactVec3 some_normal(const FacePoints& points);
bool all_in_plane(const FacePoints& points, const kernel::ExactVec3& normal);

// v * 2^exponent, correctly rounded. If the largest component is not within [2^-900, 2^1000), the vector is first
// multiplied by the power of two that brings this component into [1/2, 1).
Vec3 nearest_vector(const kernel::ExactVec3& v, long exponent);

// The length of a vector as mantissa * 2^exponent: an estimate to about 15 digits that cannot overflow.
struct Length {
  double mantissa = 0.0;
  long exponent = 0;
};
Length length(const kernel::ExactVec3& v);
Length operator+(const Length& a, const Length& b);
double ratio(const Length& a, const Length& b);
// Clamped to the smallest and largest positive doubles.
double to_double(const Length& a);

// The largest distance of a point from the plane through the mean of the points with the given normal, over
// the largest distance between two points (an estimate).
double out_of_plane(const FacePoints& points, const kernel::ExactVec3& normal);

// Points of a plane with exact integer coordinates and double approximations for filters.
class PlanePoints {
 public:
  // kAlongNormal: the projection along `normal` (not zero). kDropAxis: the same orientations if all points lie in one
  // plane with that normal, computed from shorter numbers. Points that run counter-clockwise seen from the tip of the
  // normal have orientation +1 here.
  enum class Projection { kAlongNormal, kDropAxis };
  PlanePoints(const FacePoints& points, const kernel::ExactVec3& normal, Projection projection);

  std::size_t size() const { return x_.size(); }
  // +1 if a, b, c run counter-clockwise, -1 if clockwise, 0 if on a line. Exact.
  int orientation(std::size_t a, std::size_t b, std::size_t c) const;
  // Order of positions: by x, then y. Exact.
  int compare(std::size_t a, std::size_t b) const;

  // The point to within kApproximation in each coordinate, in a frame where none exceeds 1 in magnitude.
  double x(std::size_t i) const { return near_x_[i]; }
  double y(std::size_t i) const { return near_y_[i]; }
  static constexpr double kApproximation = 0x1p-52;
  // A bound on the error of the orientation of three points computed from those approximations. They are
  // at most 1 and off by 2^-52, differences by 2^-50, products (at most 4) by 20 * 2^-52 and the determinant by
  // 48 * 2^-52, whatever the rounding mode.
  static constexpr double kOrientationError = 0x1p-46;

 private:
  void approximate();

  std::vector<kernel::Integer> x_;
  std::vector<kernel::Integer> y_;
  std::vector<double> near_x_;
  std::vector<double> near_y_;
};

}  // namespace exactff
