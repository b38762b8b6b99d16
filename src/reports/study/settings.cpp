// The sweeps of a study.
//
//   The base setting takes the middle of the lists for eps_B and rays, and the first of every other list. If the full
//   product is small, it is run. Otherwise these are run:
//   1. the plane eps_B x rays through the base: error against eps_B, against rays and against time;
//   2. eps_A at the smallest eps_B and the most rays, where eps_A is what stops the recursion;
//   3. the variants over eps_B, and the patterns over rays;
//   4. the seeds at the base.
//   The centre pattern has one ray and no seed, the regular pattern no seed. Settings that differ only in what their
//   pattern ignores are one setting.
#include "study/settings.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kernel/expect.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::study {
namespace {

template <class T>
void drop_repetitions(std::vector<T>& list) {
  std::vector<T> kept;
  for (const T& value : list) {
    if (std::find(kept.begin(), kept.end(), value) == kept.end()) kept.push_back(value);
  }
  list = std::move(kept);
}

template <class T>
const T& middle(const std::vector<T>& list) {
  return list[list.size() / 2];
}

std::vector<double> powers_of_ten(double unit, int first, int last) {
  std::vector<double> values;
  // Dividing by an exact power of ten rounds once, so that 1 becomes 0.1 and not a neighbouring double.
  for (int power = first; power <= last; ++power) values.push_back(unit / std::pow(10.0, power));
  return values;
}

[[noreturn]] void refuse(std::string what, std::string why) { text::refuse(std::move(what), std::move(why), {}); }

void check_ranges(const Sweeps& sweeps) {
  for (double eps_b : sweeps.eps_b) {
    if (!std::isfinite(eps_b) || eps_b < 0.0)
      refuse("eps_B is " + text::shortest(eps_b), "a tolerance is finite and not negative");
  }
  for (double eps_a : sweeps.eps_a) {
    if (!std::isfinite(eps_a) || eps_a < 0.0)
      refuse("eps_A is " + text::shortest(eps_a), "an area is finite and not negative");
  }
  for (int rays : sweeps.rays) {
    if (rays < 1) refuse("a number of rays is " + std::to_string(rays), "every undecided leaf needs at least one");
  }
  const bool unbounded = std::count(sweeps.eps_b.begin(), sweeps.eps_b.end(), 0.0) > 0 &&
                         std::count(sweeps.eps_a.begin(), sweeps.eps_a.end(), 0.0) > 0;
  if (unbounded) refuse("eps_B and eps_A are both 0", "only the depth cap would end the recursion");
}

// A parameter that the pattern ignores gets one fixed value.
AdaptiveOptions normalised(AdaptiveOptions setting, const Sweeps& sweeps) {
  const bool seeded = setting.pattern == SamplePattern::kJittered || setting.pattern == SamplePattern::kLowDiscrepancy;
  if (!seeded) setting.seed = sweeps.seeds.front();
  if (setting.pattern == SamplePattern::kCentre) setting.rays = 1;
  return setting;
}

AdaptiveOptions base_of(const Sweeps& sweeps) {
  AdaptiveOptions base;
  base.eps_b = middle(sweeps.eps_b);
  base.eps_a = sweeps.eps_a.front();
  base.rays = middle(sweeps.rays);
  base.pattern = sweeps.patterns.front();
  base.seed = sweeps.seeds.front();
  base.variant = sweeps.variants.front();
  return normalised(base, sweeps);
}

std::size_t product_size(const Sweeps& sweeps) {
  return sweeps.eps_b.size() * sweeps.eps_a.size() * sweeps.rays.size() * sweeps.seeds.size() * sweeps.patterns.size() *
         sweeps.variants.size();
}

using SettingList = std::vector<AdaptiveOptions>;

// Every setting with every value of this parameter.
template <class T>
SettingList times_values(const SettingList& settings, T AdaptiveOptions::*parameter, const std::vector<T>& values) {
  SettingList all;
  for (AdaptiveOptions setting : settings) {
    for (const T& value : values) {
      setting.*parameter = value;
      all.push_back(setting);
    }
  }
  return all;
}

SettingList plane_through(const SettingList& settings, const Sweeps& sweeps) {
  return times_values(times_values(settings, &AdaptiveOptions::rays, sweeps.rays), &AdaptiveOptions::eps_b,
                      sweeps.eps_b);
}

SettingList full_product(const Sweeps& sweeps) {
  SettingList all = times_values({AdaptiveOptions{}}, &AdaptiveOptions::variant, sweeps.variants);
  all = times_values(all, &AdaptiveOptions::pattern, sweeps.patterns);
  all = times_values(all, &AdaptiveOptions::seed, sweeps.seeds);
  return plane_through(times_values(all, &AdaptiveOptions::eps_a, sweeps.eps_a), sweeps);
}

SettingList sweeps_through(const AdaptiveOptions& base, const Sweeps& sweeps) {
  AdaptiveOptions finest = base;
  finest.eps_b = std::ranges::min(sweeps.eps_b);
  finest.rays = std::ranges::max(sweeps.rays);
  const SettingList variants = times_values({base}, &AdaptiveOptions::variant, sweeps.variants);
  const SettingList patterns = times_values({base}, &AdaptiveOptions::pattern, sweeps.patterns);
  SettingList all = plane_through({base}, sweeps);
  for (const SettingList& sweep : {times_values({finest}, &AdaptiveOptions::eps_a, sweeps.eps_a),
                                   times_values(variants, &AdaptiveOptions::eps_b, sweeps.eps_b),
                                   times_values(patterns, &AdaptiveOptions::rays, sweeps.rays),
                                   times_values({base}, &AdaptiveOptions::seed, sweeps.seeds)}) {
    all.insert(all.end(), sweep.begin(), sweep.end());
  }
  return all;
}

template <class T>
void shorten(std::vector<T>& list, T kept, std::string what, const std::string& why, std::vector<LeftOut>& left_out) {
  if (list.size() < 2) return;
  list = {kept};
  left_out.push_back({std::move(what), why});
}

void leave_out_sampling(Sweeps& sweeps, const std::string& why, std::vector<LeftOut>& left_out) {
  shorten(sweeps.eps_a, sweeps.eps_a.front(), "sweep of eps_A", why, left_out);
  shorten(sweeps.rays, middle(sweeps.rays), "sweep of the number of rays", why, left_out);
  shorten(sweeps.seeds, sweeps.seeds.front(), "sweep of seeds", why, left_out);
  shorten(sweeps.patterns, sweeps.patterns.front(), "comparison of sample patterns", why, left_out);
}

}  // namespace

void complete(Sweeps& sweeps, const Scope& scope) {
  const double unit = scope.largest_rho_b > 0.0 ? scope.largest_rho_b : 1.0;
  if (sweeps.eps_b.empty()) sweeps.eps_b = powers_of_ten(unit, 1, 5);
  if (sweeps.eps_a.empty()) {
    sweeps.eps_a = powers_of_ten(scope.mean_source_area, 1, 4);
    sweeps.eps_a.insert(sweeps.eps_a.begin(), 0.0);
  }
  if (sweeps.rays.empty()) sweeps.rays = {1, 4, 16, 64, 256};
  if (sweeps.seeds.empty()) sweeps.seeds = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  if (sweeps.patterns.empty()) {
    sweeps.patterns = {SamplePattern::kJittered, SamplePattern::kCentre, SamplePattern::kRegular,
                       SamplePattern::kLowDiscrepancy};
  }
  if (sweeps.variants.empty()) sweeps.variants = {Variant::kMended, Variant::kLiteral};
  drop_repetitions(sweeps.eps_b);
  drop_repetitions(sweeps.eps_a);
  drop_repetitions(sweeps.rays);
  drop_repetitions(sweeps.seeds);
  drop_repetitions(sweeps.patterns);
  drop_repetitions(sweeps.variants);
  check_ranges(sweeps);
}

std::vector<LeftOut> leave_out(Sweeps& sweeps, const Scope& scope) {
  std::vector<LeftOut> left_out;
  if (scope.largest_rho_b <= 0.0) {
    const std::string why = "no receiver reflects anything (rho B is 0), so the adaptive algorithm returns 0 at once";
    shorten(sweeps.eps_b, middle(sweeps.eps_b), "sweep of eps_B", why, left_out);
    leave_out_sampling(sweeps, why, left_out);
  } else if (!scope.anything_sampled) {
    leave_out_sampling(
        sweeps,
        "every receiver sees all of a source or nothing of it, or one occluder hides it: no ray decides anything",
        left_out);
  }
  return left_out;
}

SettingPlan combine(const Sweeps& sweeps) {
  EXACTFF_EXPECT(product_size(sweeps) > 0);
  const AdaptiveOptions base = base_of(sweeps);
  SettingPlan plan;
  plan.full_product = product_size(sweeps) <= kFullProductLimit;
  plan.settings = plan.full_product ? full_product(sweeps) : sweeps_through(base, sweeps);
  for (AdaptiveOptions& setting : plan.settings) setting = normalised(setting, sweeps);
  drop_repetitions(plan.settings);
  plan.base = find_setting(plan.settings, base).value();
  return plan;
}

methods::Choice choice_of(const AdaptiveOptions& setting) {
  methods::Choice choice = methods::parse("adaptive");
  choice.settings.set("eps_B", setting.eps_b);
  choice.settings.set("eps_A", setting.eps_a);
  choice.settings.set("rays", std::int64_t{setting.rays});
  choice.settings.set("pattern", std::string(to_string(setting.pattern)));
  choice.settings.set("seed", static_cast<std::int64_t>(setting.seed));
  choice.settings.set("variant", std::string(to_string(setting.variant)));
  return choice;
}

methods::Choice without(methods::Choice choice, std::string_view parameter) {
  for (const SettingSpec& spec : choice.settings.specs()) {
    if (spec.name == parameter) choice.settings.set(spec.name, spec.fallback);
  }
  return choice;
}

std::vector<std::size_t> line_through(const std::vector<AdaptiveOptions>& settings, std::size_t from,
                                      std::string_view parameter) {
  std::vector<std::size_t> line;
  const methods::Choice common = without(choice_of(settings[from]), parameter);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (without(choice_of(settings[i]), parameter) == common) line.push_back(i);
  }
  return line;
}

std::optional<std::size_t> find_setting(const std::vector<AdaptiveOptions>& settings, const AdaptiveOptions& wanted) {
  const auto found = std::ranges::find(settings, wanted);
  if (found == settings.end()) return std::nullopt;
  return static_cast<std::size_t>(std::distance(settings.begin(), found));
}

}  // namespace exactff::study
