#include "bench/double_contour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "adaptive/sub_patch.h"
#include "kernel/filter.h"
#include "kernel/reals.h"

namespace exactff::bench {

using adaptive::cross;
using adaptive::dot;
using adaptive::length;
using adaptive::operator*;
using adaptive::operator+;

namespace {

// mantissa * 2^exponent, for integers of any length.
struct Scaled {
  explicit Scaled(const kernel::Integer& value) { mantissa = mpz_get_d_2exp(&exponent, value.get_mpz_t()); }
  double mantissa;
  long exponent = 0;
};

// A direction, scaled to the order of 1 and rounded, and the exponent that the scaling removed.
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

using kernel::double_double::root;
using kernel::lanes::Four;
using kernel::lanes::four;

// The angle of (cosine, sine) for sine >= 0, accurate to some units in the last place. With y / x at most 1, the
// tangent is that of an angle from 0 to pi / 4 or, if it is above tan(pi / 8), of an angle from -pi / 8 to 0 relative
// to pi / 4:
//   atan(u) = u - u z q(z),  z = u^2,
// where q is a Chebyshev interpolation on [0, tan^2(pi / 8)] with an error below 2^-57 of atan(u).
EXACTFF_INLINE Four angle(const Four& sine, const Four& cosine) {
  using namespace kernel::lanes;
  constexpr double kTangent = 0.41421356237309503;  // of pi / 8
  constexpr double kPi = std::numbers::pi;
  constexpr double kCoefficients[] = {
      -0.03923165829558719, 0.0508544973794026,   -0.0585814891280221, 0.06664511447381948, -0.07692183190826087,
      0.09090904578123903,  -0.11111111015256361, 0.14285714284666542, -0.1999999999999552, 0.3333333333333333};
  const Four c = absolute(cosine), x = larger(sine, c), y = smaller(sine, c);
  const FourMask far = y > kTangent * x;
  const Four u = pick(far, y - x, y) / pick(far, y + x, x), z = u * u;
  Four q = four(0.01917688711906226);
  for (const double coefficient : kCoefficients) q = q * z + coefficient;
  const Four first = pick(far, four(kPi / 4.0), four(0.0)) + (u - u * (z * q));
  const Four acute = pick(sine > c, kPi / 2.0 - first, first);
  return pick(cosine < 0.0, kPi - acute, acute);
}

using Part = visibility::VisibleEdges::Part;

struct FourParts {
  Four ax{}, ay{}, az{}, bx{}, by{}, bz{}, nx{}, ny{}, nz{}, s{}, t{};
};

// The first four parts; if there are fewer, the last one is repeated.
EXACTFF_INLINE void gather(const visibility::Outlines& outlines, std::span<const Part> parts, FourParts& result) {
  std::array<const Part*, 4> part{};
  std::array<const visibility::Outlines::Edge*, 4> edge{};
  std::array<const kernel::Approx3*, 4> a{}, b{};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    part[lane] = &parts[std::min(lane, parts.size() - 1)];
    edge[lane] = &outlines.edge(part[lane]->edge);
    a[lane] = &outlines.corner(edge[lane]->a).t;
    b[lane] = &outlines.corner(edge[lane]->b).t;
  }
  const auto set = [](Four& lanes, const auto& of) { lanes = Four{of(0U), of(1U), of(2U), of(3U)}; };
  set(result.ax, [&](unsigned k) { return a[k]->x; });
  set(result.ay, [&](unsigned k) { return a[k]->y; });
  set(result.az, [&](unsigned k) { return a[k]->z; });
  set(result.bx, [&](unsigned k) { return b[k]->x; });
  set(result.by, [&](unsigned k) { return b[k]->y; });
  set(result.bz, [&](unsigned k) { return b[k]->z; });
  set(result.nx, [&](unsigned k) { return edge[k]->normal.x; });
  set(result.ny, [&](unsigned k) { return edge[k]->normal.y; });
  set(result.nz, [&](unsigned k) { return edge[k]->normal.z; });
  set(result.s, [&](unsigned k) { return part[k]->begin.value; });
  set(result.t, [&](unsigned k) { return part[k]->end.value; });
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

// A part runs from a + s d to a + t d, d = b - a, along an edge with the inward normal b x a, so that the cross product
// of its ends is (s - t) times that: of length |s - t| |b x a|, and on the side of n where n . (b x a) has the sign of
// t - s.
EXACTFF_CLONES double form_factor(const visibility::EdgeCovers& visible, const Vec3& normal) {
  using namespace kernel::lanes;
  const visibility::Outlines& outlines = visible.outlines();
  Four sum = four(0.0);
  for (std::span<const Part> parts = visible.parts(); !parts.empty();) {
    FourParts p;
    gather(outlines, parts, p);
    const Four dx = p.bx - p.ax, dy = p.by - p.ay, dz = p.bz - p.az;
    const Four cosine = (p.ax * p.ax + p.ay * p.ay + p.az * p.az) + (p.s + p.t) * (p.ax * dx + p.ay * dy + p.az * dz) +
                        p.s * p.t * (dx * dx + dy * dy + dz * dz);
    const Four size = root(p.nx * p.nx + p.ny * p.ny + p.nz * p.nz);
    const Four height = normal.x * p.nx + normal.y * p.ny + normal.z * p.nz;
    const Four term = angle(absolute(p.t - p.s) * size, cosine) * height / size;
    const FourMask counts = (size > 0.0) & (FourMask{0, 1, 2, 3} < static_cast<std::int64_t>(parts.size()));
    sum += pick(counts, pick(p.t < p.s, -term, term), four(0.0));
    parts = parts.subspan(std::min<std::size_t>(4, parts.size()));
  }
  return lane_sum(sum) / (2.0 * std::numbers::pi * length(normal));
}

}  // namespace exactff::bench
