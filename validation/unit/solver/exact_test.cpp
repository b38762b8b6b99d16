// The result of the exact method: status, bounds, decimals, cutters, fractions, bad receivers, drawings.
#include "exactff/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "generate/families.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "support/random_scenes.h"
#include "support/solve.h"
#include "unit/solver/square_scenes.h"

namespace exactff {
namespace {

using generate::PlainScene;
using validation::add_square;
using validation::solve;
using validation::square_source;

TEST(ExactFormFactor, BoundsAreTheNeighboursOfACertifiedValue) {
  const FormFactor f = solve(square_source());
  EXPECT_EQ(f.status, Status::kCertified);
  EXPECT_EQ(f.lower, std::nextafter(f.value, 0.0));
  EXPECT_EQ(f.upper, std::nextafter(f.value, 1.0));
  EXPECT_TRUE(f.enclosure.contains(f.enclosure));
  EXPECT_EQ(f.enclosure.nearest(), f.value);
}

TEST(ExactFormFactor, BoundsAreNumbersHoweverFewBitsAreAllowed) {
  PlainScene plain = square_source();
  add_square(plain, "o", 0.3, 0.4, 0.1, 0.2);
  const double value = solve(plain).value;
  for (const Engine engine : validation::kEngines) {
    for (int cap = 1; cap <= 16; ++cap) {
      const FormFactor f = validation::solve_by(engine, plain, {.precision_cap = cap});
      EXPECT_LE(0.0, f.lower) << cap;
      EXPECT_LE(f.lower, value) << cap;
      EXPECT_LE(value, f.upper) << cap;
      EXPECT_LE(f.upper, 1.0) << cap;
      EXPECT_EQ(f.value, f.value) << cap;
    }
  }
}

TEST(ExactFormFactor, AValueThatRoundsToOneIsBoundedByOne) {
  const FormFactor f = solve(square_source(1.0, 1e-12));
  EXPECT_EQ(f.value, 1.0);
  EXPECT_EQ(f.upper, 1.0);
  EXPECT_EQ(f.lower, std::nextafter(1.0, 0.0));
  EXPECT_EQ(f.status, Status::kCertified);
}

TEST(ExactFormFactor, PositiveButRoundingToZeroIsAnUnderflow) {
  const FormFactor f = solve(square_source(1e-170));
  EXPECT_EQ(f.status, Status::kUnderflow);
  EXPECT_EQ(f.value, 0.0);
  EXPECT_EQ(f.lower, 0.0);
  EXPECT_EQ(f.upper, std::numeric_limits<double>::denorm_min());
}

TEST(ExactFormFactor, DenormalValuesAreCorrectlyRounded) {
  // For such a small source, F = A / (pi d^2) with a relative error of 1e-300: A = 4 h^2, h = 2^-530.
  const FormFactor f = solve(square_source(0x1p-530));
  EXPECT_EQ(f.status, Status::kCertified);
  EXPECT_EQ(f.value, std::ldexp(4.0 / 3.14159265358979323846, -1060));
}

TEST(ExactFormFactor, TheCapGivesAValidBallAndSaysSo) {
  const PlainScene tiny = square_source(1e-30);
  const FormFactor good = solve(tiny);
  EXPECT_EQ(good.status, Status::kCertified);
  for (const Engine engine : validation::kEngines) {
    const FormFactor poor = validation::solve_by(engine, tiny, {.precision_cap = 40});
    EXPECT_EQ(poor.status, Status::kNotCertified);
    EXPECT_EQ(poor.precision_bits, 40);
    EXPECT_TRUE(poor.enclosure.overlaps(good.enclosure));
    EXPECT_LE(poor.lower, good.value);
    EXPECT_GE(poor.upper, good.value);
  }
}

// Their sums round in different places, so that their estimates differ.
TEST(ExactFormFactor, EnginesThatMeetTheCapNeedNotAgreeOnAnEstimate) {
  int uncertified = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    generate::Random random(validation::seed_of(i));
    const PlainScene plain = validation::degenerate_scene(random);
    const FormFactor f = solve(plain, {.engine = Engine::kBoth, .precision_cap = 33});
    uncertified += f.status == Status::kNotCertified ? 1 : 0;
  }
  EXPECT_GT(uncertified, 0);
}

TEST(ExactFormFactor, GivesAsManyDecimalsAsAskedFor) {
  const FormFactor f = solve(square_source(), {.digits = 200});
  const std::optional<std::string> decimals = f.enclosure.decimals(200);
  ASSERT_TRUE(decimals.has_value());
  EXPECT_EQ(decimals->substr(0, 31), "0.55412642397957198712307883453");
  EXPECT_EQ(decimals->size(), 202U);
}

TEST(ExactFormFactor, ADecimalTieLeavesTheDoubleCertified) {
  // An eighth of the sphere of directions: F = 1/8, a tie that no ball can round to two decimals.
  PlainScene plain;
  plain.add_ring(plain.patch("source"), {{1, 0, 0}, {1, 0, 2}, {1, 1, 2}, {1, 1, 0}});
  plain.add_ring(plain.patch("source"), {{0, 0, 2}, {1, 1, 2}, {1, 0, 2}});
  const FormFactor f = solve(plain, {.digits = 2, .precision_cap = 1024});
  EXPECT_EQ(f.value, 0.125);
  EXPECT_EQ(f.status, Status::kCertified);
  EXPECT_FALSE(f.enclosure.decimals(2).has_value());
  EXPECT_TRUE(f.enclosure.decimals(3).has_value());
}

TEST(ExactFormFactor, AllAndNothingAreDecidedExactlyHoweverTheFractionRounds) {
  const auto seen = [](double occluder_half) {
    PlainScene plain = square_source();
    add_square(plain, "o", occluder_half, 0.5);
    return solve(plain, {.visible_fraction = true});
  };
  EXPECT_EQ(seen(0x1p-40).visible_fraction, 1.0);
  EXPECT_EQ(seen(0x1p-40).visible_part, VisiblePart::kSome);
  EXPECT_EQ(seen(0.5).visible_part, VisiblePart::kNothing);
  EXPECT_EQ(solve(square_source(), {.visible_fraction = true}).visible_part, VisiblePart::kAll);
}

TEST(ExactFormFactor, ListsTheFacesThatCutTheSource) {
  PlainScene plain = square_source();
  add_square(plain, "left", 0.1, 0.5, -0.2);
  add_square(plain, "aside", 0.1, 0.5, 2.0);
  add_square(plain, "right", 0.1, 0.5, 0.2);
  const Scene scene = generate::build(plain);
  const FormFactor f = solve(scene, plain, {.list_cutters = true});
  ASSERT_EQ(f.cutters.size(), 2U);
  EXPECT_EQ(scene.name_of(f.cutters[0]), "left");
  EXPECT_EQ(scene.name_of(f.cutters[1]), "right");
}

TEST(ExactFormFactor, AShadowInTheGapOfASourceDoesNotCutIt) {
  PlainScene plain;
  plain.add_rings(plain.patch("source"), {{{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}},
                                          {{-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}, {-0.5, -0.5, 1}}});
  add_square(plain, "in_the_gap", 0.2, 0.5);
  add_square(plain, "over_the_rim", 0.2, 0.5, 0.2);
  const Scene scene = generate::build(plain);
  const FormFactor f = solve(scene, plain, {.list_cutters = true});
  ASSERT_EQ(f.cutters.size(), 1U);
  EXPECT_EQ(scene.name_of(f.cutters[0]), "over_the_rim");
}

TEST(ExactFormFactor, OccludersCanBeSingledOut) {
  PlainScene plain = square_source();
  add_square(plain, "a", 0.1, 0.5, -0.2);
  add_square(plain, "b", 0.1, 0.5, 0.2);
  const Scene scene = generate::build(plain);
  const std::vector<FaceId> none;
  const std::vector<FaceId> only_a = scene.faces_of(scene.select("a"));
  const double open = solve(square_source()).value;
  EXPECT_EQ(solve(scene, plain, {.only_occluders = &none}).value, open);
  const double without_b = solve(scene, plain, {.only_occluders = &only_a}).value;
  EXPECT_LT(without_b, open);
  EXPECT_GT(without_b, solve(scene, plain).value);
}

// Value, status and fraction, with and without the shaft, by both engines.
void expect_the_same_without_shaft(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  for (const Engine engine : validation::kEngines) {
    ExactOptions options{.engine = engine, .visible_fraction = true};
    const FormFactor culled = solve(scene, plain, options);
    options.culling = ShaftCulling::kNone;
    const FormFactor all = solve(scene, plain, options);
    EXPECT_EQ(all.value, culled.value) << to_string(engine);
    EXPECT_EQ(all.status, culled.status) << to_string(engine);
    EXPECT_EQ(all.visible_fraction, culled.visible_fraction) << to_string(engine);
  }
}

TEST(ExactFormFactor, TheShaftSavesWorkAndChangesNoBit) {
  for (std::uint64_t i = 0; i < validation::scaled_count(4); ++i) {
    SCOPED_TRACE(i);
    generate::Random random(validation::seed_of(i));
    expect_the_same_without_shaft(validation::degenerate_scene(random));
    expect_the_same_without_shaft(validation::generic_scene(random));
    expect_the_same_without_shaft(validation::nudged_scene(random));
    expect_the_same_without_shaft(generate::soup({.n = 12, .seed = i + 1}));
  }
}

TEST(ExactFormFactor, WithoutShaftEveryFaceIsLookedAt) {
  PlainScene plain = square_source();
  add_square(plain, "in_the_shaft", 0.1, 0.5);
  for (int k = 1; k <= 5; ++k) add_square(plain, "beside", 0.1, 0.5, 2.0 * k);
  const Scene scene = generate::build(plain);
  for (const Engine engine : validation::kEngines) {
    EXPECT_EQ(solve(scene, plain, {.engine = engine}).planes.at(0).tree_candidates, 1U) << to_string(engine);
    EXPECT_EQ(solve(scene, plain, {.engine = engine, .culling = ShaftCulling::kNone}).planes.at(0).tree_candidates, 6U)
        << to_string(engine);
  }
}

TEST(ExactFormFactor, AFlippedSourceIsBehindAndTurnsBack) {
  const PlainScene plain = square_source();
  const Scene scene = generate::build(plain);
  const Scene flipped = scene.with_flipped(scene.select("source"));
  EXPECT_FALSE(behind_every_face(solve(scene, plain)));
  const FormFactor dark = solve(flipped, plain);
  EXPECT_TRUE(behind_every_face(dark));
  EXPECT_EQ(dark.status, Status::kZero);
  EXPECT_EQ(solve(flipped.with_flipped(flipped.select("source")), plain).value, solve(scene, plain).value);
}

TEST(ExactFormFactor, AFractionOverCommensurablePlanesIsExactEvenOnAMidpoint) {
  // Two unit faces at a right angle, both facing x; a strip of 2^-53 of one is hidden. The fraction 1 - 2^-54 is the
  // midpoint of two doubles, and ties go to the even one, 1.
  PlainScene plain;
  plain.add_ring(plain.patch("source"), {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}});
  plain.add_ring(plain.patch("source"), {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});
  plain.point = {0.0, 0.0, 0.0};
  plain.normal = {1, 0, 1};
  const double strip = 0x1p-54;
  plain.add_ring(plain.patch("o"), {{0, 0, 0.5}, {strip, 0, 0.5}, {strip, 0.5, 0.5}, {0, 0.5, 0.5}});
  const FormFactor f = solve(plain, {.visible_fraction = true, .exact_fraction = true});
  ASSERT_EQ(f.planes.size(), 2U);
  EXPECT_EQ(f.planes[0].exact_fraction, "9007199254740991/9007199254740992");
  EXPECT_EQ(f.planes[1].exact_fraction, "1");
  EXPECT_EQ(f.visible_fraction, 1.0);
}

TEST(ExactFormFactor, AFractionOverIncommensurablePlanesIsRounded) {
  // A fully visible unit face, and one of area sqrt(2) behind the horizon: 1 / (1 + sqrt(2)) = sqrt(2) - 1.
  PlainScene plain;
  plain.add_ring(plain.patch("source"), {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}});
  plain.add_ring(plain.patch("source"), {{0, 0, -2}, {0, 1, -2}, {1, 1, -1}, {1, 0, -1}});
  const FormFactor f = solve(plain, {.visible_fraction = true});
  EXPECT_EQ(f.visible_fraction, 0.41421356237309504880);
}

TEST(ExactFormFactor, RefusesAReceiverWithoutDirectionOrPlace) {
  PlainScene plain = square_source();
  plain.normal = {0.0, -0.0, 0.0};
  EXPECT_THROW((void)solve(plain), InputError);
  plain.normal = {0.0, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_THROW((void)solve(plain), InputError);
  plain.normal = {0.0, 0.0, 1.0};
  plain.point.x = std::nan("");
  EXPECT_THROW((void)solve(plain), InputError);
}

TEST(ExactFormFactor, TheLengthOfTheNormalMeansNothing) {
  PlainScene plain = square_source();
  plain.normal = {0.1, -0.2, 0.7};
  const double value = solve(plain).value;
  for (const double factor : {0x1p-1000, 0x1p1000}) {
    plain.normal = {0.1 * factor, -0.2 * factor, 0.7 * factor};
    EXPECT_EQ(solve(plain).value, value);
  }
  plain.normal = {0.0, 0.0, std::numeric_limits<double>::denorm_min()};
  EXPECT_EQ(solve(plain).value, solve(square_source()).value);
}

TEST(ExactFormFactor, ASourceWithoutAreaGivesZero) {
  PlainScene plain;
  plain.add_ring(plain.patch("source"), {{-1, 0, 1}, {1, 0, 1}, {0, 0, 1}});
  const FormFactor f = solve(plain, {.visible_fraction = true});
  EXPECT_EQ(f.status, Status::kZero);
  EXPECT_EQ(f.lower, 0.0);
  EXPECT_EQ(f.upper, 0.0);
  EXPECT_EQ(f.visible_fraction, 0.0);
}

TEST(ExactFormFactor, DrawsTheVisibleRegion) {
  PlainScene plain = square_source();
  add_square(plain, "o", 0.25, 0.5);
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select("source"));
  const std::vector<PlaneDrawing> drawings = draw_visibility(scene, generate::receiver_of(plain), source);
  ASSERT_EQ(drawings.size(), 1U);
  ASSERT_EQ(drawings[0].visible.size(), 2U);
  EXPECT_FALSE(drawings[0].visible[0].hole);
  EXPECT_TRUE(drawings[0].visible[1].hole);
  ASSERT_EQ(drawings[0].shadows.size(), 1U);
  for (const Vec3& corner : drawings[0].shadows[0].outline.corners) {
    EXPECT_EQ(std::abs(corner.x), 0.5);
    EXPECT_EQ(corner.z, 1.0);
  }
}

// All shadows lie within 2^-40 of one direction, but doubles know directions only to 2^-49.
TEST(ExactFormFactor, OccludersThatNothingTellsApartAreLeftToTheBooleans) {
  constexpr double kSize = 0x1p-40;
  PlainScene plain = square_source(kSize);
  generate::Random random(7);
  constexpr int kTriangles = 4000;
  for (int i = 0; i < kTriangles; ++i) {
    const double x = random.between(-2, 2), y = random.between(-2, 2);
    const auto number = [&](double middle) { return kSize * (middle + random.between(-0.05, 0.05)); };
    const auto corner = [&] { return Vec3{number(x), number(y), 0.5}; };
    plain.add_ring(plain.patch("occ"), {corner(), corner(), corner()});
  }
  const FormFactor f = validation::solve_by(Engine::kEdges, plain);
  EXPECT_EQ(f.planes.at(0).engine, Engine::kBoolean);
  EXPECT_EQ(f.planes.at(0).outcome, Outcome::kPartlyHidden);
  EXPECT_EQ(f.status, Status::kCertified);
  plain.patch("occ").faces.resize(300);
  EXPECT_EQ(solve(plain).planes.at(0).engine, Engine::kEdges);
}

// So near the source, no projection shows all of it: every occluder is compared with every edge.
TEST(ExactFormFactor, AWideSourceBehindManyOccludersHasTheSameValueForBothEngines) {
  PlainScene plain = square_source(1000.0);
  generate::Random random(7);
  for (int i = 0; i < 400; ++i) {
    const double x = random.between(-1, 1), y = random.between(-1, 1);
    const auto corner = [&] { return Vec3{x + random.between(-0.1, 0.1), y + random.between(-0.1, 0.1), 0.5}; };
    plain.add_ring(plain.patch("occ"), {corner(), corner(), corner()});
  }
  const PlaneRecord record = solve(plain).planes.at(0);
  EXPECT_EQ(record.engine, Engine::kEdges);
  EXPECT_EQ(record.outcome, Outcome::kPartlyHidden);
}

// Twice the signed area along the drawing's front normal.
double signed_area(const Loop& loop, const Vec3& n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.corners.size(); ++i) {
    const Vec3 &a = loop.corners[i], &b = loop.corners[(i + 1) % loop.corners.size()];
    sum += n.x * (a.y * b.z - a.z * b.y) + n.y * (a.z * b.x - a.x * b.z) + n.z * (a.x * b.y - a.y * b.x);
  }
  return sum;
}

// A square source across each half-axis; a smaller square in front of it leaves a visible ring.
TEST(Drawing, LoopsRunCounterClockwiseAsTheReceiverSeesThem) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const auto place = [&](double u, double v, double w) {
        const double c[3] = {w * sign, u, v * sign};
        return Vec3{c[(3 - axis) % 3], c[(4 - axis) % 3], c[(5 - axis) % 3]};
      };
      PlainScene scene;
      const auto add = [&](const char* name, double h, double w) {
        scene.add_ring(scene.patch(name), {place(-h, -h, w), place(-h, h, w), place(h, h, w), place(h, -h, w)});
      };
      add("source", 1, 1);
      add("occ", 0.25, 0.5);
      scene.normal = place(0, 0, 1);
      const Scene built = generate::build(scene);
      const ExactSource source(built, built.select("source"));
      const PlaneDrawing drawing = draw_visibility(built, generate::receiver_of(scene), source).at(0);
      ASSERT_EQ(drawing.visible.size(), 2U);
      for (const Loop& loop : drawing.visible) {
        EXPECT_EQ(signed_area(loop, drawing.normal) < 0.0, loop.hole) << axis << ' ' << sign;
      }
      EXPECT_GT(signed_area(drawing.source.at(0), drawing.normal), 0.0);
      EXPECT_GT(signed_area(drawing.clipped_source.at(0), drawing.normal), 0.0);
      EXPECT_GT(signed_area(drawing.shadows.at(0).outline, drawing.normal), 0.0);
    }
  }
}

}  // namespace
}  // namespace exactff
