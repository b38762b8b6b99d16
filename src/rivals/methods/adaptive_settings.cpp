#include "methods/adaptive_settings.h"

#include <limits>

#include "kernel/float_environment.h"
#include "text/refuse.h"

namespace exactff::methods {

namespace {

constexpr std::int64_t kDeepest = 1000;

// In the order of LeafReason.
constexpr std::array<std::string_view, kLeafReasonCount> kLeafCounters = {
    "leaves: shaft empty", "leaves: shaft cut", "leaves: V=1",      "leaves: V=0",
    "leaves: eps_F",       "leaves: eps_A",     "leaves: depth cap"};

}  // namespace

std::vector<SettingSpec> tolerance_settings() {
  constexpr double kAny = std::numeric_limits<double>::max();
  const AdaptiveOptions defaults;
  return {number_setting("eps_B", defaults.eps_b, 0.0, kAny, "tolerance: no part with F <= eps_B / max(rho B) is split",
                         "radiosity"),
          number_setting("eps_A", defaults.eps_a, 0.0, kAny, "no part of this area or less is split", "area"),
          whole_setting("depth_cap", defaults.depth_cap, 0, kDeepest, "largest number of splits above a leaf")};
}

void take_tolerances(const Settings& settings, AdaptiveOptions& options) {
  options.eps_b = settings.number("eps_B");
  options.eps_a = settings.number("eps_A");
  options.depth_cap = static_cast<int>(settings.whole("depth_cap"));
}

void check_tolerances(const Settings& settings) {
  constexpr std::int64_t kModestDepth = 12;
  if (settings.number("eps_B") > 0.0 || settings.number("eps_A") > 0.0) return;
  if (settings.whole("depth_cap") <= kModestDepth) return;
  text::refuse("eps_B and eps_A are both 0",
               "nothing but the depth cap would end the recursion, after 2^depth leaves or more",
               "give one of them, or a depth_cap of at most 12");
}

Estimate RecursionEvaluator::estimate(const AdaptiveSource& source, const Rgb& radiosity,
                                      adaptive::PatchVisibility* visibility) {
  const kernel::StandardArithmetic arithmetic;
  const Rgb rho = scene_.receiver_reflectance(receiver_.on);
  const double rho_b = Rgb{rho.r * radiosity.r, rho.g * radiosity.g, rho.b * radiosity.b}.largest();
  AdaptiveResult found = is_buried_ ? AdaptiveResult{}
                         : visibility == nullptr
                             ? solver_.form_factor(receiver_, source, rho_b, options_)
                             : AdaptiveInside::form_factor(solver_, receiver_, source, rho_b, options_, *visibility);
  Estimate result{found.form_factor, {}};
  result.counters.add("leaves", found.leaves);
  result.counters.add("rays", found.rays);
  result.counters.add("shaft tests", found.shaft_tests);
  for (std::size_t reason = 0; reason < kLeafReasonCount; ++reason) {
    result.counters.add(kLeafCounters[reason], found.leaves_by_reason[reason]);
  }
  if (keeps_results_) results_.push_back(std::move(found));
  return result;
}

}  // namespace exactff::methods
