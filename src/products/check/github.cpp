#include "check/github.h"

#include <algorithm>
#include <string_view>

#include "check/words.h"
#include "kernel/float_environment.h"
#include "text/escape.h"

namespace exactff::check {
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
    if (row != nullptr) message += "\n" + (verdict.worst ? "" : "worst row: " + name_of(*row) + ": ") + describe(*row);
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
