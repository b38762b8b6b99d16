// The errors of single values and of many.
#include "check/errors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/report.h"
#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "kernel/statistics.h"
#include "text/phrases.h"

namespace exactff::check {
namespace {

// Numbers the doubles so that neighbours have neighbouring numbers. Both zeros have 0.
std::int64_t ordinal(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}

double ulps_between(double a, double b) {
  if (!std::isfinite(a) || !std::isfinite(b)) return std::numeric_limits<double>::infinity();
  const std::int64_t low = std::min(ordinal(a), ordinal(b)), high = std::max(ordinal(a), ordinal(b));
  return static_cast<double>(static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low));  // cannot overflow
}

std::string bounds_of(const Expected& expected) {
  std::string text = text::shortest(expected.value);
  if (!expected.status) return text;
  if (expected.lower < expected.upper) {
    text += " in [" + text::shortest(expected.lower) + ", " + text::shortest(expected.upper) + "]";
  }
  return text + ", " + std::string(to_string(*expected.status));
}

}  // namespace

Expected::Expected(double number) : value(number), lower(number), upper(number) {}
Expected::Expected(const FormFactor& f) : value(f.value), lower(f.lower), upper(f.upper), status(f.status) {}
Expected::Expected(const TruthRow& row) : value(row.value), lower(row.lower), upper(row.upper), status(row.status) {}

double reference_of(double actual, const Expected& expected) {
  if (expected.status != Status::kNotCertified || std::isnan(actual)) return expected.value;
  return std::clamp(actual, expected.lower, expected.upper);
}

double relative_error(double error, double reference, double floor) {
  if (error == 0.0) return 0.0;
  const double unit = std::max(std::abs(reference), floor);
  return unit == 0.0 ? std::numeric_limits<double>::infinity() : std::abs(error) / unit;
}

Difference difference(double actual, const Expected& expected) {
  const kernel::StandardArithmetic arithmetic;
  const double reference = reference_of(actual, expected);
  const double error = actual - reference;
  return {error, relative_error(error, reference, 0.0), ulps_between(actual, reference)};
}

bool is_near(double actual, const Expected& expected, const Tolerance& tolerance) {
  const kernel::StandardArithmetic arithmetic;
  const Difference d = difference(actual, expected);
  return std::abs(d.error) <= tolerance.absolute || d.relative <= tolerance.relative;
}

std::string describe_difference(double actual, const Expected& expected, const Tolerance& tolerance) {
  const kernel::StandardArithmetic arithmetic;
  const Difference d = difference(actual, expected);
  std::string text = "  actual    " + text::shortest(actual) + "\n  expected  " + bounds_of(expected) + "\n";
  if (!std::isfinite(actual)) return text + "  the actual value is not a finite number";
  text += "  error     " + text::shortest(d.error) + ", relative " + text::shortest(d.relative) + ", " +
          text::short_number(d.ulps, 6) + (d.ulps == 1.0 ? " ulp" : " ulps") + "\n  tolerance ";
  if (tolerance.relative == 0.0) return text + text::shortest(tolerance.absolute);
  if (tolerance.absolute == 0.0) return text + "relative " + text::shortest(tolerance.relative);
  return text + text::shortest(tolerance.absolute) + ", or relative " + text::shortest(tolerance.relative);
}

// --- Many values ---

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
  const std::string& source = truth_.source_of(truth);
  return {truth.receiver, source,           name_of(truth_.keys, truth.receiver, source),
          truth.line,     values_[i].line,  truth.status,
          truth.value,    values_[i].value, error_[i],
          relative_[i],   radiosity(i),     truth.lower,
          truth.upper,    truth.claim};
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

Distribution Errors::distribution(const std::vector<Index>& among, Measure measure) const {
  const kernel::Distribution d = kernel::distribution(sorted_magnitudes(among, measure));
  return {d.median, d.p90, d.p99, d.p999, d.max, d.rms};
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
  if (truth_.kind == kImage) {
    result.relative_mse = finite > 0 ? relative_squares / static_cast<double>(finite) : 0.0;
  }
  result.absolute = distribution(among, Measure::kAbsolute);
  result.relative = distribution(among, Measure::kRelative);
  if (rho_b_known) result.radiosity = distribution(among, Measure::kRadiosity);
  return result;
}

}  // namespace exactff::check
