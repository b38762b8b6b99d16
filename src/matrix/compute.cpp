#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include "exactff/matrix.h"
#include "kernel/float_environment.h"
#include "kernel/outward.h"
#include "matrix/surroundings.h"

namespace exactff::matrix {
namespace {

using kernel::above;
using kernel::below;

// The same patches of a scene with more faces.
std::vector<Selection> of_any_scene(std::span<const Selection> patches) {
  std::vector<Selection> result(patches.begin(), patches.end());
  for (Selection& patch : result) patch.scene = kAnyScene;
  return result;
}

void take_work(ViewFactor& sum, const ViewFactor& f) {
  sum.claim = weaker(sum.claim, f.claim);
  sum.accurate = sum.accurate && f.accurate;
  sum.cells += f.cells;
  sum.event_cells += f.event_cells;
}

// Zero is exact, so that proved zeros stay zeros.
void add(ViewFactor& sum, const ViewFactor& f) {
  sum.area_from = f.area_from;
  sum.area_to += f.area_to;
  take_work(sum, f);
  if (f.upper == 0.0) return;
  const bool first = sum.upper == 0.0;
  sum.value += f.value;
  sum.lower = first ? f.lower : std::max(0.0, below(sum.lower + f.lower));
  sum.upper = first ? f.upper : above(sum.upper + f.upper);
}

// f is a part of the sum.
void subtract(ViewFactor& sum, const ViewFactor& f) {
  sum.area_to = std::max(0.0, sum.area_to - f.area_to);
  take_work(sum, f);
  if (f.upper == 0.0) return;
  sum.value -= f.value;
  sum.lower = below(sum.lower - f.upper);
  sum.upper = above(sum.upper - f.lower);
}

void clamp(ViewFactor& sum) {
  sum.lower = std::clamp(sum.lower, 0.0, 1.0);
  sum.upper = std::clamp(sum.upper, 0.0, 1.0);
  sum.value = std::clamp(sum.value, sum.lower, sum.upper);
}

std::vector<ViewFactor> factors_to_backs(const Scene& scene, std::span<const Selection> from, const Options& options,
                                         const Hooks& hooks) {
  const SceneWithBacks all = with_backs(scene);
  std::vector<Selection> to;
  for (const auto& patch : {all.backs, all.both, all.fronts}) {
    if (patch) to.push_back(*patch);
  }
  const ViewFactorMatrix parts =
      view_factor_matrix(all.scene, of_any_scene(from), to, options.factors, options.threads, hooks);
  std::vector<ViewFactor> result(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (std::size_t j = 0; j < to.size(); ++j) {
      const bool is_fronts = all.fronts && to[j] == *all.fronts;
      is_fronts ? subtract(result[i], parts.at(i, j)) : add(result[i], parts.at(i, j));
    }
    clamp(result[i]);
  }
  return result;
}

std::vector<ViewFactor> factors_to_sky(const Scene& scene, std::span<const Selection> from, const Options& options,
                                       const Hooks& hooks) {
  const SceneWithSky all = with_sky(scene);
  return view_factor_matrix(all.scene, of_any_scene(from), {&all.sky, 1}, options.factors, options.threads, hooks)
      .entries;
}

// Each patch with area is a column, as a whole, exactly once.
bool has_every_patch(const Scene& scene, const std::vector<Selection>& to) {
  std::set<PatchId> seen;
  for (const Selection& patch : to) {
    if (patch.face || !seen.insert(patch.patch).second) return false;
  }
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection patch{static_cast<PatchId>(p), {}};
    if (!scene.faces_of(patch).empty() && !seen.contains(patch.patch)) return false;
  }
  return true;
}

// At a point of a face that is not planar, its other triangles are seen, but hide nothing.
bool has_bent_rows(const Scene& scene, const std::vector<Selection>& from) {
  return std::ranges::any_of(from, [&](const Selection& patch) {
    return std::ranges::any_of(scene.faces_of(patch),
                               [&](FaceId face) { return scene.face(face).shape == FaceShape::kTriangulated; });
  });
}

// From the weakest. Names, so that a claim that is not listed here counts as the weakest.
int strength(Claim claim) {
  constexpr std::array<std::string_view, 4> kClaims = {"statistical", "topology-proved", "certified", "zero"};
  const auto found = std::ranges::find(kClaims, to_string(claim));
  return found == kClaims.end() ? -1 : static_cast<int>(found - kClaims.begin());
}

}  // namespace

Claim weaker(Claim a, Claim b) { return strength(a) <= strength(b) ? a : b; }

Matrix compute(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
               const Options& options, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  Matrix result{view_factor_matrix(scene, from, to, options.factors, options.threads, hooks), {}, {}};
  if (from.empty()) return result;
  if (options.backs) result.back = factors_to_backs(scene, from, options, hooks);
  if (options.open) result.open = factors_to_sky(scene, from, options, hooks);
  return result;
}

std::vector<Sum> row_sums(const Matrix& matrix) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Sum> sums(matrix.factors.from.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto add = [&sum = sums[i]](const ViewFactor& f) {
      if (f.lower > 0.0) sum.lower = sum.lower == 0.0 ? f.lower : below(sum.lower + f.lower);
      if (f.upper > 0.0) sum.upper = sum.upper == 0.0 ? f.upper : above(sum.upper + f.upper);
    };
    for (std::size_t j = 0; j < matrix.factors.to.size(); ++j) add(matrix.factors.at(i, j));
    if (!matrix.back.empty()) add(matrix.back[i]);
    if (!matrix.open.empty()) add(matrix.open[i]);
  }
  return sums;
}

std::vector<std::string> reasons_against_one(const Scene& scene, const Matrix& matrix) {
  std::vector<std::string> reasons;
  if (!has_every_patch(scene, matrix.factors.to)) reasons.emplace_back("not every patch is a column, once");
  if (matrix.back.empty()) reasons.emplace_back("what meets backs is not computed");
  if (matrix.open.empty()) reasons.emplace_back("what is open is not computed");
  if (!scene.transparent().empty()) reasons.emplace_back("some faces are transparent");
  if (has_bent_rows(scene, matrix.factors.from)) reasons.emplace_back("some faces of the rows are not planar");
  if (have_fronts_in_common(scene)) reasons.emplace_back("fronts of different patches overlap in one plane");
  return reasons;
}

}  // namespace exactff::matrix
