#include "text/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "kernel/float_environment.h"
#include "text/names.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

// " from 1 to 10", " of at least 0".
std::string range(const SettingValue& lowest, const SettingValue& highest, bool bounded_above) {
  if (bounded_above) return " from " + to_string(lowest) + " to " + to_string(highest);
  return " of at least " + to_string(lowest);
}

std::int64_t whole_of(double bound) {
  constexpr double kLimit = 0x1p62;
  if (bound >= kLimit) return std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(std::max(bound, -kLimit));
}

bool allows(const SettingSpec& spec, std::int64_t value) {
  return value >= whole_of(spec.lowest) && value <= whole_of(spec.highest) && value % spec.multiple_of == 0;
}

bool allows(const SettingSpec& spec, double value) { return value >= spec.lowest && value <= spec.highest; }

bool allows(const SettingSpec& spec, const std::string& value) {
  return std::find(spec.words.begin(), spec.words.end(), value) != spec.words.end();
}

// The value in the setting's type; nullopt if the type does not fit or the value is not allowed.
std::optional<SettingValue> fit(const SettingSpec& spec, SettingValue value) {
  const bool wants_number = std::holds_alternative<double>(spec.fallback);
  if (const auto* whole = std::get_if<std::int64_t>(&value); whole != nullptr && wants_number) {
    value = static_cast<double>(*whole);
  }
  if (value.index() != spec.fallback.index()) return std::nullopt;
  if (!std::visit([&](const auto& v) { return allows(spec, v); }, value)) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const SettingSpec& spec, std::string_view text) {
  const std::string unit = spec.unit.empty() ? "" : " (" + spec.unit + ")";
  text::refuse("'" + std::string(text) + "' is not a valid value of " + spec.name + unit,
               "its meaning: " + spec.meaning, "give " + allowed(spec));
}

std::optional<SettingValue> read(const SettingSpec& spec, std::string_view text) {
  if (std::holds_alternative<std::string>(spec.fallback)) return SettingValue(std::string(text));
  if (std::holds_alternative<std::int64_t>(spec.fallback)) {
    const auto whole = text::whole_number<std::int64_t>(text);
    return whole ? std::optional<SettingValue>(*whole) : std::nullopt;
  }
  const text::ParsedNumber number = text::parse_number(text);
  if (number.fault != text::NumberFault::kNone) return std::nullopt;
  return SettingValue(number.value);
}

}  // namespace

SettingSpec whole_setting(std::string name, std::int64_t fallback, std::int64_t lowest, std::int64_t highest,
                          std::string meaning, std::string unit, std::int64_t multiple_of) {
  return {.name = std::move(name),
          .meaning = std::move(meaning),
          .unit = std::move(unit),
          .fallback = fallback,
          .lowest = static_cast<double>(lowest),
          .highest = static_cast<double>(highest),
          .multiple_of = multiple_of};
}

SettingSpec number_setting(std::string name, double fallback, double lowest, double highest, std::string meaning,
                           std::string unit) {
  return {.name = std::move(name),
          .meaning = std::move(meaning),
          .unit = std::move(unit),
          .fallback = fallback,
          .lowest = lowest,
          .highest = highest};
}

SettingSpec word_setting(std::string name, std::vector<std::string> words, std::string meaning) {
  std::string first = words.front();
  return {.name = std::move(name),
          .meaning = std::move(meaning),
          .unit = {},
          .fallback = std::move(first),
          .words = std::move(words)};
}

SettingSpec seed_setting() {
  return whole_setting("seed", 1, 0, std::numeric_limits<std::int64_t>::max(),
                       "seed of the random numbers; the same seed gives the same values");
}

std::string allowed(const SettingSpec& spec) {
  const kernel::StandardArithmetic arithmetic;
  if (std::holds_alternative<std::string>(spec.fallback)) return "one of " + text::joined(spec.words);
  if (std::holds_alternative<double>(spec.fallback)) {
    return "a number" + range(spec.lowest, spec.highest, spec.highest < std::numeric_limits<double>::max());
  }
  const std::int64_t lowest = whole_of(spec.lowest), highest = whole_of(spec.highest);
  const std::string bounds = range(lowest, highest, highest < std::numeric_limits<std::int64_t>::max());
  if (spec.multiple_of == 2) return "an even whole number" + bounds;
  return (spec.multiple_of == 1 ? "a whole number" : "a multiple of " + std::to_string(spec.multiple_of)) + bounds;
}

std::string to_string(const SettingValue& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  return text::shortest(std::get<double>(value));
}

Settings::Settings(std::vector<SettingSpec> specs)
    : specs_(std::make_shared<const std::vector<SettingSpec>>(std::move(specs))) {
  for (const SettingSpec& spec : *specs_) values_.push_back(spec.fallback);
}

std::size_t Settings::place_of(std::string_view name) const {
  const auto all = specs();
  const auto found = std::find_if(all.begin(), all.end(), [&](const SettingSpec& spec) { return spec.name == name; });
  return static_cast<std::size_t>(found - all.begin());
}

bool Settings::has(std::string_view name) const { return place_of(name) < values_.size(); }

std::size_t Settings::must_find(std::string_view name) const {
  const std::size_t place = place_of(name);
  if (place < values_.size()) return place;
  std::vector<std::string_view> names;
  for (const SettingSpec& spec : specs()) names.emplace_back(spec.name);
  std::string suggestion;
  for (const std::string_view near : text::nearest_names(names, name, 1)) {
    suggestion = "did you mean " + std::string(near) + "?";
  }
  text::refuse("there is no setting '" + std::string(name) + "'",
               names.empty() ? "there are no settings" : "settings are " + text::joined(names), suggestion);
}

void Settings::set(std::string_view name, const SettingValue& value) {
  const kernel::StandardArithmetic arithmetic;
  const std::size_t place = must_find(name);
  const SettingSpec& spec = specs()[place];
  std::optional<SettingValue> fits = fit(spec, value);
  if (!fits) refuse(spec, to_string(value));
  values_[place] = std::move(*fits);
}

void Settings::set_text(std::string_view name, std::string_view text) {
  const kernel::StandardArithmetic arithmetic;
  const std::size_t place = must_find(name);
  const SettingSpec& spec = specs()[place];
  std::optional<SettingValue> value = read(spec, text);
  if (value) value = fit(spec, std::move(*value));
  if (!value) refuse(spec, text);
  values_[place] = std::move(*value);
}

namespace {

template <class Type>
const Type& must_be(const SettingValue* value, std::string_view name) {
  const Type* typed = value == nullptr ? nullptr : std::get_if<Type>(value);
  if (typed == nullptr) throw std::logic_error("there is no setting '" + std::string(name) + "' of that type");
  return *typed;
}

}  // namespace

std::int64_t Settings::whole(std::string_view name) const {
  return must_be<std::int64_t>(has(name) ? &values_[place_of(name)] : nullptr, name);
}

double Settings::number(std::string_view name) const {
  return must_be<double>(has(name) ? &values_[place_of(name)] : nullptr, name);
}

const std::string& Settings::word(std::string_view name) const {
  return must_be<std::string>(has(name) ? &values_[place_of(name)] : nullptr, name);
}

std::string Settings::text_of(bool all) const {
  std::string text;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const SettingSpec& spec = specs()[i];
    if (!all && values_[i] == spec.fallback) continue;
    text += (text.empty() ? "" : ",") + spec.name + "=" + to_string(values_[i]);
  }
  return text;
}

std::string Settings::text() const {
  const kernel::StandardArithmetic arithmetic;
  return text_of(true);
}
std::string Settings::short_text() const {
  const kernel::StandardArithmetic arithmetic;
  return text_of(false);
}

bool Settings::names_equal(const Settings& other) const {
  const auto a = specs(), b = other.specs();
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SettingSpec& p, const SettingSpec& q) { return p.name == q.name; });
}

}  // namespace exactff

namespace exactff::text {

// --- Choice text ---

namespace {

// The part before `mark`, which is removed from `rest` together with the mark; the whole rest if there is no mark.
std::string_view take_until(std::string_view& rest, char mark) {
  const std::size_t end = std::min(rest.find(mark), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return trimmed(part);
}

// Reads one SETTING=VALUE.
void read_assignment(std::string_view text, Settings& settings, std::vector<std::string>& seen) {
  std::string_view value = text;
  const std::string name(take_until(value, '='));
  if (text.find('=') == std::string_view::npos) {
    refuse("'" + std::string(text) + "' has no value", "settings are written NAME=VALUE", {});
  }
  if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
    refuse("setting '" + name + "' is given twice", "a setting has one value", "remove one");
  }
  seen.push_back(name);
  settings.set_text(name, trimmed(value));
}

}  // namespace

ChoiceText take_apart(std::string_view text) {
  const std::string_view name = take_until(text, ':');
  return {name, text};
}

void read_assignments(std::string_view assignments, const std::string& whose, Settings& settings) {
  std::vector<Problem> problems;
  std::vector<std::string> seen;
  while (!trimmed(assignments).empty()) {
    try {
      read_assignment(take_until(assignments, ','), settings, seen);
    } catch (const InputError& error) {
      for (Problem problem : error.problems()) {
        problem.what = whose + ": " + problem.what;
        problems.push_back(std::move(problem));
      }
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

InputError unknown_name(const std::string& kind, std::string_view name, const std::vector<std::string_view>& known) {
  return InputError(Problem{{},
                            0,
                            "there is no " + kind + " '" + std::string(name) + "'",
                            kind + "s are " + joined(known),
                            "did you mean " + joined(nearest_names(known, name, 3)) + "?"});
}

std::string setting_lines(std::span<const SettingSpec> settings) {
  std::string text;
  for (const SettingSpec& spec : settings) {
    text += "  " + spec.name + "=" + to_string(spec.fallback) + (spec.unit.empty() ? "" : " " + spec.unit) + ": " +
            spec.meaning + "; " + allowed(spec) + "\n";
  }
  return text;
}

}  // namespace exactff::text
