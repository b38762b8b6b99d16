// Eq. (4) at four points at a time (view_factors/quick_formula.h), against the same sum in long double.
#include "view_factors/quick_formula.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "generate/random.h"
#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

using generate::Random;
using Long3 = std::array<long double, 3>;

Vec3 random_point(Random& random) {
  return {random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(0.0, 1.0)};
}

Long3 minus(const Vec3& a, const Vec3& b) {
  return {static_cast<long double>(a.x) - b.x, static_cast<long double>(a.y) - b.y,
          static_cast<long double>(a.z) - b.z};
}
Long3 cross(const Long3& a, const Long3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double dot(const Long3& a, const Long3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
long double length(const Long3& a) { return std::sqrt(dot(a, a)); }

QuickPart::Segment segment(const Vec3& a, const Vec3& b) {
  const Vec3 along = kernel::difference(b, a);
  return {a, along, kernel::distance(a, b)};
}

// The edge from a to b, which the line from c to d cuts off.
struct CutEdge {
  Vec3 a, b, c, d;
  double sign = 1.0;

  [[nodiscard]] QuickPart part() const { return {segment(a, b), {{}, a, false}, {segment(c, d), {}, true}, sign}; }
  [[nodiscard]] long double term(const Vec3& normal, const Vec3& x) const {
    const Long3 p = minus(a, x), q = minus(b, x), plane = cross(p, q), other = cross(minus(c, x), minus(d, x));
    const long double at_p = std::abs(dot(other, p)), share = at_p / (at_p + std::abs(dot(other, q)));
    Long3 end;
    for (std::size_t i = 0; i < 3; ++i) end[i] = p[i] + share * (q[i] - p[i]);
    const long double angle = std::atan2(dot(cross(p, end), plane) / length(plane), dot(p, end));
    return -sign * angle * dot(plane, minus(normal, {})) / length(plane) / (2.0L * std::numbers::pi_v<long double>);
  }
};

TEST(QuickFormula, ErrsByNoMoreThanItSays) {
  Random random(1);
  const Vec3 normal{0.0, 0.0, 1.0};
  for (int round = 0; round < 2000; ++round) {
    std::vector<CutEdge> edges(1 + random.below(3));
    for (CutEdge& edge : edges) {
      edge = {random_point(random), random_point(random), random_point(random), random_point(random),
              random.one_in(2) ? 1.0 : -1.0};
    }
    // Far, near and almost on the edge: small, large and nearly straight angles.
    const CutEdge& first = edges.front();
    const double t = random.unit(), off = std::ldexp(1.0, -random.integer(0, 20));
    const Vec3 x{first.a.x + t * (first.b.x - first.a.x) + off * random.unit(),
                 first.a.y + t * (first.b.y - first.a.y) + off * random.unit(),
                 first.a.z + t * (first.b.z - first.a.z)};
    std::vector<QuickPart> parts;
    long double expected = 0.0L;
    for (const CutEdge& edge : edges) {
      parts.push_back(edge.part());
      expected += edge.term(normal, x);
    }
    Evaluated found;
    evaluate(parts, normal, {&x, 1}, {&found, 1});
    EXPECT_LE(std::abs(found.value - expected), found.rounding) << round;
    EXPECT_LT(off > 0.1 ? found.rounding : 0.0, 1e-9) << round;
  }
}

TEST(QuickFormula, PointsDoNotAffectOneAnother) {
  Random random(2);
  const Vec3 normal{0.0, 0.0, 1.0};
  const std::vector<QuickPart> parts{
      CutEdge{random_point(random), random_point(random), random_point(random), random_point(random)}.part()};
  std::vector<Vec3> points(23);
  for (Vec3& point : points) point = random_point(random);
  points[5] = parts[0].edge.a;  // nothing is known there
  std::vector<Evaluated> together(points.size());
  evaluate(parts, normal, points, together);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Evaluated alone;
    evaluate(parts, normal, {&points[i], 1}, {&alone, 1});
    EXPECT_EQ(together[i].value, alone.value) << i;
    EXPECT_EQ(together[i].rounding, alone.rounding) << i;
    EXPECT_EQ(std::isinf(alone.rounding), i == 5) << i;
  }
}

}  // namespace
}  // namespace exactff::view_factors
