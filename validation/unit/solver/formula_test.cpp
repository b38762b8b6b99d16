// The formula of a cell in doubles, judged by balls: it is precise where edges are almost seen along one another.
#include "view_factors/formula.h"

#include "kernel/ball.h"
#include "kernel/vec.h"
#include "support/test.h"
#include "unit/solver/visit_cells.h"
#include "view_factors/quick_formula.h"

namespace exactff::view_factors {
namespace {

using Kind = QuickPart::End::Kind;
using Long3 = std::array<long double, 3>;

// A triangle beside the receiver that rises a little above its plane, before a wall.
PlainScene neighbour(double height) {
  PlainScene scene;
  add(scene, "from", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add(scene, "neighbour", {{1, 0, 0}, {1, 1, height}, {0, 1, 0}});
  add(scene, "to", {{2, -1, -1}, {2, -1, 2}, {2, 3, 2}, {2, 3, -1}});
  return scene;
}

// A plate close below the source, with an edge that crosses one of the source's at a small angle.
PlainScene plate(double angle) {
  const double height = 1.0 - 0x1p-10 * angle;
  PlainScene scene;
  add(scene, "from", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(scene, "to", {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}});
  add(scene, "plate", {{0.5, -0.5, height}, {1 - angle, -0.5, height}, {1 + angle, 1.5, height}, {0.5, 1.5, height}});
  return scene;
}

struct Worst {
  std::size_t cells = 0;
  double rounding = 0.0, of_rounding = 0.0;  // the largest; the largest error over it
};

Worst worst_of(const PlainScene& scene) {
  Worst worst;
  Random random(3);
  visit_cells(generate::build(scene), "from", "to", [&](const Formula& formula, const Cell& cell) {
    ++worst.cells;
    for (int i = 0; i < 5; ++i) {
      const double s = random.between(0.25, 0.75), t = random.between(0.25, 0.75);
      const Vec3 &p = cell.corners[0].at, &q = cell.corners[1].at, &v = cell.corners[2].at;
      const auto coordinate = [&](double a, double b, double c) { return a + s * ((b - a) + t * (c - b)); };
      const Evaluated found =
          formula.at({coordinate(p.x, q.x, v.x), coordinate(p.y, q.y, v.y), coordinate(p.z, q.z, v.z)});
      const double truth = kernel::nearest_to_midpoint(value_in_balls(formula, cell, s, t));
      worst.rounding = std::max(worst.rounding, found.rounding);
      worst.of_rounding = std::max(worst.of_rounding, std::abs(found.value - truth) / found.rounding);
    }
  });
  return worst;
}

// Of every scene, which depends on a small number.
void expect_precise(PlainScene (*scene_of)(double), const std::vector<int>& exponents) {
  for (const int exponent : exponents) {
    const Worst worst = worst_of(scene_of(std::ldexp(1.0, exponent)));
    EXPECT_GT(worst.cells, 0U) << exponent;
    EXPECT_LE(worst.of_rounding, 1.0) << exponent;
    EXPECT_LE(worst.rounding, 1e-11) << exponent;
  }
}

TEST(Formula, IsPreciseWhereANeighbourIsAlmostInTheReceiversPlane) {
  expect_precise(neighbour, {-10, -20, -30, -40, -50});
}

TEST(Formula, IsPreciseWhereEdgesAlmostHideOneAnother) { expect_precise(plate, {-5, -10, -20, -30, -40}); }

// --- Eq. (4) at four points at a time (view_factors/quick_formula.h), against long doubles or balls ---

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

  [[nodiscard]] QuickPart part() const {
    return {segment(a, b), {Kind::kVertex, a, {}}, {Kind::kCrossing, {}, segment(c, d)}, sign};
  }
  [[nodiscard]] long double term(const Vec3& normal, const Vec3& x) const {
    const Long3 p = minus(a, x), q = minus(b, x), plane = cross(p, q), other = cross(minus(c, x), minus(d, x));
    const long double at_p = std::abs(dot(other, p)), share = at_p / (at_p + std::abs(dot(other, q)));
    Long3 end;
    for (std::size_t i = 0; i < 3; ++i) end[i] = p[i] + share * (q[i] - p[i]);
    const long double angle = std::atan2(dot(cross(p, end), plane) / length(plane), dot(p, end));
    return -sign * angle * dot(plane, minus(normal, {})) / length(plane) / (2.0L * std::numbers::pi_v<long double>);
  }
};

// From x on, where the planes through x and both segments meet, on the first one; nothing if that is not between the
// ends of both.
std::optional<Long3> crossing_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Long3 p = minus(a, {}), q = minus(b, {}), r = minus(c, {}), s = minus(d, {});
  const Long3 one = cross(p, q), other = cross(r, s);
  const long double at_p = dot(other, p), at_q = dot(other, q);
  if (!(at_p * at_q < 0.0L) || !(dot(one, r) * dot(one, s) < 0.0L)) return std::nullopt;
  const long double share = at_p / (at_p - at_q);
  Long3 at;
  for (std::size_t i = 0; i < 3; ++i) at[i] = p[i] + share * (q[i] - p[i]);
  return at;
}

long double term_of(const Vec3& a, const Vec3& b, const Long3& from, const Long3& to, double sign, const Vec3& normal) {
  const Long3 plane = cross(minus(a, {}), minus(b, {}));
  const long double angle = std::atan2(dot(cross(from, to), plane) / length(plane), dot(from, to));
  return -sign * angle * dot(plane, minus(normal, {})) / length(plane) / (2.0L * std::numbers::pi_v<long double>);
}

// A triangle round x that is hardly above its plane: from a corner along two lines, which the side beyond cuts off.
// Where they cross may be anywhere, as far as doubles tell.
TEST(QuickFormula, KnowsWhereEdgesNearTheHorizonMayTurnRoundThePoint) {
  Random random(5);
  const double size = std::sqrt(0.3 * 0.3 + 0.7 * 0.7 + 1.0);
  const Vec3 normal{-0.3 / size, -0.7 / size, 1.0 / size}, x{};
  std::size_t known = 0, round_x = 0;
  for (int round = 0; round < 200000; ++round) {
    const double height = std::ldexp(1.0, -random.integer(20, 60));
    const auto point = [&] {
      const double u = random.between(-1.0, 1.0), v = random.between(-1.0, 1.0);
      return Vec3{u, v, 0.3 * u + 0.7 * v + height * random.unit()};
    };
    const Vec3 corner = point(), a = point(), b = point(), c = point(), d = point();
    const auto first = crossing_of(a, b, corner, c), second = crossing_of(a, b, corner, d);
    if (!first || !second) continue;
    const Long3 start = minus(corner, x);
    const long double expected = term_of(a, b, *first, *second, 1.0, normal) +
                                 term_of(corner, d, start, *second, -1.0, normal) +
                                 term_of(corner, c, start, *first, 1.0, normal);
    const QuickPart::Segment side = segment(a, b), to_c = segment(corner, c), to_d = segment(corner, d);
    const QuickPart::End at_corner{Kind::kVertex, corner, {}};
    const std::vector<QuickPart> parts{{side, {Kind::kSharedOnEdge, {}, to_c}, {Kind::kSharedOnEdge, {}, to_d}, 1.0},
                                       {to_d, at_corner, {Kind::kSharedOnOther, {}, side}, -1.0},
                                       {to_c, at_corner, {Kind::kSharedOnOther, {}, side}, 1.0}};
    Evaluated found;
    evaluate(parts, normal, {&x, 1}, {&found, 1});
    if (!(found.rounding < 0x1p-6)) continue;
    ++known;
    round_x += std::abs(expected) > 0.5L ? 1 : 0;
    EXPECT_LE(std::abs(found.value - expected), found.rounding) << round;
  }
  EXPECT_GE(known, 1000U);
  EXPECT_GE(round_x, 10U);
}

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

// --- Two parts that end at one crossing, judged by balls ---

using Ball3 = std::array<Ball, 3>;

Ball3 minus_in_balls(const Vec3& a, const Vec3& b) {
  constexpr long kBits = 400;
  const auto difference = [](double p, double q) { return kernel::to_ball(p, kBits) - kernel::to_ball(q, kBits); };
  return {difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z)};
}
Ball3 cross(const Ball3& a, const Ball3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Ball dot(const Ball3& a, const Ball3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The edges from a to b and from c to d, as seen from x; the parts are a to the crossing, and from there to d.
struct Crossed {
  Vec3 a, b, c, d, x;

  [[nodiscard]] std::vector<QuickPart> parts() const {
    return {{segment(a, b), {Kind::kVertex, a, {}}, {Kind::kSharedOnEdge, {}, segment(c, d)}, 1.0},
            {segment(c, d), {Kind::kSharedOnOther, {}, segment(a, b)}, {Kind::kVertex, d, {}}, 1.0}};
  }
  // Nothing if they do not cross for certain.
  [[nodiscard]] std::optional<double> value() const {
    const Ball3 p = minus_in_balls(a, x), q = minus_in_balls(b, x), v = minus_in_balls(c, x), w = minus_in_balls(d, x);
    const Ball3 one = cross(p, q), other = cross(v, w);
    const std::optional<Ball3> on_one = crossing(p, q, other), on_other = crossing(v, w, one);
    if (!on_one || !on_other || !(kernel::nearest_to_midpoint(dot(*on_one, *on_other)) > 0.0)) return std::nullopt;
    return kernel::nearest_to_midpoint(term(p, *on_one, one) + term(*on_other, w, other));
  }

 private:
  static std::optional<Ball3> crossing(const Ball3& from, const Ball3& to, const Ball3& plane) {
    const Ball at_from = dot(plane, from), at_to = dot(plane, to);
    if (!(kernel::nearest_to_midpoint(at_from) * kernel::nearest_to_midpoint(at_to) < 0.0)) return std::nullopt;
    const Ball share = at_from / (at_from - at_to);
    Ball3 at;
    for (std::size_t i = 0; i < 3; ++i) at[i] = from[i] + (to[i] - from[i]) * share;
    return at;
  }
  // For the normal (0, 0, 1).
  static Ball term(const Ball3& from, const Ball3& to, const Ball3& plane) {
    const Ball size = sqrt(dot(plane, plane)), angle = atan2(dot(cross(from, to), plane) / size, dot(from, to));
    return kernel::to_ball(0.0, 400) - angle * plane[2] / (size * twice(kernel::pi(400)));
  }
};

Vec3 shifted(const Vec3& at, double far, const Vec3& along) {
  return {at.x + far * along.x, at.y + far * along.y, at.z + far * along.z};
}

// Almost along one another: both through one direction, the second one turned by `turn` about it.
Crossed almost_along(Random& random, double turn) {
  const Vec3 x = random_point(random), to = random_point(random), along = random_point(random);
  const Vec3 at = shifted(x, 0.5, to), beyond = shifted(x, 0.5 + 0.5 * random.unit(), to);
  const Vec3 turned = shifted(along, turn, random_point(random));
  return {shifted(at, -0.3, along), shifted(at, 0.4, along), shifted(beyond, -0.5, turned),
          shifted(beyond, 0.3, turned), x};
}

// The second one is seen almost end-on.
Crossed end_on(Random& random, double aside) {
  const Vec3 x = random_point(random), to = random_point(random), off = random_point(random);
  const Vec3 near = shifted(x, 0.25, to), far = shifted(x, 0.75, to);
  const Vec3 along = random_point(random), at = shifted(shifted(x, 0.5, to), 0.3 * aside, off);
  return {shifted(at, -0.3, along), shifted(at, 0.4, along), shifted(near, aside, off),
          shifted(far, -aside * random.unit(), off), x};
}

TEST(QuickFormula, OfASharedCrossingErrsByNoMoreThanItSays) {
  Random random(3);
  const Vec3 normal{0.0, 0.0, 1.0};
  std::size_t seen = 0, precise = 0;
  for (int round = 0; round < 4000; ++round) {
    const double small = std::ldexp(1.0, -random.integer(1, 40));
    const bool is_end_on = round % 2 == 0;
    const Crossed crossed = is_end_on ? end_on(random, small) : almost_along(random, small);
    const std::optional<double> expected = crossed.value();
    if (!expected) continue;
    ++seen;
    Evaluated found;
    evaluate(crossed.parts(), normal, {&crossed.x, 1}, {&found, 1});
    EXPECT_LE(std::abs(found.value - *expected), found.rounding) << round;
    precise += is_end_on || found.rounding < 1e-10 ? 1 : 0;
  }
  EXPECT_GT(seen, 2000U);
  EXPECT_GT(precise, seen - seen / 50);
}

}  // namespace
}  // namespace exactff::view_factors
