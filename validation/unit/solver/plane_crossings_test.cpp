// The heights by which the edge engine decides are never further off than their bounds, for corners that almost line
// up. EXACTFF_TEST_SCALE multiplies the number of scenes.
#include "visibility/outlines.h"

#include "generate/vectors.h"
#include "support/random_scenes.h"
#include "support/shapes.h"
#include "support/test.h"
#include "visibility/source_plane.h"

namespace exactff::visibility {
namespace {

using generate::operator*;
using generate::operator+;
using kernel::Rational;
using kernel::times_power_of_two;

// Triangles whose corners, seen from x, lie on few lines except for rounding; x is a point of the scene.
PlainScene triangles_on_few_lines(Random& random) {
  PlainScene scene;
  const auto number = [&] { return random.between(-1.0, 1.0); };
  scene.point = {number(), number(), number()};
  const Vec3 lines[] = {{number(), number(), 2.0}, {number(), number(), 2.0}, {number(), number(), 2.0}};
  for (int i = 0; i < 5; ++i) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &p = lines[k], &q = lines[(k + random.below(2)) % 3];
      const double depth = std::ldexp(random.between(0.5, 1.0), -random.integer(0, 30)), s = random.integer(0, 8) / 8.0;
      corners.push_back(scene.point + (p * s + q * (1.0 - s)) * depth);
    }
    scene.add_ring(scene.patch("source"), corners);
  }
  return scene;
}

void add_pieces(const Scene& scene, Outlines& outlines) {
  std::vector<CornerId> corners;
  for (const Piece& piece : scene.pieces()) {
    outlines.corners_of(scene.corners(piece), corners);
    outlines.add(corners, true);
  }
}

struct Answers {
  int certain = 0, declined = 0;
};

// Every corner against every edge.
void expect_true_heights(const PlainScene& plain, double unit, Answers& tally) {
  const Scene scene = generate::build(plain);
  Outlines outlines;
  outlines.start(scene, plain.point, unit);
  add_pieces(scene, outlines);
  kernel::Integer exact;
  for (const Outlines::Edge& edge : outlines.edges()) {
    for (CornerId t = 0; t < outlines.corner_count(); ++t) {
      const Height height = outlines.height(edge, t);
      outlines.set_exact_height(exact, edge, t);
      EXPECT_EQ(outlines.side(edge, t), kernel::sign(exact));
      EXPECT_EQ(kernel::sign(exact), kernel::orientation(plain.point, outlines.position(*outlines.vertex(edge.b)),
                                                         outlines.position(*outlines.vertex(edge.a)),
                                                         outlines.position(*outlines.vertex(t))));
      const bool certain = std::abs(height.value) > height.error;
      ++(certain ? tally.certain : tally.declined);
      if (!std::isfinite(height.error)) {
        EXPECT_FALSE(certain);
        continue;
      }
      const long exponent = outlines.exponent(edge.a) + outlines.exponent(edge.b) + outlines.exponent(t);
      const Rational error = abs(times_power_of_two(Rational(exact), exponent) - kernel::to_rational(height.value));
      EXPECT_LE(error, kernel::to_rational(height.error));
    }
  }
}

TEST(Outlines, HeightsAreWithinTheirError) {
  Answers tally;
  for (std::uint64_t i = 0; i < validation::scaled_count(40); ++i) {
    SCOPED_TRACE("seed " + std::to_string(validation::seed_of(i)));
    Random random(validation::seed_of(i));
    PlainScene scene = triangles_on_few_lines(random);
    const double scale = std::ldexp(1.0, random.integer(-900, 900));
    generate::scale(scene, scale);
    expect_true_heights(scene, scale, tally);
  }
  EXPECT_GT(tally.certain, tally.declined / 10);   // the filters are useful,
  EXPECT_GT(tally.declined, tally.certain / 100);  // and were also tried where they fail
}

// --- crossings with the source's plane: the double-double result is always right, or it declines ---

struct Segment {
  Vec3 x, p, q;
  Vec3 a, b, c;  // in the plane
};

Vec3 random_point(Random& random, double size) {
  return {size * random.between(-1, 1), size * random.between(-1, 1), size * random.between(-1, 1)};
}

Vec3 between(const Vec3& a, const Vec3& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

// Some segments have ends within rounding errors of the plane; some cross the plane within rounding errors of x.
Segment random_segment(Random& random) {
  const double size = std::ldexp(1.0, random.integer(-40, 40));
  Segment s{random_point(random, size), random_point(random, size), random_point(random, size),
            random_point(random, size), random_point(random, size), random_point(random, size)};
  if (random.below(3) == 0) s.p = between(between(s.a, s.b, random.between(0, 1)), s.c, random.between(0, 1));
  if (random.below(3) == 0) s.x.x = s.p.x = s.q.x;
  if (random.below(6) == 0) s.x = s.a = between(s.p, s.q, random.between(0, 1));
  return s;
}

kernel::ExactVec3 normal_of(const Segment& s) {
  const kernel::ScaledVec3 ab = kernel::exact_difference(s.b, s.a), ac = kernel::exact_difference(s.c, s.a);
  kernel::ExactVec3 normal = kernel::cross(ab.v, ac.v);
  kernel::make_primitive(normal);
  return normal;
}

int height_sign(const Segment& s, const Vec3& y) { return kernel::orientation(s.a, s.b, s.c, y); }

// The point where the segment pq crosses the plane with this normal.
void expect_holds(const PlaneCrossings::Fine& fine, PlaneCrossings& crossings, const Vec3& p, const Vec3& q,
                  const kernel::ExactVec3& normal) {
  kernel::ScaledVec3 exact;
  crossings.set_exact(exact, p, q, normal, fine.exponent);
  const Rational u = kernel::to_rational(0x1p-53);
  for (int axis = 0; axis < 3; ++axis) {
    const Rational t = kernel::times_power_of_two(Rational(exact.v[axis]), exact.exponent);
    const Rational hi = kernel::to_rational(fine.direction.hi[axis]), lo = kernel::to_rational(fine.direction.lo[axis]);
    EXPECT_LE(abs(t - hi - lo), kernel::to_rational(fine.direction.error));
    EXPECT_LE(abs(t - hi), 2 * u * abs(t));
    EXPECT_EQ(fine.direction.hi[axis] == 0.0, kernel::sign(t) == 0);
  }
}

TEST(PlaneCrossings, HoldWhatTheyPromise) {
  int fine_ones = 0, declined = 0;
  for (std::uint64_t i = 0; i < validation::scaled_count(3000); ++i) {
    Random random(validation::seed_of(i));
    const Segment s = random_segment(random);
    const kernel::ExactVec3 normal = normal_of(s);
    if (kernel::is_zero(normal) || height_sign(s, s.p) * height_sign(s, s.q) >= 0) continue;
    int scale = 0;
    std::frexp(std::abs(s.p.x - s.x.x) + std::abs(s.q.y - s.x.y) + std::abs(s.q.z - s.x.z), &scale);
    PlaneCrossings crossings;
    crossings.start(s.x, fine_normal(normal), s.a, -scale);
    const auto fine = crossings.fine(s.p, s.q);
    if (!fine) {
      ++declined;
      continue;
    }
    ++fine_ones;
    expect_holds(*fine, crossings, s.p, s.q, normal);
  }
  EXPECT_GT(fine_ones, 500);
  EXPECT_GT(declined, 20);
}

}  // namespace
}  // namespace exactff::visibility
