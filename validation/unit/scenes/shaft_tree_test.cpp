// The bounding-volume tree never loses a piece that may meet a half-space.
#include "scene/shaft_tree.h"

#include "support/test.h"

namespace exactff {
namespace {

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

TEST(ShaftTree, KeepsEverythingWhereArithmeticFails) {
  Random random(3);
  const ShaftTree huge(random_boxes(random, 20, 1e308));
  const ShaftTree tiny(random_boxes(random, 20, 1e-300));
  const HalfSpace nowhere{{std::nan(""), 0, 1}, 1e300};
  EXPECT_EQ(found(huge, {}, {nowhere}).size(), 20U);
  EXPECT_EQ(found(tiny, {}, {{{1e-20, 1e-20, 0}, 1e-310}}).size(), 20U);   // products underflow
  EXPECT_EQ(found(huge, {-1e308, 0, 0}, {{{1, 1, 1}, 0.0}}).size(), 20U);  // differences overflow
}

}  // namespace
}  // namespace exactff
