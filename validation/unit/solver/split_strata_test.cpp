// Strata that are split where a function may be large.
#include "view_factors/split_strata.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactff/scene.h"
#include "generate/plain_scene.h"
#include "kernel/vec.h"
#include "view_factors/exact_scene.h"
#include "view_factors/patch_parts.h"
#include "view_factors/stratified_mean.h"

namespace exactff::view_factors {
namespace {

using generate::PlainScene;

class SplitStrataOf : public testing::TestWithParam<std::vector<Vec3>> {
 protected:
  static Scene build() {
    PlainScene plain;
    plain.add_ring(plain.patch("patch"), GetParam());
    return generate::build(plain);
  }

  // Large near the first corner.
  static double f(const Vec3& p) { return 1.0 / (1.0 + 50.0 * kernel::dot(p, p)); }
  [[nodiscard]] double largest(const Tile& tile) const {
    const std::vector<Vec3> corners = corners_of(parts_[tile.part], tile, exact_.units);
    double result = 0.0;
    for (const Vec3& corner : corners) {
      // Its distance from the origin is at least that of a corner, less the tile's diameter.
      double reach = 0.0;
      for (const Vec3& other : corners) reach = std::max(reach, kernel::distance(corner, other));
      const double nearest = std::max(0.0, kernel::length(corner) - reach);
      result = std::max(result, 1.0 / (1.0 + 50.0 * nearest * nearest));
    }
    return result;
  }

  [[nodiscard]] Vec3 middle(const Tile& tile) const {
    const std::vector<Vec3> corners = corners_of(parts_[tile.part], tile, exact_.units);
    Vec3 sum;
    for (const Vec3& corner : corners) sum = kernel::sum(sum, corner);
    return kernel::scaled(sum, 1.0 / static_cast<double>(corners.size()));
  }
  // In the plane z = 0, counter-clockwise.
  [[nodiscard]] bool holds(const Tile& tile, const Vec3& at) const {
    const std::vector<Vec3> corners = corners_of(parts_[tile.part], tile, exact_.units);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
      if ((b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x) < 0.0) return false;
    }
    return true;
  }

  const Scene scene_ = build();
  const ExactScene exact_{scene_};
  const std::vector<Part> parts_ = parts_of(exact_, scene_.select("patch"));
  const SplitStrata::RangeOf range_ = [this](const Tile& tile) { return largest(tile); };
};

TEST_P(SplitStrataOf, ShareTheAreaAndHoldTheFunction) {
  SplitStrata split(parts_, 36, range_);
  const double area = split.strata().area;
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(split.split());
  double sum = 0.0;
  for (std::size_t s = 0; s < split.strata().strata.size(); ++s) {
    const Stratum& stratum = split.strata().strata[s];
    sum += stratum.area;
    ASSERT_EQ(stratum.end, stratum.begin + 1);
    for (std::size_t n = 0; n < 4; ++n) {
      Draws draws(1, s, n);
      const Tile& tile = split.strata().tiles[stratum.begin];
      EXPECT_LE(f(point_in(parts_[tile.part], tile, draws, exact_.units).at), split.range(s));
    }
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
}

// The worst one has some four times the mean weight: strata of the same size would have a worse one.
TEST_P(SplitStrataOf, AreSmallWhereTheFunctionMayBeLarge) {
  SplitStrata split(parts_, 36, range_);
  while (split.strata().strata.size() < 1000) ASSERT_TRUE(split.split());
  double sum = 0.0, worst = 0.0;
  for (std::size_t s = 0; s < split.strata().strata.size(); ++s) {
    const double weight = split.range(s) * split.strata().strata[s].area / split.strata().area;
    sum += weight;
    worst = std::max(worst, weight);
  }
  EXPECT_DOUBLE_EQ(split.largest(), worst);
  EXPECT_LE(worst, 4.0 * sum / static_cast<double>(split.strata().strata.size()));
}

// The mean over many looks at split strata is that over very many equal ones.
TEST_P(SplitStrataOf, LeaveTheMeanAsItIs) {
  const auto mean = [&](const Strata& strata, std::size_t look) {
    StratifiedMean result;
    for (std::size_t s = 0; s < strata.strata.size(); ++s) {
      double values[kDraws];
      for (std::size_t d = 0; d < kDraws; ++d) {
        Draws draws(look, s, d);
        const Tile& tile = draw_tile(strata, strata.strata[s], d, draws);
        values[d] = f(point_in(parts_[tile.part], tile, draws, exact_.units).at);
      }
      result.add(values[0], values[1], values[0], strata.strata[s].area / strata.area);
    }
    return result;
  };
  const double truth = mean(strata_of(parts_, 40000), 0).value;
  SplitStrata split(parts_, 36, range_);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(split.split());
  double sum = 0.0, square = 0.0;
  constexpr std::size_t kLooks = 100;
  for (std::size_t look = 1; look <= kLooks; ++look) {
    const StratifiedMean found = mean(split.strata(), look);
    sum += found.value;
    square += found.square;
  }
  const double error = std::sqrt(square) / kLooks;
  EXPECT_NEAR(sum / kLooks, truth, 5.0 * error + 1e-5);
  EXPECT_LT(error, 1e-3 * truth);
}

// The first look sets their numbers as guesses; then each is that of the stratum that holds it, as far as its range
// goes.
TEST_P(SplitStrataOf, KeepTheGuessesOfWhatTheyWereSplitFrom) {
  SplitStrata split(parts_, 36, range_);
  const std::vector<Stratum> first = split.strata().strata;
  std::vector<double> guesses;
  for (std::size_t s = 0; s < first.size(); ++s) {
    EXPECT_EQ(split.guess(s), 0.0);
    const Tile tile = split.strata().tiles[first[s].begin];
    guesses.push_back(f(middle(tile)));
    split.set_guess(s, guesses.back());
  }
  std::vector<Tile> wholes;
  for (const Stratum& stratum : first) wholes.push_back(split.strata().tiles[stratum.begin]);
  while (split.strata().strata.size() < 500) ASSERT_TRUE(split.split());
  for (std::size_t s = 0; s < split.strata().strata.size(); ++s) {
    const Vec3 at = middle(split.strata().tiles[split.strata().strata[s].begin]);
    const auto whole = std::ranges::find_if(wholes, [&](const Tile& tile) { return holds(tile, at); });
    ASSERT_NE(whole, wholes.end());
    const double guess = guesses[static_cast<std::size_t>(whole - wholes.begin())];
    EXPECT_EQ(split.guess(s), std::min(guess, split.range(s))) << s;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, SplitStrataOf,
                         testing::Values(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {8, 0, 0}, {8, 1, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 3, 0}, {0, 2, 0}}));

// Those of many small faces share strata until they are split.
TEST(SplitStrata, OfManyFacesAreSharedOutAmongThem) {
  PlainScene plain;
  for (int i = 0; i < 400; ++i) {
    const double x = i % 20, y = i / 20;
    plain.add_ring(plain.patch("patch"), {{x, y, 0}, {x + 0.5, y, 0}, {x + 0.5, y + 0.5, 0}, {x, y + 0.5, 0}});
  }
  const Scene scene = generate::build(plain);
  const ExactScene exact(scene);
  const std::vector<Part> parts = parts_of(exact, scene.select("patch"));
  SplitStrata split(parts, 40, [](const Tile&) { return 1.0; });
  EXPECT_LT(split.strata().strata.size(), 100U);
  while (split.strata().strata.size() < 400) ASSERT_TRUE(split.split());
  std::vector<int> of_part(parts.size());
  for (const Stratum& stratum : split.strata().strata) {
    EXPECT_EQ(stratum.end, stratum.begin + 1);
    ++of_part[split.strata().tiles[stratum.begin].part];
  }
  EXPECT_EQ(std::ranges::count(of_part, 1), 400);
}

}  // namespace
}  // namespace exactff::view_factors
