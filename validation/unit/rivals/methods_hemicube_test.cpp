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

// Gauss-Legendre with 5 x 5 points, whose error for these pixels is far below 1e-12 of the value.
double integral(const auto& integrand, double a0, double a1, double b0, double b1) {
  constexpr double kNodes[] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double kWeights[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                 0.2369268850561891};
  double total = 0.0;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const double a = 0.5 * (a0 + a1) + 0.5 * (a1 - a0) * kNodes[i], b = 0.5 * (b0 + b1) + 0.5 * (b1 - b0) * kNodes[j];
      total += kWeights[i] * kWeights[j] * integrand(a, b);
    }
  }
  return total * 0.25 * (a1 - a0) * (b1 - b0);
}

TEST(HemicubePixels, DeltaFormFactorsAgreeWithNumericalIntegration) {
  const int n = 20;
  const HemicubePixels pixels(n);
  const auto top = [](double a, double b) { return std::numbers::inv_pi / std::pow(a * a + b * b + 1.0, 2); };
  const auto side = [](double a, double b) { return b * std::numbers::inv_pi / std::pow(a * a + b * b + 1.0, 2); };
  const double size = 2.0 / n;
  for (int face = 0; face < methods::kHemicubeFaces; ++face) {
    for (int row = 0; row < pixels.rows(face); ++row) {
      for (int column = 0; column < n; ++column) {
        const double a = -1.0 + column * size, b = (face == 0 ? -1.0 : 0.0) + row * size;
        const double wanted =
            face == 0 ? integral(top, a, a + size, b, b + size) : integral(side, a, a + size, b, b + size);
        const auto pixel = pixels.first(face) + static_cast<std::size_t>(row * n + column);
        ASSERT_NEAR(pixels.form_factors()[pixel], wanted, 1e-11 * wanted) << face << ' ' << row << ' ' << column;
      }
    }
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

TEST(Hemicube, RotationMovesTheValueWithinThePixelsOnTheOutline) {
  generate::PlainScene plain;
  add(plain, "source", {{-0.3, -0.4, 1}, {-0.3, 0.2, 1}, {0.5, 0.2, 1}, {0.5, -0.4, 1}});
  const double f = truth(plain);
  // For every rotation, the corners stay within sqrt(0.5) of the axis, on the top face, and a side of length l spans at
  // most sqrt(2) l.
  const double bound = std::numbers::sqrt2 * outline_bound({{-0.3, -0.4}, {-0.3, 0.2}, {0.5, 0.2}, {0.5, -0.4}}, 100);
  std::vector<double> values;
  for (const char* rotation : {"0", "10", "45", "90", "-33.3"}) {
    values.push_back(value(plain, std::string("hemicube:rotation=") + rotation));
    EXPECT_NEAR(values.back(), f, bound) << rotation;
  }
  EXPECT_NE(values[0], values[1]);
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

// The back of an occluder hides like its front. The back of a source is dark and hides what is behind it.
TEST(Hemicube, BothSidesHideAndOnlyTheFrontShines) {
  generate::PlainScene plain = open_scene();
  std::vector<Vec3> turned = square_above(0.75, 0.5);
  std::reverse(turned.begin(), turned.end());
  add(plain, "dark", turned);
  EXPECT_EQ(value(plain, "hemicube"), 0.0);
  plain.source = "dark";
  EXPECT_EQ(value(plain, "hemicube"), 0.0);
}

// A floor that extends behind the receiver and below its horizon needs no special treatment.
TEST(Hemicube, FacesThatReachBehindTheReceiverAreClipped) {
  generate::PlainScene plain;
  add(plain, "source", {{-50, -50, -1}, {-50, -50, 60}, {-50, 50, 60}, {-50, 50, -1}});
  add(plain, "ceiling", {{-1000, -1000, 1}, {-1000, 1000, 1}, {1000, 1000, 1}, {1000, -1000, 1}});
  EXPECT_NEAR(value(plain, "hemicube:resolution=200"), truth(plain), 1e-3);
  plain.source = "ceiling";
  EXPECT_NEAR(value(plain, "hemicube:resolution=200"), truth(plain), 0.01);
}

TEST(Hemicube, TheReceiversFaceIsLeftOut) {
  const Scene room = furnished_room();
  Receiver receiver = room_receivers(room)[0];
  receiver.on.clear();
  receiver.point.z = -1e-3;  // below the floor, which then hides everything
  EXPECT_EQ(estimate(room, receiver, "lamp", "hemicube").form_factor, 0.0);
  receiver.on = {room.faces_of(room.select("floor"))[0]};
  EXPECT_GT(estimate(room, receiver, "lamp", "hemicube").form_factor, 0.0);
}

// If two faces are coplanar, the first one gets the pixels of both.
TEST(Hemicube, TheFirstOfTwoCoplanarFacesWins) {
  for (const bool lamp_first : {false, true}) {
    generate::PlainScene plain;
    if (lamp_first) add(plain, "source", square_above(0.4, 0.7));
    add(plain, "ceiling", square_above(3.1, 0.7));
    if (!lamp_first) add(plain, "source", square_above(0.4, 0.7));
    if (lamp_first) {
      EXPECT_GT(value(plain, "hemicube:rotation=12"), 0.2);
    } else {
      EXPECT_EQ(value(plain, "hemicube:rotation=12"), 0.0);
    }
  }
}

}  // namespace
}  // namespace exactff::validation
