// The points at which edges are cut.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"

namespace exactff::division {

// One part in 10^9 is allowed, so that roundings of a length add no cell.
inline constexpr double kTolerance = 1e-9;

// The vector between two points, over a length: neither overflows, nor underflows where the quotient is not tiny.
[[nodiscard]] Vec3 difference_over(const Vec3& to, const Vec3& from, double length);

// The vertices of a scene, and those that cells add.
class CutPoints {
 public:
  CutPoints(std::span<const Vec3> vertices, double length)
      : vertices_(vertices.begin(), vertices.end()), length_(length) {}

  [[nodiscard]] const Vec3& operator[](std::uint32_t vertex) const { return vertices_[vertex]; }
  [[nodiscard]] std::span<const Vec3> all() const { return vertices_; }
  [[nodiscard]] double length() const { return length_; }

  // The fewest equal parts of a segment that are not longer than LENGTH.
  [[nodiscard]] std::size_t parts(std::uint32_t a, std::uint32_t b) const;
  // New vertices between the two, in the order from a to b, that cut the segment into these parts. They are the same
  // in the other direction: of n parts, the k-th ends at p + (q - p) k / n, rounded once, where p is the end that comes
  // first by x, then y, then z.
  std::vector<std::uint32_t> between(std::uint32_t a, std::uint32_t b);

  // The largest distance of a point made by between() from its exact place.
  [[nodiscard]] double largest_displacement() const { return largest_displacement_; }

 private:
  std::vector<Vec3> vertices_;
  double length_;
  double largest_displacement_ = 0.0;
};

// The distance of a point from the plane through three others, computed exactly and rounded: 0 only if it is in it.
// Smaller than all doubles, it is the smallest positive one.
[[nodiscard]] double distance_from_plane(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

// Whether all corners of a polygon lie exactly in one plane.
[[nodiscard]] bool is_planar(const CutPoints& points, std::span<const std::uint32_t> polygon);

}  // namespace exactff::division
