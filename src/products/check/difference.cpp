// The error of a single value.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "check/errors.h"
#include "exactff/check.h"
#include "kernel/float_environment.h"
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

}  // namespace exactff::check
