// The visible share of a window at the limits of its bounds: what doubles decide, and what they leave to rational
// numbers, is the same.
#include "exact/visible_share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "exact/source_planes.h"
#include "generate/plain_scene.h"
#include "unit/solver/square_scenes.h"

namespace exactff::validation {
namespace {

using exact::VisibleShare;
using generate::PlainScene;

struct Shadowed {
  PlainScene plain;
  Scene scene = generate::build(plain);
  ExactSource source{scene, scene.select("source")};
  Workspace workspace;
  VisibleShare share{scene, generate::receiver_of(plain), ExactSourceInside::planes(source).planes.front(), workspace};

  explicit Shadowed(PlainScene given) : plain(std::move(given)) {
    share.start(ExactSourceInside::planes(source).planes.front().pieces[0]);
  }
};

std::vector<Vec3> window_at(double x, double y, double side) {
  return {{x, y, 1}, {x, y + side, 1}, {x + side, y + side, 1}, {x + side, y, 1}};
}

void expect_as_exactly(VisibleShare& share, const std::vector<Vec3>& window) {
  const double found = share.of(window), exactly = share.of_exactly(window);
  EXPECT_NEAR(found, exactly, VisibleShare::kAccuracy);
  EXPECT_EQ(found == 0.0, exactly == 0.0);
  EXPECT_EQ(found == 1.0, exactly == 1.0);
}

// The shadow's edge x + y = 1/4 passes a corner of the window at up to 2^-20, and at less than the doubles can tell.
TEST(VisibleShare, OfAWindowWhoseCornerNearlyTouchesAShadow) {
  PlainScene plain = square_source();
  plain.add_ring(plain.patch("occluder"), {{0.125, 0, 0.5}, {0, 0.125, 0.5}, {-1, -1, 0.5}});
  Shadowed shadowed(plain);
  VisibleShare& share = shadowed.share;
  int decided = 0, undecided = 0;
  for (int exponent = -53; exponent <= -20; ++exponent) {
    for (const double sign : {-1.0, 0.0, 1.0}) {
      const std::uint64_t before = share.undecided();
      expect_as_exactly(share, window_at(0.125 + sign * std::ldexp(1.0, exponent), 0.125, 0.0625));
      ++(share.undecided() == before ? decided : undecided);
    }
  }
  EXPECT_GT(decided, 20);
  EXPECT_GT(undecided, 20);
}

// Strips of which the narrowest windows see a few; the bound on the blur of the windows' corners leaves the narrowest
// to rational numbers.
TEST(VisibleShare, OfWindowsOfAllSizes) {
  PlainScene plain = square_source();
  for (int strip = 0; strip < 32; ++strip) {
    const double x = strip * 0x1p-22;
    plain.add_ring(plain.patch("occluder"), {{x, -1, 0.5}, {x + 0x1p-23, -1, 0.5}, {x + 0x1p-23, 1, 0.5}, {x, 1, 0.5}});
  }
  Shadowed shadowed(plain);
  VisibleShare& share = shadowed.share;
  int decided = 0, undecided = 0;
  for (int exponent = -24; exponent <= -2; ++exponent) {
    for (const double factor : {1.0, 1.1, 1.3, 1.7}) {
      const std::uint64_t before = share.undecided();
      expect_as_exactly(share, window_at(0.3 * 0x1p-22, 0.1, factor * std::ldexp(1.0, exponent)));
      ++(share.undecided() == before ? decided : undecided);
    }
  }
  EXPECT_GT(decided, 20);
  EXPECT_GT(undecided, 20);
}

}  // namespace
}  // namespace exactff::validation
