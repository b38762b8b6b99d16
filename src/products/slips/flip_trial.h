// What a flip would change: which patches see each other and how much of the view shows backs, before and after it, by
// rays and lines of sight.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "exactff/slips.h"
#include "slips/outlook.h"
#include "slips/sight_lines.h"

namespace exactff::slips {

// Indices of patches, the lower one first, twice the same for a patch that sees itself.
using PairsInSight = std::set<std::pair<std::size_t, std::size_t>>;

// Of the patches that are turned round, with each other and with all others. Other pairs do not change, since faces
// occlude from both sides.
struct FlipEffect {
  PairsInSight before, after;
  std::size_t lit_before = 0, lit_after = 0;  // pairs of which one emits
  bool stacks = false;                        // a front would lie on the front of another patch
  bool shows_backs = false;                   // fronts would look at more backs
  bool is_complete = true;                    // false if the rays ran out

  // Or may. Neither all pairs nor those of different patches may become fewer, and no more backs may be seen.
  [[nodiscard]] bool darkens() const;
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> gained() const;  // of different patches
  [[nodiscard]] bool helps() const { return !darkens() && !gained().empty(); }
};

// Trials in one scene, which share a limited number of rays.
class FlipTrials {
 public:
  explicit FlipTrials(const Scene& scene);

  [[nodiscard]] FlipEffect try_flip(std::span<const Selection> selections);

  // Those of the selections that a flip of all of them brings into sight of others, if the flip of these alone helps.
  // Otherwise none.
  [[nodiscard]] std::vector<Selection> useful_flips(std::span<const Selection> selections);

 private:
  [[nodiscard]] std::size_t patch_of(std::uint32_t piece) const;
  [[nodiscard]] Vec3 front_of(std::uint32_t piece, const Flipped& flipped) const;
  void look(std::size_t patch, const Flipped& flipped, PairsInSight& pairs);
  void cast_rays(std::size_t patch, const Flipped& flipped, PairsInSight& pairs);
  void draw_lines(std::size_t patch, const Flipped& flipped, PairsInSight& pairs);
  void draw_lines(std::uint32_t from, std::uint32_t to, std::size_t points, const Flipped& flipped,
                  PairsInSight& pairs);
  void follow(std::size_t patch, const Vec3& from, const Vec3& direction, double limit, const Flipped& flipped,
              PairsInSight& pairs);
  [[nodiscard]] std::size_t lit(const PairsInSight& pairs) const;
  [[nodiscard]] bool shows_more_backs(const Flipped& as_they_are, const Flipped& flipped);
  [[nodiscard]] bool is_on_a_front(std::uint32_t piece, const Flipped& flipped) const;

  const Scene& scene_;
  const SightLines sight_;
  std::vector<std::vector<std::uint32_t>> pieces_;  // by patch
  std::vector<std::uint32_t> ends_;                 // of lines
  std::vector<bool> emits_;                         // by patch
  std::uint64_t rays_ = 0;
  std::optional<Outlook> outlook_;  // made when it is needed
};

// --- Findings ---

// The diagnoses of this module, one function each. They return nothing if there is nothing to say.

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
