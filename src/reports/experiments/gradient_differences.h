// Finite differences against exact derivatives. Programs that need the slope of the light at a point, such as
// irradiance caches, take differences of sampled values. How wrong are these, by step and method?
//
// At receivers on the floor of the Cornell box and of the room with the blind, dF/dx along the two axes of the floor is
// known exactly (exact.h). Central differences of every method are compared with it. With a large step they miss how
// F bends; with a small one the noise of two samples is divided by it. Receivers at kinks, where F has no derivative,
// do not count.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct DifferencesSize {
  std::uint64_t receivers = 64;                          // on each floor
  std::vector<double> steps = geometric(0.1, 1e-6, 11);  // over the width of the floor
  std::vector<std::string> choices = {"exact",
                                      "area-sampling:samples=64,pattern=stratified",
                                      "area-sampling:samples=1024,pattern=stratified",
                                      "hemicube:resolution=256",
                                      "nettle:splits=4,rays=4",
                                      "adaptive:eps_B=0.001"};
  std::size_t timed = 12;  // receivers whose time is measured
};

// Of one method in one scene.
struct DifferenceErrors {
  std::string scene, choice;
  std::vector<double> rms;  // by step, over the root mean square of the true derivatives

  [[nodiscard]] std::size_t best() const;  // index of the step with the least error
};
struct DifferencesStudy {
  std::size_t receivers = 0, kinks = 0;  // in both scenes
  std::vector<DifferenceErrors> errors;
};
[[nodiscard]] DifferencesStudy differences_study(const DifferencesSize& size, int threads, const Hooks& hooks);

[[nodiscard]] Result gradient_differences(const DifferencesSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result gradient_differences(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
