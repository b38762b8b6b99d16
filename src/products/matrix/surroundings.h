// What rows of a matrix see besides fronts: factors to patches that are added to copies of the scene.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "exactff/view_factors.h"
#include "kernel/disc.h"
#include "scene/scene_copy.h"
#include "view_factors/pairs.h"

namespace exactff::matrix {

// Of a share of an area: all of it, exactly.
[[nodiscard]] inline bool is_whole_share(const kernel::Disc& share) {
  return share.centre == 1.0 && share.radius == 0.0;
}

// Targets that are no patches of a scene: backs, all sides, the sky, windows. They are patches of a copy of it, since
// panels, exact coordinates and the search for what hides a patch are made for all faces of a scene together. In the
// copy, all patches and faces of the scene keep their ids, and what was added is transparent.
class Targets {
 public:
  struct Added {
    SceneCopy copy;
    std::vector<PatchId> patches = {};  // of the copy: the columns
    std::vector<view_factors::Columns> kinds = {};
  };
  // Factors to columns that are not patches: the other direction is not asked for, but may give this one.
  Targets(Added added, std::span<const Selection> from, const ViewFactorOptions& options);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const view_factors::Pairs& pairs() const { return pairs_; }
  [[nodiscard]] std::span<const Selection> from() const { return from_; }  // in the copy
  [[nodiscard]] std::span<const Selection> to() const { return to_; }
  // Also where rows are equal, and so one pair gives several entries. `finer`: see Pairs::compute.
  [[nodiscard]] ViewFactor factor(std::size_t row, std::size_t column, double finer = 1.0) const;

 private:
  Scene scene_;
  std::vector<Selection> from_, to_;
  view_factors::Pairs pairs_;
};

// For each row, what it sees of backs.
class BackFactors {
 public:
  BackFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options);

  // Of the row's patch, without its area. From any thread.
  [[nodiscard]] ViewFactor of_row(std::size_t row) const;

  // False is a proof.
  [[nodiscard]] bool may_see_some(std::size_t row) const;
  [[nodiscard]] bool is_enclosed(std::size_t row) const { return targets_.pairs().is_enclosed(row); }

 private:
  struct Term {
    std::size_t column;
    bool is_subtracted;
  };
  [[nodiscard]] std::vector<Term> terms_of(std::size_t row) const;
  [[nodiscard]] double find_area() const;

  double accuracy_;
  std::size_t whole_ = 0;  // columns; after them come three for each plane with an overlap
  Targets targets_;
  double area_;
};

// For each row, what is open: by the cheapest of a few ways that hold.
//
// - Closed surfaces around all that the row sees: nothing.
// - Surfaces around it that are almost closed: no more than their strips let through, if that is within the accuracy.
// - Within a surface with a convex hole in a plane, and nothing beyond: the factor to the hole.
// - If little is there to be seen: the rest that the faces leave of 1, from either side.
// - Otherwise, or if the rest is not accurate: the factor to the sky or the rest, the one that is narrower.
class OpenFactors {
 public:
  // Keeps references to the scene and its pairs, whose rows these are. Throws InputError if the scene is so large that
  // there is no double to put a corner of the sky at.
  OpenFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options,
              const view_factors::Pairs& pairs);

  // Of the row's patch, without its area. From any thread.
  [[nodiscard]] ViewFactor of_row(std::size_t row) const;

 private:
  [[nodiscard]] const Targets& sides() const;  // what rows see of faces, from either side
  // By the last two ways.
  [[nodiscard]] ViewFactor computed(std::size_t row) const;

  const Scene& scene_;
  std::vector<Selection> from_;
  ViewFactorOptions options_;
  const view_factors::Pairs& pairs_;
  std::vector<std::size_t> surfaces_;  // of each window: an index of ClosedSurfaces::surfaces()
  Targets targets_;                    // the sky, then the windows
  mutable std::once_flag sides_once_;
  mutable std::unique_ptr<const Targets> sides_;  // made when asked for
};

// What is proved of patches without a factor: that no point of one sees a back, or anything open. False does not mean
// that it does.
struct ProvedZeros {
  std::vector<bool> back, open;  // for each of the patches
};
[[nodiscard]] ProvedZeros proved_zeros(const Scene& scene, std::span<const Selection> from);

// Whether fronts of different patches overlap in one plane.
[[nodiscard]] bool have_fronts_in_common(const Scene& scene);

}  // namespace exactff::matrix
