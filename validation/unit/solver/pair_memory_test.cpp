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
