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
// Rounding is to nearest (float_environment.h), and products and sums are never contracted.
#pragma once

#include <cmath>
#include <limits>

namespace exactff::kernel {

struct Disc {
  double centre = 0.0;
  double radius = 0.0;
};

namespace disc {

inline constexpr double kUnit = 0x1p-53;
inline constexpr double kUp = 1.0 + 0x1p-49;
inline constexpr double kTiny = 0x1p-1000;
inline constexpr Disc kFailed{0.0, std::numeric_limits<double>::infinity()};

}  // namespace disc

// A number that a double holds with a relative error of at most u; it may underflow.
inline Disc rounded_once(double x) { return {x, disc::kUnit * std::abs(x) + disc::kTiny}; }

[[nodiscard]] inline bool is_finite(const Disc& a) { return a.radius < std::numeric_limits<double>::infinity(); }
// Every number of the disc has a positive real part.
[[nodiscard]] inline bool is_positive(const Disc& a) { return a.centre > a.radius; }
[[nodiscard]] inline bool is_negative(const Disc& a) { return -a.centre > a.radius; }

// The largest magnitude of the numbers in the disc, rounded up; and the ends on the real axis, rounded outward.
[[nodiscard]] inline double magnitude(const Disc& a) { return (std::abs(a.centre) + a.radius) * disc::kUp; }
[[nodiscard]] inline double lower_end(const Disc& a) {
  return std::nextafter(a.centre - a.radius, -std::numeric_limits<double>::infinity());
}
[[nodiscard]] inline double upper_end(const Disc& a) {
  return std::nextafter(a.centre + a.radius, std::numeric_limits<double>::infinity());
}
[[nodiscard]] inline Disc widened(const Disc& a, double by) { return {a.centre, (a.radius + by) * disc::kUp}; }

inline Disc operator-(const Disc& a) { return {-a.centre, a.radius}; }

// r = e_a + e_b.
inline Disc operator+(const Disc& a, const Disc& b) {
  const double c = a.centre + b.centre;
  return {c, (a.radius + b.radius + disc::kUnit * std::abs(c)) * disc::kUp};
}
inline Disc operator-(const Disc& a, const Disc& b) { return a + -b; }
inline Disc operator+(const Disc& a, double b) { return a + Disc{b, 0.0}; }

// With z = m_a + v, w = m_b + y: z w - m_a m_b = m_a y + m_b v + v y, so r = |m_a| e_b + |m_b| e_a + e_a e_b.
inline Disc operator*(const Disc& a, const Disc& b) {
  const double c = a.centre * b.centre;
  const double inherited = std::abs(a.centre) * b.radius + (std::abs(b.centre) + b.radius) * a.radius;
  return {c, (inherited + disc::kUnit * std::abs(c)) * disc::kUp + disc::kTiny};
}
inline Disc operator*(double k, const Disc& a) {
  const double c = k * a.centre;
  return {c, (std::abs(k) * a.radius + disc::kUnit * std::abs(c)) * disc::kUp + disc::kTiny};
}
inline Disc square(const Disc& a) {
  const double c = a.centre * a.centre;
  const double inherited = (2.0 * std::abs(a.centre) + a.radius) * a.radius;
  return {c, (inherited + disc::kUnit * c) * disc::kUp + disc::kTiny};
}

// |1 / z - 1 / m| = |z - m| / (|m| |z|), so r = e / (|m| (|m| - e)). kFailed unless 0 lies outside the disc.
inline Disc inverse(const Disc& a) {
  const double m = std::abs(a.centre), least = m - a.radius;
  if (!(least > 0.0)) return disc::kFailed;
  const double c = 1.0 / a.centre;
  return {c, (a.radius / least / m + disc::kUnit * std::abs(c)) * disc::kUp + disc::kTiny};
}
inline Disc operator/(const Disc& a, const Disc& b) { return a * inverse(b); }

// The root with a positive real part, analytic off the negative half of the real axis; kFailed unless m > e. A
// number z of it has |z| >= m - e and Re z >= m - e, so Re sqrt(z) = sqrt((|z| + Re z) / 2) >= sqrt(m - e). Since
// |sqrt(z) - sqrt(m)| = |z - m| / |sqrt(z) + sqrt(m)|, r = e / (sqrt(m - e) + sqrt(m)).
inline Disc square_root(const Disc& a) {
  const double least = a.centre - a.radius;
  if (!(least > 0.0)) return disc::kFailed;
  const double c = std::sqrt(a.centre);
  return {c, (a.radius / (c + std::sqrt(least)) + disc::kUnit * c) * disc::kUp + disc::kTiny};
}

// A(z) = atan(sqrt(z)) / sqrt(z) = integral over t from 0 to 1 of 1 / (1 + t^2 z): analytic off the real numbers up to
// -1, and at 0. kFailed unless m - e > -3/4 and m >= -1/2.
//
// Radius. For z = m + v, |v| <= e: |1 + t^2 z| >= 1 + t^2 (m - e). So
//   |A(z) - A(m)| <= e * integral of t^2 / ((1 + t^2 (m - e)) (1 + t^2 m)) <= e / (3 min(1, 1 + m - e) min(1, 1 + m)).
// Where that is larger than A(m) + |A(z)|, the disc is still right.
Disc atan_of_root(const Disc& a);

// 1 / pi.
inline constexpr Disc kInversePi{0x1.45f306dc9c883p-2, 0x1p-54};

}  // namespace exactff::kernel
