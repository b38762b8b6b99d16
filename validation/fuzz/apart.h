// Runs a check in a process of its own, so that a crash or a hang is one of its outcomes.
#pragma once

#include <functional>
#include <string>

namespace exactff::validation {

enum class Ending { kFine, kProblem, kCrash, kHang };

struct Outcome {
  Ending ending = Ending::kFine;
  std::string problem;  // what the check returned
};

// `check` returns what is wrong, or nothing. What it prints is lost.
[[nodiscard]] Outcome run_apart(const std::function<std::string()>& check, unsigned seconds);

}  // namespace exactff::validation
