// Tampieri's ray-sampled adaptive algorithm (adaptive.h), as one of the methods.
#include "exactff/adaptive.h"

#include <limits>

#include "methods/adaptive_settings.h"
#include "methods/method_files.h"

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

namespace {

struct AdaptivePrepared : PreparedSource {
  AdaptivePrepared(const AdaptiveSolver& solver, const Scene& scene, const Selection& chosen)
      : PreparedSource(chosen), source(solver.prepare(chosen)), radiosity(scene.source_radiosity(chosen)) {}
  AdaptiveSource source;
  Rgb radiosity;
};

AdaptiveOptions options_of(const Settings& settings) {
  AdaptiveOptions options;
  take_tolerances(settings, options);
  options.rays = static_cast<int>(settings.whole("rays"));
  options.pattern = pattern_named(settings.word("pattern"));
  options.seed = static_cast<std::uint64_t>(settings.whole("seed"));
  options.variant = settings.word("variant") == "mended" ? Variant::kMended : Variant::kLiteral;
  return options;
}

class Adaptive : public RecursionEvaluator {
 public:
  Adaptive(const AdaptiveSolver& solver, const Scene& scene, const Settings& settings)
      : RecursionEvaluator(solver, scene, options_of(settings)) {}

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& prepared) override {
    const auto& source = own<AdaptivePrepared>(prepared);
    return estimate(source.source, source.radiosity);
  }
};

}  // namespace

Method adaptive_method() {
  const AdaptiveOptions defaults;
  std::vector<SettingSpec> settings = tolerance_settings();
  settings.push_back(whole_setting("rays", defaults.rays, 1, kMostRays, "shadow rays for each undecided sub-patch"));
  settings.push_back(pattern_setting());
  settings.push_back(word_setting(
      "variant", {"mended", "literal"},
      "literal: as printed in 1992, without clipping at the horizon, in single precision; mended: corrected"));
  settings.push_back(seed_setting());
  return {.name = "adaptive",
          .summary =
              "Tampieri's algorithm: splits the source until visibility is certain or the form factor is small; "
              "visibility V from shadow rays",
          .source = "F. Tampieri, Accurate Form-Factor Computation (1992)",
          .settings = std::move(settings),
          .prepare = prepare_as<OnScene<AdaptiveSolver, AdaptivePrepared, Adaptive>>,
          .uses = pattern_uses,
          .check = check_tolerances,
          .can_leave_unit = [](const Settings&) { return true; }};  // the sum over a source of several faces
}

}  // namespace exactff::methods
