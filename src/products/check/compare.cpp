// Compares files: tables, matrices with what they must keep to, images.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "check/images.h"
#include "check/report.h"
#include "check/tables.h"
#include "exr/other_image.h"
#include "files/file.h"
#include "kernel/float_environment.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::check {

// --- Matrices ---

namespace {

class FactFinder {
 public:
  FactFinder(const Truth& truth, const std::vector<Measured>& values)
      : truth_(truth), order_(order_of(truth)), width_(truth.sources.size()) {
    NameList rows;
    for (const std::string& name : order_.rows) (void)rows.number_of(name);
    entries_.resize(order_.rows.size() * width_);
    std::vector<std::size_t> place;  // of each row of the truth
    for (const TruthRow& row : truth.rows) {
      place.push_back(*rows.find(row.receiver) * width_ + row.source);
      entries_[place.back()] = {true, kNaN, row.lower, row.upper};
    }
    for (const Measured& one : values) entries_[place[one.row]].value = one.value;
  }

  MatrixFacts find() {
    for (std::size_t i = 0; i < order_.rows.size(); ++i) look_at_row(i);
    if (order_.rows == order_.columns && !order_.areas.empty()) look_at_reciprocity();
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
      const auto entry = [&, f = value] { return MatrixFacts::Largest{f, order_.rows[i], truth_.sources[j]}; };
      if (value < 0.0 && (facts_.negative++ == 0 || value < facts_.least.by)) facts_.least = entry();
      if (value > 1.0 && (facts_.above_one++ == 0 || value > facts_.largest.by)) facts_.largest = entry();
      sum += value;
      lower += least;
      upper += most;
    }
    if (!std::isfinite(sum)) return;  // an entry is missing, or not finite
    raise(facts_.row_sum, {std::max({0.0, sum - upper, lower - sum}), order_.rows[i], {}});
  }

  void look_at_reciprocity() {
    const std::vector<std::string>& names = order_.rows;
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (std::size_t j = i + 1; j < names.size(); ++j) {
        const double ratio = order_.areas[j] / order_.areas[i];  // A_j / A_i
        const double f_ij = entries_[i * width_ + j].value, f_ji = entries_[j * width_ + i].value;
        const double by = ratio >= 1.0 ? std::abs(f_ij - ratio * f_ji) : std::abs(f_ij / ratio - f_ji);
        if (std::isfinite(by)) raise(facts_.reciprocity, {by, names[i], names[j]});
      }
    }
  }

  const Truth& truth_;
  const matrix::Order order_;
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
