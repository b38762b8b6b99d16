// Sampled decisions held against the exact visible region.
#pragma once

#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"

namespace exactff::study {

struct SampledVerdict {
  std::uint64_t silent = 0;  // sampled as 0 or 1, in truth in between
  std::uint64_t wrong = 0;   // sampled as 0 where the truth is 1, or the other way round
  // What these leaves add to the form factor, minus what they should: each leaf's unoccluded form factor times the
  // error of its visible fraction, taken by area.
  double error = 0.0;
};

// Looks at the leaves that sampling decided (kSampledVisible, kSampledHidden) and at no other. The region is
// the exact one rounded to doubles, so parts below 1e-9 of a leaf's area are not told from nothing.
[[nodiscard]] SampledVerdict judge_leaves(const std::vector<Leaf>& leaves, const std::vector<PlaneDrawing>& truth);

// The plane that a leaf lies in: the nearest of those that face its way; null if none does.
[[nodiscard]] const PlaneDrawing* plane_of(const Leaf& leaf, const std::vector<PlaneDrawing>& planes);

// Area of the part of the loops (outer ones minus holes) inside a convex polygon of the same plane.
[[nodiscard]] double area_inside(const std::vector<Loop>& loops, const std::vector<Vec3>& convex, const Vec3& normal);

}  // namespace exactff::study
