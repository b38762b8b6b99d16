// How receivers see the sources, taken from the record of the exact method: each by itself, the edges of shadows
// between them, and a profile along a line through a penumbra.
#pragma once

#include <span>
#include <variant>

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

// See Study::edge_distance.
struct ShadowEdges {
  std::vector<double> distance;
  double resolution = 0.0;
};
// Where the visibility of the sources changes in kind, from a raster finer than the grid of receivers; or why there are
// none. The distance of a receiver is that to the nearest such place.
[[nodiscard]] std::variant<ShadowEdges, LeftOut> find_shadow_edges(const Request& request,
                                                                   std::span<const ExactSource> sources,
                                                                   const Hooks& hooks);

// The radiosity along a line of receivers: the exact values and those of other methods. Requires exact values and
// ladders. If the receivers are not a grid on a quadrilateral, or none sees the source partly, says so instead. The
// line is the row of the grid with the most such receivers.
[[nodiscard]] std::variant<Profile, LeftOut> find_profile(const Study& study, std::span<const ExactSource> sources,
                                                          const Hooks& hooks);

}  // namespace exactff::study
