// The settings "pattern", "rays" and "seed" of methods that send several rays to a sub-patch.
#pragma once

#include "exactff/adaptive.h"
#include "exactff/methods.h"

namespace exactff::methods {

[[nodiscard]] SettingSpec pattern_setting();
[[nodiscard]] SamplePattern pattern_named(std::string_view name);  // one of the setting's words

// True if a pattern uses the setting: the centre pattern has one ray and no seed, the regular one no seed.
[[nodiscard]] bool pattern_uses(const Settings& settings, std::string_view setting);

}  // namespace exactff::methods
