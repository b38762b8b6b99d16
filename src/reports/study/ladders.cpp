#include "study/ladders.h"

#include <algorithm>
#include <cmath>

#include "kernel/float_environment.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::study {
namespace {

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

}  // namespace

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

namespace {

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

}  // namespace exactff::study
