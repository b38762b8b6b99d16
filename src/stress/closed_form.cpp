#include "stress/closed_form.h"

#include <algorithm>

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

// root = sqrt(a^2 + h^2), angle = atan(b / root) / root
void root_and_angle(const Rational& a, const Rational& b, const Rational& h, long bits, Ball& angle) {
  Ball root = to_ball(Rational(a * a + h * h), bits);
  arb_sqrt(root.get(), root.get(), bits);
  arb_div(angle.get(), to_ball(b, bits).get(), root.get(), bits);
  arb_atan(angle.get(), angle.get(), bits);
  arb_div(angle.get(), angle.get(), root.get(), bits);
}

// 2 pi n . (Hu, Hv, +-G) at one corner.
Ball corner_value(const Rational& u, const Rational& v, const Rational& h, const std::array<Rational, 3>& n,
                  long bits) {
  Ball in_u, in_v;  // atan(v/A)/A, atan(u/B)/B
  root_and_angle(u, v, h, bits, in_u);
  root_and_angle(v, u, h, bits, in_v);
  arb_mul(in_u.get(), in_u.get(), to_ball(Rational(n[2] * u - n[0] * h), bits).get(), bits);
  arb_mul(in_v.get(), in_v.get(), to_ball(Rational(n[2] * v - n[1] * h), bits).get(), bits);
  arb_add(in_u.get(), in_u.get(), in_v.get(), bits);
  return in_u;
}

// 2 pi n . L
Ball rectangle_value(const Rectangle& r, const std::array<Rational, 3>& normal, long bits) {
  const auto axis = static_cast<std::size_t>(r.axis);
  const Rational h = abs(r.distance);
  std::array<Rational, 3> n = {normal[(axis + 1) % 3], normal[(axis + 2) % 3], normal[axis]};
  if (sign(r.distance) < 0) n[2] = -n[2];
  Ball sum = corner_value(r.u.high, r.v.high, h, n, bits);
  arb_sub(sum.get(), sum.get(), corner_value(r.u.low, r.v.high, h, n, bits).get(), bits);
  arb_sub(sum.get(), sum.get(), corner_value(r.u.high, r.v.low, h, n, bits).get(), bits);
  arb_add(sum.get(), sum.get(), corner_value(r.u.low, r.v.low, h, n, bits).get(), bits);
  return sum;
}

}  // namespace

Ball ClosedForm::evaluate(long bits) const {
  Ball sum;
  for (const Term& term : terms_) {
    const Ball value = rectangle_value(term.rectangle, normal_, bits);
    arb_addmul(sum.get(), value.get(), to_ball(term.weight, bits).get(), bits);
  }
  Ball scale = to_ball(Rational(normal_[0] * normal_[0] + normal_[1] * normal_[1] + normal_[2] * normal_[2]), bits);
  arb_sqrt(scale.get(), scale.get(), bits);
  arb_div(sum.get(), sum.get(), scale.get(), bits);
  arb_const_pi(scale.get(), bits);
  arb_mul_2exp_si(scale.get(), scale.get(), 1);
  arb_div(sum.get(), sum.get(), scale.get(), bits);
  return sum;
}

Enclosure ClosedForm::value() const {
  if (terms_.empty()) return {};
  constexpr long kWanted = 120, kFirst = 192, kLast = 1L << 17;
  Ball ball = evaluate(kFirst);
  for (long bits = 2 * kFirst; bits <= kLast && arb_rel_accuracy_bits(ball.get()) < kWanted; bits *= 2) {
    ball = evaluate(bits);
  }
  return Enclosure(ball);
}

}  // namespace exactff::stress
