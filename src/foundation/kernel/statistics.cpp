#include "kernel/statistics.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/expect.h"

namespace exactff::kernel {
namespace {

double product_sum(std::span<const std::pair<double, double>> points, double first, double second, bool square) {
  double sum = 0.0;
  for (const auto& [x, y] : points) sum += (x - first) * (square ? x - first : y - second);
  return sum;
}

}  // namespace

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

double root_mean_square(std::span<const double> values, double largest) {
  if (largest == 0.0) return 0.0;
  double sum = 0.0;
  for (const double v : values) sum += (v / largest) * (v / largest);
  return largest * std::sqrt(sum / static_cast<double>(values.size()));
}

double nearest_rank(const std::vector<double>& ascending, double share) {
  if (ascending.empty()) return 0.0;
  const auto n = static_cast<double>(ascending.size());
  double rank = std::floor(share * n);
  // Compares k / n with the share as written: both are rounded from the same fraction.
  while (rank < n && rank / n < share) ++rank;
  return ascending[static_cast<std::size_t>(std::clamp(rank, 1.0, n)) - 1];
}

Distribution distribution(std::vector<double> magnitudes) {
  if (magnitudes.empty()) return {};
  std::sort(magnitudes.begin(), magnitudes.end());
  const double largest = magnitudes.back();
  return {nearest_rank(magnitudes, 0.5),
          nearest_rank(magnitudes, 0.9),
          nearest_rank(magnitudes, 0.99),
          nearest_rank(magnitudes, 0.999),
          largest,
          std::isinf(largest) ? largest : root_mean_square(magnitudes, largest)};
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

}  // namespace exactff::kernel
