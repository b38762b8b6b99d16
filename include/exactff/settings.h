// Settings with names, as methods and models have them, read from text such as "resolution=200,rotation=15".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace exactff {

// A whole number, a number, or a word.
using SettingValue = std::variant<std::int64_t, double, std::string>;

struct SettingSpec {
  std::string name;
  std::string meaning;
  std::string unit;       // "degrees", "radiosity", "area"; empty: a pure number or a word
  SettingValue fallback;  // the default; its type is the setting's
  double lowest = 0.0;    // for numbers: the allowed range, both ends included
  double highest = 0.0;
  std::int64_t multiple_of = 1;  // for whole numbers: the value must be a multiple of this
  std::vector<std::string> words = {};
};

[[nodiscard]] SettingSpec whole_setting(std::string name, std::int64_t fallback, std::int64_t lowest,
                                        std::int64_t highest, std::string meaning, std::string unit = {},
                                        std::int64_t multiple_of = 1);
[[nodiscard]] SettingSpec number_setting(std::string name, double fallback, double lowest, double highest,
                                         std::string meaning, std::string unit = {});
// The first word is the default.
[[nodiscard]] SettingSpec word_setting(std::string name, std::vector<std::string> words, std::string meaning);
// The setting "seed", from which stochastic methods generate their random numbers.
[[nodiscard]] SettingSpec seed_setting();

// The allowed values in words: "an even whole number from 2 to 8192", "a number of at least 0", "one of random,
// stratified".
[[nodiscard]] std::string allowed(const SettingSpec& spec);
// The shortest text that reads back to the same value.
[[nodiscard]] std::string to_string(const SettingValue& value);

// A value for every setting of a method; settings that are not set have their defaults.
class Settings {
 public:
  Settings() = default;
  explicit Settings(std::vector<SettingSpec> specs);

  [[nodiscard]] std::span<const SettingSpec> specs() const { return specs_ ? *specs_ : std::span<const SettingSpec>(); }
  [[nodiscard]] std::span<const SettingValue> values() const { return values_; }

  // Throw InputError if there is no such setting or if it does not allow the value. A setting of type number also
  // accepts a whole number.
  void set(std::string_view name, const SettingValue& value);
  void set_text(std::string_view name, std::string_view text);

  // Throw std::logic_error if there is no such setting of that type: names in a program are the programmer's
  // responsibility.
  [[nodiscard]] std::int64_t whole(std::string_view name) const;
  [[nodiscard]] double number(std::string_view name) const;
  [[nodiscard]] const std::string& word(std::string_view name) const;
  [[nodiscard]] bool has(std::string_view name) const;

  // "resolution=100,rotation=0". The short text omits settings with their default values and may be empty.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string short_text() const;

  friend bool operator==(const Settings& a, const Settings& b) { return a.values_ == b.values_ && a.names_equal(b); }

 private:
  [[nodiscard]] std::size_t place_of(std::string_view name) const;  // specs().size() if there is no such setting
  [[nodiscard]] std::size_t must_find(std::string_view name) const;
  [[nodiscard]] std::string text_of(bool all) const;
  [[nodiscard]] bool names_equal(const Settings& other) const;

  std::shared_ptr<const std::vector<SettingSpec>> specs_;
  std::vector<SettingValue> values_;
};

}  // namespace exactff
