#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "stress/family.h"
#include "stress/stress.h"
#include "text/phrases.h"

namespace exactff::stress {

std::string_view to_string(Evidence evidence) {
  constexpr std::array<std::string_view, 3> kNames = {"closed form", "symmetry", "certified enclosure"};
  return kNames[static_cast<std::size_t>(evidence)];
}

namespace {

struct MethodNames {
  std::string_view name, short_name;
};
// Indexed by Method.
constexpr std::array<MethodNames, kMethodCount> kMethodNames = {
    {{"exact", "exact"},
     {"Eq. (4) in double on the exact region, acos", "acos"},
     {"Eq. (4) in double on the exact region, atan2", "atan2"},
     {"Eq. (4) in double on the exact region, atan2 with a × (b − a)", "atan2-difference"},
     {"Tampieri's algorithm as mended", "tampieri"},
     {"Tampieri's algorithm as printed", "tampieri-literal"}}};

}  // namespace

std::string_view name_of(Method method) { return kMethodNames[static_cast<std::size_t>(method)].name; }
std::string_view short_name_of(Method method) { return kMethodNames[static_cast<std::size_t>(method)].short_name; }

const std::vector<FamilyInfo>& families() {
  static const std::vector<FamilyInfo> list = [] {
    std::vector<FamilyInfo> infos;
    for (const Family& family : all_families()) infos.push_back(family.info);
    return infos;
  }();
  return list;
}

double usable_up_to(const FamilyResult& result, Method method, double threshold) {
  double last = 0.0;
  for (const Row& row : result.rows) {
    if (!(row.of(method).error < threshold)) break;  // also for NaN
    last = row.stiffness;
  }
  return last;
}

bool has_tolerance(Method method) { return method == Method::kAdaptive || method == Method::kAdaptiveLiteral; }

double kept_up_to(const FamilyResult& result, Method method) {
  double last = 0.0;
  for (const Row& row : result.rows) {
    const Answer& answer = row.of(method);
    const double error = std::abs(answer.value - row.truth.nearest().value_or(row.truth.lower()));
    if (answer.refused || !(error <= row.tolerance)) break;  // also for NaN
    last = row.stiffness;
  }
  return last;
}

bool Report::sound() const {
  return std::all_of(families.begin(), families.end(), [](const FamilyResult& family) {
    return std::all_of(family.rows.begin(), family.rows.end(),
                       [](const Row& row) { return row.agrees && row.status != Status::kNotCertified; });
  });
}

std::string stiffness_text(double stiffness) {
  if (stiffness == 0.0) return "–";
  constexpr double kSmallEnoughToWrite = 1e4;
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

namespace {

std::string words_of(const FamilyResult& result, double reach) {
  return !result.rows.empty() && reach == result.rows.back().stiffness ? "all" : stiffness_text(reach);
}

// Whether the method refuses the scene after the last one at which it is good enough.
bool next_is_refused(const FamilyResult& result, Method method, double reach) {
  for (const Row& row : result.rows) {
    if (row.stiffness > reach) return row.of(method).refused;
  }
  return false;
}

}  // namespace

std::string reach_text(const FamilyResult& result, Method method, double threshold) {
  return words_of(result, usable_up_to(result, method, threshold));
}

std::string reaches_text(const FamilyResult& result, Method method) {
  std::string text;
  double reach = kept_up_to(result, method);
  if (has_tolerance(method)) {
    text = words_of(result, reach);
  } else {
    reach = usable_up_to(result, method, kThresholds.front());
    for (const double threshold : kThresholds)
      text += (text.empty() ? "" : " · ") + reach_text(result, method, threshold);
    if (text == "all · all · all") return "all";
  }
  return next_is_refused(result, method, reach) ? text + " (refused)" : text;
}

}  // namespace exactff::stress
