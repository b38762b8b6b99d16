// View factors from patch to patch with known values.
#include <stdexcept>

#include "support/test.h"
#include "unit/solver/known_factors.h"

namespace exactff {
namespace {

Selection named(const Scene& scene, const char* name) { return scene.select(name); }

// Estimated and certified, in both directions between patches of the same area.
void expect_factor(const PlainScene& plain, const char* from, const char* to, double truth) {
  const Scene scene = generate::build(plain);
  for (const double accuracy : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    for (const bool certify : {false, true}) {
      for (const auto& [a, b] : {std::pair(from, to), std::pair(to, from)}) {
        SCOPED_TRACE(testing::Message() << a << ' ' << accuracy << ' ' << certify);
        const ViewFactor f =
            view_factor(scene, named(scene, a), named(scene, b), {.accuracy = accuracy, .certify = certify});
        EXPECT_TRUE(f.accurate);
        EXPECT_EQ(f.claim, certify ? Claim::kCertified : Claim::kEstimated);
        EXPECT_LE(f.lower, truth);
        EXPECT_GE(f.upper, truth);
        EXPECT_LE(f.upper - f.lower, accuracy * 1.001);
        EXPECT_LE(f.lower, f.value);
        EXPECT_LE(f.value, f.upper);
      }
    }
  }
}

TEST(ViewFactor, OfParallelSquaresIsTheKnownOne) {
  expect_factor(plates(1.0, 1.0), "below", "above", 0.199824895698387383041599251193);
  expect_factor(plates(2.0, 1.0), "below", "above", 0.415253283577146735374144917);
  expect_factor(plates(1.0, 10.0), "below", "above", 0.00316205683875760162512871788517);
  expect_factor(plates(1.0, 100.0), "below", "above", 3.18288667328291964442604e-5);
  expect_factor(plates(1.0, 1000.0), "below", "above", 3.18309673977380257770e-7);
}

TEST(ViewFactor, OfSquaresWithACommonEdgeIsTheKnownOne) {
  expect_factor(floor_and_wall(), "floor", "wall", 0.200043776075403154239600187202);
}

TEST(ViewFactor, WithAPlateBetweenIsTheKnownOne) {
  expect_factor(plates_with_plate(1.0, 0.5, 0.75), "below", "above", 0.115620602132415020312711990740);
  expect_factor(plates_with_plate(2.0, 0.9, 0.75), "below", "above", 0.2828875141866424869);
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

matrix::Factors matrix_of(const std::string& file, double accuracy, bool certify = false) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/formats/" + file);
  const std::vector<Selection> all = all_patches(scene);
  return matrix::compute(scene, all, all, {.factors = {.accuracy = accuracy, .certify = certify}}).factors;
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
  for (const bool certify : {false, true}) {
    const matrix::Factors matrix = matrix_of("test4.vs3", 1e-8, certify);
    EXPECT_LE(matrix.at(0, 5).lower, 0.1823559036685958);
    EXPECT_GE(matrix.at(0, 5).upper, 0.1823559036685958);
    expect_rows_to_hold_one(matrix, 1e-8);
  }
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
    const std::string told = complaint([&] { (void)view_factor(built, named(built, "below"), named(built, "above")); });
    EXPECT_HOLDS(told, "patch below has no area that a double can hold");
  }
}

}  // namespace
}  // namespace exactff
