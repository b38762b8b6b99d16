// Runs a check in a separate process, so that a crash or a hang is just another outcome.
#pragma once

#include <functional>
#include <string>

namespace exactff::validation {

enum class Ending { kFine, kProblem, kCrash, kHang };

struct Outcome {
  Ending ending = Ending::kFine;
  std::string problem;  // the result of the check
};

// `check` returns a description of the problem, empty if there is none. Its output is discarded.
[[nodiscard]] Outcome run_apart(const std::function<std::string()>& check, unsigned seconds);

}  // namespace exactff::validation
