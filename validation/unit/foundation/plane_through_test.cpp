// Planes that are prepared for the sides of many points: the exact signs, and boxes on the safe side.
#include "kernel/filter.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

using kernel::PlaneThrough;

// Coordinates that make many determinants zero or nearly so, or that leave the range of the filter.
Vec3 odd_point(Random& random, int exponent) {
  const auto coordinate = [&] {
    const double whole = static_cast<double>(random.integer(-2, 2));
    const double nudged = random.one_in(4) ? std::nextafter(whole, 9.0) : whole;
    return std::ldexp(nudged, exponent);
  };
  return {coordinate(), coordinate(), coordinate()};
}

TEST(PlaneThrough, HasTheExactSideOfEveryPoint) {
  for (std::uint64_t s = 0; s < scaled_count(20000); ++s) {
    Random random(seed_of(s));
    const int exponent = random.one_in(3) ? 0 : random.integer(-1020, 1000);
    const auto point = [&] { return odd_point(random, exponent); };
    const Vec3 a = point(), b = point(), c = point(), x = point();
    EXPECT_EQ(PlaneThrough(a, b, c).side_of(x), kernel::orientation(a, b, c, x));
  }
}

TEST(PlaneThrough, ABoxIsOnASideIfAllItsCornersAre) {
  int decided = 0;
  for (std::uint64_t s = 0; s < scaled_count(20000); ++s) {
    Random random(seed_of(s));
    const auto point = [&] { return odd_point(random, 0); };
    const Vec3 a = point(), b = point(), c = point(), p = point(), q = point();
    const Vec3 low{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)};
    const Vec3 high{std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)};
    const int side = PlaneThrough(a, b, c).side_of_box(low, high);
    if (side == kernel::kUncertain) continue;
    ++decided;
    for (const double x : {low.x, high.x}) {
      for (const double y : {low.y, high.y}) {
        for (const double z : {low.z, high.z}) EXPECT_EQ(kernel::orientation(a, b, c, {x, y, z}), side);
      }
    }
  }
  EXPECT_GE(decided, 1000);
}

}  // namespace
}  // namespace exactff::validation
