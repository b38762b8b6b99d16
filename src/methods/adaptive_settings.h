// The code shared by Tampieri's algorithm and its control with exact visibility.
#pragma once

#include "exactff/adaptive.h"
#include "exactff/methods.h"

namespace exactff::methods {

// eps_B, eps_A and depth_cap.
[[nodiscard]] std::vector<SettingSpec> tolerance_settings();
void take_tolerances(const Settings& settings, AdaptiveOptions& options);
// Throws InputError if only the depth cap would end the recursion.
void check_tolerances(const Settings& settings);

// The largest rho_r B_s over the channels.
[[nodiscard]] double largest_rho_b(const Scene& scene, const Receiver& receiver, const Rgb& radiosity);

// "leaves", "rays", and the leaves by reason: "leaves: V=1" and so on.
void count_leaves(const AdaptiveResult& found, Counters& counters);

}  // namespace exactff::methods
