// Drafts of matrices: intervals hold the factors that are known otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "exactff/matrix.h"
#include "generate/plain_scene.h"
#include "support/random_scenes.h"
#include "support/view_scenes.h"

namespace exactff::validation {
namespace {

using generate::PlainScene;
using matrix::draft;
using matrix::DraftOptions;
using matrix::Matrix;

std::vector<Selection> patches_with_area(const Scene& scene) {
  std::vector<Selection> all;
  for (std::uint32_t p = 0; p < scene.patches().size(); ++p) {
    if (!scene.faces_of({PatchId{p}, {}}).empty()) all.push_back({PatchId{p}, {}});
  }
  return all;
}

Matrix draft_of(const Scene& scene, const DraftOptions& options = {}) {
  const std::vector<Selection> all = patches_with_area(scene);
  return draft(scene, all, all, options);
}

// Looking inward, in the order x = 0, x = 1, y = 0, ...
Scene cube() {
  PlainScene plain;
  plain.add_ring(plain.patch("left"), {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  plain.add_ring(plain.patch("right"), {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});
  plain.add_ring(plain.patch("front"), {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  plain.add_ring(plain.patch("rear"), {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}});
  plain.add_ring(plain.patch("floor"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("ceiling"), {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  return generate::build(plain);
}

TEST(Draft, OfACubeHoldsTheKnownFactors) {
  const double opposite = 0.19982489569838746, beside = 0.20004377607540314;
  const Scene scene = cube();
  for (const std::size_t views : {216, 2000}) {
    const Matrix m = draft_of(scene, {.views = views, .backs = true, .open = true});
    for (std::size_t i = 0; i < 6; ++i) {
      double sum = m.back[i].value + m.open[i].value;
      for (std::size_t j = 0; j < 6; ++j) {
        const ViewFactor& f = m.factors.at(i, j);
        sum += f.value;
        if (i == j) {
          EXPECT_EQ(f.claim, Claim::kZero);
          EXPECT_EQ(f.upper, 0.0);
          continue;
        }
        EXPECT_EQ(f.claim, Claim::kEstimated);
        const double truth = i / 2 == j / 2 ? opposite : beside;
        EXPECT_LE(f.lower, truth);
        EXPECT_GE(f.upper, truth);
        EXPECT_LT(f.upper - f.lower, views == 216 ? 0.7 : 0.25);
        EXPECT_EQ(f.area_from, 1.0);
      }
      EXPECT_NEAR(sum, 1.0, 1e-13);
      EXPECT_GT(m.open[i].upper, 0.0) << "not proved";
    }
  }
}

TEST(Draft, DoesNotDependOnThreads) {
  const Scene scene = cube();
  const Matrix one = draft_of(scene, {.threads = 1}), two = draft_of(scene, {.threads = 2});
  for (std::size_t e = 0; e < one.factors.entries.size(); ++e) {
    EXPECT_EQ(one.factors.entries[e].value, two.factors.entries[e].value);
    EXPECT_EQ(one.factors.entries[e].upper, two.factors.entries[e].upper);
  }
}

// Two squares of one metre, ten metres apart. A millimetre above the lower one is a lid with a hole of a millimetre.
TEST(Draft, WhatNoViewHasMetHasAnUpperBound) {
  PlainScene plain;
  plain.add_ring(plain.patch("low"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("high"), {{0, 0, 10}, {0, 1, 10}, {1, 1, 10}, {1, 0, 10}});
  const double a = 0.5, b = 0.501, h = 0.001;
  generate::PlainPatch& lid = plain.patch("lid");
  plain.add_ring(lid, {{-9, -9, h}, {a, -9, h}, {a, 9, h}, {-9, 9, h}});
  plain.add_ring(lid, {{b, -9, h}, {9, -9, h}, {9, 9, h}, {b, 9, h}});
  plain.add_ring(lid, {{a, -9, h}, {b, -9, h}, {b, a, h}, {a, a, h}});
  plain.add_ring(lid, {{a, b, h}, {b, b, h}, {b, 9, h}, {a, 9, h}});
  const Scene scene = generate::build(plain);
  const Matrix m = draft_of(scene);
  const ViewFactor &f = m.factors.at(0, 1),
                   truth = view_factor(scene, scene.select("low"), scene.select("high"), {.accuracy = 1e-10});
  ASSERT_GT(truth.lower, 0.0);
  ASSERT_EQ(f.value, 0.0);
  EXPECT_EQ(f.claim, Claim::kEstimated);
  EXPECT_LE(f.lower, truth.lower);
  EXPECT_GE(f.upper, truth.upper);
  EXPECT_LE(f.upper, 1.0 / (100.0 * 3.14159)) << "A / (pi d^2)";
}

TEST(Draft, RefusesFacesAndTransparentColumns) {
  const Scene scene = cube();
  const std::vector<Selection> from = {scene.select("floor")}, face = {scene.select("left:1")};
  EXPECT_THROW((void)draft(scene, from, face, {}), InputError);
  const Scene clear = scene.with_transparent(std::vector{scene.select("left")});
  EXPECT_THROW((void)draft(clear, std::vector{clear.select("floor")}, std::vector{clear.select("left")}, {}),
               InputError);
}

class DraftOf : public testing::TestWithParam<RandomFamily> {};

// By cells, as far as they go; both intervals hold the factor, so they meet.
TEST_P(DraftOf, RandomScenesMeetsTheFactorsByCells) {
  for_each_scene_of(GetParam(), 120, [](const PlainScene&, const Scene& scene, const Receiver&) {
    const std::vector<Selection> all = patches_with_area(scene);
    Matrix m;
    try {
      m = draft_of(scene);
    } catch (const InputError&) {
      return;  // an area that no double holds
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(all.size(), 3); ++i) {
      for (std::size_t j = 0; j < std::min<std::size_t>(all.size(), 3); ++j) {
        const ViewFactor cells =
            view_factor(scene, all[i], all[j], {.accuracy = 1e-2, .budget = 300, .sample_crowds = false});
        EXPECT_LE(m.factors.at(i, j).lower, cells.upper) << scene.name_of(all[i]) << ' ' << scene.name_of(all[j]);
        EXPECT_GE(m.factors.at(i, j).upper, cells.lower) << scene.name_of(all[i]) << ' ' << scene.name_of(all[j]);
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Families, DraftOf, testing::ValuesIn(random_families()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace exactff::validation
