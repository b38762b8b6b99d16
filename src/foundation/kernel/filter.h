// Floating-point filters with a proved bound: a sign that they return is the exact sign; otherwise they decline.
//
// Notation: u = 2^-53. An Approx3 approximates an exact vector up to one positive factor for the whole vector. For each
// component it holds a double with a relative error of at most 2u, and exactly 0 if the component is 0; or it holds
// NaN, which makes every filter decline.
//
// sign_of_dot: products of two components carry (1 + 2u)^2 (1 + u), and two additions add at most 2u of the sum m of
// the magnitudes. The total is below 8u m. m itself is computed to within 8u, so |s| > 16u m = 2^-49 m decides. A
// product that underflows is wrong by at most 2^-1075, which is negligible beside 2^-49 * 2^-900, the smallest
// threshold that is admitted.
#pragma once

#include <algorithm>
#include <cmath>

#include "exactff/geometry.h"
#include "kernel/exact_vec.h"

namespace exactff::kernel {

struct Approx3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

inline Vec3 to_vec3(const Approx3& a) { return {a.x, a.y, a.z}; }
inline double dot(const Vec3& a, const Approx3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double max_norm(const Approx3& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

inline constexpr int kUncertain = 2;
inline constexpr double kLeastMagnitude = 0x1p-900;
inline constexpr double kLargestMagnitude = 0x1p900;

// p - q by one correctly rounded subtraction per component. The relative error is u, also for denormals; an overflow
// gives an infinity, and the filters then decline.
inline Approx3 approx_difference(const Vec3& p, const Vec3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }

// Components scaled so that the largest is in [1/2, 1); NaN if a component would leave the normal range.
Approx3 approx(const ExactVec3& exact);

// The sign of an exact sum, or kUncertain, from the computed sum s and the computed sum m of the magnitudes of its
// terms.
inline int certified_sign(double s, double m) {
  if (!(m >= kLeastMagnitude && m <= kLargestMagnitude)) return kUncertain;
  const double bound = 0x1p-49 * m;
  return s > bound ? 1 : s < -bound ? -1 : kUncertain;
}

inline int sign_of_dot(const Approx3& a, const Approx3& b) {
  const double px = a.x * b.x;
  const double py = a.y * b.y;
  const double pz = a.z * b.z;
  const double m = std::abs(px) + std::abs(py) + std::abs(pz);
  // m == 0 may be an underflow. It proves a zero only if every product has a factor that is zero.
  if (m == 0.0) {
    const bool zero = (a.x == 0.0 || b.x == 0.0) && (a.y == 0.0 || b.y == 0.0) && (a.z == 0.0 || b.z == 0.0);
    return zero ? 0 : kUncertain;
  }
  return certified_sign(px + py + pz, m);
}

// Sign of det(a, b, c). Each of its six products carries (1 + 2u)^3 (1 + u)^2, and the five sums add 5u of the sum m of
// the magnitudes. The total is below 14u m, well within the 16u m of certified_sign, where m is computed to within 8u.
// A product of two factors that underflows is wrong by 2^-1075, times at most 2^300, which is negligible beside
// 2^-49 * 2^-700.
inline int sign_of_det(const Approx3& a, const Approx3& b, const Approx3& c) {
  const double terms[] = {a.x * (b.y * c.z),  -a.x * (b.z * c.y), a.y * (b.z * c.x),
                          -a.y * (b.x * c.z), a.z * (b.x * c.y),  -a.z * (b.y * c.x)};
  double sum = 0.0;
  double magnitude = 0.0;
  for (const double term : terms) {
    sum += term;
    magnitude += std::abs(term);
  }
  const bool moderate = max_norm(a) <= 0x1p300 && magnitude >= 0x1p-700;
  return moderate ? certified_sign(sum, magnitude) : kUncertain;
}

}  // namespace exactff::kernel
