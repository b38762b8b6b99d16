#include "check/matrices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "check/name_list.h"
#include "check/other_matrix.h"
#include "check/row_keys.h"
#include "check/words.h"
#include "exactff/matrix.h"
#include "kernel/float_environment.h"
#include "text/csv_dialect.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::check {
namespace {

namespace fs = std::filesystem;

// The columns to compare: all patches, and what else there is on both sides.
struct Columns {
  bool back = false, open = false, buried = false;
};

TruthRow truth_row(const std::string& from, std::size_t column, const ViewFactor& f, std::uint32_t line) {
  TruthRow row;
  row.receiver = from;
  row.source = static_cast<std::uint32_t>(column);
  row.line = line;
  row.status = f.claim == Claim::kZero ? Status::kZero : Status::kNotCertified;  // not rounded: judged by its bounds
  row.value = f.value;
  row.lower = f.lower;
  row.upper = f.upper;
  row.claim = f.claim;
  row.way = f.way;
  row.accurate = f.accurate;
  return row;
}

void require_single_entries(const Truth& truth) {
  text::ProblemList problems;
  RowKeys<TruthRow> keys(truth.rows);
  for (std::uint32_t i = 0; i < truth.rows.size(); ++i) {
    if (keys.insert(i) == i) continue;
    problems.add({truth.file, truth.rows[i].line,
                  name_of_entry(truth.rows[i].receiver, truth.source_of(truth.rows[i])) + " occurs twice",
                  "it is not clear which one a value belongs to", "name each patch once by --from and --to"});
  }
  problems.throw_if_any();
}

Truth truth_of(const matrix::NamedMatrix& table, const Columns& columns) {
  Truth truth;
  truth.file = table.file;
  truth.column = "factor";
  truth.is_matrix = true;
  truth.faces = {""};
  NameList names;
  for (const std::string& to : table.to) (void)names.number_of(to);
  const std::size_t patches = table.to.size();
  const std::size_t open = patches + (table.back.empty() ? 0 : 1), buried = open + (table.open.empty() ? 0 : 1);
  const std::size_t width = buried + (table.buried.empty() ? 0 : 1);
  for (std::size_t i = 0; i < table.from.size(); ++i) {
    const auto add = [&](const std::string& to, const ViewFactor& f, std::size_t place) {
      truth.rows.push_back(
          truth_row(table.from[i], names.number_of(to), f, static_cast<std::uint32_t>(table.lines[i * width + place])));
    };
    for (std::size_t j = 0; j < patches; ++j) add(table.to[j], table.entries[i * patches + j], j);
    if (columns.back) add(std::string(matrix::kBack), table.back[i], patches);
    if (columns.open) add(std::string(matrix::kOpen), table.open[i], open);
    if (columns.buried) add(std::string(matrix::kBuried), table.buried[i], buried);
  }
  truth.sources = names.take();
  require_single_entries(truth);
  return truth;
}

// --- By names ---

// "factor" is the value of our own files.
CandidateColumns columns_of_list(const fs::path& file, CandidateColumns columns) {
  if (columns.receiver.empty()) columns.receiver = "from";
  if (columns.source.empty()) columns.source = "to";
  if (!columns.value.empty()) return columns;
  text::CsvLines lines(file, "a CSV file of values");
  std::vector<std::string> names;
  for (std::string_view line; names.empty() && lines.next(line);) {
    if (!text::is_csv_comment(line)) (void)text::CsvDialect(line).split(line, names);
  }
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  if (has("factor") && !has("value")) columns.value = "factor";
  return columns;
}

void compare_by_names(const matrix::NamedMatrix& table, const Candidate& candidate, bool partial, Matrices& result) {
  const auto has = [&](std::string_view name) {
    return std::ranges::find(candidate.sources, name) != candidate.sources.end();
  };
  result.candidate_file = candidate.file;
  result.truth = truth_of(table, {.back = !table.back.empty() && has(matrix::kBack),
                                  .open = !table.open.empty() && has(matrix::kOpen),
                                  .buried = !table.buried.empty() && has(matrix::kBuried)});
  MatchOptions options;
  options.partial = partial;
  result.values = match(result.truth, candidate, options);
}

// --- By their order ---

void require_same_size(const matrix::NamedMatrix& table, const NumberGrid& grid) {
  if (grid.rows == table.from.size() && grid.columns == table.to.size()) return;
  text::refuse(fs::path(grid.file),
               "is " + grid.kind + " of " + std::to_string(grid.rows) + " x " + std::to_string(grid.columns) +
                   ", and the truth is " + std::to_string(table.from.size()) + " x " + std::to_string(table.to.size()),
               "without names, entries are compared in their order",
               "compute the truth for the same patches in the same order, or write a CSV with from,to,value");
}

// View3D's areas have six digits: they are off by 5e-6 of themselves at most.
void require_same_areas(const matrix::NamedMatrix& table, const NumberGrid& grid) {
  constexpr double kSixDigits = 1e-5;
  text::ProblemList problems;
  for (std::size_t i = 0; i < grid.areas.size(); ++i) {
    const double ours = table.entries[i * table.to.size()].area_from;
    if (std::abs(grid.areas[i] - ours) <= kSixDigits * ours) continue;
    problems.add({grid.file, grid.line_of_areas,
                  "surface " + std::to_string(i + 1) + " has the area " + text::shortest(grid.areas[i]) + ", and " +
                      text::in_quotes(table.from[i]) + " has " + text::short_number(ours, 6),
                  "the matrices are of other patches, in another order or in another unit",
                  "compute the truth for the same scene, and name its patches by --from and --to in this order"});
  }
  problems.throw_if_any();
}

void compare_in_order(const matrix::NamedMatrix& table, const NumberGrid& grid, Matrices& result) {
  require_same_size(table, grid);
  if (!grid.areas.empty()) require_same_areas(table, grid);
  result.candidate_file = grid.file;
  result.truth = truth_of(table, {});
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    result.values.push_back({static_cast<std::uint32_t>(i), grid.lines.empty() ? 0 : grid.lines[i], grid.values[i]});
  }
}

// --- Facts ---

class FactFinder {
 public:
  FactFinder(const matrix::NamedMatrix& table, const Matrices& matrices)
      : table_(table), truth_(matrices.truth), theirs_(truth_.rows.size(), std::numeric_limits<double>::quiet_NaN()) {
    for (const Measured& one : matrices.values) theirs_[one.row] = one.value;
  }

  MatrixFacts find() {
    for (std::size_t k = 0; k < theirs_.size(); ++k) look_at_entry(k);
    const std::size_t width = truth_.sources.size();
    for (std::size_t first = 0; first < theirs_.size(); first += width) look_at_row(first, width);
    if (table_.from == table_.to) look_at_reciprocity(width);
    return facts_;
  }

 private:
  void look_at_entry(std::size_t k) {
    const double value = theirs_[k];
    const MatrixFacts::Largest entry{value, truth_.rows[k].receiver, truth_.source_of(truth_.rows[k])};
    if (value < 0.0 && (facts_.negative++ == 0 || value < facts_.least.by)) facts_.least = entry;
    if (value > 1.0 && (facts_.above_one++ == 0 || value > facts_.largest.by)) facts_.largest = entry;
  }

  static void raise(std::optional<MatrixFacts::Largest>& largest, MatrixFacts::Largest one) {
    if (!largest || one.by > largest->by) largest = std::move(one);
  }

  void look_at_row(std::size_t first, std::size_t width) {
    double sum = 0.0, lower = 0.0, upper = 0.0;
    for (std::size_t k = first; k < first + width; ++k) {
      sum += theirs_[k];
      lower += truth_.rows[k].lower;
      upper += truth_.rows[k].upper;
    }
    if (!std::isfinite(sum)) return;  // an entry is missing, or not finite
    raise(facts_.row_sum, {std::max({0.0, sum - upper, lower - sum}), truth_.rows[first].receiver, {}});
  }

  void look_at_reciprocity(std::size_t width) {
    const std::size_t count = table_.from.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) {
        const double ratio = table_.entries[j * count].area_from / table_.entries[i * count].area_from;  // A_j / A_i
        const double f_ij = theirs_[i * width + j], f_ji = theirs_[j * width + i];
        const double by = ratio >= 1.0 ? std::abs(f_ij - ratio * f_ji) : std::abs(f_ij / ratio - f_ji);
        if (std::isfinite(by)) raise(facts_.reciprocity, {by, table_.from[i], table_.from[j]});
      }
    }
  }

  const matrix::NamedMatrix& table_;
  const Truth& truth_;
  std::vector<double> theirs_;  // in the order of the truth; NaN where there is none
  MatrixFacts facts_;
};

}  // namespace

Matrices read_matrices(const fs::path& truth, const fs::path& candidate, const CandidateColumns& columns,
                       bool partial) {
  const kernel::StandardArithmetic arithmetic;
  const matrix::NamedMatrix table = matrix::read_named(truth);
  Matrices result;
  switch (kind_of(candidate, columns)) {
    case OtherKind::kList:
      compare_by_names(table, read_candidate(candidate, columns_of_list(candidate, columns)), partial, result);
      break;
    case OtherKind::kNamed:
      compare_by_names(table, read_named(candidate), partial, result);
      break;
    case OtherKind::kNumbers:
      compare_in_order(table, read_numbers(candidate), result);
      break;
    case OtherKind::kView3d:
      compare_in_order(table, read_view3d_output(candidate), result);
      break;
    case OtherKind::kNpy:
      compare_in_order(table, read_npy_grid(candidate), result);
      break;
  }
  result.facts = FactFinder(table, result).find();
  return result;
}

std::vector<std::string> sentences(const MatrixFacts& facts) {
  std::vector<std::string> texts;
  const auto at = [](const MatrixFacts::Largest& entry) { return ", at " + name_of_entry(entry.from, entry.to); };
  if (facts.row_sum) {
    texts.push_back("sums of rows are at most " + text::short_number(facts.row_sum->by) + " off those of the truth" +
                    (facts.row_sum->by > 0.0 ? ", in the row of " + text::in_quotes(facts.row_sum->from) : ""));
  }
  if (facts.reciprocity) {
    texts.push_back("A_i F_ij and A_j F_ji differ by at most " + text::short_number(facts.reciprocity->by) +
                    " of the smaller area" + (facts.reciprocity->by > 0.0 ? at(*facts.reciprocity) : ""));
  }
  if (facts.negative > 0) {
    texts.push_back(text::counted(facts.negative, "entry", "entries") + " below 0, the least " +
                    text::shortest(facts.least.by) + at(facts.least));
  }
  if (facts.above_one > 0) {
    texts.push_back(text::counted(facts.above_one, "entry", "entries") + " above 1, the largest " +
                    text::shortest(facts.largest.by) + at(facts.largest));
  }
  return texts;
}

}  // namespace exactff::check
