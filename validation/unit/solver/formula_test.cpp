// The formula of a cell in doubles, judged by balls: it is precise where edges are almost seen along one another.
#include "view_factors/formula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "generate/plain_scene.h"
#include "generate/random.h"
#include "unit/solver/visit_cells.h"

namespace exactff::view_factors {
namespace {

using generate::PlainScene;
using validation::value_in_balls;
using validation::visit_cells;

void add(PlainScene& scene, const std::string& name, const std::vector<Vec3>& corners) {
  scene.add_ring(scene.patch(name), corners);
}

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
  generate::Random random(3);
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

}  // namespace
}  // namespace exactff::view_factors
