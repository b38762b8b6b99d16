#include <algorithm>
#include <string>

#include "exactff/stress.h"
#include "stress/family.h"
#include "study/text.h"

namespace exactff::stress {

std::string_view to_string(Evidence evidence) {
  switch (evidence) {
    case Evidence::kClosedForm:
      return "closed form";
    case Evidence::kSymmetry:
      return "symmetry";
    case Evidence::kCertified:
      break;
  }
  return "certified enclosure";
}

std::string_view name_of(Method method) {
  switch (method) {
    case Method::kExact:
      return "exact";
    case Method::kAcos:
      return "Eq. (4) in double on the exact region, acos";
    case Method::kAtan2:
      return "Eq. (4) in double on the exact region, atan2";
    case Method::kAtan2Difference:
      return "Eq. (4) in double on the exact region, atan2 with a × (b − a)";
    case Method::kAdaptive:
      return "Tampieri's algorithm as mended";
    case Method::kAdaptiveLiteral:
      break;
  }
  return "Tampieri's algorithm as printed";
}

std::string_view short_name_of(Method method) {
  switch (method) {
    case Method::kExact:
      return "exact";
    case Method::kAcos:
      return "acos";
    case Method::kAtan2:
      return "atan2";
    case Method::kAtan2Difference:
      return "atan2-difference";
    case Method::kAdaptive:
      return "tampieri";
    case Method::kAdaptiveLiteral:
      break;
  }
  return "tampieri-literal";
}

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
    if (!(row.of(method).error < threshold)) break;  // NaN too
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
