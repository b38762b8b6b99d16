// Which methods a study compares, and which of them cannot show anything in a scene. A ladder is one method with
// settings of rising effort; a rung is one of these settings.
#pragma once

#include <span>
#include <vector>

#include "exactff/study.h"
#include "study/settings.h"

namespace exactff::study {

// Every method of the library over its range of effort. The values of eps_B are tenths of the largest rho B.
[[nodiscard]] std::vector<Ladder> default_ladders(double largest_rho_b);

// Gives every setting of the sweeps a rung, whatever its seed: of a ladder that has it or goes along eps_B with the
// same other settings, or else of a new ladder after the others of its method. Those without a line along eps_B share
// one.
void add_sweeps(std::vector<Ladder>& ladders, std::span<const AdaptiveOptions> settings);

// The choice with the default seed, and with the defaults of what does not affect it.
[[nodiscard]] methods::Choice without_seed(methods::Choice choice);

// Removes the ladders that cannot show anything, and returns the reasons.
[[nodiscard]] std::vector<LeftOut> leave_out(std::vector<Ladder>& ladders, const Scope& scope);

// The value of the setting that varies along the ladder, at this rung: "64". Empty if no setting varies.
[[nodiscard]] std::string rung_text(const Ladder& ladder, std::size_t rung);
// "area sampling, stratified, samples 64".
[[nodiscard]] std::string rung_name(const Ladder& ladder, std::size_t rung);
// Of a setting of the sweeps, as its rung is named: "adaptive, 16 rays, ε_B 0.0123". A seed that is not that of the
// base is added.
[[nodiscard]] std::string setting_name(const Study& study, std::size_t setting);

}  // namespace exactff::study
