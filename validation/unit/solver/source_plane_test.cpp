// A source with several faces, or with a hole: overlaps count once, separate planes are added, back faces do not count.
#include "visibility/source_plane.h"

#include <gtest/gtest.h>

#include "generate/plain_scene.h"
#include "support/solve.h"

namespace exactff {
namespace {

using generate::PlainScene;
using validation::solve;
using Corners = std::vector<Vec3>;

// A rectangle at height z that faces down.
Corners rectangle(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y1, z}, {x1, y1, z}, {x1, y0, z}, {x0, y0, z}};
}

PlainScene source_of(const std::vector<Corners>& faces) {
  PlainScene scene;
  for (const Corners& face : faces) scene.add_ring(scene.patch("source"), face);
  return scene;
}

Enclosure form_factor(const Corners& face) { return solve(source_of({face})).enclosure; }

// Two balls of about 90 bits, or sums of such balls, that contain the same number.
void expect_equal(const Enclosure& a, const Enclosure& b) {
  EXPECT_TRUE(a.overlaps(b)) << a.midpoint() << " and " << b.midpoint();
  EXPECT_LT(a.upper() - a.lower(), 0x1p-50);
  EXPECT_LT(b.upper() - b.lower(), 0x1p-50);
}

TEST(SourcePlane, StepsInParallelPlanesCountEachForItself) {
  const Corners low = rectangle(-1, 0, -1, 1, 1);
  const Corners high = rectangle(0, 1, -1, 1, 2);
  const PlainScene plain = source_of({low, high});
  const Scene scene = generate::build(plain);
  EXPECT_EQ(visibility::group_by_plane(scene, scene.faces_of(scene.select("source"))).size(), 2U);
  Enclosure sum = form_factor(low);
  sum += form_factor(high);
  expect_equal(solve(plain).enclosure, sum);
}

TEST(SourcePlane, AnOverlapCountsOnceInTheVisibleFraction) {
  PlainScene plain = source_of({rectangle(-1, 0.5, -1, 1, 1), rectangle(-0.5, 1, -1, 1, 1)});
  EXPECT_EQ(solve(plain, {.visible_fraction = true}).visible_part, VisiblePart::kAll);
  plain.add_ring(plain.patch("right_half"), rectangle(0, 1, -1, 1, 0.5));
  EXPECT_EQ(solve(plain, {.visible_fraction = true}).visible_fraction, 0.5);
}

TEST(SourcePlane, AHoleGivesNothing) {
  const Corners inner = rectangle(-0.5, 0.25, -0.5, 0.75, 1);
  PlainScene framed;
  framed.add_rings(framed.patch("source"), {rectangle(-1, 1, -1, 1, 1), inner});
  Enclosure sum = solve(framed).enclosure;
  sum += form_factor(inner);
  expect_equal(sum, form_factor(rectangle(-1, 1, -1, 1, 1)));
}

}  // namespace
}  // namespace exactff
