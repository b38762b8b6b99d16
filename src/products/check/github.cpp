#include "check/github.h"

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

}  // namespace

std::string github_annotations(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  std::string text;
  const std::size_t own = report.worst.empty() ? 0 : report.worst.front().line;
  for (const Verdict& verdict : report.verdicts) {
    if (verdict.passed) continue;
    std::string message = sentence(verdict);
    if (verdict.worst) message += "\n" + describe(*verdict.worst);
    text += command("error", {report.candidate_file, verdict.worst ? verdict.worst->line : own},
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
