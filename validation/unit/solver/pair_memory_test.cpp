// What a pair of patches remembers of its cells, and the filter before exact planes.
#include <gmpxx.h>

#include "kernel/filter.h"
#include "support/test.h"
#include "view_factors/cell.h"

namespace exactff::view_factors {
namespace {

using Exact3 = std::array<mpq_class, 3>;

TEST(PairMemory, SignsHoldForTheCellAndItsParts) {
  PairMemory memory;
  memory.start(0, 4, 5);
  EXPECT_EQ(memory.sign(1, 2), kUnasked);
  memory.keep_sign(1, 2, -1);
  EXPECT_EQ(memory.sign(1, 2), -1);
  EXPECT_EQ(memory.sign(2, 1), kUnasked);
  memory.enter(1);
  memory.keep_sign(3, 4, 1);
  memory.enter(2);
  EXPECT_EQ(memory.sign(1, 2), -1);
  EXPECT_EQ(memory.sign(3, 4), 1);
  memory.enter(1);  // the other part of the first cell
  EXPECT_EQ(memory.sign(1, 2), -1);
  EXPECT_EQ(memory.sign(3, 4), kUnasked);
  memory.enter(2);
  EXPECT_EQ(memory.sign(3, 4), kUnasked);
  memory.enter(0);
  EXPECT_EQ(memory.sign(1, 2), kUnasked);
}

// Points in or near a plane, on a grid in which many are exactly in it.
TEST(RoundedPlane, NeverContradictsTheExactSide) {
  Random random(21);
  const Units units{-40, 40};
  std::size_t decided = 0, declined = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double step = random.below(2) == 0 ? 0x1p-3 : 0x1p-39;
    const auto coordinate = [&] { return 0.5 + step * (static_cast<double>(random.below(7)) - 3.0); };
    std::vector<Point> p;
    for (int i = 0; i < 4; ++i) p.push_back(point_of({coordinate(), coordinate(), coordinate()}, units));
    const Plane plane = make_plane(join(p[0], p[1], p[2]), units);
    const int found = RoundedPlane(p[0], p[1], p[2]).side_of(p[3]);
    if (found == kernel::kUncertain) {
      ++declined;
    } else {
      EXPECT_EQ(found, side_of(plane, p[3]));
      ++decided;
    }
  }
  EXPECT_GT(decided, 500U);
  EXPECT_GT(declined, 50U);
}

// --- The filter of crossing orders (view_factors/cell.h), where three lines almost meet as seen from the cell ---

Exact3 minus(const Vec3& a, const Vec3& b) {
  return {mpq_class(a.x) - b.x, mpq_class(a.y) - b.y, mpq_class(a.z) - b.z};
}
Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// det(N_e, N_g, N_h) at x.
int exact_sign(const std::vector<Vec3>& ends, const Vec3& x) {
  const auto normal = [&](std::size_t i) { return cross(minus(ends[i], x), minus(ends[i + 1], x)); };
  const Exact3 e = normal(0), gh = cross(normal(2), normal(4));
  return sgn(mpq_class(e[0] * gh[0] + e[1] * gh[1] + e[2] * gh[2]));
}

// Both ends of a line through the point, as well as doubles can be.
void add_line(Random& random, const Vec3& through, double size, std::vector<Vec3>& ends) {
  const Vec3 d{size * random.between(-1.0, 1.0), size * random.between(-1.0, 1.0), size * random.between(-1.0, 1.0)};
  ends.push_back({through.x - d.x, through.y - d.y, through.z - d.z});
  ends.push_back({through.x + d.x, through.y + d.y, through.z + d.z});
}

TEST(CrossingOrder, IsThatOfEveryCornerWhereLinesAlmostMeet) {
  Random random(1);
  int decided = 0, signs_of_corners = 0;
  for (int round = 0; round < 1000; ++round) {
    const auto coarse = [&] { return std::ldexp(random.integer(-1000, 1000), -10); };
    const Vec3 centre{coarse(), coarse(), 0.0};
    const double off = std::ldexp(1.0, -random.integer(20, 50));
    const std::vector<Vec3> corners{
        {centre.x, centre.y, 0.0}, {centre.x + off, centre.y, 0.0}, {centre.x, centre.y + off, 0.0}};
    const Vec3 direction{random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(0.5, 1.0)};
    std::vector<Vec3> ends;
    for (int line = 0; line < 3; ++line) {
      const double t = random.between(0.2, 0.9);
      add_line(random, {centre.x + t * direction.x, centre.y + t * direction.y, t * direction.z},
               std::ldexp(1.0, -random.integer(1, 12)), ends);
    }
    std::vector<Vec3> all = ends;
    all.insert(all.end(), corners.begin(), corners.end());
    const Units units = Units::of(all);
    Points points(units);
    std::vector<PointId> ids;
    for (const Vec3& v : all) ids.push_back(points.add(point_of(v, units)));
    const Ring ring = points.ring({ids[6], ids[7], ids[8]});
    const Cell cell = cell_of(points, ring, make_plane(join(points[ids[6]], points[ids[7]], points[ids[8]]), units));
    std::array<LineId, 3> lines{};
    for (std::size_t i = 0; i < 3; ++i) lines[i] = points.ring({ids[2 * i], ids[2 * i + 1], ids[6]}).front().line;
    const int order = crossing_order(points, cell, lines[0], lines[1], lines[2]);
    if (order == kMixed) continue;
    ++decided;
    for (const Vec3& corner : corners) {
      const int sign = exact_sign(ends, corner);
      EXPECT_TRUE(sign == 0 || sign == order) << round;
      signs_of_corners += sign != 0 ? 1 : 0;
    }
  }
  EXPECT_GE(decided, 150);
  EXPECT_GE(signs_of_corners, 450);
}

}  // namespace
}  // namespace exactff::view_factors
