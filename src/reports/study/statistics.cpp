#include "study/statistics.h"

#include <algorithm>
#include <cmath>

#include "kernel/statistics.h"

namespace exactff::study {
namespace {

std::vector<double> finite_only(std::span<const double> values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept), [](double v) { return std::isfinite(v); });
  return kept;
}

}  // namespace

ErrorStatistics error_statistics(std::span<const double> errors) {
  ErrorStatistics result;
  const std::vector<double> numbers = finite_only(errors);
  result.not_a_number = errors.size() - numbers.size();
  if (numbers.empty()) return result;
  std::vector<double> magnitudes = numbers;
  for (double& m : magnitudes) m = std::abs(m);
  result.worst = *std::max_element(magnitudes.begin(), magnitudes.end());
  result.rms = kernel::root_mean_square(numbers, result.worst);
  result.mean = kernel::mean(numbers);
  result.p99 = kernel::percentile(std::move(magnitudes), 99.0);
  return result;
}

Summary summarise(const std::vector<SampleRow>& rows, const Study& study, double eps_b) {
  Summary summary;
  std::vector<double> form_factor, radiosity, partly, silent;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SampleRow& row = rows[i];
    form_factor.push_back(row.error);
    radiosity.push_back(row.radiosity_error);
    if (study.exact[i].sight == Sight::kPartly) partly.push_back(row.radiosity_error);
    if (!(std::abs(row.radiosity_error) <= eps_b)) ++summary.violations;
    summary.leaves += row.leaves;
    summary.rays += row.rays;
    summary.silent_leaves += row.silent_leaves;
    summary.wrong_leaves += row.wrong_leaves;
    summary.silent_receivers += row.silent_leaves + row.wrong_leaves > 0 ? 1 : 0;
  }
  for (const std::size_t i : study.judged) silent.push_back(rows[i].silent_error);
  summary.form_factor = error_statistics(form_factor);
  summary.radiosity = error_statistics(radiosity);
  summary.radiosity_partly = error_statistics(partly);
  summary.silent = error_statistics(silent);
  return summary;
}

double largest_radiosity(const Study& study) {
  double largest = 0.0;
  for (const ExactRow& row : study.exact) largest = std::max(largest, row.radiosity.largest());
  return largest;
}

}  // namespace exactff::study
