#include "view_factors/exact_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

constexpr double kSubtractionError = 0x1p-51;  // of a component of a difference of two points, each rounded once
constexpr int kExactBits = 50;                 // of products whose sums of four are exact
constexpr int kBitsForRoundedPlane = 15;       // see RoundedPlane
constexpr long kLargestShift = 256;            // so that no product of three numbers underflows

int bits_of(std::span<const Integer> numbers, const Units& units) {
  if (units.shift > kLargestShift) return kManyBits;
  long bits = 0;
  for (const Integer& x : numbers) bits = std::max(bits, kernel::bit_length(x));
  return static_cast<int>(std::min<long>(bits, kManyBits));
}

Integer integer_of(double value, const Units& units) {
  const kernel::BinaryDouble parts = kernel::decompose(value);
  Integer result(parts.mantissa);
  if (parts.mantissa != 0) result <<= static_cast<unsigned long>(parts.exponent - units.exponent);
  return result;
}

Integer minor(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c, int i, int j, int k) {
  return a[i] * (b[j] * c[k] - b[k] * c[j]) - a[j] * (b[i] * c[k] - b[k] * c[i]) + a[k] * (b[i] * c[j] - b[j] * c[i]);
}

// The vector that is orthogonal to three others, with the sign of a determinant.
Homogeneous orthogonal(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c) {
  return {minor(a, b, c, 1, 2, 3), -minor(a, b, c, 0, 2, 3), minor(a, b, c, 0, 1, 3), -minor(a, b, c, 0, 1, 2)};
}

// Divides by the greatest common divisor.
void make_primitive(Homogeneous& a) {
  Integer divisor = abs(a[0]);
  for (int i = 1; i < 4; ++i) divisor = gcd(divisor, a[i]);
  if (divisor <= 1) return;
  for (Integer& x : a) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), divisor.get_mpz_t());
}

}  // namespace

Units Units::of(std::span<const Vec3> vertices) {
  int least = std::numeric_limits<int>::max();
  double largest = 0.0;
  for (const Vec3& v : vertices) {
    for (const double x : {v.x, v.y, v.z}) {
      if (x != 0.0) least = std::min(least, kernel::decompose(x).exponent);
    }
    largest = std::max(largest, kernel::max_norm(v));
  }
  if (largest == 0.0) return {};
  return {least, std::ilogb(largest) + 1 - least};
}

Point point_of(const Vec3& v, const Units& units) {
  return make_point({integer_of(v.x, units), integer_of(v.y, units), integer_of(v.z, units), Integer(1)}, units);
}

Point make_point(Homogeneous exact, const Units& units) {
  EXACTFF_EXPECT(sgn(exact[3]) != 0);
  if (sgn(exact[3]) < 0) exact = opposite(std::move(exact));
  make_primitive(exact);
  const auto coordinate = [&](int i) {
    return exact[3] == 1 ? kernel::nearest_double(exact[i], -units.shift)
                         : kernel::nearest_double(exact[i], exact[3], -units.shift);
  };
  const Vec3 at{coordinate(0), coordinate(1), coordinate(2)};
  const int bits = exact[3] == 1 ? bits_of(std::span(exact).first(3), units) : kManyBits;
  return {std::move(exact), at, bits};
}

Plane make_plane(Homogeneous exact, const Units& units) {
  make_primitive(exact);
  long bits = kernel::bit_length(exact[3]) - units.shift;
  for (int i = 0; i < 3; ++i) bits = std::max(bits, kernel::bit_length(exact[i]));
  Plane plane{std::move(exact), {}, kManyBits};
  plane.bits = bits_of(plane.exact, units);
  for (int i = 0; i < 4; ++i) {
    plane.rounded[i] = kernel::nearest_double(plane.exact[i], -bits - (i == 3 ? units.shift : 0));
  }
  return plane;
}

Homogeneous join(const Point& a, const Point& b, const Point& c) { return orthogonal(a.exact, b.exact, c.exact); }
Homogeneous meet(const Plane& a, const Plane& b, const Plane& c) { return orthogonal(a.exact, b.exact, c.exact); }

bool is_zero(const Homogeneous& a) {
  return std::ranges::all_of(a, [](const Integer& x) { return sgn(x) == 0; });
}

Homogeneous opposite(Homogeneous a) {
  for (Integer& x : a) mpz_neg(x.get_mpz_t(), x.get_mpz_t());
  return a;
}

int side_of(const Plane& plane, const Point& point) {
  const double terms[] = {plane.rounded[0] * point.at.x, plane.rounded[1] * point.at.y, plane.rounded[2] * point.at.z,
                          plane.rounded[3]};
  const double sum = terms[0] + terms[1] + terms[2] + terms[3];
  if (plane.bits + point.bits <= kExactBits) return sum > 0.0 ? 1 : sum < 0.0 ? -1 : 0;
  const double magnitude = std::abs(terms[0]) + std::abs(terms[1]) + std::abs(terms[2]) + std::abs(terms[3]);
  const int filtered = kernel::certified_sign(sum, magnitude);
  if (filtered != kernel::kUncertain) return filtered;
  Integer value = plane.exact[3] * point.exact[3];
  for (int i = 0; i < 3; ++i) value += plane.exact[i] * point.exact[i];
  return sgn(value);
}

RoundedPlane::RoundedPlane(const Point& a, const Point& b, const Point& c)
    : origin_(a.at), is_exact_(std::max({a.bits, b.bits, c.bits}) <= kBitsForRoundedPlane) {
  const Vec3 ab = kernel::difference(b.at, a.at), ac = kernel::difference(c.at, a.at);
  normal_ = kernel::cross(ab, ac);
  const double size_b = kernel::max_norm(ab) + kSubtractionError, size_c = kernel::max_norm(ac) + kSubtractionError;
  product_ = size_b * size_c;
  sum_ = size_b + size_c;
}

double RoundedPlane::height(const Vec3& x) const { return kernel::dot(normal_, kernel::difference(x, origin_)); }

double RoundedPlane::error_at(const Vec3& from_origin) const {
  return 0x1p-46 * (product_ + sum_ * (kernel::max_norm(from_origin) + kSubtractionError));
}

int RoundedPlane::side_of(const Point& x) const {
  const Vec3 ax = kernel::difference(x.at, origin_);
  const double value = kernel::dot(normal_, ax);
  if (is_exact_ && x.bits <= kBitsForRoundedPlane) return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
  const double error = error_at(ax);
  return value > error ? 1 : value < -error ? -1 : kernel::kUncertain;
}

bool RoundedPlane::is_beyond(const Vec3& x, double errors) const {
  const Vec3 ax = kernel::difference(x, origin_);
  return std::abs(kernel::dot(normal_, ax)) > errors * error_at(ax);
}

}  // namespace exactff::view_factors
