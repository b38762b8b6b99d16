// A closed room: every ray from a point in it ends on some patch, so the form factors of all patches sum to exactly 1.
// The balls of the exact method must contain 1. For the other methods, the difference of the sum from 1 is their
// closure error. Programs often use it as a check of accuracy, but the hemicube passes this check by construction,
// whatever its single values are.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct ClosureSize {
  std::string room = "closed-room:lamp=hanging";
  std::uint64_t receivers = 64;  // chosen at random on walls and ceiling
  std::vector<std::string> choices = {"hemicube", "nettle:splits=4,rays=4", "wallace:splits=8",
                                      "area-sampling:samples=64,pattern=stratified", "adaptive:eps_B=0.01"};
};

struct ClosureErrors {
  std::string choice;
  double rms = 0.0;  // of the sum minus 1, over the receivers
  double worst = 0.0;
  double single_rms = 0.0;  // of the single form factors
};

struct ClosureStudy {
  std::size_t receivers = 0;
  std::size_t patches = 0;
  std::size_t hold_one = 0;  // receivers whose summed ball contains 1
  double widest = 0.0;       // width of the widest summed ball
  std::vector<ClosureErrors> methods = {};
};
[[nodiscard]] ClosureStudy closure_study(const ClosureSize& size, int threads, const Hooks& hooks);

[[nodiscard]] Result closure(const ClosureSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result closure(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
