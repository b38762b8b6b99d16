#include <algorithm>
#include <set>

#include "exactff/matrix.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "matrix/entry_jobs.h"
#include "matrix/row_facts.h"
#include "matrix/surroundings.h"
#include "text/escape.h"
#include "text/refuse.h"

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
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection patch{static_cast<PatchId>(p), {}};
    if (!scene.faces_of(patch).empty() && !seen.contains(patch.patch)) return false;
  }
  return true;
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

// By its number, row by row, with back, open and buried.
ViewFactor& entry_of(Matrix& matrix, std::size_t entry) {
  const std::size_t patches = matrix.factors.to.size();
  const std::size_t width =
      patches + (matrix.back.empty() ? 0 : 1) + (matrix.open.empty() ? 0 : 1) + (matrix.buried.empty() ? 0 : 1);
  const std::size_t row = entry / width, column = entry % width;
  if (column < patches) return matrix.factors.entries[row * patches + column];
  if (!matrix.buried.empty() && column + 1 == width) return matrix.buried[row];
  return (matrix.back.empty() || column > patches ? matrix.open : matrix.back)[row];
}

}  // namespace

Claim weaker(Claim a, Claim b) { return std::min(a, b); }

Matrix compute(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
               const Options& options, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const EntryJobs jobs(scene, from, to, options);
  Matrix result{{{from.begin(), from.end()}, {to.begin(), to.end()}, {}}, {}, {}, {}};
  result.factors.entries.resize(from.size() * to.size());
  if (options.backs) result.back.resize(from.size());
  if (options.open) result.open.resize(from.size());
  if (jobs.has_buried()) result.buried.resize(from.size());
  const files::Loop loop{
      .count = jobs.count(), .threads = options.threads, .stage = "view factors", .name = [&](std::size_t job) {
        return jobs.name(job);
      }};
  const files::Body body = [&](std::size_t job) {
    jobs.compute(job, [&](std::size_t entry, const ViewFactor& f) { entry_of(result, entry) = f; });
  };
  files::parallel_for(loop, hooks, [&] { return body; });
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
    if (!matrix.buried.empty()) add(matrix.buried[i]);
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

namespace {

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

}  // namespace exactff::matrix
