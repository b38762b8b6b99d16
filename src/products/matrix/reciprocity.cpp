#include <algorithm>
#include <optional>

#include "exactff/matrix.h"
#include "kernel/float_environment.h"
#include "matrix/row_facts.h"

namespace exactff::matrix {
namespace {

using kernel::above;
using kernel::below;

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

}  // namespace exactff::matrix
