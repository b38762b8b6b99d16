#include "check/junit.h"

#include <algorithm>

#include "check/words.h"
#include "kernel/float_environment.h"
#include "text/escape.h"

namespace exactff::check {
namespace {

std::string worst_rows(const Report& report) {
  std::string text;
  for (const RowError& row : report.worst) text += "\n" + name_of(row) + ": " + describe(row);
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

}  // namespace

std::string junit_xml(const Report& report, const std::optional<MatrixFacts>& matrix) {
  const kernel::StandardArithmetic arithmetic;
  const auto failures = std::count_if(report.verdicts.begin(), report.verdicts.end(),
                                      [](const Verdict& verdict) { return !verdict.passed; });
  const std::string counts = " tests=\"" + std::to_string(report.verdicts.size()) + "\" failures=\"" +
                             std::to_string(failures) + "\" errors=\"0\" time=\"0\"";
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"exactff check\"" + counts +
                     ">\n  <testsuite name=\"" + text::html("exactff check " + report.candidate_file) + "\"" + counts +
                     ">\n    <properties>\n" + property("truth", report.truth_file) +
                     property("candidate", report.candidate_file) +
                     property("rows", std::to_string(report.overall.rows)) + "    </properties>\n";
  for (const Verdict& verdict : report.verdicts) text += test_case(report, verdict);
  std::vector<std::string> lines = matrix ? sentences(*matrix) : std::vector<std::string>();
  for (const std::string& doubt : warnings(report)) lines.push_back("warning: " + doubt);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += (i == 0 ? "    <system-out>" : "\n") + text::html(lines[i]);
  }
  if (!lines.empty()) text += "</system-out>\n";
  return text + "  </testsuite>\n</testsuites>\n";
}

}  // namespace exactff::check
