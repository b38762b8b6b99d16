#include "study/statistics.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/expect.h"

namespace exactff::study {
namespace {

std::vector<double> finite_only(std::span<const double> values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept), [](double v) { return std::isfinite(v); });
  return kept;
}

// Scaled by the largest magnitude, so that squares neither underflow nor overflow.
double root_mean_square(std::span<const double> values, double largest) {
  if (largest == 0.0) return 0.0;
  double sum = 0.0;
  for (double v : values) sum += (v / largest) * (v / largest);
  return largest * std::sqrt(sum / static_cast<double>(values.size()));
}

double product_sum(std::span<const std::pair<double, double>> points, double first, double second, bool square) {
  double sum = 0.0;
  for (const auto& [x, y] : points) sum += (x - first) * (square ? x - first : y - second);
  return sum;
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
  result.rms = root_mean_square(numbers, result.worst);
  result.mean = mean(numbers);
  result.p99 = percentile(std::move(magnitudes), 99.0);
  return result;
}

double percentile(std::vector<double> values, double percent) {
  EXACTFF_EXPECT(!values.empty() && percent > 0.0 && percent <= 100.0);
  // Multiplies percent * n before dividing: the rank is then exact for whole percents.
  const double rank = std::ceil(percent * static_cast<double>(values.size()) / 100.0);
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : std::midpoint(values[half - 1], values[half]);
}

double mean(std::span<const double> values) {
  if (values.empty()) return 0.0;
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (double v : values) sum += v;
  if (std::isfinite(sum)) return sum / n;
  sum = 0.0;
  for (double v : values) sum += v / n;  // near the largest double, where nothing is lost by it
  return sum;
}

double mean_half_width(std::span<const double> values) {
  if (values.size() < 2) return 0.0;
  const double middle = mean(values), n = static_cast<double>(values.size());
  const double factor = boost::math::quantile(boost::math::students_t(n - 1.0), 0.975);
  double squares = 0.0;
  for (const double v : values) squares += (v - middle) * (v - middle);
  if (std::isfinite(squares)) return factor * std::sqrt(squares / (n - 1.0) / n);
  constexpr double kSmaller = 0x1p-600;  // squares of such deviations overflow
  squares = 0.0;
  for (const double v : values) squares += (v * kSmaller - middle * kSmaller) * (v * kSmaller - middle * kSmaller);
  const double half_width = factor * std::sqrt(squares / (n - 1.0) / n) / kSmaller;
  return std::min(half_width, std::numeric_limits<double>::max());
}

std::optional<double> fitted_slope(std::span<const std::pair<double, double>> points) {
  std::vector<std::pair<double, double>> logs;
  double x_mean = 0.0;
  double y_mean = 0.0;
  for (const auto& [x, y] : points) {
    if (!(x > 0.0) || !(y > 0.0)) continue;
    logs.emplace_back(std::log(x), std::log(y));
    x_mean += logs.back().first;
    y_mean += logs.back().second;
  }
  if (logs.size() < 2) return std::nullopt;
  x_mean /= static_cast<double>(logs.size());
  y_mean /= static_cast<double>(logs.size());
  const double spread = product_sum(logs, x_mean, y_mean, true);
  if (!(spread > 0.0)) return std::nullopt;
  return product_sum(logs, x_mean, y_mean, false) / spread;
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

TimeSummary summarise_times(std::span<const double> seconds, const std::vector<ExactRow>& exact) {
  std::vector<double> all, partly;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (std::isnan(seconds[i])) continue;  // not timed
    all.push_back(seconds[i]);
    if (exact[i].sight == Sight::kPartly) partly.push_back(seconds[i]);
  }
  return {median(all), mean(all), median(partly), mean(partly)};
}

}  // namespace exactff::study
