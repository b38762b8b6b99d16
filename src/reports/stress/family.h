// The families of stiff scenes, grouped by what makes them stiff. A family is a list of stiffnesses and a function that
// makes the scene for one of them.
#pragma once

#include <span>
#include <vector>

#include "stress/stage.h"
#include "stress/stress.h"

namespace exactff::stress {

struct Family {
  FamilyInfo info;
  std::vector<double> stiffnesses;  // ascending
  Case (*make)(double stiffness);
};

[[nodiscard]] std::vector<Family> distance_families();    // near, far, small, thin, on the horizon
[[nodiscard]] std::vector<Family> occluder_families();    // cracks, contacts, planes that nearly coincide
[[nodiscard]] std::vector<Family> crowd_families();       // many occluders, many edges at one point
[[nodiscard]] std::vector<Family> number_families();      // the numbers themselves: scales, translations, denormals
[[nodiscard]] const std::vector<Family>& all_families();  // in the order of the report

// 1, 10, 100, ... to 10^16, then every 20th decade, and the last.
[[nodiscard]] std::vector<double> decades(int last);
// 1, 2, 4, ... 2^last; every step-th of them.
[[nodiscard]] std::vector<double> octaves(int last, int step = 1);

}  // namespace exactff::stress
