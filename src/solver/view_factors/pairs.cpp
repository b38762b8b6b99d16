#include "view_factors/pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "kernel/float_environment.h"
#include "scene/scene_copy.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "view_factors/exact_scene.h"
#include "view_factors/pair_memory.h"
#include "view_factors/patch_bounds.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"
#include "view_factors/strata.h"
#include "view_factors/view_factor.h"

namespace exactff::view_factors {
namespace {

void check_accuracy(double accuracy) {
  if (accuracy > 0.0 && std::isfinite(accuracy)) return;
  text::refuse("the accuracy of a view factor is " + text::shortest(accuracy), "it bounds an error",
               "give a positive number; the default is 1e-6");
}

using Key = std::pair<PatchId, std::optional<FaceId>>;
Key key_of(const Selection& selection) { return {selection.patch, selection.face}; }

// Whether a part of the one may see a part of the other.
bool sees_some_of(const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to) {
  for (std::size_t i = 0; i < from.parts.size(); ++i) {
    for (std::size_t j = 0; j < to.parts.size(); ++j) {
      if (!are_separated(seen, from, i, to, j) && from.seen.sees(seen, from.parts, i, to.parts[j])) return true;
    }
  }
  return false;
}

// The mean over the whole patch: nothing is seen from what is buried.
ViewFactor of_whole(ViewFactor f, const PreparedPatch& from, const PreparedPatch& to) {
  f.area_from = from.whole_area;
  f.area_to = to.whole_area;
  const kernel::Disc& share = from.exposed_share;
  if (f.claim == Claim::kZero || (share.centre == 1.0 && share.radius == 0.0)) return f;
  f.lower = std::clamp(lower_end(f.lower * share), 0.0, 1.0);
  f.upper = std::clamp(upper_end(f.upper * share), 0.0, 1.0);
  f.value = std::clamp(f.value * share.centre, f.lower, f.upper);
  return f;
}

}  // namespace

struct Pairs::Patches {
  // Selections of the given scene, in a copy of it.
  Patches(const Scene& given, std::span<const Selection> from, std::span<const Selection> to, Columns what)
      : moved(near_origin(given)), scene(moved ? *moved : given), seen(scene) {
    rows = prepare(given, from, Columns::kPatches);
    columns = prepare(given, to, what);
  }

  std::vector<const PreparedPatch*> prepare(const Scene& given, std::span<const Selection> patches, Columns what) {
    std::vector<const PreparedPatch*> result;
    for (const Selection& patch : patches) {
      (void)given.faces_of(patch);  // throws if it is of another scene
      std::unique_ptr<const PreparedPatch>& known = prepared[key_of(patch)];
      if (known == nullptr) {
        known = std::make_unique<const PreparedPatch>(scene, Selection{patch.patch, patch.face}, what);
      }
      result.push_back(known.get());
    }
    return result;
  }

  std::optional<Scene> moved;
  ExactScene scene;
  SeenParts seen;
  std::map<Key, std::unique_ptr<const PreparedPatch>> prepared;
  std::vector<const PreparedPatch*> rows, columns;
  mutable PairMemories memories;
};

Pairs::Pairs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
             const ViewFactorOptions& options, Columns what)
    : options_(options) {
  check_accuracy(options.accuracy);
  patches_ = std::make_unique<const Patches>(scene, from, to, what);
  std::map<std::pair<Key, Key>, std::size_t> known;
  for (std::size_t e = 0; e < from.size() * to.size(); ++e) {
    const Ends ends = ends_of(e);
    const auto [place, is_new] =
        known.try_emplace({key_of(ends.from->selection), key_of(ends.to->selection)}, entries_.size());
    if (is_new) entries_.emplace_back();
    entries_[place->second].push_back(e);
    pair_of_.push_back(place->second);
  }
}
Pairs::~Pairs() = default;

double Pairs::area_from(std::size_t row) const { return patches_->rows[row]->whole_area; }
double Pairs::area_to(std::size_t column) const { return patches_->columns[column]->whole_area; }
kernel::Disc Pairs::exposed_share(std::size_t row) const { return patches_->rows[row]->exposed_share; }

bool Pairs::is_enclosed(std::size_t row) const {
  const PreparedPatch& patch = *patches_->rows[row];
  return std::ranges::all_of(patch.seen.windings(patches_->seen, patch.parts), [&](const Windings& windings) {
    return patches_->seen.enclosures().are_around(windings);
  });
}

bool Pairs::is_within(std::size_t row, std::size_t surface) const {
  const PreparedPatch& patch = *patches_->rows[row];
  return std::ranges::all_of(patch.seen.windings(patches_->seen, patch.parts),
                             [&](const Windings& windings) { return windings[surface] && *windings[surface] != 0; });
}

bool Pairs::may_see(std::size_t row, std::size_t column) const {
  return sees_some_of(patches_->seen, *patches_->rows[row], *patches_->columns[column]);
}

double Pairs::unhidden(std::size_t row, std::size_t column) const {
  const PreparedPatch &from = *patches_->rows[row], &to = *patches_->columns[column];
  if (from.parts.empty()) return 0.0;
  PatchBounds bounds(patches_->scene, patches_->seen, from, to);
  const Strata strata = strata_of(from.parts, kFewestStrata);
  double sum = 0.0;
  for (const Stratum& stratum : strata.strata) {
    const Tile& tile = strata.tiles[stratum.begin];
    const Vec3 middle = reach_of(from.parts[tile.part], tile).middle;
    sum += stratum.area / strata.area * bounds.range_at(tile.part, middle);
  }
  return std::min(1.0, sum);
}

// Of two patches that may be exchanged, the one that comes first in the scene is seen from, whichever is asked for.
Pairs::Ends Pairs::ends_of(std::size_t entry) const {
  const std::size_t columns = patches_->columns.size();
  const PreparedPatch *const row = patches_->rows[entry / columns], *const column = patches_->columns[entry % columns];
  const bool turned = is_symmetric(*column, options_) && key_of(column->selection) < key_of(row->selection);
  return turned ? Ends{column, row, true} : Ends{row, column, false};
}

void Pairs::compute(std::size_t pair, const std::function<void(std::size_t, const ViewFactor&)>& take,
                    double finer) const {
  const kernel::StandardArithmetic of_thread;
  ViewFactorOptions options = options_;
  options.accuracy /= finer;
  const auto [from, to, turned] = ends_of(entries_[pair].front());
  // First what the row may see, which all of its entries ask for.
  const PreparedPatch &row = turned ? *to : *from, &column = turned ? *from : *to;
  std::unique_ptr<PairMemory> memory = patches_->memories.take();
  ViewFactor computed{.area_from = from->area, .area_to = to->area};
  if (sees_some_of(patches_->seen, row, column)) {
    computed = factor_between(patches_->scene, patches_->seen, *from, *to, options, *memory);
  }
  patches_->memories.give_back(std::move(memory));
  for (const std::size_t entry : entries_[pair]) {
    const bool is_turned = ends_of(entry).turned;
    take(entry, of_whole(is_turned ? transpose(computed, *from, *to) : computed, is_turned ? *to : *from,
                         is_turned ? *from : *to));
  }
}

}  // namespace exactff::view_factors
