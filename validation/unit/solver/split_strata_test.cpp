// Strata that are split where a function may be large.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactff/scene.h"
#include "generate/plain_scene.h"
#include "kernel/vec.h"
#include "unit/solver/add_numbers.h"
#include "view_factors/exact_scene.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/strata.h"

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
    const std::vector<Vec3> corners = corners_of(parts_[tile.part], tile);
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

  const Scene scene_ = build();
  const ExactScene exact_{scene_};
  const std::vector<Part> parts_ = parts_of(exact_, scene_.select("patch"));
  const SplitStrata::SpanOf span_ = [this](const Tile& tile, bool) { return Span{.range = largest(tile)}; };
};

TEST_P(SplitStrataOf, ShareTheAreaAndHoldTheFunction) {
  SplitStrata split(parts_, 36, span_);
  const double area = split.strata().area;
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(split.split_largest_term());
  double sum = 0.0;
  for (std::size_t s = 0; s < split.strata().strata.size(); ++s) {
    const Stratum& stratum = split.strata().strata[s];
    sum += stratum.area;
    ASSERT_EQ(stratum.end, stratum.begin + 1);
    for (std::size_t n = 0; n < 4; ++n) {
      Draws draws(1, s, n);
      const Tile& tile = split.strata().tiles[stratum.begin];
      const Vec3 at = point_at(parts_[tile.part], tile, draw_place(tile, draws), exact_.units).at;
      EXPECT_LE(f(at), split.span(s).range);
    }
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
}

// The mean over many analyses at split strata is that over very many equal ones.
TEST_P(SplitStrataOf, LeaveTheMeanAsItIs) {
  const auto mean = [&](const Strata& strata, std::size_t analysis) {
    StratifiedMean result;
    for (std::size_t s = 0; s < strata.strata.size(); ++s) {
      double values[kDraws];
      for (std::size_t d = 0; d < kDraws; ++d) {
        Draws draws(analysis, s, d);
        const Tile& tile = draw_tile(strata, strata.strata[s], d, draws);
        values[d] = f(point_at(parts_[tile.part], tile, draw_place(tile, draws), exact_.units).at);
      }
      add_numbers(result, values[0], values[1], values[0], strata.strata[s].area / strata.area);
    }
    return result;
  };
  const double truth = mean(strata_of(parts_, 40000), 0).value;
  SplitStrata split(parts_, 36, span_);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(split.split_largest_term());
  double sum = 0.0, square = 0.0;
  constexpr std::size_t kAnalyses = 100;
  for (std::size_t analysis = 1; analysis <= kAnalyses; ++analysis) {
    const StratifiedMean found = mean(split.strata(), analysis);
    sum += found.value;
    square += found.square;
  }
  const double error = std::sqrt(square) / kAnalyses;
  EXPECT_NEAR(sum / kAnalyses, truth, 5.0 * error + 1e-5);
  EXPECT_LT(error, 1e-3 * truth);
}

// Of strata with a bound of their change that is small enough, one random number is taken, and the term is less.
TEST_P(SplitStrataOf, LeaveLessToChanceWhereTheFunctionHardlyChanges) {
  const auto span = [](const Tile& tile, bool) { return Span{.range = 0.5, .change = tile.column == 0 ? 0.25 : 0.1}; };
  const SplitStrata split(parts_, 36, span);
  double largest = 0.0;
  for (std::size_t s = 0; s < split.strata().strata.size(); ++s) {
    const Stratum& stratum = split.strata().strata[s];
    const bool changes = split.strata().tiles[stratum.begin].column == 0;
    EXPECT_EQ(split.is_by_middle(s), !changes);
    largest = std::max(largest, (changes ? 0.25 : kOverChange * 0.1) * stratum.area / split.strata().area);
  }
  EXPECT_DOUBLE_EQ(split.largest_term(), largest);
}

INSTANTIATE_TEST_SUITE_P(Shapes, SplitStrataOf,
                         testing::Values(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {8, 0, 0}, {8, 1, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 3, 0}, {0, 2, 0}}));

}  // namespace
}  // namespace exactff::view_factors
