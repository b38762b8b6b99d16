// Random points of patches: where they lie, and what their means are.
#include "view_factors/strata.h"

#include <iterator>
#include <ostream>

#include "kernel/vec.h"
#include "support/test.h"
#include "view_factors/exact_scene.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {
namespace {

// The first one's control variate is given, the second one's is the first number. `share`: of the area, of the stratum.
void add_numbers(StratifiedMean& mean, double a, double b, double control, double share) {
  mean.add(a, control, control, 0.5 * share);
  mean.add(b, a, a, 0.5 * share);
}

struct Patch {
  const char* name;
  std::vector<std::vector<Vec3>> rings;
  std::vector<Vec3> wall{};  // stands on it, if there is one
};

void PrintTo(const Patch& patch, std::ostream* out) { *out << patch.name; }

std::vector<Patch> patches() {
  return {
      {"square", {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}},
      {"strip", {{{0, 0, 0}, {9, 0, 0}, {9, 1, 0}, {0, 1, 0}}}},
      {"sheared", {{{0, 0, 0}, {2, 1, 0}, {3, 3, 0}, {1, 2, 0}}}},
      {"triangle", {{{0, 0, 0}, {3, 0, 1}, {0, 2, 0}}}},
      {"kite", {{{0, 0, 0}, {2, 1, 0}, {3, 3, 0}, {1, 2.5, 0}}}},
      {"hexagon", {{{1, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 1, 0}}}},
      {"square and triangle", {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{4, 0, 0}, {5, 0, 0}, {4, 3, 0}}}},
      {"cut square", {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{0.375, 0, 0}, {0, 1.125, 0}, {0, 1.125, 1}}},
      {"cut kite", {{{0, 0, 0}, {2, 1, 0}, {3, 3, 0}, {1, 2.5, 0}}}, {{0, 2, 0}, {3, 1, 0}, {3, 1, 1}}},
  };
}

struct Sample {
  std::size_t part;
  Point point;
};

// The point of one of the two draws of a stratum.
Sample sample(const std::vector<Part>& parts, const Strata& strata, std::size_t analysis, std::size_t stratum,
              std::size_t draw, const Units& units) {
  Draws draws(analysis, stratum, draw);
  const Tile& tile = draw_tile(strata, strata.strata[stratum], draw, draws);
  return {tile.part, point_at(parts[tile.part], tile, draw_place(tile, draws), units)};
}

class StrataOf : public testing::TestWithParam<Patch> {
 protected:
  static PlainScene plain() {
    PlainScene plain;
    for (const std::vector<Vec3>& ring : GetParam().rings) plain.add_ring(plain.patch("patch"), ring);
    if (!GetParam().wall.empty()) plain.add_ring(plain.patch("wall"), GetParam().wall);
    return plain;
  }
  static std::vector<Part> fragments(const ExactScene& scene) {
    std::vector<Part> result;
    for (const Part& part : parts_of(scene, scene.scene.select("patch"))) {
      std::ranges::move(cut_at_contacts(scene, part), std::back_inserter(result));
    }
    return result;
  }

  const Scene scene_ = generate::build(plain());
  const ExactScene exact_{scene_};
  const std::vector<Part> parts_ = fragments(exact_);

  // The mean over the patch; its square is the sum of those of half the differences.
  template <typename Function>
  StratifiedMean mean_of(const Strata& strata, std::size_t analysis, const Function& f) {
    StratifiedMean mean;
    for (std::size_t s = 0; s < strata.strata.size(); ++s) {
      const auto value = [&](std::size_t draw) {
        return f(sample(parts_, strata, analysis, s, draw, exact_.units).point.at);
      };
      const double a = value(0);
      add_numbers(mean, a, value(1), a, strata.strata[s].area / strata.area);
    }
    return mean;
  }

  // By Gauss's rule for a triangle that is exact for squares: the middles of its sides.
  template <typename Function>
  double exact_mean(const Function& f) {
    double sum = 0.0, whole = 0.0;
    for (const Part& part : parts_) {
      const std::vector<Vec3> ring = positions_of(part.corners);
      for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        const std::array<Vec3, 3> t{ring[0], ring[i], ring[i + 1]};
        const double size = area({t[0], t[1], t[2]});
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 &a = t[k], &b = t[(k + 1) % 3];
          sum += size / 3.0 * f({0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z)});
        }
        whole += size;
      }
    }
    return sum / whole;
  }
};

// The mean over many analyses, within five standard errors; and what the analyses say of their variance.
TEST_P(StrataOf, MeansOfSquaresAreUnbiased) {
  const auto f = [](const Vec3& p) { return p.x * p.x + p.x * p.y + 2.0 * p.z * p.z; };
  const Strata strata = strata_of(parts_, 36);
  constexpr std::size_t kAnalyses = 400;
  double sum = 0.0, squares = 0.0, variance = 0.0;
  for (std::size_t analysis = 0; analysis < kAnalyses; ++analysis) {
    const StratifiedMean mean = mean_of(strata, analysis, f);
    sum += mean.value;
    squares += mean.value * mean.value;
    variance += mean.square / kAnalyses;
  }
  const double average = sum / kAnalyses, spread = squares / kAnalyses - average * average;
  EXPECT_NEAR(average, exact_mean(f), 5.0 * std::sqrt(spread / kAnalyses));
  EXPECT_GT(variance, 0.7 * spread);
  EXPECT_LT(variance, 1.4 * spread);
}

// Their middle is the mean of the places in them, and sides and corners lie where points are drawn.
TEST_P(StrataOf, MiddlesAreTheMeansOfPlaces) {
  const Strata strata = strata_of(parts_, 36);
  for (const Tile& tile : {strata.tiles.front(), strata.tiles.back()}) {
    const Part& part = parts_[tile.part];
    constexpr std::size_t kDrawn = 4000;
    Place sum;
    for (std::size_t n = 0; n < kDrawn; ++n) {
      Draws draws(1, 0, n);
      const Place place = draw_place(tile, draws);
      sum = {sum.along + place.along, sum.up + place.up};
      if (n >= 20) continue;
      const Vec3 at = point_at(part, tile, place, exact_.units).at, close = sides_of(part, tile).at(place);
      EXPECT_LE(kernel::distance(at, close), 0x1p-48);
      double areas = 0.0;
      const std::vector<Vec3> corners = corners_of(part, tile);
      for (std::size_t i = 0; i < corners.size(); ++i)
        areas += area({corners[i], corners[(i + 1) % corners.size()], at});
      EXPECT_NEAR(areas, area(corners), 1e-9 * area(corners));
    }
    const Place middle = middle_of(tile);
    EXPECT_NEAR(sum.along / kDrawn, middle.along, 0.025);
    EXPECT_NEAR(sum.up / kDrawn, middle.up, 0.025);
  }
}

INSTANTIATE_TEST_SUITE_P(Patches, StrataOf, testing::ValuesIn(patches()), [](const auto& test) {
  std::string name = test.param.name;
  std::ranges::replace(name, ' ', '_');
  return name;
});

// Strips of different widths with gaps between them, more than are worth a stratum each. The function is 1 on every
// second one.
TEST(Strata, OfManyFacesShareTheirFacesWithoutBias) {
  PlainScene plain;
  double x = 0.0, all = 0.0, odd = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double width = 1.0 + i % 7;
    plain.add_ring(plain.patch("strips"), {{x, 0, 0}, {x + width, 0, 0}, {x + width, 1, 0}, {x, 1, 0}});
    x += width + 1.0;
    all += width;
    if (i % 2 == 1) odd += width;
  }
  const Scene scene = generate::build(plain);
  const ExactScene exact(scene);
  const std::vector<Part> parts = parts_of(exact, scene.select("strips"));
  const Strata strata = strata_of(parts, 36);
  EXPECT_GE(strata.strata.size(), 36U);
  EXPECT_LE(strata.strata.size(), 72U);
  constexpr std::size_t kAnalyses = 2000;
  double sum = 0.0, squares = 0.0, variance = 0.0;
  for (std::size_t analysis = 0; analysis < kAnalyses; ++analysis) {
    StratifiedMean mean;
    for (std::size_t s = 0; s < strata.strata.size(); ++s) {
      std::array<double, 2> values{};
      for (std::size_t d = 0; d < 2; ++d) {
        Draws draws(analysis, s, d);
        values[d] = draw_tile(strata, strata.strata[s], d, draws).part % 2 == 1 ? 1.0 : 0.0;
      }
      add_numbers(mean, values[0], values[1], values[0], strata.strata[s].area / strata.area);
    }
    sum += mean.value;
    squares += mean.value * mean.value;
    variance += mean.square / kAnalyses;
  }
  const double average = sum / kAnalyses, spread = squares / kAnalyses - average * average;
  EXPECT_NEAR(average, odd / all, 5.0 * std::sqrt(spread / kAnalyses));
  EXPECT_GT(variance, 0.9 * spread);
}

// However small: without its own stratum, few or no points would meet it.
TEST(Strata, ACornerThatAFacePiercesIsAStratum) {
  PlainScene plain;
  plain.add_ring(plain.patch("floor"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("other"), {{0.01, 0, -1}, {0, 0.01, -1}, {0, 0.01, 1}, {0.01, 0, 1}});
  const Scene scene = generate::build(plain);
  const ExactScene exact(scene);
  const std::vector<Part> floor = parts_of(exact, scene.select("floor")), parts = cut_at_contacts(exact, floor.front());
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(area_of(parts), area_of(floor), 1e-15);
  const auto is_corner = [](const Stratum& s) { return s.area < 1e-4; };
  EXPECT_EQ(std::ranges::count_if(strata_of(parts, 36).strata, is_corner), 1);
}

// --- Strata that are split where a function may be large ---

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
  const SplitStrata::RangeOf range_ = [this](const Tile& tile) { return largest(tile); };
};

TEST_P(SplitStrataOf, ShareTheAreaAndHoldTheFunction) {
  SplitStrata split(parts_, 36, range_);
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
      EXPECT_LE(f(at), split.range(s));
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
  SplitStrata split(parts_, 36, range_);
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

INSTANTIATE_TEST_SUITE_P(Shapes, SplitStrataOf,
                         testing::Values(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {8, 0, 0}, {8, 1, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}},
                                         std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 3, 0}, {0, 2, 0}}));

// --- Intervals of means over strata, judged by numbers whose means are known ---

// Strata of equal area. On each, a function is `high` on a share of it and 0 elsewhere.
struct Spots {
  std::vector<double> shares, high;

  [[nodiscard]] double weight() const { return 1.0 / static_cast<double>(shares.size()); }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (std::size_t s = 0; s < shares.size(); ++s) sum += weight() * shares[s] * high[s];
    return sum;
  }
  // Each range is 1. `control`: of every stratum.
  StratifiedMean analyse(std::mt19937_64& random, double control, double expected) const {
    StratifiedMean result{.expected = expected};
    std::uniform_real_distribution<double> uniform;
    for (std::size_t s = 0; s < shares.size(); ++s) {
      const auto draw = [&] { return uniform(random) < shares[s] ? high[s] : 0.0; };
      const double a = draw();
      add_numbers(result, a, draw(), control, weight());
    }
    return result;
  }
};

Spots spots(std::size_t count, double share, double high = 1.0) {
  return {std::vector(count, share), std::vector(count, high)};
}

// The probability with which an interval of risk 0.2 misses the mean.
double missed(const Spots& of, double control, double expected) {
  constexpr int kAnalyses = 1000;
  constexpr double kRisk = 0.2;
  std::mt19937_64 random(7);
  int missed = 0;
  for (int i = 0; i < kAnalyses; ++i) {
    const StratifiedMean mean = of.analyse(random, control, expected);
    missed += std::abs(mean.value - of.mean()) > mean.error(0.5 * of.weight(), kRisk) ? 1 : 0;
  }
  return static_cast<double>(missed) / kAnalyses;
}

// None of 72 numbers meets anything.
TEST(StratifiedMean, WhatNoNumberHasMetCounts) {
  StratifiedMean mean;
  for (int s = 0; s < 36; ++s) add_numbers(mean, 0.0, 0.0, 0.0, 1.0 / 36.0);
  const double error = mean.error(0.5 / 36.0, 1e-6), least = std::log(2e6) / 72.0;
  EXPECT_GT(error, least);
  EXPECT_LT(error, 1.02 * least);
  EXPECT_LT(std::pow(1.0 - error, 72.0), 1e-6)
      << "the probability that 72 draws miss a set of this share, evenly spread";
  EXPECT_NEAR(mean.error(0.0625 / 36.0, 1e-6), 0.125 * error, 1e-12) << "of a function that is an eighth as large";
}

// Rare, and common; all alike, and different; whatever the control variates, and what was expected.
TEST(StratifiedMean, IntervalsMissNoMoreThanTheirRisk) {
  std::mt19937_64 random(1);
  std::vector<Spots> all;
  for (const double share : {0.002, 0.01, 0.03, 0.1, 0.5, 0.9, 0.999}) all.push_back(spots(60, share));
  for (const double high : {0.1, 0.5}) all.push_back(spots(60, 0.5, high));
  Spots mixed;
  for (int s = 0; s < 60; ++s) {
    mixed.shares.push_back(std::uniform_real_distribution<double>()(random));
    mixed.high.push_back(std::uniform_real_distribution<double>()(random));
  }
  all.push_back(mixed);
  const double r = 0.5 / 60.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const double control : {0.0, 0.5, 1.0}) {
      for (const double expected : {0.0, 2.0 * r * r, 30.0 * r * r})
        EXPECT_LT(missed(all[i], control, expected), 0.2) << i;
    }
  }
}

}  // namespace
}  // namespace exactff::view_factors
