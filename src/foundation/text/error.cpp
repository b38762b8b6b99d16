#include "exactff/error.h"

#include <algorithm>
#include <utility>

#include "text/escape.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff {

namespace {

constexpr std::size_t kPrintedProblems = 20;

std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  const std::size_t printed = std::min(problems.size(), kPrintedProblems);
  for (std::size_t i = 0; i < printed; ++i) {
    if (i > 0) text += '\n';
    text += problems[i].message();
  }
  const std::size_t others = problems.size() - printed;
  const bool at_least =
      problems.size() > text::ProblemList::kKept;  // the last one then gives the number of dropped problems
  if (others > 0) {
    text += std::string("\n... and ") + (at_least ? "more than " : "") + text::counted(others, "more problem");
  }
  return text;
}

}  // namespace

std::string Problem::message() const {
  std::string text;
  if (!file.empty()) text += file + ":";
  if (line > 0) text += std::to_string(line) + ":";
  if (!text.empty()) text += ' ';
  text += what;
  if (!why.empty()) text += " (" + why + ")";
  if (!suggestion.empty()) text += "; " + suggestion;
  return text::printable(text);
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

InputError::InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

}  // namespace exactff
