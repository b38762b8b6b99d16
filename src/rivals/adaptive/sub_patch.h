// Triangles and quadrilaterals of the source: ways to split them, the sides of their planes, their unoccluded form
// factor.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/geometry.h"
#include "exactff/scene.h"
#include "kernel/expect.h"
#include "kernel/split_mix.h"
#include "kernel/vec.h"

namespace exactff::adaptive {

// --- Plain double vectors for the sampled methods ---

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(const Vec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }

using kernel::cross;
using kernel::dot;
using kernel::max_norm;

// Squares at least this large are accurate, and remain accurate if a product loses 2^-100.
inline constexpr double kLeastSquare = 0x1p-900;

// `a` times the power of two that brings its max norm into [1, 2); `exponent` undoes it. Requires a finite a other
// than 0.
inline Vec3 normalised(const Vec3& a, int& exponent) {
  EXACTFF_EXPECT(kernel::is_finite(a) && !(a == Vec3{}));
  exponent = std::ilogb(max_norm(a));
  return {std::scalbn(a.x, -exponent), std::scalbn(a.y, -exponent), std::scalbn(a.z, -exponent)};
}

// Also correct where squares underflow. Requires components below 2^511.
inline double length(const Vec3& a) {
  const double square = dot(a, a);
  if (square >= kLeastSquare) return std::sqrt(square);
  if (a == Vec3{}) return 0.0;
  int exponent = 0;
  const Vec3 near_one = normalised(a, exponent);
  return std::scalbn(std::sqrt(dot(near_one, near_one)), exponent);
}

// --- Sub patch ---

enum class PatchShape { kTriangle, kParallelogram, kQuadrilateral };

// A convex planar patch; corners are relative to the receiving point and run counter-clockwise as it sees them. Stored
// by coordinate, and a triangle repeats its last corner, so that loops over four corners vectorise.
struct SubPatch {
  alignas(32) double x[4];
  double y[4];
  double z[4];
  PatchShape shape = PatchShape::kTriangle;

  [[nodiscard]] int corner_count() const { return shape == PatchShape::kTriangle ? 3 : 4; }
  [[nodiscard]] Vec3 corner(int i) const { return {x[i], y[i], z[i]}; }
};

// Requires three or four corners of a convex planar polygon.
[[nodiscard]] SubPatch make_sub_patch(std::span<const Vec3> corners);

[[nodiscard]] double area(const SubPatch& s);

// The centroid of a triangle, the mean of the corners of a quadrilateral.
[[nodiscard]] Vec3 centroid(const SubPatch& s);

// Tampieri's SplitPatch: four parts of the same shape and orientation that tile s. A triangle is split by the
// midpoints of its edges; a quadrilateral by those and its centre (the bilinear one).
[[nodiscard]] std::array<SubPatch, 4> split_patch(const SubPatch& s);

// Replaces `parts` by m^2 parts of the same shape that tile s: triangles similar to a triangle; the cells of the
// bilinear map of a quadrilateral.
void split_evenly(const SubPatch& s, int m, std::vector<SubPatch>& parts);

// The part of a convex polygon with normal . corner >= 0, corners relative to the receiving point. Fewer than three
// corners: nothing is left. `clipped` may not alias `polygon`.
void clip_by_horizon(std::span<const Vec3> polygon, const Vec3& normal, std::vector<Vec3>& clipped);

// --- Plane side ---

// Tests for sides of planes, used to set up one receiver: sums of products with a bound on their rounding error.
//
// Notation: u = 2^-53. Inputs are differences of points, within relative error u a component. A component of a cross
// product errs by at most 4u of its magnitude (the sum of the magnitudes of its two products), a dot product with it by
// less than 9u of its own magnitude; the bound used is 32u. Every product with a zero factor has magnitude 0, and every
// other at least 2^-400, far above the effect of underflow in coordinates of about 1. So an axis-parallel plane gets
// the bound 0 and is decided like the others, without an exact sign.

struct Bounded {
  double value = 0.0;
  double error = 0.0;

  [[nodiscard]] bool certainly_positive() const { return value > error; }
  [[nodiscard]] bool certainly_negative() const { return value < -error; }
  [[nodiscard]] bool certainly_not_positive() const { return value <= -error; }
  [[nodiscard]] bool certainly_zero() const { return value == 0.0 && error == 0.0; }
};

// A normal and the magnitudes of its components' terms.
struct Normal {
  Vec3 value;
  Vec3 magnitude;
};

// (b - a) x (c - a): points to the side from which a, b, c run counter-clockwise.
[[nodiscard]] Normal plane_normal(const Vec3& a, const Vec3& b, const Vec3& c);
// The given vector as a normal, without error.
[[nodiscard]] Normal exact_normal(const Vec3& n);

[[nodiscard]] Bounded bounded_dot(const Normal& n, const Vec3& d);

// --- Source roots ---

// A source prepared for the recursion: its faces as triangles and quadrilaterals, and which pieces lie in their planes.

struct SourcePlane {
  std::array<Vec3, 3> frame;            // scaled; counter-clockwise seen from the front
  std::array<Vec3, 3> exact_frame;      // not scaled
  std::vector<std::uint32_t> coplanar;  // pieces exactly in this plane, ascending
};

struct SourceRoot {
  std::array<Vec3, 4> corners;  // scaled
  int corner_count = 0;
  std::uint32_t plane = 0;
  std::uint32_t piece = 0;
};

struct SourceRoots {
  std::vector<SourcePlane> planes;
  std::vector<SourceRoot> roots;
};

// `points` are the scene's vertices scaled to about 1. A piece with three or four corners is a root, any other a fan of
// triangles. A piece with the same corners as an earlier one of the source is left out; other overlaps of coplanar
// faces are not detected.
[[nodiscard]] SourceRoots make_source_roots(const Scene& scene, const std::vector<Vec3>& points,
                                            const Selection& selection);

// --- Tampieri's Eq. (4): the unoccluded form factor from the origin to a polygon ---

// In double, by atan2; an estimate with a relative error of about 1e-15 r/h for a patch of size h at distance r.
// Requires a unit normal and a patch above the horizon of x.
[[nodiscard]] double unoccluded_form_factor(const SubPatch& s, const Vec3& unit_normal);

// As printed in 1992, in single precision by acos: wrong for small or distant patches, and for patches that the horizon
// cuts.
[[nodiscard]] double literal_unoccluded_form_factor(const SubPatch& s, const Vec3& unit_normal);

}  // namespace exactff::adaptive

namespace exactff {

// --- Patch visibility ---

// A source of the visible fraction V of a sub-patch, used by the recursion in place of shadow rays.

namespace adaptive {

class PatchVisibility {
 public:
  virtual ~PatchVisibility() = default;
  // The sub-patches in the following calls are parts of this piece of the scene.
  virtual void start(std::uint32_t piece) = 0;
  // V in [0, 1]; the recursion ends at 0 and at 1. Corners are relative to x, in scaled coordinates.
  virtual double fraction(const SubPatch& s) = 0;
};

}  // namespace adaptive

struct AdaptiveInside {
  using SourceData = AdaptiveSource::Data;
  // As AdaptiveSolver::form_factor, but where shaft culling leaves V undecided, `visibility` computes V instead of
  // rays.
  [[nodiscard]] static AdaptiveResult form_factor(const AdaptiveSolver& solver, const Receiver& receiver,
                                                  const AdaptiveSource& source, double largest_rho_b,
                                                  const AdaptiveOptions& options,
                                                  adaptive::PatchVisibility& visibility);
};

}  // namespace exactff

namespace exactff::adaptive {

// --- The ends of shadow rays: points of a sub-patch, uniform over its area ---

// Ray ends relative to the receiving point, by coordinate. Padded to a multiple of kLanes by repeating the last one.
struct RayEnds {
  static constexpr int kLanes = 8;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  int count = 0;
  int padded_count = 0;

  void resize(int rays);
  void set(std::size_t i, const Vec3& end) {
    x[i] = end.x;
    y[i] = end.y;
    z[i] = end.z;
  }
  [[nodiscard]] Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

inline constexpr double kUnit32 = 0x1p-32;

// A point of the unit square.
struct UnitPoint {
  double u = 0.0;
  double v = 0.0;
};

// Back into [0, 1) from [0, 2).
inline double wrapped(double u) { return u >= 1.0 ? u - 1.0 : u; }

// Number `index` of the stream `key`, each coordinate in [0, 1).
inline UnitPoint random_point(std::uint64_t key, std::uint64_t index) {
  const std::uint64_t bits = kernel::split_mix(key, index);
  return {static_cast<double>(static_cast<std::int64_t>(bits >> 32)) * kUnit32,
          static_cast<double>(static_cast<std::int64_t>(bits & 0xffffffffU)) * kUnit32};
}

// The images of the points under a map to the sub-patch that preserves ratios of areas. Fills `ends`, padding included.
void place_by_area(const SubPatch& s, std::span<const UnitPoint> points, RayEnds& ends);

// The points of the unit square that a pattern prescribes for n rays, and their images on sub-patches.
class SamplePlan {
 public:
  // kCentre makes one ray and ignores `rays`. Any number of jittered or regular cells of area 1/n: about sqrt(n) rows,
  // each as high as its share of the cells. kLowDiscrepancy: Hammersley's points, shifted modulo 1 by a random vector
  // per sub-patch (Cranley and Patterson 1976).
  void prepare(SamplePattern pattern, int rays);

  [[nodiscard]] int ray_count() const { return static_cast<int>(cells_.size()); }

  // Random numbers come from the stream `key` alone. `ends` must have been resized to ray_count().
  void place(const SubPatch& s, std::uint64_t key, RayEnds& ends) const;

 private:
  struct Cell {
    double u, v;  // low corner
    double width, height;
  };
  template <class Map>
  void place_by(const Map& map, std::uint64_t key, RayEnds& ends) const;
  void make_rows(int rays);
  void make_hammersley(int rays);

  SamplePattern pattern_ = SamplePattern::kJittered;
  int rays_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace exactff::adaptive
