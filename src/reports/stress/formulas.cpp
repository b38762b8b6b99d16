#include "stress/formulas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vec.h"

namespace exactff::stress {

using kernel::sign;
using kernel::to_ball;

Interval intersection(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}
bool is_empty(const Interval& a) { return a.low >= a.high; }

ClosedForm::ClosedForm(const Vec3& normal)
    : normal_{kernel::to_rational(normal.x), kernel::to_rational(normal.y), kernel::to_rational(normal.z)} {}

void ClosedForm::add(const Rectangle& rectangle, const Rational& weight) {
  if (!is_empty(rectangle.u) && !is_empty(rectangle.v)) terms_.push_back({rectangle, weight});
}

namespace {

// atan(b / root) / root, root = sqrt(a^2 + h^2)
Ball angle_over_root(const Rational& a, const Rational& b, const Rational& h, long bits) {
  const Ball root = sqrt(to_ball(Rational(a * a + h * h), bits));
  return atan(to_ball(b, bits) / root) / root;
}

// 2 pi n . (Hu, Hv, +-G) at one corner: H has atan(v/A)/A and atan(u/B)/B.
Ball corner_value(const Rational& u, const Rational& v, const Rational& h, const std::array<Rational, 3>& n,
                  long bits) {
  return angle_over_root(u, v, h, bits) * to_ball(Rational(n[2] * u - n[0] * h), bits) +
         angle_over_root(v, u, h, bits) * to_ball(Rational(n[2] * v - n[1] * h), bits);
}

// 2 pi n . L
Ball rectangle_value(const Rectangle& r, const std::array<Rational, 3>& normal, long bits) {
  const auto axis = static_cast<std::size_t>(r.axis);
  const Rational h = abs(r.distance);
  std::array<Rational, 3> n = {normal[(axis + 1) % 3], normal[(axis + 2) % 3], normal[axis]};
  if (sign(r.distance) < 0) n[2] = -n[2];
  const auto at = [&](const Rational& u, const Rational& v) { return corner_value(u, v, h, n, bits); };
  return at(r.u.high, r.v.high) - at(r.u.low, r.v.high) - at(r.u.high, r.v.low) + at(r.u.low, r.v.low);
}

}  // namespace

Ball ClosedForm::evaluate(long bits) const {
  Ball sum(bits);
  for (const Term& term : terms_) {
    sum.add_product(rectangle_value(term.rectangle, normal_, bits), to_ball(term.weight, bits));
  }
  const Rational squared_length = normal_[0] * normal_[0] + normal_[1] * normal_[1] + normal_[2] * normal_[2];
  return sum / sqrt(to_ball(squared_length, bits)) / twice(kernel::pi(bits));
}

Enclosure ClosedForm::value() const {
  if (terms_.empty()) return {};
  constexpr long kWanted = 120, kFirst = 192, kLast = 1L << 17;
  Ball ball = evaluate(kFirst);
  for (long bits = 2 * kFirst; bits <= kLast && kernel::certain_bits(ball) < kWanted; bits *= 2) {
    ball = evaluate(bits);
  }
  return EnclosureInside::of(ball);
}

// --- Eq. (4) in double ---

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
