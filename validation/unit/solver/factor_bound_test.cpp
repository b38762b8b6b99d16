// What is known of a pair before any cell: a bound of its form factors, and the shaft between its boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/vec.h"
#include "support/random_scenes.h"
#include "unit/solver/factor_at.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {
namespace {

using generate::PlainScene;
using generate::Random;
using validation::scaled_count;
using validation::seed_of;

Scene two_triangles(Random& random) {
  PlainScene scene;
  const double size = std::ldexp(1.0, -random.integer(0, 6)), gap = std::ldexp(1.0, -random.integer(0, 4));
  const auto corner = [&](double x) {
    return Vec3{x + size * random.unit(), size * random.unit(), size * random.unit()};
  };
  scene.add_ring(scene.patch("receiver"), {corner(0), corner(0), corner(0)});
  scene.add_ring(scene.patch("source"), {corner(size + gap), corner(size + gap), corner(size + gap)});
  return generate::build(scene);
}

TEST(FactorBound, IsAtLeastEveryFormFactorOfTheCell) {
  int tight = 0, seeing = 0;
  for (std::uint64_t s = 0; s < scaled_count(400); ++s) {
    Random random(seed_of(s));
    const Scene scene = two_triangles(random);
    const ExactScene exact(scene);
    const Part receiver = parts_of(exact, scene.select("receiver")).front();
    const Part source = parts_of(exact, scene.select("source")).front();
    const auto sight = sight_of(exact, SeenParts(exact).seen_from(receiver).occluders, receiver, source);
    if (!sight) continue;
    ++seeing;
    const double bound = FactorBound(*sight).on(sight->root);
    EXPECT_LE(bound, 1.0);
    const ExactSource from(scene, scene.select("source"));
    double largest = 0.0;
    for (const Point& corner : sight->root.corners) {
      largest = std::max(largest, factor_at(exact, corner.at, sight->receiver, receiver.face, from));
    }
    EXPECT_LE(largest, bound * (1.0 + 0x1p-30));
    tight += largest > 0.25 * bound ? 1 : 0;
  }
  EXPECT_GE(seeing, 40);
  EXPECT_GE(tight, seeing / 4) << "of small patches, it should be of the order of the factor";
}

// Of hulls of all sizes about a point of the receiver, also of those that lie on both sides of the source's plane.
TEST(OpenFactorBound, IsAtLeastEveryFormFactorOfTheHull) {
  int tight = 0, small = 0;
  for (std::uint64_t s = 0; s < scaled_count(400); ++s) {
    Random random(seed_of(s));
    const Scene scene = two_triangles(random);
    const ExactScene exact(scene);
    const Part receiver = parts_of(exact, scene.select("receiver")).front();
    const Part source = parts_of(exact, scene.select("source")).front();
    const Plane plane = plane_of(receiver, exact.units);
    const OpenFactorBound bound(positions_of(source.corners), plane);
    const std::vector<Vec3> corners = positions_of(receiver.corners);
    const Vec3 middle = kernel::scaled(kernel::sum(kernel::sum(corners[0], corners[1]), corners[2]), 1.0 / 3.0);
    const ExactSource from(scene, scene.select("source"));
    for (const double size : {1.0, 0.25, 0x1p-12}) {
      std::vector<Vec3> hull;
      for (const Vec3& corner : corners)
        hull.push_back(kernel::along(middle, kernel::difference(corner, middle), size));
      const double largest = bound.on(hull);
      double found = 0.0;
      for (const Vec3& at : hull) {
        found = std::max(found, factor_at(exact, at, plane, receiver.face, from));
      }
      EXPECT_LE(found, largest) << s << ' ' << size;
      if (size > 0.1 || found == 0.0) continue;
      ++small;
      tight += largest <= found + 0.01 ? 1 : 0;
    }
  }
  EXPECT_GE(small, 40);
  EXPECT_GE(tight, small / 2);
}

TEST(PairShaft, HoldsEverySegmentBetweenTheBoxes) {
  int outside = 0;
  for (std::uint64_t s = 0; s < scaled_count(2000); ++s) {
    Random random(seed_of(s));
    const auto point = [&] {
      const auto coordinate = [&] { return static_cast<double>(random.integer(-8, 8)) / 8.0; };
      return Vec3{coordinate(), coordinate(), coordinate()};
    };
    const auto box = [&] {
      Box result;
      result.include(point());
      if (random.one_in(2)) result.include(point());
      return result;
    };
    const Box a = box(), b = box();
    const PairShaft shaft(a, b);
    const auto inside = [&](const Box& of) {
      const auto between = [&](double low, double high) { return low + random.unit() * (high - low); };
      return Vec3{between(of.low.x, of.high.x), between(of.low.y, of.high.y), between(of.low.z, of.high.z)};
    };
    const Vec3 p = inside(a), q = inside(b);
    const double t = random.unit();
    Box at;
    at.include({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)});
    EXPECT_FALSE(shaft.is_outside(at));
    outside += shaft.is_outside(box()) ? 1 : 0;
  }
  EXPECT_GE(outside, 500);
}

}  // namespace
}  // namespace exactff::view_factors
