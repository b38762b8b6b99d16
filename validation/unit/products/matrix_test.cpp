// Matrices of view factors: what meets backs and what is open, sums of rows, files for other programs.
#include "exactff/matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "exactff/scene_files.h"
#include "generate/plain_scene.h"
#include "matrix/row_facts.h"
#include "matrix/surroundings.h"
#include "support/program.h"
#include "view_factors/exact_scene.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/pairs.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"

namespace exactff::matrix {
namespace {

using generate::PlainScene;

constexpr double kOpposite = 0.199824895698387383041599251193;  // squares of side 1, 1 apart
constexpr double kAdjacent = 0.200043776075403154239600187202;  // with a common edge

void add(PlainScene& scene, const char* name, std::vector<Vec3> corners, bool turned = false) {
  if (turned) std::ranges::reverse(corners);
  scene.add_ring(scene.patch(name), corners);
}

std::vector<Vec3> square(double side, double height) {
  const double h = 0.5 * side;
  return {{-h, -h, height}, {h, -h, height}, {h, h, height}, {-h, h, height}};
}

// The unit cube without its lid. Fronts look inward.
PlainScene open_box() {
  PlainScene scene;
  add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(scene, "left", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  add(scene, "right", {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});
  add(scene, "near", {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  add(scene, "far", {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}});
  return scene;
}

std::vector<Selection> all_of(const Scene& scene) {
  std::vector<Selection> patches;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) patches.push_back({static_cast<PatchId>(i), {}, scene.id()});
  return patches;
}

Matrix whole(const Scene& scene, double accuracy = 1e-6) {
  return compute(scene, all_of(scene), all_of(scene), {.factors = {.accuracy = accuracy}, .backs = true, .open = true});
}

void expect_holds(const ViewFactor& f, double truth, double accuracy) {
  EXPECT_LE(f.lower, truth);
  EXPECT_GE(f.upper, truth);
  EXPECT_LE(f.upper - f.lower, accuracy);
  EXPECT_TRUE(f.accurate);
}

void expect_rows_hold_one(const Scene& scene, const Matrix& matrix, double width) {
  EXPECT_EQ(reasons_against_one(scene, matrix), std::vector<std::string>{});
  for (const Sum& sum : row_sums(matrix)) {
    EXPECT_LE(sum.lower, 1.0);
    EXPECT_GE(sum.upper, 1.0);
    EXPECT_LE(sum.upper - sum.lower, width);
  }
}

TEST(Matrix, OfABoxWithoutALidIsOpenAsMuchAsTheLidWouldGet) {
  const Scene scene = generate::build(open_box());
  const Matrix matrix = whole(scene, 1e-3);
  expect_holds(matrix.open[0], kOpposite, 1.1e-3);
  for (std::size_t wall = 1; wall < 5; ++wall) expect_holds(matrix.open[wall], kAdjacent, 1.1e-3);
  for (const ViewFactor& back : matrix.back) EXPECT_EQ(back.claim, Claim::kZero);
  expect_rows_hold_one(scene, matrix, 1e-2);
}

TEST(Matrix, OfAPlateInSpaceIsOpen) {
  for (const double scale : {1.0, 0x1p-500, 0x1p500}) {
    PlainScene plain;
    add(plain, "plate", square(scale, 0.75 * scale));
    const Scene scene = generate::build(plain);
    const Matrix matrix = whole(scene);
    expect_holds(matrix.open[0], 1.0, 1.1e-6);
    expect_rows_hold_one(scene, matrix, 1e-2);
  }
  PlainScene large;
  add(large, "plate", square(0x1p1023, 0.0));
  EXPECT_THROW((void)whole(generate::build(large)), InputError);
}

// A sheet of two faces has no back: whatever its side, a front is seen.
TEST(Matrix, ASheetOfTwoFacesHasNoBacks) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "sheet up", square(0.5, 0.5));
  add(plain, "sheet down", square(0.5, 0.5), true);
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene);
  EXPECT_EQ(matrix.back[0].claim, Claim::kZero);
  EXPECT_EQ(matrix.back[1].claim, Claim::kZero);
  EXPECT_EQ(matrix.back[2].claim, Claim::kZero);  // it looks down on the front of the plate below
  EXPECT_GT(matrix.factors.at(0, 2).lower, 0.1);
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// The backs are what the larger face, turned round, gets, less what the smaller one in its plane gets.
TEST(Matrix, BacksUnderAFrontInTheirPlaneDoNotCount) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "up", square(2.0, 0.5));
  add(plain, "down", square(0.5, 0.5), true);
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene, 1e-6);
  const Scene turned = scene.with_flipped(scene.select("up"));
  const ViewFactor large = view_factor(turned, turned.select("below"), turned.select("up"), {.accuracy = 1e-6});
  const ViewFactor small = view_factor(turned, turned.select("below"), turned.select("down"), {.accuracy = 1e-6});
  EXPECT_NEAR(matrix.back[0].value, large.value - small.value, 2e-6);
  EXPECT_LE(matrix.back[0].upper - matrix.back[0].lower, 1e-6) << "the sum of three factors is accurate, too";
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// No more is left to be seen from elsewhere: its sides, its lid and the floor hide the backs.
TEST(Matrix, OutsideOfABoxWithoutABottomItsBacksAreProvedUnseen) {
  PlainScene plain = open_box();  // a room whose lid is missing, and a box on its floor
  const double l = 0.25, h = 0.75;
  add(plain, "box", {{l, l, 0.5}, {h, l, 0.5}, {h, h, 0.5}, {l, h, 0.5}});
  add(plain, "box", {{l, l, 0}, {h, l, 0}, {h, l, 0.5}, {l, l, 0.5}});
  add(plain, "box", {{h, l, 0}, {h, h, 0}, {h, h, 0.5}, {h, l, 0.5}});
  add(plain, "box", {{h, h, 0}, {l, h, 0}, {l, h, 0.5}, {h, h, 0.5}});
  add(plain, "box", {{l, h, 0}, {l, l, 0}, {l, l, 0.5}, {l, h, 0.5}});
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene, 1e-2);
  expect_holds(matrix.back[0], 0.25, 1.1e-2);
  for (std::size_t row = 1; row < matrix.back.size(); ++row) EXPECT_EQ(matrix.back[row].claim, Claim::kZero) << row;
  expect_rows_hold_one(scene, matrix, 0.1);
}

// Strips between the plates make each of the terms about as wide as it may be.
TEST(Matrix, BacksBesideFrontsInTheirPlaneAreAsAccurateAsAsked) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "up", square(2.0, 0.5));
  add(plain, "down", square(0.5, 0.5), true);
  for (const double x : {-0.5, -0.3125, -0.125, 0.0625, 0.25, 0.4375}) {
    add(plain, "strips", {{x, -0.5, 0.25}, {x, 0.4375, 0.25}, {x + 0.125, 0.5, 0.25}, {x + 0.125, -0.4375, 0.25}});
  }
  const Scene scene = generate::build(plain);
  for (const double accuracy : {0.1, 0.03, 0.01, 0.003, 0.001}) {
    const ViewFactor back =
        compute(scene, std::vector{scene.select("below")}, {}, {.factors = {.accuracy = accuracy}, .backs = true})
            .back.front();
    EXPECT_LE(back.upper - back.lower, accuracy);
    EXPECT_TRUE(back.accurate);
  }
}

// A front that is cut in two hides a back as one does, wherever the cut is.
TEST(Matrix, BacksUnderSeveralFrontsDoNotCount) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "down", {{-1, -1, 0.5}, {-1, 1, 0.5}, {0.125, 1, 0.5}, {0.125, -1, 0.5}});
  add(plain, "down", {{0.125, -1, 0.5}, {0.125, 1, 0.5}, {1, 1, 0.5}, {1, -1, 0.5}});
  add(plain, "up", square(0.5, 0.5));
  EXPECT_EQ(whole(generate::build(plain), 1e-3).back[0].claim, Claim::kZero);
  plain.patch("up").faces.clear();
  add(plain, "up", square(2.5, 0.5));
  const Matrix matrix = whole(generate::build(plain), 1e-3);
  EXPECT_GT(matrix.back[0].lower, 0.0);
  EXPECT_TRUE(matrix.back[0].accurate);
}

// To the floor of an open box, by what its last patch, the sixth, hides.
void expect_less_open_than_the_lid(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene, 1e-3);
  EXPECT_LE(matrix.open[0].upper, kOpposite - matrix.factors.at(0, 5).lower + 1e-3);
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// What lies beyond the missing lid is not open.
TEST(Matrix, OfABoxWithoutALidUnderAPlateIsOpenBesideThePlate) {
  PlainScene plain = open_box();
  add(plain, "plate", {{0, 0, 1.5}, {0, 1, 1.5}, {1, 1, 1.5}, {1, 0, 1.5}});
  expect_less_open_than_the_lid(plain);
}

// The lid of a box whose fronts look inward, and a plate in its plane, both turned away from the row above.
TEST(Matrix, BacksInOnePlaneCountOnceWhateverTheyBelongTo) {
  PlainScene plain = open_box();
  add(plain, "lid", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  add(plain, "plate", {{0.25, 0.25, 1}, {0.25, 0.75, 1}, {0.75, 0.75, 1}, {0.75, 0.25, 1}});
  add(plain, "above", {{0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}});
  const Scene scene = generate::build(plain);
  const Matrix matrix = compute(scene, std::vector{scene.select("above")}, {},
                                {.factors = {.accuracy = 1e-4}, .backs = true, .open = true});
  EXPECT_NEAR(matrix.back[0].area_to, 7.0, 1e-12) << "five walls, the lid, and the row itself";
  const Sum sum = row_sums(matrix).front();
  EXPECT_LE(sum.lower, 1.0);
  EXPECT_GE(sum.upper, 1.0);
}

// Nine slats on a large floor: the rest is known long before the sky is.
TEST(Matrix, OfAFloorWithLittleOnItIsOpenAsMuchAsIsLeft) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/slats.obj");
  const Matrix matrix = whole(scene, 1e-3);
  expect_holds(matrix.open[0], 0.996696, 1e-3);
  EXPECT_LE(matrix.open[0].cells, 1000U) << "the sky takes 2,000";
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// A closed box whose fronts look inward stands above the floor, which sees nothing but its backs and the sky.
TEST(Matrix, OfAFloorUnderABoxTurnedInsideOutIsOpenBesideTheBox) {
  PlainScene plain = open_box();
  add(plain, "lid", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  add(plain, "ground", square(4.0, -0.5));
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene, 1e-3);
  EXPECT_GT(matrix.back.back().lower, 0.03);
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// A sheet of two faces stands on another one, which lies on the floor. Cells outside of that may leave out backs, but
// not with the fronts that a back covered before.
TEST(Matrix, ASheetThatStandsOnASheetHidesTheSky) {
  PlainScene plain;
  add(plain, "floor", {{-2, -2, 0}, {6, -2, 0}, {2, 2, 0}});
  for (const bool turned : {false, true}) {
    add(plain, "sheet", {{1, -1, 0}, {1, 0, 0}, {0, 0, 0}, {0, -1, 0}}, turned);
    add(plain, "sheet", {{1, -1, 1}, {1, 0, 1}, {1, 0, 0}, {1, -1, 0}}, turned);
  }
  add(plain, "tent", {{6, 6, 0}, {-2, 6, 0}, {0, 3.5, 3}});
  const Scene scene = generate::build(plain);
  const std::vector<Selection> floor{scene.select("floor")};
  const SceneWithSky made = with_sky(scene);
  const view_factors::Pairs to_sky(made.scene, of_any_scene(floor), std::vector{made.sky}, {.accuracy = 1e-3},
                                   view_factors::Columns::kSurroundings);
  ViewFactor sky;
  to_sky.compute(0, [&](std::size_t, const ViewFactor& f) { sky = f; });
  const ViewFactor rest = compute(scene, floor, {}, {.factors = {.accuracy = 1e-4}, .open = true}).open.front();
  expect_holds(sky, rest.value, 1e-3);
}

// Without that, points would take several times as long.
TEST(Matrix, OfWhatIsOpenItIsKnownHowFastItChanges) {
  const SceneWithSky made = with_sky(read_scene(EXACTFF_DATA_DIR "/scenes/slats.obj"));
  const view_factors::ExactScene scene(made.scene);
  const view_factors::SeenParts seen(scene);
  const view_factors::PreparedPatch lamp(scene, made.scene.select("lamp"), view_factors::Columns::kPatches);
  const view_factors::PreparedPatch sky(scene, made.sky, view_factors::Columns::kSurroundings);
  view_factors::PatchBounds bounds(scene, seen, lamp, sky);
  const double unit = std::ldexp(1.0, static_cast<int>(scene.units.exponent + scene.units.shift));
  const double slope = bounds.about(0, lamp.parts[0].corners[0].at).change / unit;
  EXPECT_LT(slope, 10.0) << "nine slats, 1.3 m away";
  EXPECT_GT(slope, 0.1);
}

// A patch of two plates, one in the box, one beside it.
TEST(Matrix, OfAPatchInsideAndOutsideOfABoxMoreIsOpenThanTheLid) {
  PlainScene plain = open_box();
  add(plain, "plates", {{0.25, 0.25, 0.5}, {0.75, 0.25, 0.5}, {0.75, 0.75, 0.5}, {0.25, 0.75, 0.5}});
  add(plain, "plates", {{2.25, 0.25, 0.5}, {2.75, 0.25, 0.5}, {2.75, 0.75, 0.5}, {2.25, 0.75, 0.5}});
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene, 1e-3);
  EXPECT_GT(matrix.open[5].lower, 0.6);
  expect_rows_hold_one(scene, matrix, 2e-2);
}

// A frame in the plane of the missing lid hides some of what is open.
TEST(Matrix, OfABoxWithoutALidAndWithAStripInItsPlaceIsOpenBesideTheStrip) {
  PlainScene plain = open_box();
  add(plain, "strip", {{0.25, 0, 1}, {0.25, 1, 1}, {0.75, 1, 1}, {0.75, 0, 1}});
  expect_less_open_than_the_lid(plain);
}

TEST(Matrix, SaysWhyRowsNeedNotAddUpToOne) {
  const Scene scene = generate::build(open_box());
  const std::vector<Selection> all = all_of(scene);
  const auto count = [&](const Options& options, const std::vector<Selection>& to, const Scene& in) {
    return reasons_against_one(in, compute(in, std::vector{all[0]}, to, options)).size();
  };
  const Options coarse{.factors = {.accuracy = 0.1}}, full{.factors = {.accuracy = 0.1}, .backs = true, .open = true};
  EXPECT_EQ(count(full, all, scene), 0U);
  EXPECT_EQ(count(coarse, all, scene), 2U);
  EXPECT_EQ(count(full, {all[0], all[1]}, scene), 1U);
  EXPECT_EQ(count(full, {all[0], all[1], all[2], all[3], all[4], all[4]}, scene), 1U);
  PlainScene twice = open_box();
  add(twice, "carpet", {{0.5, 0.5, 0}, {2, 0.5, 0}, {2, 2, 0}, {0.5, 2, 0}});
  add(twice, "tile", {{1, 0, 0}, {2, 0, 0}, {2, 0.5, 0}, {1, 0.5, 0}});  // touches the carpet and the floor only
  const Scene in_common = generate::build(twice);
  const auto reasons = reasons_against_one(in_common, whole(in_common, 0.1));
  EXPECT_EQ(reasons, std::vector<std::string>{"fronts of different patches overlap in one plane"});
  PlainScene apart = open_box();
  add(apart, "tile", {{1, 0, 0}, {2, 0, 0}, {2, 0.5, 0}, {1, 0.5, 0}});
  const Scene beside = generate::build(apart);
  EXPECT_EQ(reasons_against_one(beside, whole(beside, 0.1)), std::vector<std::string>{});
}

// --- Both directions, both sides ---

TEST(Matrix, BothDirectionsComputedApartAgree) {
  const Scene scene = generate::build(open_box());
  const std::vector<Selection> all = all_of(scene);
  const Matrix one_way = compute(scene, all, all, {.factors = {.accuracy = 1e-4}});
  Matrix both = compute(scene, all, all, {.factors = {.accuracy = 1e-4, .both_directions = true}});
  const Reciprocity found = reciprocity(both);
  EXPECT_EQ(found.pairs, 10U);
  EXPECT_TRUE(found.apart.empty());
  ASSERT_TRUE(found.worst);
  EXPECT_LE(found.worst->distance, found.worst->radius);
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = i; j < 5; ++j) EXPECT_EQ(both.factors.at(i, j).value, one_way.factors.at(i, j).value);
  }
  ViewFactor& wrong = both.factors.entries[5 * 3 + 1];  // from "near" to "left"
  for (double ViewFactor::*number : {&ViewFactor::value, &ViewFactor::lower, &ViewFactor::upper}) wrong.*number += 2e-4;
  const Reciprocity broken = reciprocity(both);
  ASSERT_EQ(broken.apart.size(), 1U);
  EXPECT_EQ(broken.apart[0].row, 1U);
  EXPECT_EQ(broken.apart[0].column, 3U);
  EXPECT_NEAR(broken.apart[0].distance, 2e-4, 1e-4);
}

// From a large patch the factor is small: what is compared is the same on both sides.
TEST(Matrix, ReciprocityIsThatOfTheExchange) {
  PlainScene plain;
  add(plain, "large", square(8.0, 0.0));
  add(plain, "small", square(0.5, 1.0), true);
  const Scene scene = generate::build(plain);
  const std::vector<Selection> rows{scene.select("small")}, columns{scene.select("large")};
  EXPECT_EQ(reciprocity(compute(scene, rows, columns)).pairs, 0U);
  const std::vector<Selection> all = all_of(scene);
  const Reciprocity found =
      reciprocity(compute(scene, all, all, {.factors = {.accuracy = 1e-6, .both_directions = true}}));
  EXPECT_EQ(found.pairs, 1U);
  EXPECT_TRUE(found.apart.empty());
  EXPECT_LE(found.worst->radius, 2e-6);
}

TEST(Matrix, TheBackOfATwoSidedPatchGetsWhatMetBacks) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "screen", square(0.75, 0.5));
  add(plain, "above", square(1.0, 1.0), true);
  const Scene scene = generate::build(plain);
  const Matrix before = whole(scene, 1e-4);
  const Scene doubled = with_two_sided(scene, std::vector{scene.select("screen")});
  ASSERT_EQ(doubled.patches().size(), 4U);
  EXPECT_EQ(doubled.patches()[3].name, "screen (back)");
  const Matrix after = whole(doubled, 1e-4);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(after.factors.at(i, j).value, before.factors.at(i, j).value, 1e-6);
    }
    EXPECT_EQ(after.back[i].claim, Claim::kZero);
    EXPECT_NEAR(after.factors.at(i, 3).value, before.back[i].value, 1e-4);
  }
  EXPECT_GT(before.back[0].lower, 0.2);
  EXPECT_NEAR(after.factors.at(3, 0).value, after.factors.at(1, 2).value, 1e-4);  // by symmetry
  expect_rows_hold_one(doubled, after, 1e-2);
}

TEST(Matrix, TwoSidedFacesKeepHolesMaterialsAndGlass) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  generate::PlainPatch& frame = plain.patch("frame");
  plain.add_rings(frame, {square(1.0, 0.5), square(0.5, 0.5)});
  plain.materials.push_back({.name = "gold", .reflectance = {0.75, 0.5, 0.25}});
  frame.material = "gold";
  const Scene scene = generate::build(plain);
  const Selection selection = scene.select("frame");
  const Scene doubled = with_two_sided(scene, std::vector{selection, selection});
  EXPECT_EQ(doubled.faces().size(), 3U);
  EXPECT_EQ(doubled.face(FaceId{2}).area, scene.face(FaceId{1}).area);
  EXPECT_EQ(doubled.material(doubled.face(FaceId{2}).material).name, "gold");
  EXPECT_LT(doubled.face(FaceId{2}).newell.z, 0.0);
  EXPECT_FALSE(doubled.face(FaceId{2}).transparent);
  const Scene clear = scene.with_transparent({&selection, 1});
  const Scene glass = with_two_sided(clear, std::vector{clear.select("frame")});
  EXPECT_TRUE(glass.face(FaceId{1}).transparent);
  EXPECT_TRUE(glass.face(FaceId{2}).transparent);
}

// The twin of a bent face must be cut as the face is: else points between the two surfaces see one through the other.
TEST(Matrix, TheTwinOfABentFaceIsItsTrianglesTurnedRound) {
  std::mt19937_64 random(57);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  const auto bent = [&](std::size_t corners, double height) {
    std::vector<Vec3> ring;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle = 6.0 * static_cast<double>(i) / static_cast<double>(corners);
      ring.push_back({std::cos(angle), std::sin(angle), height * anywhere(random)});
    }
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(random() % corners), ring.end());
    return ring;
  };
  for (int i = 0; i < 8; ++i) {
    PlainScene plain;
    add(plain, "sail", bent(4 + random() % 5, i % 2 == 0 ? 0.5 : 1e-9), random() % 2 == 0);
    add(plain, "lamp", square(1.0, 2.0), true);
    const Scene scene = generate::build(plain), triangles = triangulated(scene);
    const auto sail = [](const Scene& in) { return std::vector{in.select("sail")}; };
    const Scene doubled = with_two_sided(scene, sail(scene)), cut = with_two_sided(triangles, sail(triangles));
    const Scene turned = scene.with_flipped(sail(scene));
    const auto value = [](const Scene& in, const Receiver& at, const char* name) {
      return exact_form_factor(in, at, ExactSource(in, in.select(name))).value;
    };
    for (int k = 0; k < 6; ++k) {
      const double side = k % 2 == 0 ? 1.0 : -1.0;
      const Receiver at{{anywhere(random), anywhere(random), side * (0.6 + anywhere(random))},
                        {anywhere(random), anywhere(random), -side},
                        {},
                        {}};
      EXPECT_EQ(value(doubled, at, "sail"), value(scene, at, "sail"));
      EXPECT_EQ(value(doubled, at, "sail (back)"), value(turned, at, "sail"));
      EXPECT_EQ(value(doubled, at, "lamp"), value(scene, at, "lamp"));
      for (const char* name : {"sail", "sail (back)", "lamp"}) {
        EXPECT_EQ(value(doubled, at, name), value(cut, at, name)) << name;
      }
    }
  }
}

// --- Files ---

std::string text_of(std::string_view name, const Scene& scene, const Matrix& matrix, const std::string& zone = "zone") {
  const ProgramFormat& format = *std::ranges::find(program_formats(), name, &ProgramFormat::name);
  return files_of(format, square_of(format, scene, matrix, zone), "file").front().second;
}

TEST(MatrixFiles, OfView3DAreItsOwn) {
  const Scene scene = generate::build(open_box());
  const std::string text = text_of("view3d", scene, compute(scene, all_of(scene), all_of(scene)));
  EXPECT_EQ(text.substr(0, text.find('\n')).size(), 30U);
  EXPECT_EQ(text.substr(text.find('\n')),
            "\n1 1 1 1 1\n"
            "0.000000 0.200044 0.200044 0.200044 0.200044\n"
            "0.200044 0.000000 0.199825 0.200044 0.200044\n"
            "0.200044 0.199825 0.000000 0.200044 0.200044\n"
            "0.200044 0.200044 0.200044 0.000000 0.199825\n"
            "0.200044 0.200044 0.200044 0.199825 0.000000\n"
            "0.000 0.000 0.000 0.000 0.000\n");
  const Matrix row = compute(scene, std::vector{scene.select("floor")}, all_of(scene), {.factors = {.accuracy = 0.1}});
  EXPECT_THROW((void)text_of("view3d", scene, row), InputError);
  EXPECT_THROW((void)text_of("energyplus", scene, row, "zone"), InputError);
}

TEST(MatrixFiles, OfEnergyPlusHoldNamesAndEveryDigit) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "above", square(1.0, 1.0), true);
  const Scene scene = generate::build(plain);
  const Matrix matrix = compute(scene, all_of(scene), all_of(scene));
  const std::string text = text_of("energyplus", scene, matrix, "Zone 7");
  EXPECT_EQ(text.find("! exactff "), 0U);
  EXPECT_NE(
      text.find(
          "\nZoneProperty:UserViewFactors:bySurfaceName,\n  Zone 7,\n  below, below, 0,\n  below, above, 0.19982"),
      std::string::npos);
  EXPECT_EQ(text.substr(text.size() - 21), ",\n  above, above, 0;\n");
  EXPECT_THROW((void)text_of("energyplus", scene, matrix, "a;b"), InputError);
  EXPECT_THROW((void)text_of("energyplus", scene, matrix, ""), InputError);
  for (const char* name : {"a,b", "a!b", " a", "Below"}) {
    PlainScene odd = plain;
    odd.patches[1].name = name;
    const Scene built = generate::build(odd);
    EXPECT_THROW((void)text_of("energyplus", built, compute(built, all_of(built), all_of(built)), "zone"), InputError)
        << name;
  }
}

// --- The command ---

class MatrixFilesOfTheCommand : public testing::Test {
 protected:
  static validation::ProgramRun run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "matrix");
    return validation::run_program(EXACTFF_PROGRAM, arguments);
  }
  [[nodiscard]] std::string file(const char* name) const { return (folder_.path() / name).string(); }

  const validation::TemporaryDirectory folder_;
  const std::string scene_ = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
};

// "below" looks up at the back of "cover" and past it.
TEST_F(MatrixFilesOfTheCommand, HaveBackAndOpenAsColumns) {
  const std::string scene = folder_
                                .write("plates.obj",
                                       "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                       "g below\nf 1 2 3 4\ng cover\nf 5 6 7 8\n")
                                .string();
  const validation::ProgramRun plain =
      run({scene, "--accuracy", "1e-3", "--backs", "--to", "all,sky", "--plain", "-o", file("m.csv")});
  EXPECT_EQ(plain.exit_code, 0);
  EXPECT_NE(plain.output.find("below\t(back)\t0.199"), std::string::npos) << plain.output;
  EXPECT_NE(plain.output.find("below\t(open)\t0.80017"), std::string::npos) << plain.output;
  EXPECT_NE(plain.output.find("cover\t(back)\t0\t0\tzero\tcells\n"), std::string::npos) << plain.output;
  EXPECT_EQ(std::ranges::count(plain.output, '\n'), 2 * 4);
  EXPECT_NE(validation::text_of(file("m.csv")).find("\ncover,(back),0,0,0,zero,cells,yes,1,2,"), std::string::npos);
  const validation::ProgramRun table = run({scene, "--accuracy", "1e-3", "--backs", "--to", "all", "--to", "sky"});
  EXPECT_NE(table.output.find("Every row adds up to 1 within its bounds."), std::string::npos);
  EXPECT_NE(table.output.find("(open)"), std::string::npos);
  EXPECT_NE(run({scene}).output.find("what meets backs is not computed and what is open is not computed."),
            std::string::npos);
  EXPECT_EQ(run({scene, "--from", "sky"}).exit_code, 2);
}

// Without patches as columns: what is open alone, or beside what meets backs.
TEST_F(MatrixFilesOfTheCommand, HoldTheSkyAlone) {
  const std::string scene =
      folder_.write("plate.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng plate\nf 1 2 3 4\n").string();
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--backs"}}) {
    std::vector<std::string> command = {scene,         "--to",  "sky",         "--plain", "-o",
                                        file("m.csv"), "--npz", file("m.npz"), "--force"};
    command.insert(command.end(), more.begin(), more.end());
    const validation::ProgramRun made = run(command);
    ASSERT_EQ(made.exit_code, 0);
    EXPECT_EQ(std::ranges::count(made.output, '\n'), 1 + static_cast<int>(more.size()));
    EXPECT_NE(made.output.find("plate\t(open)\t1\t1\tcertified"), std::string::npos) << made.output;
    const NamedMatrix read = read_named(file("m.csv"));
    EXPECT_EQ(read.to.size(), 0U);
    EXPECT_EQ(read.open.size(), 1U);
    EXPECT_EQ(read.back.size(), more.size());
    std::ranges::replace(command, "--force", "--resume");
    EXPECT_EQ(run(command).output, made.output);
  }
  EXPECT_EQ(run({scene, "--to", "sky", "--vtk", file("row.vtp")}).exit_code, 2);
}

TEST_F(MatrixFilesOfTheCommand, AreWrittenWholeOrNotAtAll) {
  const std::vector<std::string> outputs = {"--npz",        file("m.npz"), "--view3d", file("m.txt"),
                                            "--energyplus", file("m.idf"), "--zone",   "Hall"};
  std::vector<std::string> command = {scene_, "--accuracy", "1e-3"};
  command.insert(command.end(), outputs.begin(), outputs.end());
  EXPECT_EQ(run(command).exit_code, 0);
  const std::string npz = validation::text_of(file("m.npz"));
  EXPECT_EQ(npz.substr(0, 4), "PK\3\4");
  EXPECT_NE(validation::text_of(file("m.idf")).find("\n  Hall,\n  srf-1, srf-1, 0,"), std::string::npos);
  EXPECT_EQ(run(command).exit_code, 2);  // the files exist
  command.emplace_back("--force");
  EXPECT_EQ(run(command).exit_code, 0);
  EXPECT_EQ(validation::text_of(file("m.npz")), npz);
  for (const char* flag : {"--npz", "--view3d", "--energyplus", "--vtk"}) {
    const std::string other = file(flag + 2);
    EXPECT_EQ(run({scene_, "--from", "srf-1", "--view3d", other + "/not/there", flag, other}).exit_code, 2);
    EXPECT_EQ(run({scene_, flag, file("."), "--force"}).exit_code, 2);
    EXPECT_EQ(validation::size_of(other), 0U);
  }
  EXPECT_EQ(run({scene_, "--npz", file("x"), "-o", file("x")}).exit_code, 2);
  EXPECT_EQ(run({scene_, "--zone", "Hall"}).exit_code, 2);
}

// A window on a wall counts besides it.
TEST_F(MatrixFilesOfTheCommand, OfOverlappingFrontsAreWrittenOnlyByForce) {
  const validation::TemporaryDirectory aside;
  std::string told;
  const auto command = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"matrix", EXACTFF_DATA_DIR "/regression/window_on_a_wall.obj", "--accuracy", "0.1"});
    const validation::RunningProgram program(EXACTFF_PROGRAM, flags, aside.path() / "told");
    const int exit_code = program.wait();
    told = program.error();
    return exit_code;
  };
  const std::string names = "'window' lies in the plane of 'east' and overlaps it by 1 (area)";
  for (const char* flag : {"--energyplus", "--view3d"}) {
    EXPECT_EQ(command({flag, file("factors.txt"), "-o", file("m.csv")}), 2);
    EXPECT_NE(told.find(names), std::string::npos) << told;
    EXPECT_NE(told.find("; --force writes it all the same\n"), std::string::npos) << told;
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
    EXPECT_EQ(command({flag, file("factors.txt"), "--force"}), 0);
    EXPECT_TRUE(std::filesystem::remove(file("factors.txt")));
    EXPECT_EQ(command({flag, file("factors.txt"), "--from", "floor,east", "--to", "floor,east"}), 0) << told;
    EXPECT_TRUE(std::filesystem::remove(file("factors.txt"))) << "the window is no column";
  }
  EXPECT_EQ(command({"-o", file("m.csv")}), 0);
  EXPECT_EQ(told.find("warning: " + names), 0U) << told;
  EXPECT_EQ(command({"--from", "floor", "--to", "east", "--plain"}), 0);
  EXPECT_EQ(told, "");
}

// Wider entries are named, with the reason and what would help; a file keeps the reason.
TEST_F(MatrixFilesOfTheCommand, TellsWhyEntriesAreWider) {
  std::string told;
  const auto command = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"matrix", EXACTFF_DATA_DIR "/scenes/cornell_box.obj", "--from", "light", "--to"};
    all.insert(all.end(), more.begin(), more.end());
    const validation::RunningProgram program(EXACTFF_PROGRAM, all, folder_.path() / "told");
    const int exit_code = program.wait();
    told = program.error();
    return exit_code;
  };
  EXPECT_EQ(command({"floor,tall_block", "--budget", "1", "--certify", "-o", file("m.csv")}), 3) << told;
  EXPECT_EQ(told.find("warning: 2 entries are wider than the accuracy 1e-06: 'light' to '"), 0U) << told;
  EXPECT_NE(
      told.find(" (the limit of work for an entry, 1 cell and four points for each, is reached; their bounds are as "
                "strong as their claims); give more by --budget, ask for less by --accuracy, divide patches by "
                "--divide, or take estimates instead of --certify\n"),
      std::string::npos)
      << told;
  for (const ViewFactor& f : read_named(file("m.csv")).entries) EXPECT_EQ(f.limit, Limit::kBudget);
  EXPECT_EQ(command({"floor", "--accuracy", "0.1"}), 0);
  EXPECT_EQ(told, "");
}

TEST(Matrix, TwoSidedRefusesTakenNames) {
  PlainScene taken;
  add(taken, "wall", square(1.0, 0.0));
  add(taken, "wall (back)", square(1.0, 1.0));
  const Scene with_name = generate::build(taken);
  EXPECT_THROW((void)with_two_sided(with_name, std::vector{with_name.select("wall")}), InputError);
}

// --- Sums of groups ---

// Of cells, against the factors to the undivided patches; and as their file has them.
TEST(MatrixSums, OfCellsHoldTheFactorsOfTheirPatches) {
  const std::pair<Scene, double> scenes[] = {
      {generate::build(open_box()), 0.6},
      {read_scene(EXACTFF_DATA_DIR "/scenes/formats/test4.vs3"), 2.0},
      {read_scene(EXACTFF_DATA_DIR "/scenes/cornell_box.obj"), 400.0},
  };
  for (const auto& [scene, length] : scenes) {
    const Scene cells = divided(scene, length).scene;
    std::vector<std::string> names;
    for (std::size_t p = 0; p < 3; ++p) names.push_back(scene.patches()[p].name);
    const std::vector<Selection> whole_from{scene.select(names.front())}, from = cells.select_all(names.front());
    const Options options{.factors = {.accuracy = 1e-4}};
    const Matrix truth = compute(scene, whole_from, all_of(scene), options);
    Matrix matrix = compute(cells, from, all_of(cells), options);
    add_sums(cells, names, 1e-3, matrix);
    ASSERT_EQ(matrix.sums.size(), names.size());
    for (std::size_t p = 0; p < names.size(); ++p) {
      const GroupSum& sum = matrix.sums[p];
      EXPECT_EQ(name_of(sum), "(sum " + names[p] + ')');
      EXPECT_EQ(sum.columns.size(), cells.select_all(names[p]).size());
      double lower = 0.0, upper = 0.0, area = 0.0;  // means over the cells of the first patch
      for (std::size_t i = 0; i < from.size(); ++i) {
        const ViewFactor& f = sum.factors[i];
        double value = 0.0;
        for (const std::size_t j : sum.columns) value += matrix.factors.at(i, j).value;
        EXPECT_NEAR(f.value, value, 1e-12);
        EXPECT_LE(f.lower, f.value);
        EXPECT_LE(f.value, f.upper);
        EXPECT_LE(f.upper, 1.0);
        EXPECT_EQ(f.accurate, f.upper - f.lower <= 1e-3);
        lower += f.area_from * f.lower, upper += f.area_from * f.upper, area += f.area_from;
      }
      const ViewFactor& whole_factor = truth.factors.at(0, p);
      EXPECT_LE(lower / area, whole_factor.upper + 1e-12) << names[p];
      EXPECT_GE(upper / area, whole_factor.lower - 1e-12) << names[p];
    }
  }
}

TEST(MatrixSums, RefuseWhatIsNoColumnUnknownOrTwice) {
  const Scene scene = divided(generate::build(open_box()), 0.6).scene;
  const std::vector<Selection> from{scene.select("left:1")};
  const auto refused = [&](std::vector<Selection> to, const std::vector<std::string>& names) {
    Matrix matrix{{from, to, std::vector<ViewFactor>(to.size())}, {}, {}, {}};
    try {
      add_sums(scene, names, 1e-6, matrix);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(scene.select_all("floor"), {"floor"}), "");
  EXPECT_NE(refused({scene.select("floor:1")}, {"floor"}).find("is no column"), std::string::npos);
  EXPECT_NE(refused(scene.select_all("floor"), {"floor", "floor"}).find("twice"), std::string::npos);
  EXPECT_NE(refused(scene.select_all("floor"), {"roof"}), "");
}

TEST_F(MatrixFilesOfTheCommand, HaveSumsThatAreReadAsNoPatches) {
  const std::vector<std::string> command = {scene_,  "--accuracy", "1e-3",    "--to", "srf-1,srf-2,sky",
                                            "--sum", "srf-[12]",   "--plain", "-o",   file("m.csv"),
                                            "--npz", file("m.npz")};
  const validation::ProgramRun made = run(command);
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_NE(made.output.find("\t(sum srf-[12])\t"), std::string::npos) << made.output;
  const NamedMatrix read = read_named(file("m.csv"));
  EXPECT_EQ(read.to, (std::vector<std::string>{"srf-1", "srf-2"}));
  EXPECT_EQ(read.open.size(), read.from.size());
  EXPECT_EQ(run({scene_, "--to", "srf-1", "--sum", "srf-2"}).exit_code, 2);
}

}  // namespace
}  // namespace exactff::matrix
