#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "methods/hemicube.h"
#include "unit/rivals/methods_support.h"

namespace exactff::validation {
namespace {

using methods::HemicubePixels;

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(HemicubePixels, DeltaFormFactorsSumToOne) {
  for (const int n : {2, 4, 10, 100, 358, 512}) {
    const HemicubePixels pixels(n);
    EXPECT_EQ(pixels.count(), 3U * static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
    EXPECT_NEAR(sum(pixels.form_factors()), 1.0, 1e-12) << n;
  }
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
  generate::PlainScene plain;  // a square of side 1.2 at height 1, off the axis
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
  generate::PlainScene plain;
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

// Triangles with shared sides cover every pixel exactly once: a tessellated source has the pixels of the whole source.
TEST(Hemicube, TrianglesThatShareSidesTileThePixels) {
  generate::PlainScene whole, cut;
  const std::vector<Vec3> square = square_above(0.75, 1.0);  // sides through pixel centres at n = 16
  add(whole, "source", square);
  const Vec3 middle{0.0625, -0.1875, 1.0};
  for (std::size_t i = 0; i < 4; ++i) add(cut, "source", {square[i], square[(i + 1) % 4], middle});
  for (const char* choice :
       {"hemicube:resolution=16", "hemicube:resolution=100", "hemicube:resolution=64,rotation=45"}) {
    EXPECT_NEAR(value(cut, choice), value(whole, choice), 1e-15) << choice;
  }
}

TEST(Hemicube, TheNearerFaceHasThePixelWhicheverComesFirst) {
  for (const bool occluder_first : {false, true}) {
    generate::PlainScene plain;
    if (occluder_first) add(plain, "occluder", square_above(0.75, 0.5));
    add(plain, "source", square_above(1.0, 1.0));
    if (!occluder_first) add(plain, "occluder", square_above(0.75, 0.5));
    EXPECT_EQ(value(plain, "hemicube"), 0.0);
  }
  generate::PlainScene beyond = open_scene();
  add(beyond, "occluder", square_above(2.0, 1.5));
  EXPECT_GT(value(beyond, "hemicube"), 0.5);
}

}  // namespace
}  // namespace exactff::validation
