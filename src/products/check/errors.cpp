// The errors of single values and of many, and whether they keep to limits.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/report.h"
#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "kernel/statistics.h"
#include "text/hashes.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::check {

// --- Single values ---

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

// F*: the true value; if it is not certified, the point of its enclosure nearest to `actual`.
double reference_of(double actual, const Expected& expected) {
  if (expected.status != Status::kNotCertified || std::isnan(actual)) return expected.value;
  return std::clamp(actual, expected.lower, expected.upper);
}

// The error divided by max(|reference|, floor). 0 if the error is 0; otherwise infinite if both are 0.
double relative_error(double error, double reference, double floor) {
  if (error == 0.0) return 0.0;
  const double unit = std::max(std::abs(reference), floor);
  return unit == 0.0 ? std::numeric_limits<double>::infinity() : std::abs(error) / unit;
}

}  // namespace

Expected::Expected(double number) : value(number), lower(number), upper(number) {}
Expected::Expected(const FormFactor& f) : value(f.value), lower(f.lower), upper(f.upper), status(f.status) {}
Expected::Expected(const TruthRow& row) : value(row.value), lower(row.lower), upper(row.upper), status(row.status) {}

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

namespace {

// The errors of all values, in the order of the values. Keeps references to the truth and the values.
class Errors {
 public:
  using Index = std::uint32_t;  // index into the values

  Errors(const Truth& truth, const std::vector<Measured>& values, double relative_floor)
      : truth_(truth), values_(values) {
    error_.reserve(values.size());
    relative_.reserve(values.size());
    for (const Measured& one : values) {
      const double reference = reference_of(one.value, truth.rows[one.row]);
      error_.push_back(one.value - reference);
      relative_.push_back(relative_error(error_.back(), reference, relative_floor));
    }
  }

  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] const TruthRow& truth_row(Index i) const { return truth_.rows[values_[i].row]; }
  [[nodiscard]] bool is_finite(Index i) const { return std::isfinite(values_[i].value); }

  // The magnitude of the error: infinite for values that are not finite, 0 if rho B is not known.
  [[nodiscard]] double magnitude(Index i, Measure measure) const {
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

  [[nodiscard]] RowError row(Index i) const {
    const TruthRow& truth = truth_row(i);
    const std::string& source = truth_.source_of(truth);
    return {truth.receiver, source,           name_of(truth_.keys, truth.receiver, source),
            truth.line,     values_[i].line,  truth.status,
            truth.value,    values_[i].value, error_[i],
            relative_[i],   radiosity(i),     truth.lower,
            truth.upper,    truth.claim};
  }

  // The value with the largest magnitude; the first one if several are equal. Requires at least one.
  [[nodiscard]] Index worst(const std::vector<Index>& among, Measure measure) const {
    EXACTFF_EXPECT(!among.empty());
    return *std::max_element(among.begin(), among.end(),
                             [&](Index a, Index b) { return magnitude(a, measure) < magnitude(b, measure); });
  }

  // The `count` largest errors, the worst first; equal ones in the order of the truth. Values without error are left
  // out.
  [[nodiscard]] std::vector<RowError> worst_rows(Measure measure, std::size_t count) const {
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

  // The magnitudes of the finite values, ascending.
  [[nodiscard]] std::vector<double> sorted_magnitudes(const std::vector<Index>& among, Measure measure) const {
    std::vector<double> magnitudes;
    magnitudes.reserve(among.size());
    for (const Index i : among) {
      if (is_finite(i)) magnitudes.push_back(magnitude(i, measure));
    }
    std::sort(magnitudes.begin(), magnitudes.end());
    return magnitudes;
  }

  [[nodiscard]] Statistics statistics(const std::vector<Index>& among) const {
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

 private:
  [[nodiscard]] std::optional<double> radiosity(Index i) const {
    const auto& rho_b = truth_row(i).largest_rho_b;
    if (!rho_b) return std::nullopt;
    return *rho_b == 0.0 ? 0.0 : std::abs(error_[i]) * *rho_b;
  }

  [[nodiscard]] Distribution distribution(const std::vector<Index>& among, Measure measure) const {
    const kernel::Distribution d = kernel::distribution(sorted_magnitudes(among, measure));
    return {d.median, d.p90, d.p99, d.p999, d.max, d.rms};
  }

  const Truth& truth_;
  const std::vector<Measured>& values_;
  std::vector<double> error_, relative_;
};

using Rows = std::vector<Errors::Index>;

void require_limit(const std::optional<double>& limit, std::string_view name) {
  if (!limit || *limit >= 0.0) return;
  text::refuse("the limit for " + std::string(name) + " is " + text::shortest(*limit), "errors are never negative",
               "give 0 or more");
}

class Judge {
 public:
  Judge(const Truth& truth, const std::vector<Measured>& values, const Criteria& criteria)
      : truth_(truth), values_(values), criteria_(criteria), errors_(truth, values, criteria.relative_floor) {}

  Report judge(const std::string& candidate_file) {
    report_.truth_file = truth_.file;
    report_.candidate_file = candidate_file;
    report_.column = truth_.column;
    report_.keys = truth_.keys;
    report_.criteria = criteria_;
    report_.truth_rows = truth_.rows.size();
    report_.identity = identity();
    describe_rows();
    require_rho_b();
    require_image();
    add_finiteness();
    for (std::size_t s = 0; criteria_.per_source && s < report_.sources.size(); ++s) {
      add_verdicts(report_.sources[s], report_.by_source[s], rows_of_[s]);
    }
    if (!criteria_.per_source) add_verdicts({}, report_.overall, all_);
    report_.worst = errors_.worst_rows(report_.worst_by, criteria_.worst);
    return std::move(report_);
  }

 private:
  void describe_rows() {
    all_.resize(errors_.size());
    std::iota(all_.begin(), all_.end(), Errors::Index{0});
    report_.overall = errors_.statistics(all_);
    report_.magnitudes = errors_.sorted_magnitudes(all_, Measure::kAbsolute);
    std::vector<Rows> by_source(truth_.sources.size());
    for (const Errors::Index i : all_) {
      by_source[errors_.truth_row(i).source].push_back(i);
      count(errors_.truth_row(i));
    }
    for (std::size_t s = 0; s < by_source.size(); ++s) {
      if (by_source[s].empty()) continue;  // none of its rows has a value
      report_.sources.push_back(truth_.sources[s]);
      report_.by_source.push_back(errors_.statistics(by_source[s]));
      rows_of_.push_back(std::move(by_source[s]));
    }
  }

  void count(const TruthRow& row) {
    if (!row.claim) {
      if (row.status == Status::kNotCertified) ++report_.not_certified;
      return;
    }
    if (row.by_points) ++report_.by_points;
    if (!row.accurate) ++report_.not_accurate;
    if (row.by_points || !row.accurate) report_.widest = std::max(report_.widest, row.upper - row.lower);
  }

  // A sum, so that the order of the rows has no effect.
  [[nodiscard]] std::string identity() const {
    std::uint64_t sum = 0;
    for (const Measured& one : values_) {
      const TruthRow& row = truth_.rows[one.row];
      text::Fnv1a hash;
      for (const std::string_view text :
           {std::string_view(truth_.column), std::string_view(row.receiver), std::string_view(truth_.source_of(row))}) {
        hash.add_bytes(text);
        hash.add_byte(0);
      }
      hash.add(row.value);
      sum += hash.value();
    }
    return text::hexadecimal(sum, 16);
  }

  void require_rho_b() const {
    if (!criteria_.eps_b || report_.overall.radiosity) return;
    text::refuse(truth_.file, "does not contain rho B for every row",
                 "--eps-b limits the error in radiosity, which is the absolute error times rho B",
                 "use a truth file with the column largest_rho_b, or use --max-abs");
  }

  void require_image() const {
    if (!criteria_.relative_mse || truth_.kind == kImage) return;
    text::refuse(truth_.file, "is not an image", "--relative-mse limits an error of images",
                 "compare two .exr files, or use --rms");
  }

  void add_finiteness() {
    Verdict verdict{"finite", {}, static_cast<double>(report_.overall.not_finite), 0.0, true, {}};
    verdict.passed = report_.overall.not_finite == 0;
    if (!verdict.passed) verdict.worst = errors_.row(errors_.worst(all_, Measure::kAbsolute));
    report_.verdicts.push_back(std::move(verdict));
  }

  void add_verdicts(const std::string& source, const Statistics& statistics, const Rows& rows) {
    add_largest("max-abs", criteria_.max_abs, source, statistics.absolute.max, rows, Measure::kAbsolute);
    add_largest("max-rel", criteria_.max_rel, source, statistics.relative.max, rows, Measure::kRelative);
    if (criteria_.rms) add("rms", *criteria_.rms, source, statistics.absolute.rms, Measure::kAbsolute);
    if (criteria_.eps_b) {
      add_largest("eps-b", criteria_.eps_b, source, statistics.radiosity->max, rows, Measure::kRadiosity);
    }
    if (criteria_.relative_mse) {
      add("relative-mse", *criteria_.relative_mse, source, *statistics.relative_mse, Measure::kAbsolute);
    }
    if (criteria_.quantiles.empty()) return;
    const std::vector<double> magnitudes = errors_.sorted_magnitudes(rows, Measure::kAbsolute);
    for (const Quantile& quantile : criteria_.quantiles) {
      add(name_of(quantile), quantile.limit, source, kernel::nearest_rank(magnitudes, quantile.share),
          Measure::kAbsolute);
    }
  }

  void add_largest(const char* criterion, const std::optional<double>& limit, const std::string& source,
                   double measured, const Rows& rows, Measure measure) {
    if (!limit) return;
    Verdict& verdict = add(criterion, *limit, source, measured, measure);
    if (!verdict.passed) verdict.worst = errors_.row(worst_finite(rows, measure));
  }

  // Only finite rows: the first verdict reports the others.
  [[nodiscard]] Errors::Index worst_finite(const Rows& rows, Measure measure) const {
    Rows finite;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(finite),
                 [&](Errors::Index i) { return errors_.is_finite(i); });
    return errors_.worst(finite, measure);
  }

  Verdict& add(std::string criterion, double limit, const std::string& source, double measured, Measure measure) {
    const bool passed = measured <= limit;
    if (!passed && !broken_) {
      report_.worst_by = measure;
      broken_ = true;
    }
    return report_.verdicts.emplace_back(Verdict{std::move(criterion), source, measured, limit, passed, {}});
  }

  const Truth& truth_;
  const std::vector<Measured>& values_;
  const Criteria& criteria_;
  const Errors errors_;
  Report report_;
  Rows all_;
  std::vector<Rows> rows_of_;  // one list for each source of the report
  bool broken_ = false;
};

}  // namespace

void check_criteria(const Criteria& criteria) {
  require_limit(criteria.max_abs, "max-abs");
  require_limit(criteria.max_rel, "max-rel");
  require_limit(criteria.rms, "rms");
  require_limit(criteria.eps_b, "eps-b");
  require_limit(criteria.relative_mse, "relative-mse");
  require_limit(criteria.relative_floor, "the relative floor");
  for (const Quantile& quantile : criteria.quantiles) {
    require_limit(quantile.limit, name_of(quantile));
    if (quantile.share > 0.0 && quantile.share <= 1.0) continue;
    text::refuse("the share of a quantile is " + text::shortest(quantile.share), "a quantile is a share of the rows",
                 "give a number above 0 and up to 1, for example 0.99");
  }
}

bool Report::passed() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) { return verdict.passed; });
}

Report judge(const Truth& truth, const std::vector<Measured>& values, const Criteria& criteria,
             const std::string& candidate_file) {
  const kernel::StandardArithmetic arithmetic;
  check_criteria(criteria);
  if (values.empty()) {
    text::refuse(truth.file, "has no row to check", "a check without rows would always pass",
                 "give values for its rows");
  }
  return Judge(truth, values, criteria).judge(candidate_file);
}

Report judge(const Truth& truth, std::span<const double> values, const Criteria& criteria) {
  if (values.size() != truth.rows.size()) {
    text::refuse(
        truth.file,
        "has " + text::counted(truth.rows.size(), "row") + ", but there are " + text::counted(values.size(), "value"),
        "every row needs one value", "give the values in the order of its rows");
  }
  std::vector<Measured> measured;
  measured.reserve(values.size());
  for (std::uint32_t i = 0; i < values.size(); ++i) measured.push_back({i, 0, values[i]});
  return judge(truth, measured, criteria);
}

}  // namespace exactff::check
