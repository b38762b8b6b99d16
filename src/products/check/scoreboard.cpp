// Several programs held against one truth: a page, JSON, JUnit XML and a table in Markdown.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "check/report.h"
#include "files/file.h"
#include "kernel/float_environment.h"
#include "page/gnuplot.h"
#include "page/output_folder.h"
#include "page/page_text.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::check {
namespace {

using nlohmann::ordered_json;

// What is graded by itself: a whole report, or a level of a suite.
struct Part {
  const Statistics* statistics = nullptr;  // null if the program answered none of its questions
  std::size_t cases = 0, limits = 0, limits_kept = 0;

  [[nodiscard]] std::size_t not_finite() const { return statistics ? statistics->not_finite : 0; }
  [[nodiscard]] std::size_t answered() const { return statistics ? statistics->rows - not_finite() : 0; }
  [[nodiscard]] bool passed() const { return limits == limits_kept && not_finite() == 0; }
};

Part part_of(const Report& report, const Level* level = nullptr) {
  Part part{.statistics = &report.overall, .cases = level ? level->questions : report.truth_rows};
  if (level) {
    const auto found = std::ranges::find(report.sources, level->name);
    part.statistics = found == report.sources.end() ? nullptr : &report.by_source[found - report.sources.begin()];
  }
  for (const Verdict& verdict : report.verdicts) {
    if (level && verdict.source != level->name) continue;
    ++part.limits;
    part.limits_kept += verdict.passed ? 1U : 0U;
  }
  return part;
}

constexpr std::array kHeadings = {"program", "result", "answered",       "worst error",   "RMS",         "median",
                                  "90 %",    "99 %",   "digits, median", "digits, worst", "limits kept", "time"};

std::string of(std::size_t part, std::size_t whole) { return std::to_string(part) + " of " + std::to_string(whole); }

std::string digits(double relative) {
  const double value = digits_of(relative);
  return value == kMostDigits ? "all" : text::short_number(std::floor(10.0 * value) / 10.0 + 0.0);  // no -0
}

// Without an error, all digits are right; without an answer, there is nothing to say.
std::vector<std::string> cells_of(const Score& score, const Level* level = nullptr) {
  const Part part = part_of(score.report, level);
  std::vector<std::string> cells = {score.program, part.passed() ? "passed" : "FAILED",
                                    of(part.answered(), part.cases)};
  if (level && part.statistics == nullptr) cells[1] = "not asked";
  const Distribution none, &errors = part.answered() ? part.statistics->absolute : none;
  for (const double error : {errors.max, errors.rms, errors.median, errors.p90, errors.p99}) {
    cells.push_back(part.answered() ? text::short_number(error, 2) : "");
  }
  for (const double Distribution::*which : {&Distribution::median, &Distribution::max}) {
    cells.push_back(part.answered() ? digits(part.statistics->relative.*which) : "");
  }
  cells.push_back(of(part.limits_kept, part.limits));
  cells.push_back(score.seconds ? text::duration(*score.seconds) : "");
  return cells;
}

// Of a suite, a line for each program: what it answered on each level, with how many digits, and the largest error.
std::vector<std::vector<std::string>> level_cells(const Scoreboard& board) {
  std::vector<std::vector<std::string>> rows = {{"program", "result"}};
  for (const Level& level : board.scores.front().report.levels) rows[0].push_back(level.name);
  rows[0].emplace_back("time");
  for (const Score& score : board.scores) {
    std::vector<std::string>& row = rows.emplace_back();
    row = {score.program, score.report.passed() ? "passed" : "FAILED"};
    for (const Level& level : score.report.levels) {
      const Part part = part_of(score.report, &level);
      row.push_back(part.statistics == nullptr ? "not asked" : of(part.answered(), part.cases));
      if (part.answered() == 0) continue;
      row.back() += ": " + digits(part.statistics->relative.median) + " digits, worst " +
                    text::short_number(part.statistics->absolute.max, 2);
    }
    row.push_back(score.seconds ? text::duration(*score.seconds) : "");
  }
  return rows;
}

// The last column is there only if a time was given.
std::size_t columns_of(const Scoreboard& board) {
  const bool timed = std::ranges::any_of(board.scores, [](const Score& score) { return score.seconds.has_value(); });
  return kHeadings.size() - (timed ? 0 : 1);
}

// The headings, then a row for each program.
std::vector<std::vector<std::string>> all_cells(const Scoreboard& board, const Level* level = nullptr) {
  std::vector<std::vector<std::string>> rows = {{kHeadings.begin(), kHeadings.end()}};
  for (const Score& score : board.scores) rows.push_back(cells_of(score, level));
  return rows;
}

bool is_suite(const Scoreboard& board) { return !board.scores.front().report.levels.empty(); }

// Rows that failed are marked.
std::string html_table(const Scoreboard& board, std::vector<std::vector<std::string>> rows) {
  using page::HtmlTable;
  const auto kind = [](std::size_t i) { return i < 2 ? HtmlTable::CellKind::kText : HtmlTable::CellKind::kNumber; };
  HtmlTable table(HtmlTable::Shape::kWide);
  const std::size_t columns = rows[0].size() - (kHeadings.size() - columns_of(board));
  for (std::size_t i = 0; i < columns; ++i) table.column(rows[0][i], kind(i));
  for (std::size_t r = 1; r < rows.size(); ++r) {
    table.row(rows[r][1] == "FAILED" ? "base" : "");
    for (std::size_t i = 0; i < columns; ++i) table.cell(page::prose(text::html(rows[r][i])), kind(i));
  }
  return table.text() + '\n';
}

std::string html_tables(const Scoreboard& board) {
  if (!is_suite(board)) return html_table(board, all_cells(board));
  std::string tables = html_table(board, level_cells(board));
  for (const Level& level : board.scores.front().report.levels) {
    tables += page::heading("Level: " + text::html(level.name)) + html_table(board, all_cells(board, &level));
  }
  return tables;
}

std::string list_of(const std::vector<std::string>& lines) {
  std::string items;
  for (const std::string& line : lines) items += "<li>" + page::prose(text::html(line)) + "</li>\n";
  return items.empty() ? items : "<ul>\n" + items + "</ul>\n";
}

// Broken limits, the worst rows, and what else is to be known of a program.
std::string details_of(const Score& score) {
  const Report& report = score.report;
  std::vector<std::string> broken;
  for (const Verdict& verdict : report.verdicts) {
    if (!verdict.passed) broken.push_back(sentence(verdict));
  }
  std::vector<std::string> known = report.matrix ? sentences(*report.matrix) : std::vector<std::string>();
  for (const std::string& warning : warnings(report)) known.push_back(warning);
  const auto part = [](const std::string& title, const std::vector<std::string>& lines) {
    return lines.empty() ? "" : page::paragraph(title) + list_of(lines);
  };
  return page::fold(text::html(score.program) + ": " +
                        (report.passed() ? "passed" : text::counted(broken.size(), "limit") + " exceeded"),
                    page::paragraph("File: <code>" + text::html(report.candidate_file) + "</code>") +
                        part("Limits that are exceeded:", broken) +
                        part("Worst rows by " + std::string(to_string(report.worst_by)) + ":", worst_lines(report)) +
                        part("Also:", known));
}

std::string page_of(const Scoreboard& board) {
  const Report& first = board.scores.front().report;
  std::size_t passed = 0;
  for (const Score& score : board.scores) passed += score.report.passed() ? 1 : 0;
  std::vector<std::string> limits;
  for (const Verdict& verdict : first.verdicts) {
    if (verdict.criterion == "finite") continue;
    const std::string limit = (is_suite(board) ? verdict.criterion : name_of(verdict)) + " at most " +
                              text::shortest(verdict.limit) + (is_suite(board) ? " on each level" : "");
    if (std::ranges::find(limits, limit) == limits.end()) limits.push_back(limit);
  }
  std::string text = page::page_head("Scoreboard");
  text += "<h1>Scoreboard</h1>\n<p class=\"subtitle\">" + text::counted(board.scores.size(), "program") +
          " against true values of " + text::html(text::program_version()) + "</p>\n<p class=\"verdict\">" +
          (passed == board.scores.size()
               ? std::string(passed == 1 ? "The program keeps" : "All programs keep") + " every limit."
               : "Every limit is kept by " + std::to_string(passed) + " of " +
                     text::counted(board.scores.size(), "program") + ".") +
          "</p>\n";
  text += page::facts_table(
      {{"truth", "<code>" + text::html(first.truth_file) + "</code>"},
       {"judged", "column <code>" + text::html(first.column) + "</code>, " + text::counted(first.truth_rows, "case")},
       {"limits", limits.empty() ? "none but that every value is a finite number"
                                 : text::html(text::enumerate(limits)) + "; every value is a finite number"}});
  text += page::heading("Results") + html_tables(board) +
          page::paragraph(
              "Errors are absolute: the distance from the true value, or from its bounds where it is not "
              "certified. <i>90 %</i>: nine of ten answers are at most that far off. <i>Digits</i> are "
              "correct decimal digits, by the relative error.");
  const Plot picture = plot(shares_script(board));
  if (!picture.svg.empty()) {
    text += "<div class=\"figures\"><figure id=\"errors\">\n" +
            page::inline_svg(picture.svg, "errors", "How large errors are") +
            "\n<figcaption>How many of all cases have an error of at most x. A higher line is better. Errors of 0 "
            "count, but cannot be drawn.</figcaption>\n</figure></div>\n";
  } else {
    text += page::paragraph(text::html("There is no figure: " + picture.why_not + "."));
  }
  text += page::heading("Each program");
  for (const Score& score : board.scores) text += details_of(score);
  return text + page::page_end();
}

ordered_json json_of(const std::string& level, const Part& part) {
  ordered_json json = {{"level", level},
                       {"cases", part.cases},
                       {"answered", part.answered()},
                       {"limits", part.limits},
                       {"limits_kept", part.limits_kept}};
  if (part.answered() == 0) return json;
  json["errors"] = json_of(part.statistics->absolute);
  json["digits"] = {{"median", digits_of(part.statistics->relative.median)},
                    {"worst", digits_of(part.statistics->relative.max)}};
  return json;
}

std::string json_text(const Scoreboard& board) {
  const Report& first = board.scores.front().report;
  ordered_json json;
  json["program"] = text::program_version();
  json["truth"] = {{"file", first.truth_file}, {"column", first.column}, {"rows", first.truth_rows}};
  json["programs"] = ordered_json::array();
  for (const Score& score : board.scores) {
    const Report& report = score.report;
    const Part part = part_of(report);
    ordered_json one = {
        {"name", score.program},
        {"passed", report.passed()},
        {"cases", report.truth_rows},
        {"answered", part.answered()},
        {"errors", json_of(report.overall.absolute)},
        {"digits",
         {{"median", digits_of(report.overall.relative.median)}, {"worst", digits_of(report.overall.relative.max)}}},
        {"limits", part.limits},
        {"limits_kept", part.limits_kept}};
    for (const Level& level : report.levels) one["levels"].push_back(json_of(level.name, part_of(report, &level)));
    if (score.seconds) one["seconds"] = json_number(*score.seconds);
    one["report"] = json_of(report);
    json["programs"].push_back(std::move(one));
  }
  return text::json_document(json) + '\n';
}

}  // namespace

double digits_of(double relative_error) {
  const kernel::StandardArithmetic arithmetic;
  return relative_error == 0.0 ? kMostDigits : std::clamp(-std::log10(relative_error), 0.0, kMostDigits);
}

std::vector<std::string> program_names(std::span<const std::filesystem::path> candidates) {
  std::map<std::string, int> uses;
  for (const std::filesystem::path& file : candidates) ++uses[file.stem().string()];
  std::vector<std::string> names;
  for (const std::filesystem::path& file : candidates) {
    names.push_back(uses[file.stem().string()] == 1 ? file.stem().string() : file.string());
  }
  return names;
}

Scoreboard scoreboard(const std::filesystem::path& truth, std::span<const std::filesystem::path> candidates,
                      const Options& options) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Report> reports = compare_all(truth, candidates, options);
  const std::vector<std::string> names = program_names(candidates);
  Scoreboard board;
  for (std::size_t i = 0; i < reports.size(); ++i) board.scores.push_back({names[i], {}, std::move(reports[i])});
  return board;
}

std::string markdown(const Scoreboard& board) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<std::vector<std::string>> rows = is_suite(board) ? level_cells(board) : all_cells(board);
  const std::size_t columns = rows[0].size() - (kHeadings.size() - columns_of(board));
  rows.emplace(rows.begin() + 1);
  for (std::size_t i = 0; i < columns; ++i) rows[1].emplace_back(i < 2 ? "---" : "--:");
  std::string text;
  for (std::vector<std::string>& row : rows) {
    text += '|';
    for (std::size_t i = 0; i < columns; ++i) {
      std::string cell = text::printable(row[i]);
      text::replace_all(cell, "|", "\\|");
      std::size_t width = 3;
      for (const std::vector<std::string>& other : rows) width = std::max(width, other[i].size());
      const std::string blanks(width > cell.size() ? width - cell.size() : 0, &row == &rows[1] ? '-' : ' ');
      text += ' ' + (i < 2 ? cell + blanks : blanks + cell) + " |";
    }
    text += '\n';
  }
  return text;
}

void write(const Scoreboard& board, const std::filesystem::path& folder) {
  const kernel::StandardArithmetic arithmetic;
  page::StagedFolder staged(folder);
  const auto put = [&](const char* name, const std::string& text) {
    files::WholeFile file(staged.path() / name);
    file.append(text);
    file.commit();
  };
  std::vector<Report> reports;
  for (const Score& score : board.scores) reports.push_back(score.report);
  put(page::kScoreFile, json_text(board));
  put("junit.xml", junit_xml(reports));
  put("index.html", page_of(board));
  staged.commit();
}

// --- Pictures of errors, drawn by gnuplot ---

namespace {

double edge(long index, int bins_per_decade) {
  return std::pow(10.0, static_cast<double>(index) / static_cast<double>(bins_per_decade));
}

// The bin with edge(k - 1) < value <= edge(k).
long bin_of(double value, int bins_per_decade) {
  const double finite = std::min(value, std::numeric_limits<double>::max());
  auto k = static_cast<long>(std::ceil(std::log10(finite) * bins_per_decade));
  if (edge(k, bins_per_decade) < finite) ++k;  // the logarithm was rounded down onto an edge
  return k;
}

// The limits of single errors. Each is listed once, even if it applies to several sources.
std::vector<page::Mark> limits(const Report& report) {
  std::vector<page::Mark> marks;
  for (const Verdict& verdict : report.verdicts) {
    if (verdict.criterion != "max-abs" && !verdict.criterion.starts_with("quantile")) continue;
    const page::Mark mark{verdict.criterion + " " + text::shortest(verdict.limit), verdict.limit};
    const auto is_same = [&](const page::Mark& other) { return other.title == mark.title; };
    if (std::none_of(marks.begin(), marks.end(), is_same)) marks.push_back(mark);
  }
  return marks;
}

// A temporary folder, not one beside the output: the picture may go to a pipe.
files::WorkFolder scratch_folder() {
  try {
    return files::WorkFolder(std::filesystem::temp_directory_path() / "exactff-plot");
  } catch (const std::filesystem::filesystem_error& error) {
    text::refuse("cannot create a temporary folder: " + error.code().message(), "gnuplot needs one to draw",
                 "set TMPDIR to a writable folder, or remove --plot");
  }
}

}  // namespace

Histogram histogram(const Report& report, int bins_per_decade, std::size_t most_bins) {
  Histogram result;
  const std::vector<double>& errors = report.magnitudes;
  const auto nonzero = std::upper_bound(errors.begin(), errors.end(), 0.0);
  result.exact = static_cast<std::size_t>(nonzero - errors.begin());
  if (nonzero == errors.end()) return result;
  const long last = bin_of(errors.back(), bins_per_decade);
  const long first = std::max(bin_of(*nonzero, bins_per_decade), last - static_cast<long>(most_bins) + 1);
  auto from = nonzero;
  for (long k = first; k <= last; ++k) {
    const double high = edge(k, bins_per_decade);
    const auto to = k == last ? errors.end() : std::upper_bound(from, errors.end(), high);
    result.bins.push_back({edge(k - 1, bins_per_decade), high, static_cast<std::size_t>(to - from)});
    from = to;
  }
  return result;
}

std::string histogram_script(const Report& report) {
  constexpr int kBinsPerDecade = 4;
  constexpr std::size_t kMostBins = 120;
  const Histogram shown = histogram(report, kBinsPerDecade, kMostBins);
  std::vector<page::Bar> bars;
  for (const HistogramBin& bin : shown.bins) bars.push_back({bin.low, bin.high, static_cast<double>(bin.count)});
  const std::string exact =
      shown.exact > 0 ? " (not shown: " + text::counted(shown.exact, "row") + " without error)" : "";
  const std::string rows = "of " + text::counted(report.overall.rows, "row");  // short: the axis is not long
  return page::bar_plot({"absolute error" + exact, rows, true, false}, bars, limits(report));
}

// A step of a line for each row would be too many.
std::string shares_script(const Scoreboard& board) {
  constexpr std::size_t kMostPoints = 400;
  std::vector<page::Series> lines;
  for (const Score& score : board.scores) {
    page::Series& line = lines.emplace_back();
    line.title = score.program;
    line.style = static_cast<int>(lines.size());
    line.drawn = page::Drawn::kLine;
    const std::vector<double>& errors = score.report.magnitudes;
    const auto all = static_cast<double>(score.report.truth_rows);
    const std::size_t step = errors.size() / kMostPoints + 1;
    for (std::size_t i = 0; i < errors.size(); i += step) {
      const std::size_t last = std::min(i + step, errors.size());
      line.points.emplace_back(errors[last - 1], static_cast<double>(last) / all);
    }
  }
  if (lines.empty()) return {};
  return page::line_plot({.x = "absolute error",
                          .y = "share of all cases",
                          .log_y = false,
                          .extra = {"set yrange [0:1]"},
                          .marks = limits(board.scores.front().report)},
                         lines);
}

Plot plot(const std::string& script, const std::function<bool()>& cancelled) {
  if (script.empty()) return {{}, "every error is 0, which a logarithmic axis cannot show"};
  const files::WorkFolder scratch = scratch_folder();
  const page::PlotResult result = page::run_gnuplot(script, scratch.path(), cancelled);
  if (result.outcome == page::PlotResult::Outcome::kDrawn) return {result.svg, {}};
  const bool missing = result.outcome == page::PlotResult::Outcome::kNoProgram;
  return {{}, missing ? "gnuplot was not found; install it" : "gnuplot failed: " + result.message};
}

}  // namespace exactff::check
