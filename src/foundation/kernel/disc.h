// Discs of the complex plane about real centres, in double precision.
//
// A disc holds every complex number within `radius` of the real number `centre`. Every operation returns a disc that
// holds the result for all numbers of its operands. So a disc encloses a real number, with all roundings counted, and
// bounds an analytic function of a complex variable as well.
//
// Notation: u = 2^-53; c and r are the centre and radius of the result, m and e those of the operand. The exact radius
// of each operation is derived beside it. Two more errors are counted:
// - rounding c to a double moves it by at most u |c|, or by 2^-1074 if it underflows. This is added to r;
// - r is computed from numbers that are not negative, by at most 12 roundings, each of at most u: less than 2^-49. So r
//   is multiplied by kUp. Each underflow on the way loses at most 2^-1074: operations with products add kTiny.
// Sums and differences of two doubles cannot underflow.
//
// An operation that is not analytic on its operand, or overflows, returns an infinite radius, or one that is NaN. So
// does everything computed from it. Conditions are written such that they fail for both.
//
// Rounding is to nearest (float_environment.h), and products and sums are never contracted. Operations are written once
// for one disc and for four at a time (reals.h), with the same bits.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "kernel/reals.h"

namespace exactff::kernel {

template <class Real>
struct BasicDisc {
  Real centre{};
  Real radius{};
};
using Disc = BasicDisc<double>;

namespace disc {

using double_double::both;
using double_double::magnitude;
using double_double::root;
using double_double::uniform;
using double_double::where;

inline constexpr double kUnit = 0x1p-53;
inline constexpr double kUp = 1.0 + 0x1p-49;
inline constexpr double kTiny = 0x1p-1000;
inline constexpr Disc kFailed{0.0, std::numeric_limits<double>::infinity()};

}  // namespace disc

// A number that a double holds with a relative error of at most u; it may underflow.
inline Disc rounded_once(double x) { return {x, disc::kUnit * std::abs(x) + disc::kTiny}; }

// The same disc in every lane.
template <class Real>
EXACTFF_INLINE BasicDisc<Real> uniform(const Disc& a) {
  if constexpr (std::is_same_v<Real, double>) {
    return a;
  } else {
    return {lanes::four(a.centre), lanes::four(a.radius)};
  }
}

// A bool for one disc, a mask for four.
template <class Real>
[[nodiscard]] EXACTFF_INLINE auto is_finite(const BasicDisc<Real>& a) {
  return a.radius < std::numeric_limits<double>::infinity();
}
// Every number of the disc has a positive real part.
template <class Real>
[[nodiscard]] EXACTFF_INLINE auto is_positive(const BasicDisc<Real>& a) {
  return a.centre > a.radius;
}
template <class Real>
[[nodiscard]] EXACTFF_INLINE auto is_negative(const BasicDisc<Real>& a) {
  return -a.centre > a.radius;
}

// a where the condition holds, else b; or kFailed.
template <class Condition, class Real>
EXACTFF_INLINE BasicDisc<Real> where(const Condition& condition, const BasicDisc<Real>& a, const BasicDisc<Real>& b) {
  return {disc::where(condition, a.centre, b.centre), disc::where(condition, a.radius, b.radius)};
}
template <class Condition, class Real>
EXACTFF_INLINE BasicDisc<Real> only_where(const Condition& condition, const BasicDisc<Real>& a) {
  return where(condition, a, uniform<Real>(disc::kFailed));
}

// The largest magnitude of the numbers in the disc, rounded up; and the ends on the real axis, rounded outward.
[[nodiscard]] inline double magnitude(const Disc& a) { return (std::abs(a.centre) + a.radius) * disc::kUp; }
[[nodiscard]] inline double lower_end(const Disc& a) {
  return std::nextafter(a.centre - a.radius, -std::numeric_limits<double>::infinity());
}
[[nodiscard]] inline double upper_end(const Disc& a) {
  return std::nextafter(a.centre + a.radius, std::numeric_limits<double>::infinity());
}
[[nodiscard]] inline Disc widened(const Disc& a, double by) { return {a.centre, (a.radius + by) * disc::kUp}; }

template <class Real>
EXACTFF_INLINE BasicDisc<Real> operator-(const BasicDisc<Real>& a) {
  return {-a.centre, a.radius};
}

// r = e_a + e_b.
template <class Real>
EXACTFF_INLINE BasicDisc<Real> operator+(const BasicDisc<Real>& a, const BasicDisc<Real>& b) {
  const Real c = a.centre + b.centre;
  return {c, (a.radius + b.radius + disc::kUnit * disc::magnitude(c)) * disc::kUp};
}
template <class Real>
EXACTFF_INLINE BasicDisc<Real> operator-(const BasicDisc<Real>& a, const BasicDisc<Real>& b) {
  return a + -b;
}

// With z = m_a + v, w = m_b + y: z w - m_a m_b = m_a y + m_b v + v y, so r = |m_a| e_b + |m_b| e_a + e_a e_b.
template <class Real>
EXACTFF_INLINE BasicDisc<Real> operator*(const BasicDisc<Real>& a, const BasicDisc<Real>& b) {
  const Real c = a.centre * b.centre;
  const Real inherited = disc::magnitude(a.centre) * b.radius + (disc::magnitude(b.centre) + b.radius) * a.radius;
  return {c, (inherited + disc::kUnit * disc::magnitude(c)) * disc::kUp + disc::kTiny};
}
template <class Real>
EXACTFF_INLINE BasicDisc<Real> operator*(double k, const BasicDisc<Real>& a) {
  const Real c = k * a.centre;
  return {c, (std::abs(k) * a.radius + disc::kUnit * disc::magnitude(c)) * disc::kUp + disc::kTiny};
}
template <class Real>
EXACTFF_INLINE BasicDisc<Real> square(const BasicDisc<Real>& a) {
  const Real c = a.centre * a.centre;
  const Real inherited = (2.0 * disc::magnitude(a.centre) + a.radius) * a.radius;
  return {c, (inherited + disc::kUnit * c) * disc::kUp + disc::kTiny};
}

// |1 / z - 1 / m| = |z - m| / (|m| |z|), so r = e / (|m| (|m| - e)). kFailed unless 0 lies outside the disc.
template <class Real>
EXACTFF_INLINE BasicDisc<Real> inverse(const BasicDisc<Real>& a) {
  const Real m = disc::magnitude(a.centre), least = m - a.radius;
  const Real c = 1.0 / a.centre;
  const Real r = (a.radius / least / m + disc::kUnit * disc::magnitude(c)) * disc::kUp + disc::kTiny;
  return only_where(least > 0.0, BasicDisc<Real>{c, r});
}
template <class Real>
EXACTFF_INLINE BasicDisc<Real> operator/(const BasicDisc<Real>& a, const BasicDisc<Real>& b) {
  return a * inverse(b);
}

// The root with a positive real part, analytic off the negative half of the real axis; kFailed unless m > e. A
// number z of it has |z| >= m - e and Re z >= m - e, so Re sqrt(z) = sqrt((|z| + Re z) / 2) >= sqrt(m - e). Since
// |sqrt(z) - sqrt(m)| = |z - m| / |sqrt(z) + sqrt(m)|, r = e / (sqrt(m - e) + sqrt(m)).
template <class Real>
EXACTFF_INLINE BasicDisc<Real> square_root(const BasicDisc<Real>& a) {
  const Real least = a.centre - a.radius;
  const Real c = disc::root(a.centre);
  const Real r = (a.radius / (c + disc::root(least)) + disc::kUnit * c) * disc::kUp + disc::kTiny;
  return only_where(least > 0.0, BasicDisc<Real>{c, r});
}

namespace disc {

// 1 / (2k + 1), each rounded once.
inline constexpr std::size_t kTerms = 12;
inline constexpr std::array<double, kTerms> kCoefficients = [] {
  std::array<double, kTerms> result{};
  for (std::size_t k = 0; k < kTerms; ++k) result[k] = 1.0 / static_cast<double>(2 * k + 1);
  return result;
}();

// A(m) for a double m >= -1/2 by atan(y) = 2 atan(y / (1 + sqrt(1 + y^2))), which for m = y^2 is
//   A(m) = 2 / g * A(m / g^2),   g = 1 + sqrt(1 + m),
// three times, and the alternating series A(w) = sum of (-w)^k / (2k + 1).
//
// m / g^2 = (sqrt(1 + m) - 1) / (sqrt(1 + m) + 1) lies in (-0.172, 1); after the second time in (-0.048, 0.172), after
// the third in (-0.0121, 0.0396). So the first term left out, w^12 / 25, is below 2^-60, and so is their sum.
//
// Roundings. Suppose that m has a relative error of h u. Then 1 + m has at most h u |m| / (1 + m) + u, less than
// (h + 1) u, since |m| <= 1 + m; its root has less than (h / 2 + 2) u and g, of whose two terms the root is one,
// (h / 2 + 3) u. So w = m / g / g has (2h + 8.1) u. From h = 0 we get 8.1, 24.3, 56.7 for the three w, and 3, 7.1, 15.2
// for the three g, hence 30 u for the three factors 2 / g with their quotients and products. Since |A'| <= 0.34 near
// w, the error of w changes the series by at most 0.34 * 0.04 * 57 u < u; Horner's scheme adds less than 3 u. Together
// 35 u, since all three factors 2 / g and the series are positive; 64 u is used, and 2^-60 is below u.
inline constexpr double kAtanError = 0x1p-47;
template <class Real>
EXACTFF_INLINE Real atan_of_root(const Real& m) {
  Real factor = uniform<Real>(1.0), w = m;
  for (int i = 0; i < 3; ++i) {
    const Real g = 1.0 + root(1.0 + w);
    factor *= 2.0 / g;
    w = w / g / g;
  }
  Real sum = uniform<Real>(kCoefficients[kTerms - 1]);
  for (std::size_t k = kTerms - 1; k-- > 0;) sum = kCoefficients[k] - w * sum;
  return factor * sum;
}

}  // namespace disc

// A(z) = atan(sqrt(z)) / sqrt(z) = integral over t from 0 to 1 of 1 / (1 + t^2 z): analytic off the real numbers up to
// -1, and at 0. kFailed unless m - e > -3/4 and m >= -1/2.
//
// Radius. For z = m + v, |v| <= e: |1 + t^2 z| >= 1 + t^2 (m - e). So
//   |A(z) - A(m)| <= e * integral of t^2 / ((1 + t^2 (m - e)) (1 + t^2 m)) <= e / (3 min(1, 1 + m - e) min(1, 1 + m)).
// Where that is larger than A(m) + |A(z)|, the disc is still right.
template <class Real>
EXACTFF_INLINE BasicDisc<Real> atan_of_root(const BasicDisc<Real>& a) {
  const Real least = a.centre - a.radius;  // wrong by at most u |least|
  const Real c = disc::atan_of_root(a.centre), one = disc::uniform<Real>(1.0);
  const Real of_least = 1.0 + least, of_centre = 1.0 + a.centre;
  const Real divisor = 3.0 * disc::where(of_least < 1.0, of_least, one) * disc::where(of_centre < 1.0, of_centre, one);
  const Real r = (a.radius / divisor + disc::kAtanError * c) * disc::kUp + disc::kTiny;
  return only_where(disc::both(a.centre >= -0.5, least > -0.75), BasicDisc<Real>{c, r});
}

// 1 / pi.
inline constexpr Disc kInversePi{0x1.45f306dc9c883p-2, 0x1p-54};

}  // namespace exactff::kernel
