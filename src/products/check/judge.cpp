// Decides whether the errors keep to the limits.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/errors.h"
#include "check/words.h"
#include "kernel/float_environment.h"
#include "text/hashes.h"
#include "text/phrases.h"

namespace exactff::check {
namespace {

using Rows = std::vector<Errors::Index>;

void require_limit(const std::optional<double>& limit, std::string_view name) {
  if (!limit || *limit >= 0.0) return;
  throw InputError({.what = "the limit for " + std::string(name) + " is " + text::shortest(*limit),
                    .why = "errors are never negative",
                    .suggestion = "give 0 or more"});
}

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
    throw InputError({.what = "the share of a quantile is " + text::shortest(quantile.share),
                      .why = "a quantile is a share of the rows",
                      .suggestion = "give a number above 0 and up to 1, for example 0.99"});
  }
}

class Judge {
 public:
  Judge(const Truth& truth, const std::vector<Measured>& values, const Criteria& criteria)
      : truth_(truth), values_(values), criteria_(criteria), errors_(truth, values, criteria.relative_floor) {}

  Report judge(const std::string& candidate_file) {
    report_.truth_file = truth_.file;
    report_.candidate_file = candidate_file;
    report_.column = truth_.column;
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
    const bool by_points = *row.claim == Claim::kEstimated && row.way != Way::kCells;
    if (by_points) ++report_.by_points;
    if (!row.accurate) ++report_.not_accurate;
    if (by_points || !row.accurate) report_.widest = std::max(report_.widest, row.upper - row.lower);
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
    throw InputError({truth_.file, 0, "does not contain rho B for every row",
                      "--eps-b limits the error in radiosity, which is the absolute error times rho B",
                      "use a truth file with the column largest_rho_b, or use --max-abs"});
  }

  void require_image() const {
    if (!criteria_.relative_mse || truth_.is_image) return;
    throw InputError({truth_.file, 0, "is not an image", "--relative-mse limits an error of images",
                      "compare two .exr files, or use --rms"});
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
      add(name_of(quantile), quantile.limit, source, nearest_rank(magnitudes, quantile.share), Measure::kAbsolute);
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

bool Report::passed() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) { return verdict.passed; });
}

Report judge(const Truth& truth, const std::vector<Measured>& values, const Criteria& criteria,
             const std::string& candidate_file) {
  const kernel::StandardArithmetic arithmetic;
  check_criteria(criteria);
  if (values.empty()) {
    throw InputError(
        {truth.file, 0, "has no row to check", "a check without rows would always pass", "give values for its rows"});
  }
  return Judge(truth, values, criteria).judge(candidate_file);
}

Report judge(const Truth& truth, std::span<const double> values, const Criteria& criteria) {
  if (values.size() != truth.rows.size()) {
    throw InputError(
        {truth.file, 0,
         "has " + text::counted(truth.rows.size(), "row") + ", but there are " + text::counted(values.size(), "value"),
         "every row needs one value", "give the values in the order of its rows"});
  }
  std::vector<Measured> measured;
  measured.reserve(values.size());
  for (std::uint32_t i = 0; i < values.size(); ++i) measured.push_back({i, 0, values[i]});
  return judge(truth, measured, criteria);
}

}  // namespace exactff::check
