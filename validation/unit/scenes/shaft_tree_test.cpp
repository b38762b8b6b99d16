// The bounding-volume tree never loses a piece that may meet a half-space.
#include "scene/shaft_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "generate/random.h"

namespace exactff {
namespace {

using generate::Random;

std::vector<Box> random_boxes(Random& random, std::size_t count, double scale) {
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 low{scale * random.between(-4, 4), scale * random.between(-4, 4), scale * random.between(-4, 4)};
    const auto side = [&] { return scale * random.unit(); };
    boxes.push_back({low, {low.x + side(), low.y + side(), low.z + side()}});
  }
  return boxes;
}

std::set<std::uint32_t> found(const ShaftTree& tree, const Vec3& apex, const std::vector<HalfSpace>& shaft) {
  std::set<std::uint32_t> result;
  tree.query(apex, shaft, [&](std::uint32_t i) {
    EXPECT_TRUE(result.insert(i).second) << "visited twice";
    return true;
  });
  return result;
}

std::vector<HalfSpace> random_shaft(Random& random) {
  std::vector<HalfSpace> shaft;
  for (int i = 0; i < 4; ++i) {
    shaft.push_back({{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}, random.between(-2, 1)});
  }
  return shaft;
}

TEST(ShaftTree, FindsExactlyWhatATestOfEveryBoxFinds) {
  Random random(1);
  const std::vector<Box> boxes = random_boxes(random, 500, 1.0);
  const ShaftTree tree(boxes);
  for (int round = 0; round < 50; ++round) {
    const Vec3 apex{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const std::vector<HalfSpace> shaft = random_shaft(random);
    std::set<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (!ShaftTree::certainly_outside(boxes[i], apex, shaft)) expected.insert(i);
    }
    ASSERT_EQ(found(tree, apex, shaft), expected);
  }
}

double corner(double low, double high, unsigned bit) { return bit != 0 ? high : low; }

bool all_corners_inside(const Box& b, const Vec3& apex, const HalfSpace& h) {
  for (unsigned c = 0; c < 8; ++c) {
    const Vec3 y{corner(b.low.x, b.high.x, c & 1U), corner(b.low.y, b.high.y, c & 2U),
                 corner(b.low.z, b.high.z, c & 4U)};
    const double height =
        h.normal.x * (y.x - apex.x) + h.normal.y * (y.y - apex.y) + h.normal.z * (y.z - apex.z) - h.offset;
    if (height <= 0.0) return false;
  }
  return true;
}

TEST(ShaftTree, KnowsWhatLiesInside) {
  Random random(3);
  const std::vector<Box> boxes = random_boxes(random, 500, 0.5);
  const ShaftTree tree(boxes);
  std::size_t count = 0;
  for (int round = 0; round < 50; ++round) {
    const Vec3 apex{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const std::vector<HalfSpace> shaft = random_shaft(random);
    tree.query_with_inside(apex, HalfSpaceGroups(shaft), [&](std::uint32_t i, bool inside) {
      const auto holds = [&](const HalfSpace& h) { return all_corners_inside(boxes[i], apex, h); };
      EXPECT_EQ(inside, std::ranges::all_of(shaft, holds)) << i;
      count += inside ? 1U : 0U;
      return true;
    });
  }
  EXPECT_GT(count, 100U);
}

// The result is uncertain for a box that touches the half-space's plane or is within the error bounds.
TEST(ShaftTree, TakesNothingForInsideThatMayNotBe) {
  const Box box{{1, 0, 0}, {2, 1, 1}};
  const HalfSpace plain{{1, 0, 0}, 0.5};
  EXPECT_TRUE(ShaftTree::certainly_inside(box, {}, plain));
  EXPECT_FALSE(ShaftTree::certainly_inside(box, {}, {{1, 0, 0}, 1.0}));
  EXPECT_FALSE(ShaftTree::certainly_inside(box, {1, 0, 0}, {{1, 0, 0}, 0.0}));
  EXPECT_FALSE(ShaftTree::certainly_inside(box, {}, {{1, 0, 0}, 0.5, 0.25}));
  EXPECT_FALSE(ShaftTree::certainly_inside(box, {}, {{1, 0, 0}, 0.5, 0.0, 0.5}));
  EXPECT_FALSE(ShaftTree::certainly_inside(box, {}, {{std::nan(""), 0, 0}, 0.5}));
  const Box tiny{{0x1p-1000, 0, 0}, {0x1p-999, 0, 0}};
  EXPECT_FALSE(ShaftTree::certainly_inside(tiny, {}, {{0x1p-100, 0, 0}, 0.0}));
}

TEST(ShaftTree, LeavesOutMostOfWhatIsElsewhere) {
  Random random(2);
  const ShaftTree tree(random_boxes(random, 2000, 1.0));
  const std::vector<HalfSpace> narrow = {{{1, 0, 0}, 0.0}, {{-1, 0.1, 0}, 0.0}, {{0, 0, 1}, 0.0}, {{0, 0.1, -1}, 0.0}};
  EXPECT_LT(found(tree, {}, narrow).size(), 300U);
}

TEST(ShaftTree, KeepsABoxThatTouchesThePlane) {
  const std::vector<Box> boxes = {{{1, 1, 1}, {2, 2, 2}}};
  const ShaftTree tree(boxes);
  EXPECT_EQ(found(tree, {}, {{{1, 0, 0}, 2.0}}).size(), 1U);  // touches x = 2
  EXPECT_EQ(found(tree, {}, {{{1, 0, 0}, 2.5}}).size(), 0U);
  EXPECT_EQ(found(tree, {}, {{{-1, 0, 0}, -1.0}}).size(), 1U);  // touches x = 1
}

TEST(ShaftTree, KeepsEverythingWhereArithmeticFails) {
  Random random(3);
  const ShaftTree huge(random_boxes(random, 20, 1e308));
  const ShaftTree tiny(random_boxes(random, 20, 1e-300));
  const HalfSpace nowhere{{std::nan(""), 0, 1}, 1e300};
  EXPECT_EQ(found(huge, {}, {nowhere}).size(), 20U);
  EXPECT_EQ(found(tiny, {}, {{{1e-20, 1e-20, 0}, 1e-310}}).size(), 20U);   // products underflow
  EXPECT_EQ(found(huge, {-1e308, 0, 0}, {{{1, 1, 1}, 0.0}}).size(), 20U);  // differences overflow
}

TEST(ShaftTree, StopsWhenTold) {
  Random random(4);
  const ShaftTree tree(random_boxes(random, 100, 1.0));
  int visits = 0;
  tree.query({}, {}, [&](std::uint32_t) { return ++visits < 7; });
  EXPECT_EQ(visits, 7);
}

TEST(ShaftTree, AnEmptyTreeFindsNothing) {
  EXPECT_TRUE(found(ShaftTree(), {}, {}).empty());
  EXPECT_TRUE(found(ShaftTree(std::span<const Box>()), {}, {}).empty());
}

}  // namespace
}  // namespace exactff
