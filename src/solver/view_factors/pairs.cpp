#include "view_factors/pairs.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "kernel/float_environment.h"
#include "scene/scene_copy.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "view_factors/exact_scene.h"
#include "view_factors/pair_memory.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"
#include "view_factors/view_factor.h"

namespace exactff::view_factors {
namespace {

void check_accuracy(double accuracy) {
  if (accuracy > 0.0 && std::isfinite(accuracy)) return;
  text::refuse("the accuracy of a view factor is " + text::shortest(accuracy), "it bounds an error",
               "give a positive number; the default is 1e-6");
}

// Patches of the given scene, in a copy of it.
std::vector<PreparedPatch> prepare(const Scene& given, const ExactScene& scene, std::span<const Selection> patches) {
  std::vector<PreparedPatch> result;
  for (const Selection& patch : patches) {
    (void)given.faces_of(patch);  // throws if it is of another scene
    result.emplace_back(scene, Selection{patch.patch, patch.face});
  }
  return result;
}

// The entries that are computed, each with those that are its transposes.
std::vector<std::vector<std::size_t>> pairs_of(const std::vector<PreparedPatch>& from,
                                               const std::vector<PreparedPatch>& to, bool both_directions) {
  std::map<std::pair<std::pair<PatchId, std::optional<FaceId>>, std::pair<PatchId, std::optional<FaceId>>>, std::size_t>
      known;
  const auto key = [](const PreparedPatch& p) { return std::pair(p.selection.patch, p.selection.face); };
  std::vector<std::vector<std::size_t>> result;
  for (std::size_t e = 0; e < from.size() * to.size(); ++e) {
    const PreparedPatch &i = from[e / to.size()], &j = to[e % to.size()];
    const bool once = i.planar && j.planar && !both_directions;
    if (const auto other = once ? known.find({key(j), key(i)}) : known.end(); other != known.end()) {
      result[other->second].push_back(e);
    } else {
      if (once) known.emplace(std::pair(key(i), key(j)), result.size());
      result.push_back({e});
    }
  }
  return result;
}

}  // namespace

struct Pairs::Patches {
  Patches(const Scene& given, std::span<const Selection> from, std::span<const Selection> to)
      : moved(near_origin(given)),
        scene(moved ? *moved : given),
        seen(scene),
        rows(prepare(given, scene, from)),
        columns(prepare(given, scene, to)) {}

  std::optional<Scene> moved;
  ExactScene scene;
  SeenParts seen;
  std::vector<PreparedPatch> rows, columns;
  mutable PairMemories memories;
};

Pairs::Pairs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
             const ViewFactorOptions& options)
    : options_(options) {
  check_accuracy(options.accuracy);
  patches_ = std::make_unique<const Patches>(scene, from, to);
  entries_ = pairs_of(patches_->rows, patches_->columns, options.both_directions);
}
Pairs::~Pairs() = default;

double Pairs::area_from(std::size_t row) const { return patches_->rows[row].area; }

void Pairs::compute(std::size_t pair, const std::function<void(std::size_t, const ViewFactor&)>& take) const {
  const kernel::StandardArithmetic of_thread;
  const std::vector<std::size_t>& entries = entries_[pair];
  const std::size_t columns = patches_->columns.size(), first = entries.front();
  const PreparedPatch &from = patches_->rows[first / columns], &to = patches_->columns[first % columns];
  std::unique_ptr<PairMemory> memory = patches_->memories.take();
  const ViewFactor computed = factor_between(patches_->scene, patches_->seen, from, to, options_, *memory);
  patches_->memories.give_back(std::move(memory));
  take(first, computed);
  for (const std::size_t entry : std::span(entries).subspan(1)) take(entry, transpose(computed, from, to));
}

}  // namespace exactff::view_factors
