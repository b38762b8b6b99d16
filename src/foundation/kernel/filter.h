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
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "kernel/numbers.h"

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

// --- Direction ---

// Exact directions from the receiving point, each with its floating-point approximation.
//
// A direction stands for the ray x + t v, t > 0; a positive factor does not change it. A plane through x is given by
// its normal, which is also a Direction.

struct Direction {
  ExactVec3 exact;
  Approx3 approx;
};

inline Direction make_direction(ExactVec3 exact) {
  const Approx3 rounded = approx(exact);
  return {std::move(exact), rounded};
}

// Sign of normal . t: by the filter if it is certain, else by the exact product.
inline int side(const Direction& normal, const Direction& t) {
  const int filtered = sign_of_dot(normal.approx, t.approx);
  return filtered != kUncertain ? filtered : sign(dot(normal.exact, t.exact));
}

// Sign of det(a, b, c).
inline int orientation(const Direction& a, const Direction& b, const Direction& c) {
  return sign(dot(cross(a.exact, b.exact), c.exact));
}

// A convex polygon seen from x. Unless stated otherwise its corners are counter-clockwise as seen from x, that is,
// det(a, b, c) < 0 for three corners in order.
using Ring = std::vector<Direction>;

// A direction from x in double-double form, for code that only stores it. Every true component is within `error` of
// hi + lo (0: exact).
struct FineDirection {
  std::array<double, 3> hi{};
  std::array<double, 3> lo{};
  double error = 0.0;
};

// --- Plane through ---

// The plane through three points, prepared for the sides of many others.
//
// The filter is that of sign_of_det, but forms the normal n = (b - a) x (c - a) first. With d = x - a, each
// of the three differences carries u, the products of n carry u and their difference u, the product with d carries u
// and the two sums 2u: below 14u of the sum m of the magnitudes of all six terms, with the same conditions on m and d.

class PlaneThrough {
 public:
  PlaneThrough(const Vec3& a, const Vec3& b, const Vec3& c) : a_(a), b_(b), c_(c) {
    const Approx3 u = approx_difference(b, a), v = approx_difference(c, a);
    set(u.y, v.z, u.z, v.y, normal_.x, magnitude_.x, vanishes_[0]);
    set(u.z, v.x, u.x, v.z, normal_.y, magnitude_.y, vanishes_[1]);
    set(u.x, v.y, u.y, v.x, normal_.z, magnitude_.z, vanishes_[2]);
  }

  // The sign of det(b - a, c - a, x - a): positive on the side from which a, b, c run counter-clockwise.
  [[nodiscard]] int side_of(const Vec3& x) const {
    const Approx3 d = approx_difference(x, a_);
    const int filtered = sign_by_filter(d.x * normal_.x + d.y * normal_.y + d.z * normal_.z, magnitudes(d), d);
    if (filtered != kUncertain) return filtered;
    const bool is_zero = (vanishes_[0] || d.x == 0.0) && (vanishes_[1] || d.y == 0.0) && (vanishes_[2] || d.z == 0.0);
    return is_zero ? 0 : orientation(a_, b_, c_, x);
  }

  // The side on which all of the box certainly lies, off the plane; else kUncertain.
  [[nodiscard]] int side_of_box(const Vec3& low, const Vec3& high) const {
    const Approx3 p = approx_difference(low, a_), q = approx_difference(high, a_);
    const double x[] = {p.x * normal_.x, q.x * normal_.x}, y[] = {p.y * normal_.y, q.y * normal_.y},
                 z[] = {p.z * normal_.z, q.z * normal_.z};
    const Approx3 d{std::max(std::abs(p.x), std::abs(q.x)), std::max(std::abs(p.y), std::abs(q.y)),
                    std::max(std::abs(p.z), std::abs(q.z))};
    const double m = magnitudes(d);
    // Rounded sums grow with their terms, so these are those of two corners and bound those of the others.
    if (sign_by_filter(std::min(x[0], x[1]) + std::min(y[0], y[1]) + std::min(z[0], z[1]), m, d) == 1) return 1;
    if (sign_by_filter(std::max(x[0], x[1]) + std::max(y[0], y[1]) + std::max(z[0], z[1]), m, d) == -1) return -1;
    return kUncertain;
  }

 private:
  static void set(double p, double q, double r, double s, double& difference, double& magnitude, bool& vanishes) {
    difference = p * q - r * s;
    magnitude = std::abs(p * q) + std::abs(r * s);
    vanishes = (p == 0.0 || q == 0.0) && (r == 0.0 || s == 0.0);
  }

  [[nodiscard]] double magnitudes(const Approx3& d) const {
    return std::abs(d.x) * magnitude_.x + std::abs(d.y) * magnitude_.y + std::abs(d.z) * magnitude_.z;
  }

  static int sign_by_filter(double sum, double magnitude, const Approx3& d) {
    const bool moderate = max_norm(d) <= 0x1p300 && magnitude >= 0x1p-700;
    return moderate ? certified_sign(sum, magnitude) : kUncertain;
  }

  Vec3 a_, b_, c_;
  Vec3 normal_, magnitude_;
  bool vanishes_[3] = {false, false, false};
};

// --- Bounds that several predicates share ---

// Of directions from x, each component of which is known within a relative error of 2u, and the largest magnitudes |.|
// of which are moderate: then underflow does not matter.
[[nodiscard]] inline bool is_moderate(double size) { return size >= 0x1p-300 && size <= 0x1p300; }  // false for NaN

// With c_i = b_j a_k - b_k a_j in doubles, each product errs by 5u and their difference by u more of its magnitude: in
// all by 12u |a||b|; |c_i| <= 2 |a||b|. Then c . t is a sum of three products, each of which errs by
// (12u + 2 (2u + u)) |a||b||t| = 18u |a||b||t|, and two sums of at most 6 |a||b||t|, so that the total is below
// 54u + 12u = 66u.
inline constexpr double kCrossError = 0x1p-49;   // of c_i, in |a||b|
inline constexpr double kTripleError = 0x1p-46;  // of c . t, in |a||b||t|

// N . t - N . s, |N| <= 1: the two sums err by 7u of the magnitudes of their terms, at most 3 |t| and 3 |s|, and their
// difference by u of at most 3 (|t| + |s|) more: in all by 24u (|t| + |s|).
inline constexpr double kDotDifferenceError = 0x1p-48;

// --- Inverse depth ---

// The plane N . (y - x) = c, c > 0, is met at x + d / w in direction d, with w = (N / c) . d.
//
// Filter, with u = 2^-53. Let e, f be the two edge vectors of a face that span its plane and s its first corner, as
// rounded differences (relative error u), and A = |e| |f|, |.| being the largest magnitude. A component of N = e x f
// errs by less than 8u A, c = N . s by less than 64u A |s| = C. A component of N / c then errs by at most
// (8u A + |N / c| C) / (|c| - C) + u |N / c|, which is called E. For a corner t (relative error 2u), w errs by less
// than (3 E + 18u |N / c|) |t|; the difference of two such numbers adds u of each, at most 3u |N / c| |t|. So error = 3
// E + 32u |N / c| serves for differences as well, with a margin for its own rounding.
struct InverseDepth {
  Vec3 slope;          // N / c
  double error = 0.0;  // w = slope . t within error |t|; infinite where the filter must decline
};
[[nodiscard]] InverseDepth inverse_depth(const Approx3& e, const Approx3& f, const Approx3& s);

}  // namespace exactff::kernel
