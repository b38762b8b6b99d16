// The diagnoses of this module, one function each. They return nothing if there is nothing to say.
#pragma once

#include <optional>

#include "exactff/slips.h"
#include "slips/flip_trial.h"

namespace exactff::slips {

// "--flip a,b" for those that --flip has not turned round already.
[[nodiscard]] std::string flag_to_flip(const Scene& scene, std::span<const Selection> selections);

// The words of advice_to_flip(), which has tried it.
[[nodiscard]] std::string words_to_flip(const Scene& scene, std::span<const Selection> selections);

[[nodiscard]] std::optional<Finding> contradicting_normals(const Scene& scene, FlipTrials& trials);
// kInwardSurface, kOutwardRoom.
[[nodiscard]] std::vector<Finding> turned_surfaces(const Scene& scene, FlipTrials& trials);
[[nodiscard]] std::optional<Finding> outward_rooms(const Scene& scene, std::span<const Selection> turned);
// kUnseenFront, kEmitterLooksAway. Requires that no surface is turned the wrong way: its backs are what others see.
[[nodiscard]] std::vector<Finding> unseen_fronts(const Scene& scene, FlipTrials& trials);
[[nodiscard]] std::vector<Finding> twin_faces(const Scene& scene);  // kDoubledFaces, kOppositeFaces
// kOverlappingFronts, kNearlyCoplanar, except of `turned`: what lies on the back of a table does not overlap it.
[[nodiscard]] std::vector<Finding> overlap_findings(const Scene& scene, std::span<const Selection> turned);
// kOpenFloor, kNoBottom, kNearContact, kOverlappingSolids.
[[nodiscard]] std::vector<Finding> contact_findings(const Scene& scene);
[[nodiscard]] std::optional<Finding> odd_scale(const Scene& scene);

}  // namespace exactff::slips
