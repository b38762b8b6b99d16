// Which methods a study runs against one another, and what a scene gives no work to.
#pragma once

#include <vector>

#include "exactff/study.h"
#include "study/settings.h"

namespace exactff::study {

// Every method of the library over its range of effort; eps_B in tenths of the largest rho B.
[[nodiscard]] std::vector<Ladder> default_ladders(double largest_rho_b);

// What the exact values say there is to compare.
struct Sightings {
  bool any = true;      // some receiver sees something
  bool sampled = true;  // some receiver has a source hidden in part, or by several occluders together
  double largest_rho_b = 0.0;
};

// Takes the ladders out that cannot show anything, and says why.
[[nodiscard]] std::vector<LeftOut> leave_out(std::vector<Ladder>& ladders, const Sightings& sightings);

// The value that a rung has of the setting along which its ladder goes: "64"; empty where there is none.
[[nodiscard]] std::string rung_text(const Ladder& ladder, std::size_t rung);
// "area sampling, stratified, samples 64".
[[nodiscard]] std::string rung_name(const Ladder& ladder, std::size_t rung);

}  // namespace exactff::study
