// The exact visible share of a window, and the algorithm that uses it instead of rays.
#include <gtest/gtest.h>

#include <cmath>

#include "adaptive/sub_patch.h"
#include "exact/source_planes.h"
#include "exact/visible_share.h"
#include "unit/rivals/methods_support.h"

namespace exactff::validation {
namespace {

using exact::VisibleShare;
using generate::PlainScene;

struct Window {
  PlainScene plain;
  Scene scene = generate::build(plain);
  ExactSource source{scene, scene.select(plain.source)};
  Workspace workspace;
  VisibleShare share{scene, generate::receiver_of(plain), ExactSourceInside::planes(source).planes.front(), workspace};

  explicit Window(PlainScene given) : plain(std::move(given)) {
    share.start(ExactSourceInside::planes(source).planes.front().pieces[0]);
  }
};

std::vector<Vec3> square_at(double x, double y, double side) {
  return {{x, y, 1}, {x, y + side, 1}, {x + side, y + side, 1}, {x + side, y, 1}};
}

// The exact method's fraction of the square as a separate source. The original source stays in the scene: it is
// coplanar.
double fraction_of(const PlainScene& plain, const std::vector<Vec3>& square) {
  PlainScene own = plain;
  add(own, "window", square);
  const Scene scene = generate::build(own);
  const ExactSource source(scene, scene.select("window"));
  return *exact_form_factor(scene, generate::receiver_of(own), source, {.visible_fraction = true}).visible_fraction;
}

std::vector<PlainScene> busy_scenes() {
  return {generate::soup({.n = 20, .seed = 4}),
          generate::lattice({.n = 25, .seed = 2}),
          generate::blinds({.n = 8}),
          generate::karkanis({.n = 20, .seed = 6}),
          occluded_scene(0.3),
          generate::tiles({.n = 4, .drop = 3})};
}

TEST(VisibleShare, IsTheExactMethodsFraction) {
  int partly = 0;
  for (const PlainScene& plain : busy_scenes()) {
    Window window(plain);
    for (const double side : {1.0, 0.25}) {
      for (double x = -1.0; x < 1.0; x += 2.0 * side) {
        for (double y = -1.0; y < 1.0; y += 2.0 * side) {
          const std::vector<Vec3> square = square_at(x, y, side);
          const double wanted = fraction_of(plain, square);
          const double found = window.share.of(square);
          ASSERT_NEAR(found, wanted, 1e-13) << x << ' ' << y << ' ' << side;
          ASSERT_EQ(found == 0.0, wanted == 0.0);
          ASSERT_EQ(found == 1.0, wanted == 1.0);
          partly += wanted > 0.0 && wanted < 1.0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GE(partly, 50);
}

void expect_as_exactly(VisibleShare& share, const std::vector<Vec3>& window) {
  const double exactly = share.of_exactly(window), found = share.of(window);
  EXPECT_NEAR(found, exactly, VisibleShare::kAccuracy);
  EXPECT_EQ(found == 0.0, exactly == 0.0);
  EXPECT_EQ(found == 1.0, exactly == 1.0);
}

TEST(VisibleShare, DoublesAndRationalsAgree) {
  std::uint64_t key = 1;
  const auto next = [&key] { return adaptive::random_point(7, key++); };
  for (const PlainScene& plain : busy_scenes()) {
    Window window(plain);
    for (int i = 0; i < 3; ++i) {
      const adaptive::UnitPoint at = next(), size = next();
      const double side = 0.5 * size.u * size.v * size.v;
      const std::vector<Vec3> square = square_at(at.u - 0.5, at.v - 0.5, side);
      expect_as_exactly(window.share, square);
    }
  }
}

// Cases where a filter is uncertain, and where rounding would give 0 or 1.
TEST(VisibleShare, DecidesNothingAllAndInBetweenExactly) {
  Window window(occluded_scene(0.25));  // hides [-1/2, 1/2]^2
  EXPECT_EQ(window.share.of(square_at(-0.5, -0.5, 1.0)), 0.0);
  EXPECT_EQ(window.share.of(square_at(0.5, -0.5, 0.25)), 1.0);
  EXPECT_GT(window.share.undecided(), 0U);
  const double ulp = 0x1p-53;
  const double nearly_all = window.share.of(square_at(0.5 - ulp, -0.25, 0.25));
  EXPECT_LT(nearly_all, 1.0);
  EXPECT_GT(nearly_all, 0.999);
  const double nearly_nothing =
      window.share.of(std::vector<Vec3>{{0, 0, 1}, {0, 0.25, 1}, {0.5 + 2 * ulp, 0.25, 1}, {0.5 + 2 * ulp, 0, 1}});
  EXPECT_GT(nearly_nothing, 0.0);
  EXPECT_LT(nearly_nothing, 1e-14);
}

// The shadow's edge x + y = 1/4 passes a corner of the window at up to 2^-20, and at less than the doubles can tell.
TEST(VisibleShare, OfAWindowWhoseCornerNearlyTouchesAShadowIsRight) {
  PlainScene plain = open_scene();
  add(plain, "occluder", {{0.125, 0, 0.5}, {0, 0.125, 0.5}, {-1, -1, 0.5}});
  Window window(plain);
  int decided = 0, undecided = 0;
  for (int exponent = -53; exponent <= -20; ++exponent) {
    for (const double sign : {-1.0, 0.0, 1.0}) {
      const std::uint64_t before = window.share.undecided();
      expect_as_exactly(window.share, square_at(0.125 + sign * std::ldexp(1.0, exponent), 0.125, 0.0625));
      ++(window.share.undecided() == before ? decided : undecided);
    }
  }
  EXPECT_GT(decided, 20);
  EXPECT_GT(undecided, 20);
}

// A window that rounding pushes over the rim of the source keeps its visible share.
TEST(VisibleShare, TheSourcesOwnOutlineHidesNothing) {
  Window window(occluded_scene(0.25));
  const double out = 1.0 + 0x1p-52;
  EXPECT_EQ(window.share.of(std::vector<Vec3>{{0.75, 0, 1}, {0.75, 0.5, 1}, {out, 0.5, 1}, {out, 0, 1}}), 1.0);
}

TEST(Control, IsTheAdaptiveAlgorithmBitForBitWhereShaftsDecideAll) {
  const Scene room = furnished_room();
  PlainScene wall;  // half below the horizon
  add(wall, "source", {{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}});
  wall.point = {0.5, 0.5, 0};
  for (const PlainScene& plain : {open_scene(), occluded_scene(0.75), wall}) {
    EXPECT_EQ(value(plain, "adaptive-exact-visibility"), value(plain, "adaptive"));
  }
  int decided = 0;
  for (const Receiver& receiver : room_receivers(room)) {
    const methods::Estimate control = estimate(room, receiver, "lamp", "adaptive-exact-visibility:eps_B=1e-2");
    if (control.counters["exact V"] > 0) continue;
    ++decided;
    EXPECT_EQ(control.form_factor, estimate(room, receiver, "lamp", "adaptive:eps_B=1e-2").form_factor);
  }
  EXPECT_GE(decided, 1);
}

}  // namespace
}  // namespace exactff::validation
