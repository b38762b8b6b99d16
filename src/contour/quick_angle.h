// Angles in double-double (double_double.h).
#pragma once

#include <array>

#include "kernel/double_double.h"

namespace exactff::contour {

using namespace kernel::double_double;

inline constexpr int kAtanSteps = 256;  // of the table from 0 to 1

// Each within 2^-106 of itself.
struct AngleConstants {
  std::array<DoubleDouble, kAtanSteps + 1> atan;  // of k / kAtanSteps; 0 exactly for k = 0
  DoubleDouble half_pi;
  DoubleDouble pi;
};

// Computed in ball arithmetic when first asked for.
const AngleConstants& angle_constants();

EXACTFF_INLINE Bounded constant(const DoubleDouble& x) { return {x.hi, x.lo, 0x1p-106 * x.hi}; }

// atan(z) for |z| < 2^-8.9, where w = z^2 < 2^-17.8:  z (1 + w (-1/3 + w (1/5 - w (1/7 - w (1/9 - w / 11))))).
// What the series leaves out is below w^6 / 13 < 2^-92 w of |z|. The bracket of 1/7 and w times it are left to doubles,
// with the high part of w alone: the product is off by less than 2^-53 w, whence 2^-53 w^3 < 2^-88 w of |z|. With low
// parts of up to 8 u, double-double operations before the last sum err by less than 2^-100 w of |z|, that sum by 3.1
// u^2 of it. With w < 2^-17.8 all this is less than (2^-103 + 2^-87 w) |z|.
EXACTFF_INLINE Bounded atan_near_zero(const Bounded& z) {
  constexpr DoubleDouble kMinusThird{-0x1.5555555555555p-2, -0x1.5555555555555p-56};
  constexpr DoubleDouble kFifth{0x1.999999999999ap-3, -0x1.999999999999ap-57};
  constexpr double kSeventh = 0.14285714285714286, kNinth = 0.1111111111111111, kEleventh = 0.09090909090909091;
  const DoubleDouble square = raw_product({z.hi, z.lo}, {z.hi, z.lo});
  const double w = square.hi;
  const DoubleDouble second = fast_two_sum(kFifth.hi, w * (w * (kNinth - w * kEleventh) - kSeventh));
  const DoubleDouble tail = raw_product(square, {second.hi, second.lo + kFifth.lo});
  const DoubleDouble first = fast_two_sum(kMinusThird.hi, tail.hi);
  const DoubleDouble r = raw_product(square, {first.hi, first.lo + (tail.lo + kMinusThird.lo)});
  const DoubleDouble rz = raw_product(r, {z.hi, z.lo});
  const DoubleDouble sum = fast_two_sum(z.hi, rz.hi);
  return bounded(fast_two_sum(sum.hi, sum.lo + (rz.lo + z.lo)),
                 z.error + (0x1p-103 + 0x1p-87 * w) * std::abs(z.hi) + kUnderflow);
}

// atan(y / x) for 0 <= y <= x, all but for their errors. With t = k / kAtanSteps nearest to y / x,
//   atan(y / x) = atan(t) + atan(z),  z = (y - t x) / (x + t y),
// where |z| <= (1 / 2 kAtanSteps) (1 + 2^-40), but for the errors, which are negligible beside x.
EXACTFF_INLINE Bounded atan_of_ratio(const Bounded& y, const Bounded& x, const AngleConstants& known) {
  const double ratio = y.hi / x.hi;
  if (!(ratio <= 1.0)) return kDeclined;  // NaN
  const int k = static_cast<int>(ratio * kAtanSteps + 0.5);
  if (k == 0) return atan_near_zero(y / x);
  const double t = static_cast<double>(k) * (1.0 / kAtanSteps);
  return constant(known.atan[k]) + atan_near_zero((y - t * x) / (x + t * y));
}

EXACTFF_INLINE Bounded absolute(const Bounded& x) { return x.hi < 0.0 ? -x : x; }

// The angle of the point (cosine, sine) from the first axis, in (-pi, pi). Declined where the point may be the origin
// or on the negative axis.
EXACTFF_INLINE Bounded atan2(const Bounded& sine, const Bounded& cosine, const AngleConstants& known) {
  const Bounded s = absolute(sine);
  const Bounded c = absolute(cosine);
  const bool steep = c.hi < s.hi;
  const Bounded& x = steep ? s : c;
  const Bounded& y = steep ? c : s;
  if (!(x.hi >= 0x1p-600 && x.hi <= 0x1p900 && y.error <= kNegligible * x.hi && x.error <= kNegligible * x.hi)) {
    return kDeclined;
  }
  Bounded angle = atan_of_ratio(y, x, known);
  if (steep) {
    angle = constant(known.half_pi) + (cosine.hi < 0.0 ? angle : -angle);
  } else if (cosine.hi < 0.0) {
    if (!sign_is_certain(sine)) return kDeclined;
    angle = constant(known.pi) - angle;
  }
  return sine.hi < 0.0 ? -angle : angle;
}

}  // namespace exactff::contour
