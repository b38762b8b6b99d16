#include "matrix/row_facts.h"

#include <algorithm>
#include <span>

namespace exactff::matrix {

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

}  // namespace exactff::matrix
