// Compares the decisions of sampling with the exact visible region.
#pragma once

#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"

namespace exactff::study {

struct SampledVerdict {
  std::uint64_t silent = 0;  // sampled as 0 or 1, the truth is in between
  std::uint64_t wrong = 0;   // sampled as 0 where the truth is 1, or vice versa
  // The error of these leaves in the form factor: the sum over the leaves of the unoccluded form factor times the error
  // of the visible fraction (by area).
  double error = 0.0;
};

// Examines only the leaves that sampling decided (kSampledVisible, kSampledHidden). The region is the exact one rounded
// to doubles, so parts below 1e-9 of a leaf's area count as nothing.
[[nodiscard]] SampledVerdict judge_leaves(const std::vector<Leaf>& leaves, const std::vector<PlaneDrawing>& truth);

// The plane that contains the leaf: the nearest of those that face the same way; null if there is none.
[[nodiscard]] const PlaneDrawing* plane_of(const Leaf& leaf, const std::vector<PlaneDrawing>& planes);

// The area that the loops (outer ones minus holes) share with a convex polygon of the same plane.
[[nodiscard]] double area_inside(const std::vector<Loop>& loops, const std::vector<Vec3>& convex, const Vec3& normal);

}  // namespace exactff::study
