// Which settings of the adaptive algorithm a study runs.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

struct SettingPlan {
  std::vector<AdaptiveOptions> settings;
  std::size_t base = 0;
  bool full_product = false;
};

// What the exact values show about the work that a method has in the scene.
struct Scope {
  double largest_rho_b = 0.0;     // over receivers and sources
  double mean_source_area = 0.0;  // of a face
  bool anything_sampled = true;   // some receiver has a source hidden in part, or by several occluders together
  bool anything_seen = true;
};

// Fills empty lists with the defaults, drops repetitions, checks ranges. Throws InputError.
void complete(Sweeps& sweeps, const Scope& scope);

// Shortens every list that cannot affect the results to one value, and returns the reasons.
[[nodiscard]] std::vector<LeftOut> leave_out(Sweeps& sweeps, const Scope& scope);

// Requires completed sweeps. No setting occurs twice. The order depends on the lists alone.
[[nodiscard]] SettingPlan combine(const Sweeps& sweeps);

// The setting as one of the method `adaptive`.
[[nodiscard]] methods::Choice choice_of(const AdaptiveOptions& setting);

// With this parameter of a method at its default.
[[nodiscard]] methods::Choice without(methods::Choice choice, std::string_view parameter);

// The settings that differ from `from` in this one parameter of the method `adaptive` only, including `from`.
[[nodiscard]] std::vector<std::size_t> line_through(const std::vector<AdaptiveOptions>& settings, std::size_t from,
                                                    std::string_view parameter);
// The index of the setting in the list.
[[nodiscard]] std::optional<std::size_t> find_setting(const std::vector<AdaptiveOptions>& settings,
                                                      const AdaptiveOptions& wanted);

}  // namespace exactff::study
