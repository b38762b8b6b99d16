#include "bench/double_contour.h"

#include <cmath>
#include <numbers>

#include "kernel/filter.h"
#include "sampled/vec.h"

namespace exactff::bench {

using sampled::cross;
using sampled::dot;
using sampled::length;
using sampled::operator*;
using sampled::operator+;

namespace {

// mantissa * 2^exponent, for integers of any length.
struct Scaled {
  explicit Scaled(const kernel::Integer& value) { mantissa = mpz_get_d_2exp(&exponent, value.get_mpz_t()); }
  double mantissa;
  long exponent = 0;
};

// A direction and, since that is rounded to the order of 1, the exponent that it lost.
struct Rounded {
  explicit Rounded(const kernel::ExactVec3& exact) : exponent(bit_length(exact)) {
    const kernel::Approx3 t = kernel::approx(exact);
    direction = {t.x, t.y, t.z};
  }
  Vec3 direction;
  long exponent;
};

Vec3 point_at(const Rounded& a, const Rounded& b, const visibility::EdgeParameter& t) {
  const Scaled l(t.l), m(t.m);
  if (l.mantissa == 0.0) return b.direction;
  const double ratio =
      std::ldexp(m.mantissa / l.mantissa, static_cast<int>(m.exponent + b.exponent - l.exponent - a.exponent));
  return a.direction * (1.0 / (1.0 + ratio)) + b.direction * (ratio / (1.0 + ratio));
}

}  // namespace

DoubleEdge to_double(const visibility::BoundaryPiece& piece) {
  const Rounded a(piece.a), b(piece.b);
  return {point_at(a, b, piece.begin), point_at(a, b, piece.end)};
}

double form_factor(std::span<const DoubleEdge> edges, const Vec3& normal) {
  double sum = 0.0;
  for (const auto& [p, q] : edges) {
    const Vec3 c = cross(p, q);
    const double sine = length(c);
    if (sine > 0.0) sum -= std::atan2(sine, dot(p, q)) * dot(normal, c) / sine;
  }
  return sum / (2.0 * std::numbers::pi * length(normal));
}

}  // namespace exactff::bench
