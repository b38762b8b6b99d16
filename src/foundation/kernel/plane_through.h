// The plane through three points, prepared for the sides of many others.
//
// The filter is that of sign_of_det (filter.h), but forms the normal n = (b - a) x (c - a) first. With d = x - a, each
// of the three differences carries u, the products of n carry u and their difference u, the product with d carries u
// and the two sums 2u: below 14u of the sum m of the magnitudes of all six terms, with the same conditions on m and d.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/filter.h"

namespace exactff::kernel {

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

}  // namespace exactff::kernel
