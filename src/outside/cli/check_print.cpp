#include "cli/check_print.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "check/report.h"
#include "cli/output.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::cli {
namespace {

void add_statistics(TextTable& table, const std::string& what, const std::string& source,
                    const check::Statistics& statistics, const check::Distribution& d, bool has_bias) {
  table.add_row({what, source, std::to_string(statistics.rows - statistics.not_finite), text::short_number(d.median),
                 text::short_number(d.p90), text::short_number(d.p99), text::short_number(d.p999),
                 text::short_number(d.max), text::short_number(d.rms),
                 has_bias ? text::short_number(statistics.bias) : ""});
}

void add_all(TextTable& table, const std::string& source, const check::Statistics& s) {
  add_statistics(table, "absolute", source, s, s.absolute, true);
  add_statistics(table, "relative", source, s, s.relative, false);
  if (s.radiosity) add_statistics(table, "radiosity", source, s, *s.radiosity, false);
}

void print_distribution(const check::Report& report) {
  TextTable table;
  table.add_column("error");
  table.add_column("source");
  for (const char* title : {"rows", "median", "90 %", "99 %", "99.9 %", "max", "RMS", "bias"}) {
    table.add_column(title, Align::kRight);
  }
  const bool several = report.sources.size() > 1;
  add_all(table, several ? "all" : report.sources.front(), report.overall);
  for (std::size_t s = 0; several && s < report.sources.size(); ++s) {
    add_all(table, report.sources[s], report.by_source[s]);
  }
  table.print(std::cout);
  if (report.overall.relative_mse) {
    std::cout << "Relative MSE, the mean of e^2 / (t^2 + " << text::shortest(check::kRelativeMseEpsilon)
              << "): " << text::short_number(*report.overall.relative_mse) << '\n';
  }
  if (report.overall.leaks > 0) {
    std::cout << "Truth is 0, but value is not: " << text::counted(report.overall.leaks, "row") << '\n';
  }
  std::cout << '\n';
}

void print_histogram(const check::Report& report) {
  const check::Histogram histogram = check::histogram(report);
  std::size_t most = histogram.exact;
  for (const check::HistogramBin& bin : histogram.bins) most = std::max(most, bin.count);
  TextTable table;
  table.add_column("absolute error");
  table.add_column("rows", Align::kRight);
  table.add_column("");
  const auto add = [&](const std::string& range, std::size_t count) {
    constexpr std::size_t kWidth = 50;
    const std::size_t length = count == 0 ? 0 : std::max<std::size_t>(1, kWidth * count / most);
    table.add_row({range, std::to_string(count), std::string(length, '#')});
  };
  if (histogram.exact > 0) add("0", histogram.exact);
  for (const check::HistogramBin& bin : histogram.bins) add("up to " + text::short_number(bin.high, 1), bin.count);
  table.print(std::cout);
  std::cout << '\n';
}

void print_matrix_facts(const std::optional<check::MatrixFacts>& matrix) {
  if (!matrix) return;
  std::cout << "The matrix itself\n";
  for (const std::string& fact : check::sentences(*matrix)) std::cout << "  " << text::printable(fact) << '\n';
  std::cout << '\n';
}

// The first column is always our own text, so that no line can begin with text from a file.
void print_worst(const check::Report& report) {
  if (report.worst.empty()) return;
  std::cout << "Worst rows by " << to_string(report.worst_by) << '\n';
  TextTable table;
  table.add_column("#", Align::kRight);
  for (const std::string& title : report.keys) table.add_column(title);
  for (const char* title : {report.worst.front().claim ? "truth" : "exact", "found", "error", "relative", "line"})
    table.add_column(title, Align::kRight);
  for (std::size_t i = 0; i < report.worst.size(); ++i) {
    const check::RowError& row = report.worst[i];
    table.add_row({std::to_string(i + 1), row.receiver, row.source, text::shortest(row.truth),
                   text::shortest(row.value), text::short_number(row.error), text::short_number(row.relative),
                   row.line > 0 ? std::to_string(row.line) : std::string()});
  }
  table.print(std::cout);
  std::cout << '\n';
}

void print_verdicts(const check::Report& report) {
  TextTable table;
  for (const char* title : {"verdict", "criterion", "source"}) table.add_column(title);
  for (const char* title : {"measured", "limit"}) table.add_column(title, Align::kRight);
  for (const check::Verdict& verdict : report.verdicts) {
    table.add_row({verdict.passed ? "pass" : "FAIL", verdict.criterion, verdict.source.empty() ? "all" : verdict.source,
                   text::short_number(verdict.measured, 6), text::short_number(verdict.limit, 6)});
  }
  table.print(std::cout);
}

void print_improvements(const std::vector<check::Improvement>& improvements) {
  for (const check::Improvement& better : improvements) {
    std::cout << "Better than " << better.criterion
              << (better.source.empty() ? "" : ", source " + text::printable(better.source)) << ": "
              << text::short_number(better.recorded) << " -> " << text::short_number(better.now);
    if (better.recorded > 0.0 && std::isfinite(better.recorded)) {
      std::cout << ", " << text::short_number(100.0 * (1.0 - better.now / better.recorded)) << " % less";
    }
    std::cout << '\n';
  }
}

void print_end(const check::Report& report, bool improved, const std::string& baseline_to_tighten) {
  const auto failed = static_cast<std::size_t>(std::count_if(
      report.verdicts.begin(), report.verdicts.end(), [](const check::Verdict& verdict) { return !verdict.passed; }));
  if (failed > 0) {
    std::cout << "Failed: " << failed << " of " << text::counted(report.verdicts.size(), "criterion", "criteria")
              << '\n';
  } else {
    std::cout << "Passed\n";
  }
  const bool suggests = failed == 0 && improved && !baseline_to_tighten.empty();
  if (suggests)
    std::cout << "To record this improvement, without --baseline: --write-baseline "
              << text::printable(baseline_to_tighten) << '\n';
}

}  // namespace

void print_check(const check::Report& report, const std::string& baseline_to_tighten) {
  std::cout << "truth      " << text::printable(report.truth_file) << " (" << text::printable(report.column) << ", "
            << (report.matrix ? text::counted(report.truth_rows, "entry", "entries")
                              : text::counted(report.truth_rows, "row"))
            << ")\n"
            << "candidate  " << text::printable(report.candidate_file) << " ("
            << text::counted(report.overall.rows, "row") << " judged)\n\n";
  print_distribution(report);
  print_histogram(report);
  print_matrix_facts(report.matrix);
  print_worst(report);
  print_verdicts(report);
  print_improvements(report.improvements);
  print_end(report, !report.improvements.empty(), baseline_to_tighten);
}

}  // namespace exactff::cli
