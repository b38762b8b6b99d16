#include "matrix/rows.h"

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "exactff/version.h"
#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "matrix/surroundings.h"
#include "scene/selections.h"
#include "text/escape.h"
#include "text/refuse.h"
#include "vtk/vtk.h"

namespace exactff::matrix {
namespace {

using kernel::above;
using kernel::below;

// Each patch with area is a column, as a whole, exactly once.
bool has_every_patch(const Scene& scene, const std::vector<Selection>& to) {
  std::set<PatchId> seen;
  for (const Selection& patch : to) {
    if (patch.face || !seen.insert(patch.patch).second) return false;
  }
  return std::ranges::all_of(all_patches(scene), [&](const Selection& patch) { return seen.contains(patch.patch); });
}

// No patch or face is a column twice, and no face beside its patch.
bool are_different(const std::vector<Selection>& to) {
  std::set<PatchId> patches, with_faces;
  std::set<FaceId> faces;
  for (const Selection& column : to) {
    const bool is_new = column.face ? faces.insert(*column.face).second : patches.insert(column.patch).second;
    if (!is_new) return false;
    if (column.face) with_faces.insert(column.patch);
  }
  return std::ranges::none_of(with_faces, [&](PatchId patch) { return patches.contains(patch); });
}

std::vector<std::size_t> columns_of(const Scene& scene, const std::string& name, const std::vector<Selection>& to) {
  std::set<std::size_t> columns;
  for (const Selection& part : scene.select_all(name)) {
    const auto found = std::ranges::find(to, part);
    if (found == to.end()) {
      text::refuse("the sum of " + text::in_quotes(name, text::kShownName) + " is asked for, and its part " +
                       text::in_quotes(scene.name_of(part), text::kShownName) + " is no column",
                   "a sum is of columns of the matrix", "name it by --to as well");
    }
    columns.insert(static_cast<std::size_t>(found - to.begin()));
  }
  return {columns.begin(), columns.end()};
}

ViewFactor sum_of(const Factors& all, std::size_t row, const std::vector<std::size_t>& columns, bool at_most_one,
                  double accuracy) {
  ViewFactor sum = all.at(row, columns.front());
  for (const std::size_t column : std::span(columns).subspan(1)) {
    const ViewFactor& f = all.at(row, column);
    sum.value += f.value;
    if (f.lower > 0.0) sum.lower = sum.lower == 0.0 ? f.lower : below(sum.lower + f.lower);
    if (f.upper > 0.0) sum.upper = sum.upper == 0.0 ? f.upper : above(sum.upper + f.upper);
    sum.area_to += f.area_to;
    sum.claim = weaker(sum.claim, f.claim);
    if (f.way == Way::kPoints) sum.way = f.way;
    if (sum.limit == Limit::kNone) sum.limit = f.limit;
    sum.cells += f.cells;
    sum.event_cells += f.event_cells;
  }
  if (at_most_one && sum.lower <= 1.0)
    sum.upper = std::min(sum.upper, 1.0);  // else a bound does not hold, and it shows
  sum.value = std::clamp(sum.value, sum.lower, sum.upper);
  sum.accurate = sum.upper - sum.lower <= accuracy;
  return sum;
}

}  // namespace

Claim weaker(Claim a, Claim b) { return std::min(a, b); }

Claim claim_of(const Matrix& matrix, bool with_rest) {
  Claim claim = Claim::kZero;
  const auto add = [&](const std::vector<ViewFactor>& factors) {
    for (const ViewFactor& f : factors) claim = weaker(claim, f.claim);
  };
  add(matrix.factors.entries);
  if (with_rest) add(matrix.back), add(matrix.open);
  return claim;
}

double area_of_row(const Matrix& matrix, std::size_t row) {
  if (!matrix.factors.to.empty()) return matrix.factors.at(row, 0).area_from;
  return (!matrix.back.empty() ? matrix.back : !matrix.open.empty() ? matrix.open : matrix.buried)[row].area_from;
}

bool has_estimates(const Matrix& matrix, std::size_t row) {
  const auto is_estimate = [](const ViewFactor& f) { return f.claim == Claim::kEstimated; };
  const std::size_t columns = matrix.factors.to.size();
  return std::ranges::any_of(std::span(matrix.factors.entries).subspan(row * columns, columns), is_estimate) ||
         (!matrix.back.empty() && is_estimate(matrix.back[row])) ||
         (!matrix.open.empty() && is_estimate(matrix.open[row]));
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
    for (const auto* rest : {&matrix.back, &matrix.open, &matrix.buried}) {
      if (!rest->empty()) add((*rest)[i]);
    }
  }
  return sums;
}

std::vector<Sum> clipped_row_sums(const Scene& scene, const Matrix& matrix) {
  std::vector<Sum> sums = row_sums(matrix);
  if (!are_different(matrix.factors.to) || !scene.transparent().empty() || have_fronts_in_common(scene)) return sums;
  for (Sum& sum : sums) {
    if (sum.lower <= 1.0) sum.upper = std::min(sum.upper, 1.0);  // else a bound does not hold, and it shows
  }
  return sums;
}

void add_sums(const Scene& scene, std::span<const std::string> names, double accuracy, Matrix& matrix) {
  const kernel::StandardArithmetic arithmetic;
  const Factors& all = matrix.factors;
  const bool at_most_one = are_different(all.to) && scene.transparent().empty() && !have_fronts_in_common(scene);
  for (const std::string& name : names) {
    if (std::ranges::find(matrix.sums, name, &GroupSum::name) != matrix.sums.end()) {
      text::refuse("the sum of " + text::in_quotes(name, text::kShownName) + " is asked for twice",
                   "its column would be there twice", "give each name once");
    }
    GroupSum sum{name, columns_of(scene, name, all.to), {}};
    for (std::size_t i = 0; i < all.from.size(); ++i) {
      sum.factors.push_back(sum_of(all, i, sum.columns, at_most_one, accuracy));
    }
    matrix.sums.push_back(std::move(sum));
  }
}

std::vector<std::string> reasons_against_one(const Scene& scene, const Factors& factors, Surroundings known) {
  std::vector<std::string> reasons;
  if (!has_every_patch(scene, factors.to)) reasons.emplace_back("not every patch is a column, once");
  if (!known.back) reasons.emplace_back("what meets backs is not computed");
  if (!known.open) reasons.emplace_back("what is open is not computed");
  if (!scene.transparent().empty()) reasons.emplace_back("some faces are transparent");
  if (have_fronts_in_common(scene)) reasons.emplace_back("fronts of different patches overlap in one plane");
  return reasons;
}

std::vector<std::string> reasons_against_one(const Scene& scene, const Matrix& matrix) {
  return reasons_against_one(scene, matrix.factors, {.back = !matrix.back.empty(), .open = !matrix.open.empty()});
}

// --- Reciprocity ---

namespace {

// A F / M, where M is the larger area: the factor from the larger patch.
struct Exchange {
  double value, lower, upper;
};

Exchange exchange(const ViewFactor& f) {
  const double share = f.area_from / std::max(f.area_from, f.area_to);
  if (f.upper == 0.0) return {0.0, 0.0, 0.0};
  return {f.value * share, std::max(0.0, below(f.lower * share * (1.0 - 2.0 * kRoundedAreas))),
          above(f.upper * share * (1.0 + 2.0 * kRoundedAreas))};
}

double radius_of(const Exchange& e) { return std::max(e.upper - e.value, e.value - e.lower); }

std::optional<std::size_t> place_of(const Selection& patch, const std::vector<Selection>& in) {
  const auto found = std::ranges::find(in, patch);
  return found == in.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - in.begin()));
}

// distance / radius, without a division by 0.
bool is_worse(const Reciprocity::Pair& a, const Reciprocity::Pair& b) {
  return a.distance * b.radius > b.distance * a.radius;
}

void add_pair(Reciprocity& result, std::size_t row, std::size_t column, const ViewFactor& forth,
              const ViewFactor& back) {
  const Exchange a = exchange(forth), b = exchange(back);
  const Reciprocity::Pair pair{row, column, std::max(a.value, b.value) - std::min(a.value, b.value),
                               radius_of(a) + radius_of(b)};
  ++result.pairs;
  if (a.lower > b.upper || b.lower > a.upper) result.apart.push_back(pair);
  if (!result.worst || is_worse(pair, *result.worst)) result.worst = pair;
}

}  // namespace

Reciprocity reciprocity(const Matrix& matrix) {
  const kernel::StandardArithmetic arithmetic;
  const Factors& all = matrix.factors;
  std::vector<std::optional<std::size_t>> column_of_row, row_of_column;
  for (const Selection& patch : all.from) column_of_row.push_back(place_of(patch, all.to));
  for (const Selection& patch : all.to) row_of_column.push_back(place_of(patch, all.from));
  Reciprocity result;
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      if (!column_of_row[i] || !row_of_column[j] || *row_of_column[j] <= i) continue;
      add_pair(result, i, j, all.at(i, j), all.at(*row_of_column[j], *column_of_row[i]));
    }
  }
  return result;
}

// --- For ParaView ---

void write_vtk(const Scene& scene, const Matrix& matrix, const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  const Factors& all = matrix.factors;
  EXACTFF_EXPECT(!all.from.empty());
  const auto field = [&](const char* name, double ViewFactor::*number) {
    return vtk::field_of_faces(scene, name, all.to, 1,
                               [&](std::size_t j, std::size_t) { return all.at(0, j).*number; });
  };
  vtk::write_faces(
      scene,
      {field("factor", &ViewFactor::value), field("lower", &ViewFactor::lower), field("upper", &ViewFactor::upper)},
      {"exactff " + std::string(kVersion) + ", view factors from " + scene.name_of(all.from.front())}, file);
}

}  // namespace exactff::matrix
