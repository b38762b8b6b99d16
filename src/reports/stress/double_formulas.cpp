#include "stress/double_formulas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vec.h"

namespace exactff::stress {

namespace {

using kernel::cross;
using kernel::dot;
using kernel::length;

Vec3 unit(const Vec3& a) {
  const double r = length(a);
  return {a.x / r, a.y / r, a.z / r};
}

double term_by_acos(const Vec3& a, const Vec3& b, const Vec3& n) {
  const Vec3 p = unit(a), q = unit(b);
  const Vec3 c = cross(p, q);
  const double sine = length(c);
  return sine == 0.0 ? 0.0 : std::acos(std::clamp(dot(p, q), -1.0, 1.0)) * dot(n, c) / sine;
}

double term_by_atan2(const Vec3& a, const Vec3& b, const Vec3& a_cross_b, const Vec3& n) {
  const double sine = length(a_cross_b);
  return sine == 0.0 ? 0.0 : std::atan2(sine, dot(a, b)) * dot(n, a_cross_b) / sine;
}

double term(const Vec3& a, const Vec3& b, const Vec3& n, AngleFormula formula) {
  switch (formula) {
    case AngleFormula::kAcos:
      return term_by_acos(a, b, n);
    case AngleFormula::kAtan2:
      return term_by_atan2(a, b, cross(a, b), n);
    case AngleFormula::kAtan2Difference:
      break;
  }
  return term_by_atan2(a, b, cross(a, kernel::difference(b, a)), n);
}

}  // namespace

double form_factor_in_double(std::span<const Polygon> region, const Vec3& x, const Vec3& normal, AngleFormula formula) {
  const Vec3 n = unit(normal);
  double sum = 0.0;
  for (const Polygon& polygon : region) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      sum +=
          term(kernel::difference(polygon[i], x), kernel::difference(polygon[(i + 1) % polygon.size()], x), n, formula);
    }
  }
  return -0.5 * std::numbers::inv_pi * sum;
}

}  // namespace exactff::stress
