// What is known of a pair before any cell: a bound of its form factors, and the shaft between its boxes.
#include "kernel/vec.h"
#include "support/test.h"
#include "unit/solver/factor_at.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/left_out.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {
namespace {

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

// A wall or a ceiling as the source, a floor or a part of it as the receiver, and triangles between: low ones, such
// that stand at the wall, any.
struct Hiding {
  PlainScene open;                        // "receiver" and "source"
  std::vector<std::vector<Vec3>> things;  // faces that hide some of it

  [[nodiscard]] Scene with(std::size_t first, std::size_t count) const {
    PlainScene scene = open;
    for (std::size_t i = first; i < first + count; ++i)
      scene.add_ring(scene.patch("thing" + std::to_string(i)), things[i]);
    return generate::build(scene);
  }
  // The mean over random points of the receiver.
  [[nodiscard]] std::vector<double> factors(std::size_t first, std::size_t count, std::uint64_t seed) const {
    const Scene scene = with(first, count);
    const ExactSource source(scene, scene.select("source"));
    std::vector<double> values;
    for (const Receiver& receiver : sample_receivers(scene, scene.faces_of(scene.select("receiver")), 256, seed)) {
      values.push_back(exact_form_factor(scene, receiver, source).value);
    }
    return values;
  }
};

// One before a wall that hides another but for slivers.
Hiding random_cover(Random& random) {
  Hiding hiding;
  hiding.open.add_ring(hiding.open.patch("receiver"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  hiding.open.add_ring(hiding.open.patch("source"), {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  const double small = 0x1p-8 * random.unit(), x = std::ldexp(1.0, -random.integer(2, 8)), high = random.unit();
  const auto aside = [&] { return random.between(-small, small); };
  hiding.things.push_back({{x, 0, 0}, {x, 1, 0}, {x, 1, high}, {x, 0, high}});
  const double y = aside(), to_y = 1.0 + aside(), to_z = high + aside();
  hiding.things.push_back({{0.5 * x, y, 0}, {0.5 * x, to_y, 0}, {0.5 * x, to_y, to_z}, {0.5 * x, y, to_z}});
  return hiding;
}

Hiding random_hiding(Random& random) {
  if (random.one_in(4)) return random_cover(random);
  Hiding hiding;
  const double size = random.one_in(2) ? 1.0 : std::ldexp(1.0, -random.integer(0, 6));
  const double x = (1.0 - size) * random.unit(), y = (1.0 - size) * random.unit();
  hiding.open.add_ring(hiding.open.patch("receiver"),
                       {{x, y, 0}, {x + size, y, 0}, {x + size, y + size, 0}, {x, y + size, 0}});
  generate::PlainPatch& source = hiding.open.patch("source");
  if (random.one_in(2)) {
    hiding.open.add_ring(source, {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  } else {
    hiding.open.add_ring(source, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  }
  const double small = std::ldexp(1.0, -random.integer(0, 12));
  const int kind = random.integer(0, 3);
  const auto corner = [&] {
    Vec3 v{random.between(-0.2, 1.2), random.between(-0.2, 1.2), random.unit()};
    if (kind == 0) v.z = small * v.z;
    if (kind == 1) v.x = small * v.x;
    if (kind == 2) v.y = small * (v.y - 0.5);
    return v;
  };
  for (int i = 0; i < 2; ++i) hiding.things.push_back({corner(), corner(), corner()});
  // The second is perhaps about the first one, but for a sliver.
  if (random.one_in(2)) {
    hiding.things[1] = hiding.things[0];
    for (Vec3& v : hiding.things[1])
      v = {v.x + small * random.unit(), v.y + small * random.unit(), v.z + small * random.unit()};
  }
  return hiding;
}

// The mean of how much less is seen, and five standard errors of it.
std::pair<double, double> mean_of_difference(const std::vector<double>& more, const std::vector<double>& less) {
  double sum = 0.0, squares = 0.0;
  const auto n = static_cast<double>(more.size());
  for (std::size_t i = 0; i < more.size(); ++i) sum += more[i] - less[i];
  for (std::size_t i = 0; i < more.size(); ++i) squares += std::pow(more[i] - less[i] - sum / n, 2);
  return {sum / n, 5.0 * std::sqrt(squares / n / (n - 1.0))};
}

TEST(HiddenBound, IsAtLeastWhatIsHidden) {
  int hidden = 0, covered = 0, small = 0;
  for (std::uint64_t s = 0; s < scaled_count(300); ++s) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(s)));
    Random random(seed_of(s));
    const Hiding hiding = random_hiding(random);
    const Scene scene = hiding.with(0, 2);
    const ExactScene exact(scene);
    const Part receiver = parts_of(exact, scene.select("receiver")).front();
    const Part source = parts_of(exact, scene.select("source")).front();
    const auto sight = sight_of(exact, SeenParts(exact).seen_from(receiver).occluders, receiver, source);
    if (!sight || sight->occluders.size() != 2) continue;
    const std::vector<Vec3> corners = positions_of(sight->root.corners);
    const double size = area(corners);
    std::vector<Vec3> directions;
    for (const Plane& plane : {sight->receiver, *sight->occluders[0].plane, *sight->occluders[1].plane}) {
      directions.push_back(Side::of(plane).normal);
    }
    const auto open = hiding.factors(0, 0, s), first = hiding.factors(0, 1, s), both = hiding.factors(0, 2, s);
    const HiddenBound bound(*sight, sight->source_plane, directions, sight->occluders[0]);
    const double most = bound.on(corners, 1.0, size) / size;
    const auto [by_first, error] = mean_of_difference(open, first);
    EXPECT_LE(by_first - error, most);
    hidden += by_first > error ? 1 : 0;
    small += most < 0.1 ? 1 : 0;
    const double most_of_second = CoverBound(*sight, 1, 0, {}).on(corners, 1.0, size) / size;
    const auto [by_second, error_of_second] = mean_of_difference(first, both);
    EXPECT_LE(by_second - error_of_second, most_of_second);
    covered += most_of_second < 0.1 ? 1 : 0;
  }
  EXPECT_GE(hidden, 60);
  EXPECT_GE(small, 40);
  EXPECT_GE(covered, 20);
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
