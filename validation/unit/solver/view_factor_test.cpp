// View factors from patch to patch with known values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "exactff/matrix.h"
#include "exactff/models.h"
#include "exactff/receiver.h"
#include "exactff/scene_files.h"
#include "exactff/view_factors.h"
#include "generate/plain_scene.h"
#include "support/program.h"

namespace exactff {
namespace {

using generate::PlainScene;

Selection named(const Scene& scene, const char* name) { return scene.select(name); }

void add(PlainScene& scene, const char* name, const std::vector<Vec3>& corners) {
  scene.add_ring(scene.patch(name), corners);
}

// Squares of this side, `gap` apart, fronts facing: "below" and "above".
PlainScene plates(double side, double gap) {
  PlainScene scene;
  add(scene, "below", {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}});
  add(scene, "above", {{0, side, gap}, {side, side, gap}, {side, 0, gap}, {0, 0, gap}});
  return scene;
}

// A square plate between them, centred.
PlainScene plates_with_plate(double side, double plate, double height) {
  PlainScene scene = plates(side, 1.0);
  const double low = 0.5 * (side - plate), high = 0.5 * (side + plate);
  add(scene, "plate", {{low, low, height}, {high, low, height}, {high, high, height}, {low, high, height}});
  return scene;
}

void expect_factor(const Scene& scene, const char* from, const char* to, double accuracy, double truth) {
  const ViewFactor f = view_factor(scene, named(scene, from), named(scene, to), {.accuracy = accuracy});
  EXPECT_TRUE(f.accurate);
  EXPECT_EQ(f.claim, Claim::kEstimated);
  EXPECT_LE(f.lower, truth);
  EXPECT_GE(f.upper, truth);
  EXPECT_LE(f.upper - f.lower, accuracy * 1.001);
  EXPECT_LE(f.lower, f.value);
  EXPECT_LE(f.value, f.upper);
}

TEST(ViewFactor, OfParallelSquaresIsTheKnownOne) {
  const Scene near = generate::build(plates(1.0, 1.0));
  for (const double accuracy : {1e-3, 1e-6, 1e-10}) {
    expect_factor(near, "below", "above", accuracy, 0.199824895698387383041599251193);
  }
  expect_factor(generate::build(plates(2.0, 1.0)), "below", "above", 1e-10, 0.415253283577146735374144917);
  expect_factor(generate::build(plates(1.0, 10.0)), "below", "above", 1e-10, 0.00316205683875760162512871788517);
  expect_factor(generate::build(plates(1.0, 100.0)), "below", "above", 1e-10, 3.18288667328291964442604e-5);
  expect_factor(generate::build(plates(1.0, 1000.0)), "below", "above", 1e-10, 3.18309673977380257770e-7);
}

// A square with a hole, and the square that fills the hole, both ways.
TEST(ViewFactor, OfAFrameAndOfWhatFillsItAddUp) {
  PlainScene scene;
  const std::vector<Vec3> hole{{0.25, 0.5, 1}, {0.5, 0.75, 1}, {0.75, 0.5, 1}, {0.5, 0.25, 1}};
  add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  scene.add_rings(scene.patch("frame"), {{{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}}, hole});
  add(scene, "plug", hole);
  const Scene built = generate::build(scene);
  const auto factor = [&](const char* from, const char* to) {
    return view_factor(built, named(built, from), named(built, to), {.accuracy = 1e-8});
  };
  const ViewFactor frame = factor("below", "frame"), plug = factor("below", "plug");
  const double whole = 0.199824895698387;  // of unit squares, 1 apart
  EXPECT_LE(frame.lower + plug.lower, whole);
  EXPECT_GE(frame.upper + plug.upper, whole);
  const ViewFactor back = factor("frame", "below");
  EXPECT_NEAR(back.area_from, 0.875, 1e-15);
  EXPECT_LE(back.lower * back.area_from, frame.upper);
  EXPECT_GE(back.upper * back.area_from, frame.lower);
}

// Seen from afar, the factor is A / (pi d^2), less a share of the order of A / d^2.
TEST(ViewFactor, OfFarSquaresIsThatOfPoints) {
  for (const double gap : {1e4, 1e6}) {
    const Scene scene = generate::build(plates(1.0, gap));
    const double of_points = 1.0 / (std::numbers::pi * gap * gap);
    for (const bool certify : {false, true}) {
      const ViewFactor f = view_factor(scene, named(scene, "below"), named(scene, "above"),
                                       {.accuracy = 1e-6 * of_points, .certify = certify});
      EXPECT_TRUE(f.accurate) << gap;
      EXPECT_NEAR(f.value / of_points, 1.0, 1e-7) << gap;
      EXPECT_LT(f.lower, f.upper) << gap;
    }
  }
}

TEST(ViewFactor, OfSquaresWithACommonEdgeIsTheKnownOne) {
  PlainScene scene;
  add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(scene, "wall", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  for (const double accuracy : {1e-3, 1e-6, 1e-10}) {
    expect_factor(generate::build(scene), "floor", "wall", accuracy, 0.200043776075403154239600187202);
    expect_factor(generate::build(scene), "wall", "floor", accuracy, 0.200043776075403154239600187202);
  }
}

TEST(ViewFactor, WithAPlateBetweenIsTheKnownOne) {
  for (const double accuracy : {1e-3, 1e-6, 1e-10}) {
    expect_factor(generate::build(plates_with_plate(1.0, 0.5, 0.75)), "below", "above", accuracy,
                  0.115620602132415020312711990740);
    expect_factor(generate::build(plates_with_plate(2.0, 0.9, 0.75)), "below", "above", accuracy,
                  0.2828875141866424869);
  }
}

// Three plates at different heights, whose edges meet in one point as the middle of a small patch sees them. From some
// of its points there is a triangular gap between them; from the others they overlap.
Scene plates_round_a_gap(double turn) {
  PlainScene scene;
  const double half = 0.05;
  add(scene, "below", {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}});
  add(scene, "above", {{-2, 2, 1}, {2, 2, 1}, {2, -2, 1}, {-2, -2, 1}});
  for (int k = 0; k < 3; ++k) {
    const double angle = turn + 2.0 * k, c = std::cos(angle), s = std::sin(angle);
    const auto corner = [&](double u, double v) { return Vec3{c * u - s * v, s * u + c * v, 0.3 + 0.2 * k}; };
    add(scene, ("plate " + std::to_string(k)).c_str(), {corner(0, -4), corner(4, -4), corner(4, 4), corner(0, 4)});
  }
  return generate::build(scene);
}

// The mean of exact point factors over a grid on "below".
double mean_from_points(const Scene& scene) {
  const ExactSource above(scene, named(scene, "above"));
  const std::vector<Receiver> points = grid_receivers(scene, named(scene, "below"), {40, 40});
  double sum = 0.0;
  for (const Receiver& point : points) sum += exact_form_factor(scene, point, above).value;
  return sum / static_cast<double>(points.size());
}

TEST(ViewFactor, WhereThreeEdgesMeetIsBounded) {
  constexpr double kErrorOfMean = 1e-6;
  for (const double turn : {0.1, 0.6, 1.1}) {
    const Scene scene = plates_round_a_gap(turn);
    const double mean = mean_from_points(scene);
    EXPECT_GT(mean, 10 * kErrorOfMean);
    std::size_t event_cells = 0;
    for (const double accuracy : {0.3, 0.03, 3e-3, 3e-4, 3e-5}) {
      const ViewFactor f = view_factor(scene, named(scene, "below"), named(scene, "above"), {.accuracy = accuracy});
      event_cells += f.event_cells;
      EXPECT_LE(f.lower, mean + kErrorOfMean) << turn << ' ' << accuracy;
      EXPECT_GE(f.upper, mean - kErrorOfMean) << turn << ' ' << accuracy;
      EXPECT_LE(f.upper - f.lower, 1.001 * accuracy) << turn;
    }
    EXPECT_GT(event_cells, 0U);
  }
}

matrix::Factors matrix_of(const std::string& file, double accuracy) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/formats/" + file);
  std::vector<Selection> all;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) all.push_back({PatchId(i), {}, scene.id()});
  return matrix::compute(scene, all, all, {.factors = {.accuracy = accuracy}}).factors;
}

void expect_rows_to_hold_one(const matrix::Factors& matrix, double accuracy) {
  for (std::size_t i = 0; i < matrix.from.size(); ++i) {
    double lower = 0.0, upper = 0.0;
    for (std::size_t j = 0; j < matrix.to.size(); ++j) {
      lower += matrix.at(i, j).lower;
      upper += matrix.at(i, j).upper;
    }
    EXPECT_LE(lower, 1.0) << i;
    EXPECT_GE(upper, 1.0) << i;
    EXPECT_LT(upper - lower, 1.001 * accuracy * static_cast<double>(matrix.to.size())) << i;
  }
}

TEST(ViewFactor, OfTheLShapedRoomIsTheKnownOneAndRowsAddUpToOne) {
  const matrix::Factors matrix = matrix_of("test4.vs3", 1e-8);
  EXPECT_LE(matrix.at(0, 5).lower, 0.1823559036685958);
  EXPECT_GE(matrix.at(0, 5).upper, 0.1823559036685958);
  expect_rows_to_hold_one(matrix, 1e-8);
}

TEST(ViewFactor, RowsOfOtherRoomsOfView3DAddUpToOne) {
  expect_rows_to_hold_one(matrix_of("facet.vs3", 1e-6), 1e-6);
  expect_rows_to_hold_one(matrix_of("box345.vs3", 1e-4), 1e-4);
  expect_rows_to_hold_one(matrix_of("gunter1.vs3", 1e-4), 1e-4);
}

// The matrix has the values of single calls, whatever the number of threads.
TEST(ViewFactor, OfAMatrixIsThatOfItsPair) {
  const Scene scene = generate::build(plates_with_plate(1.0, 0.5, 0.75));
  const std::vector<Selection> all{named(scene, "below"), named(scene, "above"), named(scene, "plate")};
  const matrix::Factors one = matrix::compute(scene, all, all, {.threads = 1}).factors,
                        four = matrix::compute(scene, all, all, {.threads = 4}).factors;
  for (std::size_t e = 0; e < one.entries.size(); ++e) {
    EXPECT_EQ(one.entries[e].value, four.entries[e].value);
    EXPECT_EQ(one.entries[e].lower, four.entries[e].lower);
    EXPECT_EQ(one.entries[e].upper, four.entries[e].upper);
  }
  const ViewFactor pair = view_factor(scene, all[0], all[1]), back = view_factor(scene, all[1], all[0]);
  EXPECT_EQ(one.at(0, 1).value, pair.value);
  EXPECT_LE(std::abs(one.at(1, 0).value - back.value), back.upper - back.lower);
}

TEST(ViewFactor, ProvesZeros) {
  PlainScene scene = plates(1.0, 1.0);
  add(scene, "back", {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}});             // looks down
  add(scene, "lid", {{-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5}});  // hides all
  add(scene, "half", {{0, 0, 0.25}, {0.5, 0, 0.25}, {0.5, 1, 0.25}, {0, 1, 0.25}});
  const Scene built = generate::build(scene);
  const auto claim = [&](const char* from, const char* to) {
    const ViewFactor f = view_factor(built, named(built, from), named(built, to));
    EXPECT_EQ(f.claim == Claim::kZero, f.upper == 0.0);
    return f.claim;
  };
  EXPECT_EQ(claim("below", "above"), Claim::kZero);
  EXPECT_EQ(claim("back", "above"), Claim::kZero);
  EXPECT_EQ(claim("below", "below"), Claim::kZero);
  EXPECT_EQ(claim("lid", "above"), Claim::kEstimated);
}

TEST(ViewFactor, SplittingAPatchAddsUp) {
  const Scene whole = generate::build(plates_with_plate(1.0, 0.5, 0.75));
  PlainScene cut;
  add(cut, "left", {{0, 0, 0}, {0.375, 0, 0}, {0.375, 1, 0}, {0, 1, 0}});
  add(cut, "right", {{0.375, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.375, 1, 0}});
  add(cut, "both", {{0, 0, 0}, {0.375, 0, 0}, {0.375, 1, 0}, {0, 1, 0}});
  add(cut, "both", {{0.25, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.25, 1, 0}});  // overlaps: a point counts once
  PlainScene rest = plates_with_plate(1.0, 0.5, 0.75);
  for (const char* name : {"above", "plate"}) {
    for (const generate::PlainFace& face : rest.patch(name).faces) {
      std::vector<Vec3> corners;
      for (const std::uint32_t v : face.rings.front()) corners.push_back(rest.vertices[v]);
      add(cut, name, corners);
    }
  }
  const Scene split = generate::build(cut);
  const ViewFactor f = view_factor(whole, named(whole, "below"), named(whole, "above"), {.accuracy = 1e-9});
  const ViewFactor left = view_factor(split, named(split, "left"), named(split, "above"), {.accuracy = 1e-9});
  const ViewFactor right = view_factor(split, named(split, "right"), named(split, "above"), {.accuracy = 1e-9});
  const ViewFactor both = view_factor(split, named(split, "both"), named(split, "above"), {.accuracy = 1e-9});
  EXPECT_NEAR(0.375 * left.value + 0.625 * right.value, f.value, 1e-9);
  EXPECT_NEAR(both.value, f.value, 1e-9);
  EXPECT_NEAR(both.area_from, 1.0, 1e-15);
}

TEST(ViewFactor, KeepsItsWidthWhereTheBudgetIsUsedUp) {
  PlainScene scene = plates(1.0, 1.0);
  // Three triangles whose edges cross one another in the view: event cells.
  add(scene, "a", {{0.1, 0.1, 0.3}, {0.9, 0.2, 0.4}, {0.4, 0.8, 0.35}});
  add(scene, "b", {{0.2, 0.05, 0.5}, {0.95, 0.6, 0.55}, {0.3, 0.9, 0.6}});
  add(scene, "c", {{0.5, 0.1, 0.7}, {0.8, 0.9, 0.65}, {0.1, 0.5, 0.75}});
  const Scene built = generate::build(scene);
  const Selection from = named(built, "below"), to = named(built, "above");
  const ViewFactor fine = view_factor(built, from, to, {.accuracy = 1e-4});
  EXPECT_TRUE(fine.accurate);
  EXPECT_GT(fine.event_cells, 0U);
  const ViewFactor coarse = view_factor(built, from, to, {.accuracy = 1e-4, .budget = 50, .sample_crowds = false});
  EXPECT_FALSE(coarse.accurate);
  EXPECT_EQ(coarse.claim, Claim::kEstimated);
  EXPECT_GT(coarse.upper - coarse.lower, 1e-4);
  EXPECT_LE(coarse.lower, fine.upper);
  EXPECT_GE(coarse.upper, fine.lower);
}

// More work would not help, and is not done.
TEST(ViewFactor, SaysWhenOnlyRoundingsAreLeft) {
  const Scene scene = generate::build(plates_with_plate(1.0, 0.5, 0.75));
  const Selection below = named(scene, "below"), above = named(scene, "above");
  for (const bool certify : {true, false}) {
    const ViewFactor found = view_factor(scene, below, above, {.accuracy = 1e-15, .certify = certify});
    EXPECT_FALSE(found.accurate);
    EXPECT_EQ(found.limit, Limit::kRounding) << certify;
    EXPECT_LT(found.upper - found.lower, 1e-12);
    EXPECT_LT(found.cells, 50000U);
    EXPECT_EQ(view_factor(scene, below, above, {.accuracy = 1e-15, .budget = 8, .certify = certify}).limit,
              Limit::kBudget);
  }
}

// Nine parts see nine parts, and the budget is used up by the first pair.
TEST(ViewFactor, OfManyPartsIsBoundedByDistanceWhereTheBudgetIsUsedUp) {
  PlainScene scene;
  for (int i = 0; i < 9; ++i) {
    const double x = 2.0 * (i % 3), y = 2.0 * (i / 3);
    add(scene, "below", {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
    add(scene, "above", {{x, y + 1, 20}, {x + 1, y + 1, 20}, {x + 1, y, 20}, {x, y, 20}});
  }
  const Scene built = generate::build(scene);
  const Selection from = named(built, "below"), to = named(built, "above");
  const ViewFactor fine = view_factor(built, from, to);
  EXPECT_TRUE(fine.accurate);
  for (const bool certify : {false, true}) {
    const ViewFactor f = view_factor(built, from, to, {.budget = 1, .sample_crowds = false, .certify = certify});
    EXPECT_FALSE(f.accurate);
    EXPECT_LE(f.upper, 0.02);
    EXPECT_LE(f.lower, fine.upper);
    EXPECT_GE(f.upper, fine.lower);
  }
}

// A mean over the larger patch would be wider by the ratio of the areas.
TEST(ViewFactor, OfACrowdIsByPointsOfTheSmallerPatch) {
  PlainScene scene = plates(8.0, 1.0);
  add(scene, "small", {{3, 3, 0.5}, {4, 3, 0.5}, {4, 4, 0.5}, {3, 4, 0.5}});
  const Scene built = generate::build(scene);
  const ViewFactorOptions options{.accuracy = 1e-9, .budget = 1};
  const ViewFactor f = view_factor(built, named(built, "small"), named(built, "above"), options),
                   back = view_factor(built, named(built, "above"), named(built, "small"), options);
  EXPECT_EQ(f.way, Way::kPoints);
  EXPECT_EQ(back.way, Way::kPoints);
  EXPECT_NEAR((back.upper - back.lower) * 64.0, f.upper - f.lower, 1e-12);
}

// With a single cell, everything is a crowd.
TEST(ViewFactor, OfACrowdIsByPoints) {
  const Scene built = generate::build(plates_with_plate(1.0, 0.5, 0.75));
  const std::vector<Selection> below{named(built, "below")}, above{named(built, "above")};
  const auto matrix = [&](double accuracy, std::size_t budget, int threads) {
    return matrix::compute(built, below, above,
                           {.factors = {.accuracy = accuracy, .budget = budget}, .threads = threads})
        .factors.entries.front();
  };
  const ViewFactor f = matrix(1e-9, 1, 1);
  EXPECT_EQ(f.claim, Claim::kEstimated);
  EXPECT_EQ(f.way, Way::kPoints);
  EXPECT_FALSE(f.accurate);
  EXPECT_LE(f.lower, 0.115620602132415020312711990740);
  EXPECT_GE(f.upper, 0.115620602132415020312711990740);
  EXPECT_GT(f.upper - f.lower, 1e-5);
  EXPECT_LT(f.upper - f.lower, 0.2);
  const ViewFactor again = matrix(1e-9, 1, 4);
  EXPECT_EQ(f.lower, again.lower);
  EXPECT_EQ(f.upper, again.upper);
  const ViewFactor enough = matrix(0.2, 1, 1);
  EXPECT_TRUE(enough.accurate);
  EXPECT_LE(enough.upper - enough.lower, 0.2);
}

// Two squares with the slats of a blind between them, turned by different angles.
PlainScene with_slats(PlainScene scene) {
  constexpr int kSlats = 24;
  for (int i = 0; i < kSlats; ++i) {
    const double x = (i + 0.5) / kSlats, angle = 0.3 + 0.02 * i, half = 0.55 / kSlats;
    const double dx = half * std::cos(angle), dz = half * std::sin(angle);
    add(scene, "blind",
        {{x - dx, 0.01, 0.5 - dz}, {x + dx, 0.02, 0.5 + dz}, {x + dx, 0.98, 0.5 + dz}, {x - dx, 0.99, 0.5 - dz}});
  }
  return scene;
}

// Long before the cells have cost what the limit allows.
TEST(ViewFactor, OfACrowdIsByPointsAsSoonAsTheyAreCheaper) {
  const Scene scene = generate::build(with_slats(plates(1.0, 1.0)));
  const Selection from = named(scene, "below"), to = named(scene, "above");
  const ViewFactor f = view_factor(scene, from, to, {.accuracy = 4e-3});
  EXPECT_EQ(f.way, Way::kPoints);
  EXPECT_TRUE(f.accurate);
  EXPECT_LT(f.cells, 5000U);
  const ViewFactor by_cells = view_factor(scene, from, to, {.accuracy = 4e-3, .budget = 3000, .sample_crowds = false});
  EXPECT_LE(f.lower, by_cells.upper);
  EXPECT_GE(f.upper, by_cells.lower);
  const ViewFactor both = view_factor(scene, from, to, {.accuracy = 1e-6, .budget = 2000});  // cells that have paused
  EXPECT_LE(both.lower, f.upper);
  EXPECT_GE(both.upper, f.lower);
}

// Of the cells that are not known when the limit is reached, points tell more than bounds do, and no other thing.
TEST(ViewFactor, ByPointsAtCellsIsNarrowerAndAsTrue) {
  PlainScene roof;
  add(roof, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(roof, "above", {{0, 1, 1}, {0.7, 1, 1.3}, {0.7, 0, 1.3}, {0, 0, 1}});
  add(roof, "above", {{0.7, 1, 1.3}, {1, 1, 0.9}, {1, 0, 0.9}, {0.7, 0, 1.3}});
  for (const PlainScene& plain : {plates(1.0, 1.0), roof}) {
    const Scene scene = generate::build(with_slats(plain));
    const Selection from = named(scene, "below"), source = named(scene, "above");
    const ViewFactor truth = view_factor(scene, from, source, {.accuracy = 4e-3});
    ASSERT_TRUE(truth.accurate);
    std::size_t by_points = 0;
    for (const std::size_t budget : {200, 1000}) {
      const ViewFactor f = view_factor(scene, from, source, {.accuracy = 1e-9, .budget = budget});
      EXPECT_LE(f.lower, truth.upper) << budget;
      EXPECT_GE(f.upper, truth.lower) << budget;
      const ViewFactor cells =
          view_factor(scene, from, source, {.accuracy = 1e-9, .budget = budget, .sample_crowds = false});
      by_points += f.way == Way::kPoints && f.upper - f.lower < 0.25 * (cells.upper - cells.lower) ? 1 : 0;
    }
    EXPECT_GE(by_points, 2U);
  }
}

// Cells reach 1e-9 here, points could not: nothing is spent on them.
TEST(ViewFactor, ThatPointsCannotReachIsByCells) {
  const Scene scene = generate::build(plates_with_plate(1.0, 0.5, 0.75));
  const Selection from = named(scene, "below"), to = named(scene, "above");
  const ViewFactor f = view_factor(scene, from, to, {.accuracy = 1e-12, .budget = 20000}),
                   alone = view_factor(scene, from, to, {.accuracy = 1e-12, .budget = 20000, .sample_crowds = false});
  EXPECT_EQ(f.way, Way::kCells);
  EXPECT_LE(f.lower, alone.upper);
  EXPECT_GE(f.upper, alone.lower);
}

// Two Gauss rules agree by chance on a cell near an edge. The truth is what certified enclosures of both directions
// have in common.
TEST(ViewFactor, IsNotBelievedWhereTwoRulesAgreeByChance) {
  const Scene scene = models::make_scene("karkanis:n=1,cover=1,seed=2016003");
  const ViewFactor f =
      view_factor(scene, named(scene, "floor"), named(scene, "occ"), {.accuracy = 1e-8, .budget = 100});
  EXPECT_EQ(f.way, Way::kCells);
  EXPECT_LE(f.lower, 0.12873930598961789);
  EXPECT_GE(f.upper, 0.12873930598974528);
}

// Certified enclosures; of the second one, six digits, from the point factor of the tiny triangle to the large one.
TEST(ViewFactor, OfWhatOnceBrokeItHoldsTheTruth) {
  struct Case {
    const char *scene, *from, *to;
    double lower, upper;
  };
  for (const auto& [name, from, to, lower, upper] :
       {Case{"thin_gap", "B", "o0", 0.002674704022611416, 0.0026877799322701885},
        Case{"sizes_far_apart", "A", "o0", 8.86438e-35, 8.86439e-35},
        Case{"far_from_the_origin", "A", "B", 0.0950352248, 0.0950352255}}) {
    const Scene scene = read_obj(EXACTFF_DATA_DIR "/regression/" + std::string(name) + ".obj");
    for (const double accuracy : {1e-3, 1e-4, 1e-8}) {
      for (const std::size_t budget : {1, 100, 500}) {
        const ViewFactor f =
            view_factor(scene, named(scene, from), named(scene, to), {.accuracy = accuracy, .budget = budget});
        EXPECT_LE(f.lower, lower) << name << ' ' << accuracy << ' ' << budget;
        EXPECT_GE(f.upper, upper) << name << ' ' << accuracy << ' ' << budget;
      }
    }
  }
}

// Every coordinate less its least is exact.
TEST(ViewFactor, OfAFarSceneIsThatOfTheSameSceneAtTheOrigin) {
  const auto scene_at = [](const Vec3& corner) {
    PlainScene plain = plates_with_plate(1.0, 0.5, 0.75);
    for (Vec3& v : plain.vertices) v = {v.x + corner.x, v.y + corner.y, v.z + corner.z};
    return generate::build(plain);
  };
  for (const Vec3& corner : {Vec3{5e6, -4e6, 0}, Vec3{0, 0, 0x1p40}, Vec3{-1e9, 1e9, 1e9}}) {
    for (const bool certify : {false, true}) {
      const auto factor = [&](const Scene& scene) {
        return view_factor(scene, named(scene, "below"), named(scene, "above"), {.accuracy = 1e-9, .certify = certify});
      };
      const ViewFactor far = factor(scene_at(corner)), near = factor(scene_at({}));
      EXPECT_TRUE(far.accurate);
      EXPECT_EQ(far.lower, near.lower);
      EXPECT_EQ(far.upper, near.upper);
    }
  }
}

// Nothing is seen through a gap that no point of the sample looks through; the width says how much there may be.
TEST(ViewFactor, OfACrowdIsNeverCertainOfWhatItHasNotMet) {
  PlainScene scene = plates(1.0, 1.0);
  constexpr double kGap = 0x1p-20, kHeight = 0x1p-6;
  add(scene, "lid", {{kGap, -9, kHeight}, {9, -9, kHeight}, {9, 9, kHeight}, {kGap, 9, kHeight}});
  const Scene built = generate::build(scene);
  const ViewFactor f =
      view_factor(built, named(built, "below"), named(built, "above"), {.accuracy = 1e-9, .budget = 1});
  const ViewFactor truth = view_factor(built, named(built, "below"), named(built, "above"), {.accuracy = 1e-9});
  EXPECT_GT(truth.lower, 0.0);
  EXPECT_LE(f.lower, truth.lower);
  EXPECT_GE(f.upper, truth.upper);
}

// A doubled triangle that reaches through the floor: cells close to the floor's edges are checked at rounded points,
// which lie behind the twin, and at points beside these, which see the floor turned a little.
TEST(ViewFactor, OfADoubledFaceThroughAnEdgeRaisesNoFalseAlarm) {
  PlainScene scene;
  for (int twin = 0; twin < 2; ++twin) {
    add(scene, "doubled", {{0.125, 0, 0.6875}, {0.5625, 0.296875, -1.71875}, {-1.40625, -2.03125, 2.90625}});
  }
  add(scene, "floor", {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}});
  const Scene built = generate::build(scene);
  const ViewFactor close = view_factor(built, named(built, "doubled"), named(built, "floor"), {.accuracy = 1e-10});
  EXPECT_TRUE(close.accurate);
  const ViewFactor coarse = view_factor(built, named(built, "doubled"), named(built, "floor"), {.accuracy = 1e-4});
  EXPECT_LE(coarse.lower, close.lower);
  EXPECT_GE(coarse.upper, close.upper);
}

TEST(ViewFactor, RefusesWhatHasNoMeaning) {
  PlainScene scene = plates(1.0, 1.0);
  add(scene, "line", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const Scene built = generate::build(scene);
  const Selection below = named(built, "below");
  EXPECT_THROW((void)view_factor(built, below, named(built, "line")), InputError);
  EXPECT_THROW((void)view_factor(built, named(built, "line"), below), InputError);
  EXPECT_THROW((void)view_factor(built, below, below, {.accuracy = 0.0}), InputError);
  EXPECT_THROW((void)view_factor(built, below, below, {.accuracy = std::nan("")}), InputError);
  const Scene other = generate::build(plates(1.0, 1.0));
  EXPECT_THROW((void)view_factor(other, below, below), std::invalid_argument);
}

// View factors do not depend on the unit of length, but areas must be doubles.
TEST(ViewFactor, RefusesAreasThatNoDoubleHolds) {
  for (const double side : {0x1p500, 0x1p-500}) {
    const Scene built = generate::build(plates(side, side));
    const ViewFactor f = view_factor(built, named(built, "below"), named(built, "above"));
    EXPECT_NEAR(f.value, 0.199824895698387, 1e-6);
    EXPECT_EQ(f.area_from, side * side);
  }
  for (const double side : {1e300, 0x1p-600}) {
    const Scene built = generate::build(plates(side, side));
    try {
      (void)view_factor(built, named(built, "below"), named(built, "above"));
      FAIL() << side;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("patch below has no area that a double can hold"), std::string::npos)
          << error.what();
    }
  }
}

// --- The command ---

TEST(MatrixProgram, PrintsAndWritesTheSameNumbers) {
  const validation::TemporaryDirectory folder;
  const std::string file = (folder.path() / "m.csv").string();
  const std::string scene = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
  const auto run = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "matrix");
    return validation::run_program(EXACTFF_PROGRAM, arguments);
  };
  const validation::ProgramRun plain = run({scene, "--plain", "-o", file});
  EXPECT_EQ(plain.exit_code, 0);
  EXPECT_EQ(std::ranges::count(plain.output, '\n'), 64);
  EXPECT_NE(plain.output.find("srf-1\tsrf-1\t0\t0\tzero\tcells\n"), std::string::npos);
  const std::string written = validation::text_of(file);
  EXPECT_EQ(std::ranges::count(written, '\n'), 2 + 64);
  EXPECT_NE(written.find("\nsrf-1,srf-6,0.18235"), std::string::npos);
  EXPECT_EQ(run({scene, "--plain", "--threads", "3"}).output, plain.output);
  EXPECT_NE(run({scene, "--from", "srf-1"}).output.find("0.182356"), std::string::npos);
  EXPECT_EQ(run({scene, "-o", file}).exit_code, 2);  // the file exists
  EXPECT_EQ(run({scene, "-o", file, "--force"}).exit_code, 0);
  EXPECT_EQ(run({scene, "--accuracy", "-1"}).exit_code, 2);
  EXPECT_EQ(run({scene, "--to", "nobody"}).exit_code, 2);
}

}  // namespace
}  // namespace exactff
