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
#include "slips/sight_lines.h"

namespace exactff::slips {

// --- Outlook ---

// What both sides of all surfaces look at, by rays in doubles. From this table follows, for any choice of fronts, how
// much of what the fronts look at is lost.

// One side of a piece: twice the index of the piece, and 1 more for its back.
using Side = std::uint32_t;
inline std::uint32_t piece_of(Side side) { return side / 2; }

using Flipped = std::vector<bool>;  // by face

class Outlook {
 public:
  struct Ray {
    Side from = 0;
    double area = 0.0;            // for which it stands
    std::vector<Side> seen = {};  // up to the first face that is not transparent, with all faces in the same place
    bool clear = true;            // no two of them are in the same place
    bool ends = false;            // on a face that is not transparent: of others, no backs are seen
  };

  // The same number of rays from both sides of each of the oriented surfaces. None starts where another face lies on
  // the surface. There are no rays if there are too many surfaces, or if doubles do not suffice.
  Outlook(const Scene& scene, const SightLines& sight);

  [[nodiscard]] const std::vector<Ray>& rays() const { return rays_; }
  [[nodiscard]] const std::vector<std::uint32_t>& surface_of_piece() const { return surface_; }

  [[nodiscard]] bool is_front(Side side, const Flipped& flipped) const {
    return (side % 2 == 1) == flipped[index_of(scene_.pieces()[piece_of(side)].face)];
  }
  // The ray starts from a front and meets one.
  [[nodiscard]] bool is_good(const Ray& ray, const Flipped& flipped) const;

  // Summed over fronts, the area times the share of the view that shows backs, or nothing.
  struct Lost {
    double to_backs = 0.0, to_nothing = 0.0;
    [[nodiscard]] double total() const { return to_backs + to_nothing; }
  };
  [[nodiscard]] Lost lost(const Flipped& flipped) const;

 private:
  void cast(const SightLines& sight, const std::vector<std::uint32_t>& pieces, std::size_t count);
  void cast(const SightLines& sight, std::uint32_t piece, const Vec3& point, const double* place, double area);
  [[nodiscard]] bool is_covered(const SightLines& sight, std::uint32_t piece, const Vec3& point) const;

  const Scene& scene_;
  std::vector<std::uint32_t> surface_;  // by piece
  std::vector<Ray> rays_;
};

// --- Connected surfaces whose faces agree on which side is the front ---

// By piece: the number of its surface, from 0. Two pieces that are alone at an edge, and run along it in opposite
// directions, belong to one surface; likewise the pieces of a face. Edges count in parts where ends of others lie on
// them (T-junctions). Where more than two pieces meet, an edge joins none of them.
[[nodiscard]] std::vector<std::uint32_t> oriented_surfaces(const Scene& scene);

// --- Trials ---

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

}  // namespace exactff::slips
