// Points for area sampling: of the unit square, and of a flat source, uniform in the solid angle under which x sees it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adaptive/sub_patch.h"

namespace exactff::methods {

// A triangle or a rectangle, with a map of the unit square to it that preserves ratios of solid angles.
class SolidAnglePart {
 public:
  // Corners relative to x; `height` of x above their plane, not negative.
  static SolidAnglePart triangle(const Vec3& a, const Vec3& b, const Vec3& c, double height);
  // Corners in their order along the boundary.
  static SolidAnglePart rectangle(std::span<const Vec3> corners, double height);

  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  // A point of the part, relative to x and in the unit of the corners; finite.
  [[nodiscard]] Vec3 point_at(const adaptive::UnitPoint& at) const;

 private:
  void prepare_triangle(double height);
  void prepare_rectangle(double height);
  [[nodiscard]] Vec3 on_triangle(const adaptive::UnitPoint& at) const;
  [[nodiscard]] Vec3 on_rectangle(const adaptive::UnitPoint& at) const;

  bool is_rectangle_ = false;
  double solid_angle_ = 0.0;
  std::array<Vec3, 3> corners_{};  // of a rectangle: a corner, and the directions of its axes
  // Of a triangle: see on_triangle.
  Vec3 e_;
  double det_ = 0.0, p_ = 0.0, q_ = 0.0, length_a_ = 0.0, length_b_ = 0.0, length_e_ = 0.0;
  // Of a rectangle, in its own axes, as in the paper.
  double x0_ = 0.0, x1_ = 0.0, y0_ = 0.0, y1_ = 0.0, z_ = 0.0, b0_ = 0.0, b1_ = 0.0, w0_ = 0.0, k_ = 0.0, s_ = 0.0;
};

// Appends the parts of a convex polygon, with corners relative to x: the rectangle that it is, or else triangles.
void add_solid_angle_parts(std::span<const Vec3> polygon, double height, std::vector<SolidAnglePart>& parts);

// --- Point sets of the unit square for area sampling ---

enum class PointSet {
  kRandom,      // independent
  kStratified,  // one in each of n cells of equal area, in about sqrt(n) rows
  kSobol,       // the first n points of a sequence, shifted modulo 1 by a random vector (Cranley and Patterson 1976)
};

class UnitPoints {
 public:
  UnitPoints(PointSet set, int count);

  // The points of the set, with the random numbers of the stream `key`.
  void place(std::uint64_t key, std::vector<adaptive::UnitPoint>& points);

 private:
  void place_stratified(std::uint64_t key, std::vector<adaptive::UnitPoint>& points);

  PointSet set_;
  int count_;
  std::vector<adaptive::UnitPoint> sequence_;
  adaptive::SamplePlan cells_;
  adaptive::RayEnds ends_;
};

}  // namespace exactff::methods
