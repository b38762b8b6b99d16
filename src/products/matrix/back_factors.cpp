#include "matrix/back_factors.h"

#include <algorithm>

#include "exactff/matrix.h"
#include "kernel/float_environment.h"

namespace exactff::matrix {
namespace {

using kernel::above;
using kernel::below;

constexpr double kOfRoundings = 1.0 + 0x1p-20;  // of a sum, unless the accuracy is near them

void take_work(ViewFactor& sum, const ViewFactor& f) {
  sum.claim = weaker(sum.claim, f.claim);
  sum.way = std::max(sum.way, f.way);
  if (sum.limit == Limit::kNone) sum.limit = f.limit;
  sum.cells += f.cells;
  sum.event_cells += f.event_cells;
}

// Zero is exact, so that proved zeros stay zeros.
void add(ViewFactor& sum, const ViewFactor& f) {
  take_work(sum, f);
  if (f.upper == 0.0) return;
  const bool first = sum.upper == 0.0;
  sum.value += f.value;
  sum.lower = first ? f.lower : std::max(0.0, below(sum.lower + f.lower));
  sum.upper = first ? f.upper : above(sum.upper + f.upper);
}

// f is a part of the sum.
void subtract(ViewFactor& sum, const ViewFactor& f) {
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

// In this order; three for each overlap.
std::vector<Selection> columns_of(const SceneWithBacks& made) {
  std::vector<Selection> columns = made.whole;
  for (const auto& [turned, both, fronts] : made.overlaps) columns.insert(columns.end(), {turned, both, fronts});
  return columns;
}

}  // namespace

ViewFactorOptions as_one_direction(const ViewFactorOptions& options) {
  ViewFactorOptions result = options;
  result.both_directions = false;
  return result;
}

ViewFactor factor_of(const view_factors::Pairs& pairs, std::size_t entry, double finer) {
  ViewFactor result;
  const auto take = [&](std::size_t of, const ViewFactor& f) {
    if (of == entry) result = f;
  };
  pairs.compute(pairs.pair_of(entry), take, finer);
  return result;
}

BackFactors::BackFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options)
    : accuracy_(options.accuracy),
      made_(with_backs(scene)),
      columns_(columns_of(made_)),
      pairs_(made_.scene, of_any_scene(from), columns_, as_one_direction(options), view_factors::Columns::kBacks),
      area_(find_area()) {}

double BackFactors::find_area() const {
  double area = 0.0;
  std::size_t column = 0;
  for (; column < made_.whole.size(); ++column) area += pairs_.area_to(column);
  for (; column < columns_.size(); column += 3) {
    area += std::max(0.0, pairs_.area_to(column + 1) - pairs_.area_to(column + 2));
  }
  return area;
}

// Of the columns that the row may see, those that its factor is made of.
std::vector<BackFactors::Term> BackFactors::terms_of(std::size_t row) const {
  std::vector<Term> terms;
  std::size_t column = 0;
  for (; column < made_.whole.size(); ++column) {
    if (pairs_.may_see(row, column)) terms.push_back({column, false});
  }
  for (; column < columns_.size(); column += 3) {
    if (pairs_.may_see(row, column)) terms.insert(terms.end(), {{column + 1, false}, {column + 2, true}});
  }
  return terms;
}

// No entry is the transpose of another: the patches of the rows are not among the columns. The terms have equal shares
// of the accuracy, how wide they are or not: if that decided, a smaller accuracy could yield a wider sum.
ViewFactor BackFactors::of_row(std::size_t row) const {
  const std::vector<Term> terms = terms_of(row);
  const double finer = terms.size() > 1 ? kOfRoundings * static_cast<double>(terms.size()) : 1.0;
  ViewFactor sum;
  for (const auto& [column, is_subtracted] : terms) {
    const ViewFactor f = factor_of(pairs_, row * columns_.size() + column, finer);
    is_subtracted ? subtract(sum, f) : add(sum, f);
  }
  clamp(sum);
  sum.accurate = sum.upper - sum.lower <= accuracy_;
  sum.area_to = area_;
  return sum;
}

}  // namespace exactff::matrix
