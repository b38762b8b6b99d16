// The heights by which the edge engine decides are never further off than their bounds, for corners that almost line
// up.
// EXACTFF_TEST_SCALE multiplies the number of scenes.
#include "visibility/outlines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "generate/plain_scene.h"
#include "generate/random.h"
#include "generate/vectors.h"
#include "support/random_scenes.h"

namespace exactff::visibility {
namespace {

using generate::PlainScene;
using generate::Random;
using generate::operator+;
using generate::operator*;
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

// The unit is far from the distances, so only exact results are certain.
TEST(Outlines, DecidesExactlyWhereTheFiltersDecline) {
  for (const double scale : {0x1p-700, 0x1p-350, 0x1p350, 0x1p700}) {
    Random random(validation::seed_of(0));
    PlainScene scene = triangles_on_few_lines(random);
    generate::scale(scene, scale);
    Answers tally;
    expect_true_heights(scene, 1.0, tally);
    EXPECT_EQ(tally.certain, 0) << scale;
  }
}

}  // namespace
}  // namespace exactff::visibility
