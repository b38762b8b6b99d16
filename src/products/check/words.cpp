// Sentences about a report, for people, JUnit and GitHub.
#include <algorithm>
#include <array>
#include <cmath>

#include "check/report.h"
#include "check/tables.h"
#include "kernel/float_environment.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::check {

std::string_view to_string(Measure measure) {
  constexpr std::array<std::string_view, 3> kNames = {"absolute error", "relative error", "error in radiosity"};
  return kNames[static_cast<std::size_t>(measure)];
}

std::string name_of(const Quantile& quantile) { return "quantile " + text::shortest(quantile.share); }

std::string name_of(const Verdict& verdict) {
  return verdict.criterion + (verdict.source.empty() ? "" : ", source " + verdict.source);
}

std::string name_of(const std::array<std::string, 2>& keys, const std::string& receiver, const std::string& source) {
  return word_of(keys[0]) + ' ' + text::in_quotes(receiver) +
         (source.empty() ? "" : ", " + word_of(keys[1]) + ' ' + text::in_quotes(source));
}

std::string describe(const RowError& row) {
  std::string text = (row.claim ? "" : "exact ") + text::shortest(row.truth);
  if (row.claim) {
    text += " in [" + text::shortest(row.lower) + ", " + text::shortest(row.upper) + "] (" +
            std::string(to_string(*row.claim)) + ")";
  }
  text += ", found " + text::shortest(row.value);
  if (!std::isfinite(row.value)) return text;
  text += ", error " + text::short_number(row.error, 4) + ", relative " + text::short_number(row.relative, 4);
  if (!row.claim && row.status == Status::kNotCertified) text += ", truth not certified";
  return text;
}

std::string sentence(const Verdict& verdict) {
  std::string text = name_of(verdict) + ": ";
  if (verdict.criterion == "finite") {
    text += verdict.passed ? std::string("every value is a finite number")
                           : "values that are not finite numbers: " + text::shortest(verdict.measured);
  } else {
    text += text::shortest(verdict.measured) + (verdict.passed ? " is within the limit " : " is above the limit ") +
            text::shortest(verdict.limit);
  }
  return text + (verdict.worst ? ", worst at " + verdict.worst->name : "");
}

namespace {

// An entry is judged by its bounds, however wide they are.
void add_words_of_matrix(const Report& report, std::vector<std::string>& texts) {
  const auto add = [&](std::size_t count, const std::string& what) {
    if (count == 0) return;
    texts.push_back(text::counted(count, "entry", "entries") + " of the truth " + what + ": judged by " +
                    (count == 1 ? "its" : "their") + " bounds, which are up to " + text::short_number(report.widest) +
                    " wide");
  };
  add(report.by_points, "estimated by points");
  add(report.not_accurate, "wider than the accuracy it was computed with");
}

}  // namespace

std::vector<std::string> warnings(const Report& report) {
  std::vector<std::string> texts;
  if (report.not_certified > 0) {
    texts.push_back(text::counted_of(report.not_certified, report.overall.rows, "row") +
                    " of the truth not certified: compared with the enclosure instead");
  }
  add_words_of_matrix(report, texts);
  if (report.overall.rows < report.truth_rows) {
    texts.push_back(text::counted_of(report.truth_rows - report.overall.rows, report.truth_rows, "row") +
                    " of the truth without a value: not checked");
  }
  if (report.verdicts.size() == 1) {
    texts.emplace_back("no limit was given: the only check was that all values are finite numbers");
  }
  return texts;
}

std::string failure_message(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  std::string text;
  for (const Verdict& verdict : report.verdicts) {
    if (!verdict.passed) text += sentence(verdict) + '\n';
  }
  if (report.worst.empty()) return text;
  text += "worst rows by " + std::string(to_string(report.worst_by)) + ":\n";
  for (const RowError& row : report.worst) text += "  " + text::printable(row.name + ": " + describe(row)) + '\n';
  return text;
}

std::vector<std::string> sentences(const MatrixFacts& facts) {
  std::vector<std::string> texts;
  const auto at = [](const MatrixFacts::Largest& entry) {
    return ", at " + name_of({"from", "to"}, entry.from, entry.to);
  };
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

// --- JUnit ---

namespace {

std::string worst_rows(const Report& report) {
  std::string text;
  for (const RowError& row : report.worst) text += "\n" + row.name + ": " + describe(row);
  return text;
}

std::string test_case(const Report& report, const Verdict& verdict) {
  std::string text = "    <testcase classname=\"" + text::html("exactff.check." + report.column) + "\" name=\"" +
                     text::html(name_of(verdict)) + "\" time=\"0\"";
  if (verdict.passed) return text + "/>\n";
  return text + ">\n      <failure message=\"" + text::html(sentence(verdict)) + "\" type=\"" +
         text::html(verdict.criterion) + "\">" +
         text::html(sentence(verdict) + "\nworst rows by " + std::string(to_string(report.worst_by)) + ':') +
         text::html(worst_rows(report)) + "</failure>\n    </testcase>\n";
}

std::string property(const std::string& name, const std::string& value) {
  return "      <property name=\"" + name + "\" value=\"" + text::html(value) + "\"/>\n";
}

struct Counts {
  std::size_t tests = 0, failures = 0;
  [[nodiscard]] std::string text() const {
    return " tests=\"" + std::to_string(tests) + "\" failures=\"" + std::to_string(failures) +
           "\" errors=\"0\" time=\"0\"";
  }
};

std::string suite(const Report& report, Counts& all) {
  const auto failures = static_cast<std::size_t>(
      std::ranges::count_if(report.verdicts, [](const Verdict& verdict) { return !verdict.passed; }));
  all.tests += report.verdicts.size();
  all.failures += failures;
  std::string text = "  <testsuite name=\"" + text::html("exactff check " + report.candidate_file) + "\"" +
                     Counts{report.verdicts.size(), failures}.text() + ">\n    <properties>\n" +
                     property("truth", report.truth_file) + property("candidate", report.candidate_file) +
                     property("rows", std::to_string(report.overall.rows)) + "    </properties>\n";
  for (const Verdict& verdict : report.verdicts) text += test_case(report, verdict);
  std::vector<std::string> lines = report.matrix ? sentences(*report.matrix) : std::vector<std::string>();
  for (const std::string& doubt : warnings(report)) lines.push_back("warning: " + doubt);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += (i == 0 ? "    <system-out>" : "\n") + text::html(lines[i]);
  }
  if (!lines.empty()) text += "</system-out>\n";
  return text + "  </testsuite>\n";
}

}  // namespace

std::string junit_xml(std::span<const Report> reports) {
  const kernel::StandardArithmetic arithmetic;
  Counts all;
  std::string suites;
  for (const Report& report : reports) suites += suite(report, all);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"exactff check\"" + all.text() + ">\n" +
         suites + "</testsuites>\n";
}

// --- GitHub ---

namespace {

struct FileLine {
  std::string file = {};
  std::size_t line = 0;
};

std::string command(std::string_view kind, const FileLine& place, const std::string& title,
                    const std::string& message) {
  std::string text = "::" + std::string(kind) + ' ';
  if (!place.file.empty()) text += "file=" + text::github_property(place.file) + ',';
  if (!place.file.empty() && place.line > 0) text += "line=" + std::to_string(place.line) + ',';
  return text + "title=" + text::github_property(title) + "::" + text::github_message(message) + '\n';
}

// The row that decides, or an example of the worst: of this source, if the verdict is on one. Null if there is none.
const RowError* row_to_show(const Report& report, const Verdict& verdict) {
  if (verdict.worst) return &*verdict.worst;
  const auto found = std::ranges::find_if(
      report.worst, [&](const RowError& row) { return verdict.source.empty() || row.source == verdict.source; });
  return found == report.worst.end() ? nullptr : &*found;
}

}  // namespace

std::string github_annotations(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  std::string text;
  for (const Verdict& verdict : report.verdicts) {
    if (verdict.passed) continue;
    const RowError* row = row_to_show(report, verdict);
    std::string message = sentence(verdict);
    if (row != nullptr) message += "\n" + (verdict.worst ? "" : "worst row: " + row->name + ": ") + describe(*row);
    text += command("error", {report.candidate_file, row != nullptr ? row->line : 0},
                    "exactff check: " + name_of(verdict), message);
  }
  for (const std::string& warning : warnings(report)) {
    text += command("warning", {report.candidate_file, 0}, "exactff check", warning);
  }
  return text;
}

std::string github_annotations(const InputError& error) {
  const kernel::StandardArithmetic arithmetic;
  constexpr std::size_t kShown = 10;  // the runner shows no more for one step
  std::string text;
  for (const Problem& problem : error.problems()) {
    if (&problem - error.problems().data() == kShown) break;
    text += command("error", {problem.file, problem.line}, "exactff check: bad input", problem.message());
  }
  return text;
}

}  // namespace exactff::check
