// Parses NAME:SETTING=VALUE,... for methods and models.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/error.h"
#include "exactff/settings.h"

namespace exactff::text {

struct ChoiceText {
  std::string_view name;
  std::string_view assignments;  // after the colon
};
[[nodiscard]] ChoiceText take_apart(std::string_view text);

// Throws one InputError with all problems. `whose` names the owner of the settings in the messages: "method
// 'hemicube'".
void read_assignments(std::string_view assignments, const std::string& whose, Settings& settings);

// "there is no method 'hemicub' (methods are ...); did you mean hemicube?" for `kind` "method".
[[nodiscard]] InputError unknown_name(const std::string& kind, std::string_view name,
                                      const std::vector<std::string_view>& known);

// Every setting with its meaning, unit, default and range, one indented line each.
[[nodiscard]] std::string setting_lines(std::span<const SettingSpec> settings);

}  // namespace exactff::text
