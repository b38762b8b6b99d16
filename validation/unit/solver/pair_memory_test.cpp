// What a pair of patches remembers of its cells, and the filter before exact planes.
#include <gtest/gtest.h>

#include <vector>

#include "generate/random.h"
#include "kernel/filter.h"
#include "view_factors/cell.h"

namespace exactff::view_factors {
namespace {

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

// After other cells, and after another pair has asked for the same signs.
TEST(PairMemory, ResumesAtACellOfBefore) {
  PairMemory memory;
  memory.start(0, 4, 5);
  memory.keep_sign(1, 2, -1);
  memory.enter(1);
  memory.keep_sign(3, 4, 1);
  const PairMemory::Way way = memory.way();
  memory.enter(1);
  memory.keep_sign(2, 2, 1);
  memory.start(1, 4, 5);
  EXPECT_EQ(memory.sign(1, 2), kUnasked);
  memory.keep_sign(2, 3, 1);
  memory.resume(0, 4, 5, way);
  EXPECT_EQ(memory.sign(3, 4), 1);
  memory.enter(2);
  EXPECT_EQ(memory.sign(1, 2), -1);
  EXPECT_EQ(memory.sign(3, 4), 1);
  EXPECT_EQ(memory.sign(2, 2), kUnasked);
  EXPECT_EQ(memory.sign(2, 3), kUnasked);
}

TEST(PairMemory, MixedSignsHoldForTheCellAlone) {
  PairMemory memory;
  memory.start(0, 4, 5);
  memory.keep_sign(0, 0, kMixed);
  memory.keep_sign(0, 1, kMixedAndSeen);
  EXPECT_EQ(memory.sign(0, 0), kMixed);
  EXPECT_EQ(memory.sign(0, 1), kMixedAndSeen);
  memory.enter(1);
  EXPECT_EQ(memory.sign(0, 0), kUnasked);
  EXPECT_EQ(memory.sign(0, 1), kUnasked);
}

TEST(PairMemory, TellsPairsApart) {
  PairMemory memory;
  memory.start(0, 4, 5);
  memory.keep_sign(1, 2, 1);
  memory.start(1, 4, 5);
  EXPECT_EQ(memory.sign(1, 2), kUnasked);
  const Units units{0, 1};
  Points one(units), two(units);
  const auto add = [&](Points& points, const std::vector<Vec3>& corners) {
    std::vector<PointId> ids;
    for (const Vec3& corner : corners) ids.push_back(points.add(point_of(corner, units)));
    return points.ring(ids);
  };
  add(one, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  add(two, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  memory.start(0, 3, 3);
  const Homogeneous first = memory.plane(one, 0, 2)->exact;
  memory.start(1, 3, 3);
  EXPECT_NE(memory.plane(two, 0, 2)->exact, first);
  memory.start(0, 3, 3);
  EXPECT_EQ(memory.plane(one, 0, 2)->exact, first);
}

// Signs that share a place push one another out; none is mistaken for another.
TEST(PairMemory, ForgetsButNeverErrs) {
  constexpr LineId kLines = 3000;
  constexpr PointId kPoints = 1000;
  PairMemory memory;
  memory.start(0, kLines, kPoints);
  const auto sign_of = [](LineId line, PointId point) { return static_cast<int>((line * 7 + point) % 3) - 1; };
  std::size_t known = 0;
  for (LineId line = 0; line < kLines; line += 3) {
    for (PointId point = 0; point < kPoints; point += 7) {
      if (memory.sign(line, point) == kUnasked) memory.keep_sign(line, point, sign_of(line, point));
      const LineId earlier = line / 2;
      const int sign = memory.sign(earlier, point);
      if (sign == kUnasked) continue;
      EXPECT_EQ(sign, sign_of(earlier, point));
      ++known;
    }
  }
  EXPECT_GT(known, 1000U);
}

// By integers alone.
int exact_side(const Plane& plane, const Point& point) {
  Integer sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += plane.exact[i] * point.exact[i];
  return sgn(sum);
}

// Of short coordinates, from the first one that is rounded to those of which nothing is.
TEST(RoundedPlane, IsExactForShortCoordinates) {
  generate::Random random(22);
  std::size_t in_plane = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const int bits = random.integer(2, 26);
    const Units units{0, bits};
    const int most = random.one_in(2) ? (1 << bits) - 1 : 3;
    const auto coordinate = [&] { return static_cast<double>(random.integer(-most, most)); };
    std::vector<Point> p;
    for (int i = 0; i < 4; ++i) p.push_back(point_of({coordinate(), coordinate(), coordinate()}, units));
    const Plane plane = make_plane(join(p[0], p[1], p[2]), units);
    const int exact = exact_side(plane, p[3]);
    EXPECT_EQ(side_of(plane, p[3]), exact);
    const int found = RoundedPlane(p[0], p[1], p[2]).side_of(p[3]);
    EXPECT_TRUE(found == exact || (found == kernel::kUncertain && most >= 1 << 15));
    in_plane += exact == 0 ? 1U : 0U;
  }
  EXPECT_GT(in_plane, 500U);
}

// Points in or near a plane, on a grid in which many are exactly in it.
TEST(RoundedPlane, NeverContradictsTheExactSide) {
  generate::Random random(21);
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

}  // namespace
}  // namespace exactff::view_factors
