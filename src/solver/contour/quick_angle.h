// Angles in double-double (double_double.h).
#pragma once

#include <array>

#include "kernel/double_double.h"

namespace exactff::contour {

using kernel::double_double::BasicBounded;
using kernel::double_double::both;
using kernel::double_double::Bounded;
using kernel::double_double::differ;
using kernel::double_double::DoubleDouble;
using kernel::double_double::either;
using kernel::double_double::fast_two_sum;
using kernel::double_double::Four;
using kernel::double_double::FourBounded;
using kernel::double_double::kNegligible;
using kernel::double_double::kUnderflow;
using kernel::double_double::magnitude;
using kernel::double_double::uniform;
using kernel::double_double::where;

inline constexpr int kAtanSteps = 256;  // intervals of the table from 0 to 1

// Each has a relative error of at most 2^-106.
struct AngleConstants {
  std::array<DoubleDouble, kAtanSteps + 1> atan;  // atan of k / kAtanSteps; exactly 0 for k = 0
  DoubleDouble half_pi;
  DoubleDouble pi;
};

// Computed in ball arithmetic on first use.
const AngleConstants& angle_constants();

EXACTFF_INLINE Bounded constant(const DoubleDouble& x) { return {x.hi, x.lo, 0x1p-106 * x.hi}; }

// Entry k of the table. Requires a whole number k from 0 to kAtanSteps: atan_of_ratio rounds one in this range.
EXACTFF_INLINE Bounded tabulated_atan(double k, const AngleConstants& known) {
  return constant(known.atan[static_cast<std::size_t>(k)]);
}
EXACTFF_INLINE FourBounded tabulated_atan(const Four& k, const AngleConstants& known) {
  const auto at = [&](int lane) -> const DoubleDouble& { return known.atan[static_cast<std::size_t>(k[lane])]; };
  const DoubleDouble &a = at(0), &b = at(1), &c = at(2), &d = at(3);
  const Four hi{a.hi, b.hi, c.hi, d.hi};
  return {hi, Four{a.lo, b.lo, c.lo, d.lo}, 0x1p-106 * hi};
}

// atan(z) for |z| < 2^-8.9, where w = z^2 < 2^-17.8:  z (1 + w (-1/3 + w (1/5 - w (1/7 - w (1/9 - w / 11))))).
// All errors here are relative to |z|. The omitted rest of the series is below w^6 / 13 < 2^-92 w. The bracket that
// starts with 1/7, and its product with w, are computed in doubles, from the high part of w alone: the product is wrong
// by less than 2^-53 w, which gives 2^-53 w^3 < 2^-88 w. With low parts of up to 8 u, the double-double operations
// before the last sum are wrong by less than 2^-100 w, and that sum by 3.1 u^2. With w < 2^-17.8 the total is below
// (2^-103 + 2^-87 w).
template <class Real>
EXACTFF_INLINE BasicBounded<Real> atan_near_zero(const BasicBounded<Real>& z) {
  constexpr DoubleDouble kMinusThird{-0x1.5555555555555p-2, -0x1.5555555555555p-56};
  constexpr DoubleDouble kFifth{0x1.999999999999ap-3, -0x1.999999999999ap-57};
  constexpr double kSeventh = 0.14285714285714286, kNinth = 0.1111111111111111, kEleventh = 0.09090909090909091;
  const auto square = raw_product(parts(z), parts(z));
  const Real& w = square.hi;
  const auto second = fast_two_sum(uniform<Real>(kFifth.hi), w * (w * (kNinth - w * kEleventh) - kSeventh));
  const auto tail = raw_product(square, {second.hi, second.lo + kFifth.lo});
  const auto first = fast_two_sum(uniform<Real>(kMinusThird.hi), tail.hi);
  const auto r = raw_product(square, {first.hi, first.lo + (tail.lo + kMinusThird.lo)});
  const auto rz = raw_product(r, parts(z));
  const auto sum = fast_two_sum(z.hi, rz.hi);
  return bounded(fast_two_sum(sum.hi, sum.lo + (rz.lo + z.lo)),
                 z.error + (0x1p-103 + 0x1p-87 * w) * magnitude(z.hi) + kUnderflow);
}

// The whole number nearest to a. Requires 0 <= a < 2^51.
template <class Real>
EXACTFF_INLINE Real nearest_whole(const Real& a) {
  return (a + 0x1p52) - 0x1p52;
}

// atan(y / x) for 0 <= y <= x, up to their errors; declined otherwise. With t = k / kAtanSteps nearest to y / x,
//   atan(y / x) = atan(t) + atan(z),  z = (y - t x) / (x + t y),
// where |z| <= (1 / 2 kAtanSteps) (1 + 2^-40), up to errors that are negligible beside x.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> atan_of_ratio(const BasicBounded<Real>& y, const BasicBounded<Real>& x,
                                                const AngleConstants& known) {
  const Real ratio = y.hi / x.hi;
  const auto is_proper = both(ratio >= 0.0, ratio <= 1.0);  // false for NaN
  const Real k = nearest_whole(Real(kAtanSteps * where(is_proper, ratio, Real{})));
  const Real t = k * (1.0 / kAtanSteps);
  return only_where(is_proper, tabulated_atan(k, known) + atan_near_zero((y - t * x) / (x + t * y)));
}

template <class Real>
EXACTFF_INLINE BasicBounded<Real> negated_where(const auto& condition, const BasicBounded<Real>& x) {
  return where(condition, -x, x);
}

template <class Real>
EXACTFF_INLINE BasicBounded<Real> absolute(const BasicBounded<Real>& x) {
  return negated_where(x.hi < 0.0, x);
}

// The angle of the point (cosine, sine) from the first axis, in (-pi, pi). Declined if the point may be the origin or
// on the negative axis. Let x be the larger of |cosine| and |sine|, and y the other. Up to the sign of the sine, the
// angle is
//   0 + atan(y / x), pi / 2 - atan(y / x), pi / 2 + atan(y / x) or pi - atan(y / x),  depending on the octant.
template <class Real>
EXACTFF_INLINE BasicBounded<Real> atan2(const BasicBounded<Real>& sine, const BasicBounded<Real>& cosine,
                                        const AngleConstants& known) {
  const auto s = absolute(sine), c = absolute(cosine);
  const auto steep = c.hi < s.hi, obtuse = cosine.hi < 0.0;
  const auto x = where(steep, s, c), y = where(steep, c, s);
  const auto is_off_origin =
      both(both(x.hi >= 0x1p-600, x.hi <= 0x1p900), both(y.error <= kNegligible * x.hi, x.error <= kNegligible * x.hi));
  const auto is_off_axis = either(either(steep, cosine.hi >= 0.0), sign_is_certain(sine));
  const auto half_pi = uniform<Real>(constant(known.half_pi)), pi = uniform<Real>(constant(known.pi));
  const auto base = where(steep, half_pi, where(obtuse, pi, BasicBounded<Real>{}));
  const auto angle = base + negated_where(differ(steep, obtuse), atan_of_ratio(y, x, known));
  return only_where(both(is_off_origin, is_off_axis), negated_where(sine.hi < 0.0, angle));
}

}  // namespace exactff::contour
