// The sweeps: the base setting takes the middle of the lists for eps_B and rays, and the first of every other list. If
// the full product is small, it is run. Otherwise these are run:
//   1. the plane eps_B x rays through the base: error against eps_B, against rays and against time;
//   2. eps_A at the smallest eps_B and the most rays, where eps_A is what stops the recursion;
//   3. the variants over eps_B, and the patterns over rays;
//   4. the seeds at the base.
// The centre pattern has one ray and no seed, the regular pattern no seed. Settings that differ only in what their
// pattern ignores are one setting.
#include "study/settings.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

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
  const auto check = [](const std::string& name, const std::vector<double>& values, const std::string& kind) {
    for (const double v : values) {
      if (!std::isfinite(v) || v < 0.0) refuse(name + " is " + text::shortest(v), kind + " is finite and not negative");
    }
  };
  check("eps_B", sweeps.eps_b, "a tolerance");
  check("eps_A", sweeps.eps_a, "an area");
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

// --- ladders ---

std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0;;) {
    const std::size_t end = text.find(separator, start);
    parts.emplace_back(text.substr(start, end == std::string_view::npos ? end : end - start));
    if (end == std::string_view::npos) return parts;
    start = end + 1;
  }
}

// A parsed ladder.
struct LadderText {
  std::string method;
  std::vector<std::pair<std::string, std::vector<std::string>>> settings;  // name and values

  explicit LadderText(std::string_view text) {
    const std::size_t colon = text.find(':');
    method = text::trimmed(text.substr(0, colon));
    if (colon == std::string_view::npos) return;
    for (const std::string& part : parts_of(text.substr(colon + 1), ',')) {
      const std::size_t equals = part.find('=');
      const std::string values = equals == std::string::npos ? std::string() : part.substr(equals + 1);
      settings.emplace_back(std::string(text::trimmed(std::string_view(part).substr(0, equals))),
                            parts_of(values, '|'));
    }
  }

  [[nodiscard]] std::string along() const {
    std::string found;
    for (const auto& [name, values] : settings) {
      if (values.size() < 2) continue;
      if (!found.empty()) {
        text::refuse("'" + found + "' and '" + name + "' of " + method + " both have several values",
                     "only one setting of a method can vary at a time",
                     "give one of them a single value, or use two --method options");
      }
      found = name;
    }
    return found;
  }

  [[nodiscard]] std::string with(const std::string& along, const std::string& value) const {
    std::string text = method;
    char before = ':';
    for (const auto& [name, values] : settings) {
      text += before + name + '=' + (name == along ? value : values.front());
      before = ',';
    }
    return text;
  }

  [[nodiscard]] std::vector<std::string> values_of(const std::string& along) const {
    for (const auto& [name, values] : settings) {
      if (name == along) return values;
    }
    return {""};
  }
};

bool is_word(const methods::Method& method, const std::string& setting) {
  return std::any_of(method.settings.begin(), method.settings.end(), [&](const SettingSpec& spec) {
    return spec.name == setting && std::holds_alternative<std::string>(spec.fallback);
  });
}

std::string method_words(const std::string& name) {
  if (name == "adaptive-exact-visibility") return "adaptive, exact V";
  if (name == "area-sampling") return "area";
  std::string words = name;
  std::replace(words.begin(), words.end(), '-', ' ');
  return words;
}

std::string setting_words(const methods::Method& method, const std::string& name, const std::string& value) {
  if (is_word(method, name)) return value;
  return name == "rays" ? value + (value == "1" ? " ray" : " rays") : name + ' ' + value;
}

std::string ladder_name(const LadderText& text, const methods::Method& method, const std::string& along) {
  std::string name = method_words(method.name);
  for (const auto& [setting, values] : text.settings) {
    if (setting != along) name += ", " + setting_words(method, setting, std::string(text::trimmed(values.front())));
  }
  return name;
}

double eps_b_of(const methods::Choice& choice) { return choice.settings.number("eps_B"); }

bool differ_in_eps_b_only(const methods::Choice& a, const methods::Choice& b) {
  return a.method == b.method && without(a, "eps_B") == without(b, "eps_B");
}

// Effort rises as eps_B falls.
void insert(Ladder& ladder, const methods::Choice& choice) {
  const auto less_effort = [&](const methods::Choice& rung) { return eps_b_of(rung) > eps_b_of(choice); };
  ladder.rungs.insert(std::ranges::find_if_not(ladder.rungs, less_effort), choice);
}

// "adaptive, 4 rays, literal": eps_B is what differs.
std::string line_name(const methods::Choice& choice) {
  std::string name = "adaptive";
  const Settings& s = choice.settings;
  if (s.word("pattern") != "centre")
    name += ", " + setting_words(*choice.method, "rays", std::to_string(s.whole("rays")));
  if (s.word("pattern") != "jittered") name += ", " + s.word("pattern");
  if (s.word("variant") != "mended") name += ", " + s.word("variant");
  if (s.number("eps_A") > 0.0) name += ", ε_A " + text::rounded(s.number("eps_A"));
  return name;
}

std::string name_with_eps_b(const methods::Choice& choice) {
  return line_name(choice) + ", ε_B " + text::rounded(eps_b_of(choice));
}

// The ladder that has the setting, or can take it.
Ladder* ladder_for(const methods::Choice& choice, std::vector<Ladder>& ladders) {
  auto found = std::ranges::find_if(
      ladders, [&](const Ladder& one) { return std::ranges::find(one.rungs, choice) != one.rungs.end(); });
  if (found == ladders.end()) {
    found = std::ranges::find_if(ladders, [&](const Ladder& one) {
      return one.along == "eps_B" && differ_in_eps_b_only(one.rungs.front(), choice);
    });
  }
  return found == ladders.end() ? nullptr : &*found;
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

Ladder parse_ladder(std::string_view text) {
  const kernel::StandardArithmetic arithmetic;
  const LadderText taken_apart(text);
  Ladder ladder;
  ladder.along = taken_apart.along();
  for (const std::string& value : taken_apart.values_of(ladder.along)) {
    methods::Choice choice = methods::parse(taken_apart.with(ladder.along, value));
    choice.settings = choice.method->normalised(choice.settings);
    const bool repeated = std::find(ladder.rungs.begin(), ladder.rungs.end(), choice) != ladder.rungs.end();
    if (!repeated) ladder.rungs.push_back(std::move(choice));
  }
  if (ladder.along == "seed") {
    text::refuse("the seed of " + taken_apart.method + " has several values", "a study varies the seed by itself",
                 "remove the seed, and give the number of seeds with --method-seeds");
  }
  ladder.name = ladder_name(taken_apart, *ladder.rungs.front().method, ladder.along);
  return ladder;
}

std::vector<Ladder> default_ladders(double largest_rho_b) {
  const auto tolerances = [&](int first, int last) {
    std::string list;
    for (int power = first; power <= last; ++power) {
      list += (list.empty() ? "" : "|") + text::shortest(largest_rho_b / std::pow(10.0, power));
    }
    return list;
  };
  std::vector<Ladder> ladders = {parse_ladder("exact")};
  if (largest_rho_b > 0.0) {
    for (const std::string& text :
         {"adaptive:rays=16,eps_B=" + tolerances(1, 6), "adaptive:rays=64,eps_B=" + tolerances(1, 6),
          "adaptive:rays=256,eps_B=" + tolerances(1, 6), "adaptive:pattern=centre,eps_B=" + tolerances(1, 6),
          "adaptive-exact-visibility:eps_B=" + tolerances(1, 6)}) {
      ladders.push_back(parse_ladder(text));
    }
  }
  for (const char* text : {"hemicube:resolution=32|64|128|256|512|1024", "nettle:rays=16,splits=1|2|4|8|16",
                           "nettle:variant=literal,rays=16,splits=1|2|4|8|16", "wallace:splits=1|2|4|8|16|32|64",
                           "area-sampling:pattern=random,samples=4|16|64|256|1024|4096",
                           "area-sampling:pattern=stratified,samples=4|16|64|256|1024|4096",
                           "area-sampling:pattern=sobol,samples=4|16|64|256|1024|4096",
                           "area-sampling:measure=solid-angle,pattern=sobol,samples=4|16|64|256|1024|4096"}) {
    ladders.push_back(parse_ladder(text));
  }
  return ladders;
}

methods::Choice without_seed(methods::Choice choice) {
  choice = without(std::move(choice), "seed");
  choice.settings = choice.method->normalised(choice.settings);
  return choice;
}

void add_sweeps(std::vector<Ladder>& ladders, std::span<const AdaptiveOptions> settings) {
  std::vector<Ladder> added;
  for (const AdaptiveOptions& setting : settings) {
    const methods::Choice choice = without_seed(choice_of(setting));
    Ladder* ladder = ladder_for(choice, ladders);
    if (ladder == nullptr) ladder = ladder_for(choice, added);
    if (ladder == nullptr) {
      added.push_back({line_name(choice), "eps_B", {choice}, true});
    } else if (std::ranges::find(ladder->rungs, choice) == ladder->rungs.end()) {
      insert(*ladder, choice);
    }
  }
  Ladder rest{"adaptive, other settings", "", {}, true};
  for (const Ladder& line : added) {
    if (line.rungs.size() == 1) rest.rungs.push_back(line.rungs.front());
  }
  std::erase_if(added, [](const Ladder& line) { return line.rungs.size() == 1; });
  if (rest.rungs.size() == 1) {
    rest.name = name_with_eps_b(rest.rungs.front());
  }
  if (!rest.rungs.empty()) added.push_back(std::move(rest));
  const auto is_adaptive = [](const Ladder& ladder) { return ladder.rungs.front().method->name == "adaptive"; };
  const auto last = std::find_if(ladders.rbegin(), ladders.rend(), is_adaptive);
  ladders.insert(last == ladders.rend() ? ladders.end() : last.base(), added.begin(), added.end());
}

std::vector<LeftOut> leave_out(std::vector<Ladder>& ladders, const Scope& scope) {
  std::vector<LeftOut> left_out;
  const auto drop = [&](const auto& is_idle, const std::string& why) {
    std::erase_if(ladders, [&](const Ladder& ladder) {
      if (!is_idle(ladder.rungs.front())) return false;
      left_out.push_back({"method " + ladder.name, why});
      return true;
    });
  };
  const auto adaptive = [](const methods::Choice& c) { return c.method->name.starts_with("adaptive"); };
  const auto control = [](const methods::Choice& c) { return c.method->name == "adaptive-exact-visibility"; };
  if (!scope.anything_seen) {
    drop([](const methods::Choice&) { return true; }, "no receiver sees any part of a source");
  }
  if (!(scope.largest_rho_b > 0.0)) drop(adaptive, "nothing is emitted or reflected, so that it returns 0 at once");
  if (!scope.anything_sampled) {
    drop(control, "no receiver has a source hidden in part, so that there is no sampling to be replaced");
  }
  return left_out;
}

std::string rung_text(const Ladder& ladder, std::size_t rung) {
  if (ladder.along.empty()) return {};
  const Settings& settings = ladder.rungs[rung].settings;
  for (std::size_t k = 0; k < settings.specs().size(); ++k) {
    if (settings.specs()[k].name != ladder.along) continue;
    const SettingValue& value = settings.values()[k];
    if (const double* number = std::get_if<double>(&value)) return text::rounded(*number);
    return exactff::to_string(value);
  }
  return {};
}

std::string rung_name(const Ladder& ladder, std::size_t rung) {
  if (ladder.along.empty() && ladder.rungs.size() > 1) return name_with_eps_b(ladder.rungs[rung]);
  if (ladder.along.empty()) return ladder.name;
  std::string along = ladder.along;
  if (along == "eps_B") along = "ε_B";
  return ladder.name + ", " + along + ' ' + rung_text(ladder, rung);
}

std::string setting_name(const Study& study, std::size_t setting) {
  const AdaptiveOptions& one = study.settings[setting];
  const std::string seed = one.seed == study.settings[study.base].seed ? "" : ", seed " + std::to_string(one.seed);
  return name_with_eps_b(without_seed(choice_of(one))) + seed;
}

PreparedMethod::PreparedMethod(const methods::Method& method, const Scene& given, std::span<const Selection> selections)
    : scene(method.prepare(given)) {
  for (const Selection& selection : selections) {
    owned.push_back(scene->prepare_source(selection));
    sources.push_back(owned.back().get());
  }
}

const PreparedMethod& PreparedMethods::of(const methods::Method& method) {
  return prepared_.try_emplace(&method, method, *request_.scene, request_.sources).first->second;
}

methods::Choice with_seed(methods::Choice choice, std::uint64_t seed) {
  if (seed > 0) choice.settings.set("seed", static_cast<std::int64_t>(seed));
  return choice;
}

}  // namespace exactff::study
