#include "methods/sample_pattern.h"

namespace exactff::methods {

SettingSpec pattern_setting() {
  return word_setting("pattern", {"jittered", "centre", "regular", "low-discrepancy"},
                      "where the rays to a leaf or sub-patch end; centre sends only one ray");
}

SamplePattern pattern_named(std::string_view name) {
  if (name == "centre") return SamplePattern::kCentre;
  if (name == "regular") return SamplePattern::kRegular;
  return name == "jittered" ? SamplePattern::kJittered : SamplePattern::kLowDiscrepancy;
}

bool pattern_uses(const Settings& settings, std::string_view setting) {
  const SamplePattern pattern = pattern_named(settings.word("pattern"));
  if (setting == "rays") return pattern != SamplePattern::kCentre;
  if (setting != "seed") return true;
  return pattern == SamplePattern::kJittered || pattern == SamplePattern::kLowDiscrepancy;
}

}  // namespace exactff::methods
