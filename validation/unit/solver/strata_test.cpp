// Random points of patches: where they lie, and what their means are.
#include "view_factors/strata.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include "exactff/scene.h"
#include "generate/plain_scene.h"
#include "kernel/vec.h"
#include "unit/solver/add_numbers.h"
#include "view_factors/exact_scene.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {
namespace {

using generate::PlainScene;

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

TEST_P(StrataOf, AreAtLeastAsManyAsAskedForAndShareTheArea) {
  for (const std::size_t count : {1, 36, 37, 500}) {
    const Strata strata = strata_of(parts_, count);
    EXPECT_GE(strata.strata.size(), count);
    EXPECT_LE(strata.strata.size(), 2 * count + 10);
    EXPECT_NEAR(strata.area, area_of(parts_), 1e-12 * strata.area);
    const double largest = std::ranges::max(strata.strata, {}, &Stratum::area).area / strata.area;
    EXPECT_LE(largest, 1.00001 / static_cast<double>(count));
  }
}

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

// Of a unit square with other faces on it.
class Contacts : public testing::Test {
 protected:
  Contacts() { plain_.add_ring(plain_.patch("floor"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}); }
  void add(std::vector<Vec3> ring) { plain_.add_ring(plain_.patch("other"), std::move(ring)); }

  // The parts of the floor.
  std::vector<Part> cut() {
    const Scene scene = generate::build(plain_);
    const ExactScene exact(scene);
    std::vector<Part> parts = cut_at_contacts(exact, parts_of(exact, scene.select("floor")).front());
    EXPECT_NEAR(area_of(parts), area_of(parts_of(exact, scene.select("floor"))), 1e-15);
    return parts;
  }
  // Of the floor's area.
  static double share(const Part& part, const std::vector<Part>& all) { return area_of({part}) / area_of(all); }

  PlainScene plain_;
};

// However small: without its own stratum, few or no points would meet it.
TEST_F(Contacts, ACornerThatAFacePiercesIsAStratum) {
  add({{0.01, 0, -1}, {0, 0.01, -1}, {0, 0.01, 1}, {0.01, 0, 1}});
  const std::vector<Part> parts = cut();
  ASSERT_EQ(parts.size(), 2U);
  const Strata strata = strata_of(parts, 36);
  const auto is_corner = [&](const Stratum& s) { return s.area < 1e-4; };
  EXPECT_EQ(std::ranges::count_if(strata.strata, is_corner), 1);
}

TEST_F(Contacts, WhatHasNoLineOnItsFrontDoesNotCutIt) {
  add({{0.25, 0, 0}, {0.25, 1, 0}, {0.25, 1, -1}, {0.25, 0, -1}});            // below
  add({{0.5, 0, 0.125}, {0.5, 1, 0.125}, {0.5, 1, 1}, {0.5, 0, 1}});          // above
  add({{0.75, 0.5, 0}, {0.75, 1, 1}, {0.75, 0, 1}});                          // on its tip
  add({{2, 0.5, 0}, {3, 0.5, 0}, {3, 0.5, 1}, {2, 0.5, 1}});                  // beside
  add({{1, 0.625, 0}, {2, 0.625, 0}, {2, 0.625, 1}, {1, 0.625, 1}});          // only its end touches it
  add({{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}});                          // on its rim
  add({{0.25, 0.25, 0}, {0.375, 0.25, 0}, {0.375, 0.5, 0}, {0.25, 0.5, 0}});  // in its plane
  const std::vector<Part> parts = cut();
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_TRUE(parts[0].is_piece);
  EXPECT_FALSE(parts[0].is_cut);
}

}  // namespace
}  // namespace exactff::view_factors
