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

double nearest_rank_of_sorted(const std::vector<double>& values, double share) {
  const auto n = static_cast<double>(values.size());
  double rank = std::floor(share * n);
  // Compares k / n with the share as written: both are rounded from the same fraction.
  while (rank < n && rank / n < share) ++rank;
  return values[static_cast<std::size_t>(std::clamp(rank, 1.0, n)) - 1];
}

// Squares values / largest, so that nothing underflows or overflows.
double root_mean_square(std::span<const double> values, double largest) {
  if (largest == 0.0 || std::isinf(largest)) return largest;
  double sum = 0.0;
  for (const double v : values) sum += (v / largest) * (v / largest);
  return largest * std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

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

double nearest_rank(std::vector<double> values, double share) {
  EXACTFF_EXPECT(share > 0.0 && share <= 1.0);
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return nearest_rank_of_sorted(values, share);
}

Distribution distribution(std::vector<double> magnitudes) {
  if (magnitudes.empty()) return {};
  std::sort(magnitudes.begin(), magnitudes.end());
  const double largest = magnitudes.back();
  const auto rank = [&](double share) { return nearest_rank_of_sorted(magnitudes, share); };
  return {rank(0.5), rank(0.9), rank(0.99), rank(0.999), largest, root_mean_square(magnitudes, largest)};
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
