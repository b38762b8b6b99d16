// How receivers see the sources, taken from the record of the exact method: each by itself, and a profile along a line
// through a penumbra.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "exactff/study.h"

namespace exactff::study {

[[nodiscard]] Sight sight_of(const FormFactor& result);
// For several planes or sources together.
[[nodiscard]] Sight joined(Sight a, Sight b);

// True if the adaptive algorithm needs rays to decide what is visible.
[[nodiscard]] bool needs_rays(const FormFactor& result);

// The receivers that a study examines in detail: evenly spaced among those that see the source partly, and for one
// third among those that see all of it; other receivers if there are too few. Ascending.
[[nodiscard]] std::vector<std::size_t> choose_receivers(const std::vector<ExactRow>& exact, std::size_t count);

// How a receiver sees each source: not at all, hidden, partly hidden or fully visible.
[[nodiscard]] std::vector<Sight> sights(const Scene& scene, const Receiver& receiver,
                                        std::span<const ExactSource> sources);

// The radiosity along a line of receivers: the exact values and those of other methods. Requires exact values and
// ladders. If the receivers are not a grid on a quadrilateral, or none sees the source partly, says so instead. The
// line is the row of the grid with the most such receivers.
[[nodiscard]] std::variant<Profile, LeftOut> find_profile(const Study& study, std::span<const ExactSource> sources,
                                                          const Hooks& hooks);

// --- Compares the decisions of sampling with the exact visible region ---

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
