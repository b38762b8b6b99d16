// Looks at a function at random points: means over parts of different weights, and how many points they take.
#include "view_factors/looks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactff/scene.h"
#include "generate/plain_scene.h"
#include "view_factors/exact_scene.h"
#include "view_factors/patch_parts.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/sampled_factor.h"

namespace exactff::view_factors {
namespace {

constexpr double kRisk = 1e-6;
constexpr std::uint64_t kAnyEffort = std::uint64_t{1} << 62;

// 1 on a strip of each part's x, 0 elsewhere.
class Strip : public SampledFunction {
 public:
  Strip(std::vector<Part> parts, const Units& units, double from, double to)
      : SampledFunction(std::move(parts)), units_(units), from_(from), to_(to) {}
  [[nodiscard]] double range(const Tile&) override { return 1.0; }
  [[nodiscard]] std::optional<double> at(const Point& point, std::size_t) override {
    ++points_;
    const double x = std::ldexp(point.at.x, static_cast<int>(units_.exponent + units_.shift));
    return x >= from_ && x < to_ ? 1.0 : 0.0;
  }
  [[nodiscard]] std::uint64_t effort() const override { return 10 * points_; }

 private:
  const Units& units_;
  double from_, to_;
  std::uint64_t points_ = 0;
};

class LooksAtStrips : public testing::Test {
 protected:
  LooksAtStrips() : scene_(build()), exact_(scene_) {}
  static Scene build() {
    generate::PlainScene plain;
    plain.add_ring(plain.patch("left"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    plain.add_ring(plain.patch("right"), {{2, 0, 0}, {3, 0, 0}, {2.5, 2, 0}});
    return generate::build(plain);
  }
  // A square and a triangle of area 1 each.
  [[nodiscard]] std::vector<Part> parts(double left, double right) const {
    std::vector<Part> result;
    for (const auto& [name, weight] : {std::pair("left", left), std::pair("right", right)}) {
      result.push_back(parts_of(exact_, scene_.select(name)).front());
      result.back().weight = weight;
    }
    return result;
  }

  const Scene scene_;
  const ExactScene exact_;
};

TEST_F(LooksAtStrips, HoldTheirMeansWhateverThePartsWeigh) {
  for (const auto& [left, right] : {std::pair(1.0, 1.0), std::pair(1e-6, 1.0), std::pair(3.0, 0.25)}) {
    for (const double width : {0.001, 0.1, 0.5}) {
      // Of the square alone, and all of both.
      Strip strip(parts(left, right), exact_.units, 0.25, 0.25 + width);
      Strip all(parts(left, right), exact_.units, -1.0, 4.0);
      const double mean = width * left / (left + right);
      Looks looks(strip, exact_.units, kRisk, 0);
      for (int look = 0; look < 3; ++look) {
        const Looks::Mean found = looks.look();
        EXPECT_LE(std::abs(found.value - mean), found.error) << left << ' ' << width;
        EXPECT_LE(found.error, 0.6);
        (void)looks.prepare(0.5 * found.error, kAnyEffort, 20000);
      }
      Looks of_all(all, exact_.units, kRisk, 0);
      EXPECT_NEAR(of_all.look().value, 1.0, 1e-12);
    }
  }
}

TEST_F(LooksAtStrips, TakeNoMorePointsOrEffortThanTheyMay) {
  Strip strip(parts(1.0, 1.0), exact_.units, 0.25, 0.5);
  Looks looks(strip, exact_.units, kRisk, 0);
  (void)looks.look();
  const std::size_t first = looks.points();
  EXPECT_GE(first, kPointsOfFirstLook);
  EXPECT_EQ(looks.effort_of_point(), 10U);
  EXPECT_FALSE(looks.prepare(1e-6, kAnyEffort, 2000));
  EXPECT_FALSE(looks.prepare(0.05, 10 * first + 100, 1 << 20));
  ASSERT_TRUE(looks.prepare_for_all(4000));
  (void)looks.look();
  EXPECT_LE(looks.points(), 4000U);
  EXPECT_GT(looks.points(), 3500U);
}

TEST_F(LooksAtStrips, AreAsNarrowAsExpected) {
  Strip strip(parts(1.0, 1.0), exact_.units, -1.0, 4.0);
  Looks looks(strip, exact_.units, kRisk, 0);
  (void)looks.look();
  ASSERT_TRUE(looks.prepare(0.01, kAnyEffort, 1 << 20));
  const Looks::Mean found = looks.look();
  EXPECT_LE(1.0 - found.value + found.error, 0.01);
}

// Looks before, of which the risk is one with theirs, make them wider.
TEST_F(LooksAtStrips, AreWiderAfterOthers) {
  Strip strip(parts(1.0, 1.0), exact_.units, 0.25, 0.5);
  Looks first(strip, exact_.units, kRisk, 0), later(strip, exact_.units, kRisk, 100);
  EXPECT_EQ(later.count(), 100U);
  EXPECT_LT(first.look().error, later.look().error);
  EXPECT_EQ(later.count(), 101U);
}

// No interval is narrower than the factor of an unhidden source asks for, however much the points agree.
TEST(SampledMean, IsAsWideAsTheLargestFactorsSay) {
  generate::PlainScene plain;
  plain.add_ring(plain.patch("below"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("above"), {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}});
  const Scene scene = generate::build(plain);
  const ExactScene exact(scene);
  const PreparedPatch below(exact, scene.select("below"), false), above(exact, scene.select("above"), false);
  SampledMean mean(exact, below, above, kPointsOfFirstLook, 1.0);
  ASSERT_TRUE(mean.look(kAnyEffort));
  const double least = least_width(mean.first_width(), kPointsOfFirstLook / 2, kRiskOfPatch);
  EXPECT_GT(mean.upper() - mean.lower(), 1.25 * least);
  EXPECT_LT(mean.upper() - mean.lower(), 3.0 * least);
}

}  // namespace
}  // namespace exactff::view_factors
