// A closed room: every direction from a point within it ends on some patch, so that the form factors of all patches sum
// to exactly 1. The exact method's balls must hold it. What the others sum to is their closure error, which programs
// like to take for a check of accuracy: the hemicube passes it by construction, whatever its single values.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct ClosureSize {
  std::string room = "closed-room:lamp=hanging";
  std::uint64_t receivers = 64;  // drawn on walls and ceiling
  std::vector<std::string> choices = {"hemicube", "nettle:splits=4,rays=4", "wallace:splits=8",
                                      "area-sampling:samples=64,pattern=stratified", "adaptive:eps_B=0.01"};
};

struct ClosureErrors {
  std::string choice;
  double rms = 0.0;  // of the sum less 1, over the receivers
  double worst = 0.0;
  double single_rms = 0.0;  // of the single form factors
};

struct ClosureStudy {
  std::size_t receivers = 0;
  std::size_t patches = 0;
  std::size_t hold_one = 0;  // receivers whose summed ball holds 1
  double widest = 0.0;       // of the summed balls, end to end
  std::vector<ClosureErrors> methods = {};
};
[[nodiscard]] ClosureStudy closure_study(const ClosureSize& size, int threads, const study::Hooks& hooks);

[[nodiscard]] Result closure(const ClosureSize& size, int threads, const study::Hooks& hooks);
[[nodiscard]] Result closure(const Effort& effort, const study::Hooks& hooks);

}  // namespace exactff::experiments
