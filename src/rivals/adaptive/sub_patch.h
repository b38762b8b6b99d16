// Triangles and quadrilaterals of the source, and ways to split them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "adaptive/vec.h"

namespace exactff::adaptive {

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

}  // namespace exactff::adaptive
