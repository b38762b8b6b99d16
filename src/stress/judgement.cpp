#include <algorithm>
#include <array>
#include <string>

#include "exactff/stress.h"
#include "stress/family.h"
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

bool Report::sound() const {
  return std::all_of(families.begin(), families.end(), [](const FamilyResult& family) {
    return std::all_of(family.rows.begin(), family.rows.end(),
                       [](const Row& row) { return row.agrees && row.status != Status::kNotCertified; });
  });
}

}  // namespace exactff::stress
