// Which settings of the adaptive algorithm a study runs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

struct SettingPlan {
  std::vector<AdaptiveOptions> settings;
  std::size_t base = 0;
  bool full_product = false;
};

// What the scene lets a sweep show. Derived from the exact values before any sampling.
struct Work {
  double largest_rho_b = 0.0;     // over receivers and sources
  double mean_source_area = 0.0;  // of a face
  bool anything_sampled = true;   // some receiver has a source hidden in part, or by several occluders together
};

// Fills empty lists with the defaults, drops repetitions, checks ranges. Throws InputError.
void complete(Sweeps& sweeps, const Work& work);

// Shortens every list that cannot affect the results to one value, and returns the reasons.
[[nodiscard]] std::vector<LeftOut> leave_out(Sweeps& sweeps, const Work& work);

// Requires completed sweeps. No setting occurs twice. The order depends on the lists alone.
[[nodiscard]] SettingPlan combine(const Sweeps& sweeps);

// Whether the two agree in everything that can change a value.
[[nodiscard]] bool same_setting(const AdaptiveOptions& a, const AdaptiveOptions& b);

// The setting as one of the method `adaptive`.
[[nodiscard]] methods::Choice choice_of(const AdaptiveOptions& setting);

// The settings that differ from `from` in this one parameter only, including `from`.
[[nodiscard]] std::vector<std::size_t> line_through(const std::vector<AdaptiveOptions>& settings, std::size_t from,
                                                    Parameter parameter);
// The index of the setting in the list.
[[nodiscard]] std::optional<std::size_t> find_setting(const std::vector<AdaptiveOptions>& settings,
                                                      const AdaptiveOptions& wanted);

// The settings to leave out: those with the most planned work, but not the base, until the rest fits into
// Request::sweep_budget. In order of decreasing work. Requires exact values and settings. Work is counted at a few
// receivers and multiplied by fixed prices, so that the choice depends on the request alone.
[[nodiscard]] std::vector<std::size_t> over_budget(const Study& study, std::span<const ExactSource> sources,
                                                   const AdaptiveSolver& solver,
                                                   std::span<const AdaptiveSource> sampled_sources);

// "ε_B = 0.0123, 16 jittered rays": names the parameters that differ from the base.
[[nodiscard]] std::string setting_name(const Study& study, std::size_t setting);

}  // namespace exactff::study
