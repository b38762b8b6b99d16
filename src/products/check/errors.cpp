#include "check/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/expect.h"
#include "kernel/statistics.h"

namespace exactff::check {
namespace {

Distribution distribution(const std::vector<double>& ascending) {
  if (ascending.empty()) return {};
  const double largest = ascending.back();
  return {nearest_rank(ascending, 0.5),
          nearest_rank(ascending, 0.9),
          nearest_rank(ascending, 0.99),
          nearest_rank(ascending, 0.999),
          largest,
          std::isinf(largest) ? largest : kernel::root_mean_square(ascending, largest)};
}

}  // namespace

double nearest_rank(const std::vector<double>& ascending, double share) {
  if (ascending.empty()) return 0.0;
  const auto n = static_cast<double>(ascending.size());
  double rank = std::floor(share * n);
  // Compares k / n with the share as written: both are rounded from the same fraction.
  while (rank < n && rank / n < share) ++rank;
  return ascending[static_cast<std::size_t>(std::clamp(rank, 1.0, n)) - 1];
}

Errors::Errors(const Truth& truth, const std::vector<Measured>& values, double relative_floor)
    : truth_(truth), values_(values) {
  error_.reserve(values.size());
  relative_.reserve(values.size());
  for (const Measured& one : values) {
    const double reference = reference_of(one.value, truth.rows[one.row]);
    error_.push_back(one.value - reference);
    relative_.push_back(relative_error(error_.back(), reference, relative_floor));
  }
}

bool Errors::is_finite(Index i) const { return std::isfinite(values_[i].value); }

std::optional<double> Errors::radiosity(Index i) const {
  const auto& rho_b = truth_row(i).largest_rho_b;
  if (!rho_b) return std::nullopt;
  return *rho_b == 0.0 ? 0.0 : std::abs(error_[i]) * *rho_b;
}

double Errors::magnitude(Index i, Measure measure) const {
  if (!is_finite(i)) return std::numeric_limits<double>::infinity();
  switch (measure) {
    case Measure::kAbsolute:
      return std::abs(error_[i]);
    case Measure::kRelative:
      return relative_[i];
    case Measure::kRadiosity:
      return radiosity(i).value_or(0.0);
  }
  return 0.0;
}

RowError Errors::row(Index i) const {
  const TruthRow& truth = truth_row(i);
  return {truth.receiver,   truth_.source_of(truth),
          truth.line,       values_[i].line,
          truth.status,     truth.value,
          values_[i].value, error_[i],
          relative_[i],     radiosity(i),
          truth.lower,      truth.upper,
          truth.claim};
}

Errors::Index Errors::worst(const std::vector<Index>& among, Measure measure) const {
  EXACTFF_EXPECT(!among.empty());
  return *std::max_element(among.begin(), among.end(),
                           [&](Index a, Index b) { return magnitude(a, measure) < magnitude(b, measure); });
}

std::vector<RowError> Errors::worst_rows(Measure measure, std::size_t count) const {
  std::vector<Index> order(size());
  std::iota(order.begin(), order.end(), Index{0});
  // Values that are not finite come before errors that are infinite only because of the division.
  const auto worse = [&](Index a, Index b) {
    if (is_finite(a) != is_finite(b)) return !is_finite(a);
    const double of_a = magnitude(a, measure), of_b = magnitude(b, measure);
    if (of_a != of_b) return of_a > of_b;
    const double error_a = magnitude(a, Measure::kAbsolute), error_b = magnitude(b, Measure::kAbsolute);
    return error_a != error_b ? error_a > error_b : a < b;
  };
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
  std::partial_sort(order.begin(), end, order.end(), worse);
  std::vector<RowError> rows;
  for (auto i = order.begin(); i != end && magnitude(*i, measure) > 0.0; ++i) rows.push_back(row(*i));
  return rows;
}

std::vector<double> Errors::sorted_magnitudes(const std::vector<Index>& among, Measure measure) const {
  std::vector<double> magnitudes;
  magnitudes.reserve(among.size());
  for (const Index i : among) {
    if (is_finite(i)) magnitudes.push_back(magnitude(i, measure));
  }
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes;
}

Statistics Errors::statistics(const std::vector<Index>& among) const {
  Statistics result;
  bool rho_b_known = true;
  double sum = 0.0, relative_squares = 0.0;
  result.rows = among.size();
  for (const Index i : among) {
    const TruthRow& truth = truth_row(i);
    rho_b_known = rho_b_known && truth.largest_rho_b.has_value();
    result.largest_value = std::max(result.largest_value, std::abs(truth.value));
    result.largest_radiosity =
        std::max(result.largest_radiosity, std::abs(truth.value) * truth.largest_rho_b.value_or(0.0));
    if (!is_finite(i)) {
      ++result.not_finite;
      continue;
    }
    sum += error_[i];
    relative_squares += error_[i] * error_[i] / (truth.value * truth.value + kRelativeMseEpsilon);
    if (truth.value == 0.0 && error_[i] != 0.0) ++result.leaks;
  }
  const std::size_t finite = result.rows - result.not_finite;
  if (finite > 0) result.bias = sum / static_cast<double>(finite);
  if (truth_.is_image) {
    result.relative_mse = finite > 0 ? relative_squares / static_cast<double>(finite) : 0.0;
  }
  result.absolute = distribution(sorted_magnitudes(among, Measure::kAbsolute));
  result.relative = distribution(sorted_magnitudes(among, Measure::kRelative));
  if (rho_b_known) result.radiosity = distribution(sorted_magnitudes(among, Measure::kRadiosity));
  return result;
}

}  // namespace exactff::check
