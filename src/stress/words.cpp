#include <cmath>
#include <string_view>

#include "exactff/stress.h"
#include "text/phrases.h"

namespace exactff::stress {

namespace {

constexpr double kSmallEnoughToWrite = 1e4;

}  // namespace

std::string stiffness_text(double stiffness) {
  if (stiffness == 0.0) return "–";
  if (stiffness < kSmallEnoughToWrite) return text::shortest(stiffness);
  int exponent = 0;
  if (std::frexp(stiffness, &exponent) == 0.5) return "2" + text::superscript(exponent - 1);
  const int decade = static_cast<int>(std::lround(std::log10(stiffness)));
  if (std::stod("1e" + std::to_string(decade)) == stiffness) return "10" + text::superscript(decade);
  return text::rounded(stiffness);
}

std::string error_text(const Answer& answer) {
  if (answer.refused) return "refused";
  if (std::isnan(answer.error)) return "no number";
  return answer.error == 0.0 ? "0" : text::rounded(answer.error, 2);
}

std::string reach_text(const FamilyResult& result, Method method, double threshold) {
  const double reach = usable_up_to(result, method, threshold);
  return !result.rows.empty() && reach == result.rows.back().stiffness ? "all" : stiffness_text(reach);
}

namespace {

// Whether the method stops keeping to the first threshold because it refuses the scene.
bool next_is_refused(const FamilyResult& result, Method method) {
  const double reach = usable_up_to(result, method, kThresholds.front());
  for (const Row& row : result.rows) {
    if (row.stiffness > reach) return row.of(method).refused;
  }
  return false;
}

}  // namespace

std::string reaches_text(const FamilyResult& result, Method method) {
  std::string text;
  bool all = true;
  for (double threshold : kThresholds) {
    const std::string reach = reach_text(result, method, threshold);
    all = all && reach == "all";
    text += (text.empty() ? "" : " · ") + reach;
  }
  if (all) return "all";
  return next_is_refused(result, method) ? text + " (refused)" : text;
}

}  // namespace exactff::stress
