// Methods with closed forms: solid angles, hemicubes, and the exact visible share of a window in place of rays.
#include "adaptive/sub_patch.h"
#include "exact/source_planes.h"
#include "exact/visible_share.h"
#include "methods/area_sampling.h"
#include "methods/hemicube.h"
#include "support/test.h"
#include "unit/rivals/methods_support.h"
#include "unit/rivals/moments.h"

namespace exactff::validation {
namespace {

using exact::VisibleShare;

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

// Only pixels on the outline of the source can be wrong. On the top face, a side that spans da columns and db rows
// crosses at most da + db + 2 pixels, each with at most 4 / (pi n^2).
double outline_bound(const std::vector<std::array<double, 2>>& outline, int n) {
  double pixels = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& p = outline[i];
    const auto& q = outline[(i + 1) % outline.size()];
    pixels += (std::abs(p[0] - q[0]) + std::abs(p[1] - q[1])) * n / 2 + 2;
  }
  return pixels * 4.0 * std::numbers::inv_pi / (static_cast<double>(n) * n);
}

TEST(Hemicube, ErrsByNoMoreThanThePixelsOnTheOutline) {
  PlainScene plain;  // a square of side 1.2 at height 1, off the axis
  add(plain, "source", {{-0.5, -0.7, 1}, {-0.5, 0.5, 1}, {0.7, 0.5, 1}, {0.7, -0.7, 1}});
  const double f = truth(plain);
  double last = 1.0;
  for (const int n : {16, 64, 256}) {
    const double bound = outline_bound({{-0.5, -0.7}, {-0.5, 0.5}, {0.7, 0.5}, {0.7, -0.7}}, n);
    const double error = std::abs(value(plain, "hemicube:resolution=" + std::to_string(n)) - f);
    EXPECT_LE(error, bound) << n;
    EXPECT_LT(bound, last);
    last = bound;
  }
  EXPECT_LT(last, 0.03);
}

// In a closed room, every direction above the horizon hits a face, so every pixel belongs to a patch.
TEST(Hemicube, FormFactorsInAClosedRoomSumToOne) {
  PlainScene plain;
  const Vec3 c[] = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}, {0, 0, 1.5}, {3, 0, 1.5}, {3, 2, 1.5}, {0, 2, 1.5}};
  add(plain, "floor", {c[0], c[1], c[2], c[3]});
  add(plain, "ceiling", {c[4], c[7], c[6], c[5]});
  add(plain, "front", {c[0], c[4], c[5], c[1]});
  add(plain, "back", {c[3], c[2], c[6], c[7]});
  add(plain, "left", {c[0], c[3], c[7], c[4]});
  add(plain, "right", {c[1], c[5], c[6], c[2]});
  const Scene room = generate::build(plain);
  for (const char* choice : {"hemicube:resolution=50", "hemicube:resolution=32,rotation=17"}) {
    for (const Receiver& receiver : grid_receivers(room, room.select("floor"), {3, 2})) {
      double total = 0.0;
      std::uint64_t pixels = 0;
      for (const Patch& patch : room.patches()) {
        const methods::Estimate found = estimate(room, receiver, patch.name, choice);
        total += found.form_factor;
        pixels += found.counters["pixels"];
      }
      EXPECT_NEAR(total, 1.0, 1e-12);
      EXPECT_EQ(pixels, estimate(room, receiver, "floor", choice).counters["pixels drawn"]);
    }
  }
}

// --- area sampling uniform in solid angle: right on average, with the slope of theory ---

const std::string kBySolidAngle = "area-sampling:measure=solid-angle";

PlainScene scene_of(const std::vector<Vec3>& source, const Vec3& normal = {0, 0, 1}) {
  PlainScene plain;
  add(plain, "source", source);
  plain.normal = normal;
  return plain;
}

struct Family {
  const char* name;
  PlainScene scene;
};

// A rectangle and a triangle in each.
std::vector<Family> families() {
  const auto rectangle = [](double x, double y, double z, double a, double b) {
    return std::vector<Vec3>{{x, y, z}, {x, y + b, z}, {x + a, y + b, z}, {x + a, y, z}};
  };
  const auto triangle = [](double x, double y, double z, double a, double b) {
    return std::vector<Vec3>{{x, y, z}, {x, y + b, z}, {x + a, y, z}};
  };
  return {{"plain", scene_of(rectangle(-1, -1, 1, 2, 2))},
          {"plain triangle", scene_of(triangle(-1, -1, 1, 2, 2))},
          {"tiny", scene_of(rectangle(0.3, 0.2, 1, 1e-9, 1e-9))},
          {"tiny triangle", scene_of(triangle(0.3, 0.2, 1, 1e-9, 1e-9))},
          {"far", scene_of(rectangle(0.3, 0.2, 1e7, 1, 2))},
          {"long", scene_of({{1, -1e4, 0}, {1, -1e4, 2}, {1, 1e4, 2}, {1, 1e4, 0}})},
          {"sliver", scene_of(triangle(0.3, -1e4, 1, 1e-6, 2e4))},
          {"x almost in the plane", scene_of(rectangle(1, -1, 1e-9, 1, 2), {1, 0, 0})},
          {"x almost in the plane of a triangle", scene_of(triangle(1, -1, 1e-9, 1, 2), {1, 0, 0})},
          {"x almost on the source", scene_of(rectangle(-1, -1, 1e-9, 2, 3), {0.6, 0, 0.8})},
          {"x almost on a triangle", scene_of(triangle(-1, -1, 1e-9, 3, 5), {0.6, 0, 0.8})},
          {"x almost on a side", scene_of(rectangle(1e-9, -1, 1e-9, 2, 3), {0.6, 0, 0.8})},
          {"x below a corner", scene_of(rectangle(0, 0, 1e-6, 2, 3))},
          {"grazing at the horizon", scene_of({{-1, -1, 1e-9}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 1e-9}})},
          {"across the horizon", scene_of({{1, -1, -1}, {1, -1, 2}, {1, 1, 2}, {1, 1, -1}})},
          {"across the horizon, oblique", scene_of(rectangle(-1, -1, 1, 2, 2), {0.8, 0.3, 0.1})},
          {"quadrilateral", scene_of({{-1, -1, 1}, {-1, 1, 1}, {1, 1.5, 1}, {0.5, -1, 1}})}};
}

TEST(SolidAngle, OfDegenerateSourcesIsRightOnAverage) {
  for (const Family& family : families()) {
    SCOPED_TRACE(family.name);
    const double f = truth(family.scene);
    ASSERT_GT(f, 0.0);
    for (const char* pattern : {"random", "stratified", "sobol"}) {
      const std::vector<double> values =
          values_by_seed(family.scene, kBySolidAngle + ",samples=64,pattern=" + pattern, 64);
      for (const double value : values) EXPECT_TRUE(value >= 0.0 && value <= 2.0) << value;
      const Moments found = moments(values);
      EXPECT_NEAR(found.mean / f, 1.0, 5.0 * std::sqrt(found.variance / 64.0) / f + 1e-7) << pattern;
    }
  }
}

}  // namespace
}  // namespace exactff::validation
