// The result of the exact method: status, bounds, decimals, cutters, fractions, bad receivers, drawings.
#include "exactff/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

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

TEST(ExactFormFactor, ASourceWithoutAreaGivesZero) {
  PlainScene plain;
  plain.add_ring(plain.patch("source"), {{-1, 0, 1}, {1, 0, 1}, {0, 0, 1}});
  const FormFactor f = solve(plain, {.visible_fraction = true});
  EXPECT_EQ(f.status, Status::kZero);
  EXPECT_EQ(f.lower, 0.0);
  EXPECT_EQ(f.upper, 0.0);
  EXPECT_EQ(f.visible_fraction, 0.0);
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

}  // namespace
}  // namespace exactff
