// Decides whether the errors keep to the limits, and compares files.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/errors.h"
#include "check/images.h"
#include "check/report.h"
#include "check/tables.h"
#include "exr/other_image.h"
#include "files/file.h"
#include "kernel/float_environment.h"
#include "kernel/statistics.h"
#include "text/fnv1a.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_file.h"

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
    throw InputError({truth_.file, 0, "does not contain rho B for every row",
                      "--eps-b limits the error in radiosity, which is the absolute error times rho B",
                      "use a truth file with the column largest_rho_b, or use --max-abs"});
  }

  void require_image() const {
    if (!criteria_.relative_mse || truth_.kind == kImage) return;
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

// --- Matrices ---

namespace {

class FactFinder {
 public:
  FactFinder(const Truth& truth, const std::vector<Measured>& values)
      : truth_(truth), names_(names_of_grid(truth)), width_(truth.sources.size()) {
    NameList rows;
    for (const std::string& name : names_.rows) (void)rows.number_of(name);
    entries_.resize(names_.rows.size() * width_);
    std::vector<std::size_t> place;  // of each row of the truth
    for (const TruthRow& row : truth.rows) {
      place.push_back(*rows.find(row.receiver) * width_ + row.source);
      entries_[place.back()] = {true, kNaN, row.lower, row.upper};
    }
    for (const Measured& one : values) entries_[place[one.row]].value = one.value;
  }

  MatrixFacts find() {
    for (std::size_t i = 0; i < names_.rows.size(); ++i) look_at_row(i);
    if (names_.rows == names_.columns && !truth_.areas.empty()) look_at_reciprocity();
    return facts_;
  }

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  // where there is no value
  struct Entry {
    bool in_truth = false;
    double value = kNaN;
    double lower = 0.0, upper = 0.0;  // of the truth
  };

  static void raise(std::optional<MatrixFacts::Largest>& largest, MatrixFacts::Largest one) {
    if (!largest || one.by > largest->by) largest = std::move(one);
  }

  void look_at_row(std::size_t i) {
    double sum = 0.0, lower = 0.0, upper = 0.0;
    for (std::size_t j = 0; j < width_; ++j) {
      const auto& [in_truth, value, least, most] = entries_[i * width_ + j];
      if (!in_truth) continue;
      const auto entry = [&, f = value] { return MatrixFacts::Largest{f, names_.rows[i], truth_.sources[j]}; };
      if (value < 0.0 && (facts_.negative++ == 0 || value < facts_.least.by)) facts_.least = entry();
      if (value > 1.0 && (facts_.above_one++ == 0 || value > facts_.largest.by)) facts_.largest = entry();
      sum += value;
      lower += least;
      upper += most;
    }
    if (!std::isfinite(sum)) return;  // an entry is missing, or not finite
    raise(facts_.row_sum, {std::max({0.0, sum - upper, lower - sum}), names_.rows[i], {}});
  }

  void look_at_reciprocity() {
    const std::vector<std::string>& names = names_.rows;
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (std::size_t j = i + 1; j < names.size(); ++j) {
        const double ratio = truth_.areas.at(names[j]) / truth_.areas.at(names[i]);  // A_j / A_i
        const double f_ij = entries_[i * width_ + j].value, f_ji = entries_[j * width_ + i].value;
        const double by = ratio >= 1.0 ? std::abs(f_ij - ratio * f_ji) : std::abs(f_ij / ratio - f_ji);
        if (std::isfinite(by)) raise(facts_.reciprocity, {by, names[i], names[j]});
      }
    }
  }

  const Truth& truth_;
  const GridNames names_;
  const std::size_t width_;
  std::vector<Entry> entries_;
  MatrixFacts facts_;
};

// --- Files ---

// Without the rows of further sources that the candidate does not have, such as "(back)".
Truth without_absent(Truth truth, const Candidate& candidate) {
  const std::vector<std::string>* sources = texts_of(candidate.table, "source");
  const auto has = [](const std::vector<std::string>& list, const std::string& one) {
    return std::ranges::find(list, one) != list.end();
  };
  std::vector<bool> absent;  // of each source
  for (const std::string& one : truth.sources) {
    absent.push_back(has(truth.further, one) && (sources == nullptr || !has(*sources, one)));
  }
  std::erase_if(truth.rows, [&](const TruthRow& row) { return absent[row.source]; });
  return truth;
}

Report compare_tables(const Truth& all, const std::filesystem::path& file, const Options& options) {
  const Candidate candidate = read_candidate(file, all, options.columns, options.match.by);
  std::optional<Truth> kept;
  if (!all.further.empty()) kept = without_absent(all, candidate);
  const Truth& truth = kept ? *kept : all;
  const std::vector<Measured> values = match(truth, candidate, options.match);
  Report report = judge(truth, values, options.criteria, candidate.file);
  if (truth.kind == "matrix") report.matrix = FactFinder(truth, values).find();
  return report;
}

Report compare_images(const std::filesystem::path& truth, const std::filesystem::path& candidate,
                      const Options& options) {
  if (options.match != MatchOptions{.partial = options.match.partial} ||
      options.columns != CandidateColumns{.value = options.columns.value}) {
    text::refuse("a flag that matches rows is given with two images", "pixels are matched by their coordinates",
                 "remove --match, the tolerances and the columns of ids and coordinates");
  }
  const Images images =
      read_images(truth, candidate, {options.truth_column, options.columns.value}, options.match.partial);
  return judge(images.truth, images.values, options.criteria, images.candidate_file);
}

// Before anything is read: a file that is missing is not a file of another kind.
void require_file(const std::filesystem::path& file) {
  if (!files::is_there(file)) (void)text::open_text_file(file, "a file");
}

}  // namespace

std::vector<Report> compare_all(const std::filesystem::path& truth, std::span<const std::filesystem::path> candidates,
                                const Options& options) {
  const kernel::StandardArithmetic arithmetic;
  require_file(truth);
  std::ranges::for_each(candidates, require_file);
  check_criteria(options.criteria);
  const std::string kind = table::kind_of(truth);
  const bool image = kind.empty() && exr::is_image(truth);
  const bool takes_arrays = !kind.empty() && kind != "truth";  // as matrices of numbers
  std::optional<Truth> table;
  std::vector<Report> reports;
  std::vector<Problem> problems;
  for (const std::filesystem::path& candidate : candidates) {
    if (image != exr::is_image(candidate) && !takes_arrays) {
      text::refuse(image ? candidate : truth, "is no image, and the file to compare it with is one",
                   "images are OpenEXR files and NumPy arrays of shape (height, width, 3)",
                   "give two images, or two tables");
    }
    if (!image && !table) table = read_truth(truth, options.truth_column);
    try {
      reports.push_back(image ? compare_images(truth, candidate, options) : compare_tables(*table, candidate, options));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return reports;
}

Report compare(const std::filesystem::path& truth, const std::filesystem::path& candidate, const Options& options) {
  return std::move(compare_all(truth, std::span(&candidate, 1), options).front());
}

}  // namespace exactff::check
