// The light of given radiosities at points: in images, in truth files, over patches; files of solutions.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "exactff/exr.h"
#include "exactff/radiosity.h"
#include "exactff/render.h"
#include "exactff/truth.h"
#include "generate/plain_scene.h"
#include "support/complaint.h"
#include "support/program.h"

namespace exactff::radiosity {
namespace {

using generate::PlainScene;
using validation::complaint;

const Rgb kGreyKd{0.5, 0.25, 0.75}, kGreyKe{1.0, 3.0, 0.5}, kGreyB{2.0, 4.0, 2.0};  // B = Ke / (1 - Kd)

void add(PlainScene& scene, const std::string& name, const std::vector<Vec3>& corners, const Rgb& kd, const Rgb& ke) {
  generate::PlainPatch& patch = scene.patch(name);
  scene.add_ring(patch, corners);
  patch.material = "of " + name;
  scene.materials.push_back({.name = patch.material, .reflectance = kd, .radiosity = ke});
}

enum class Fronts { kInside, kOutside };

void add_box(PlainScene& scene, const std::string& name, const Vec3& a, const Vec3& b, Fronts fronts) {
  const std::vector<std::pair<std::string, std::vector<Vec3>>> sides = {
      {"below", {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}}},
      {"left", {{a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z}}},
      {"right", {{b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}}},
      {"near", {{a.x, a.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z}}},
      {"far", {{a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}},
      {"above", {{a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}}}};
  for (const auto& [side, corners] : sides) {
    std::vector<Vec3> ring = corners;
    if (fronts == Fronts::kOutside) std::ranges::reverse(ring);
    add(scene, name + '_' + side, ring, kGreyKd, kGreyKe);
  }
}

// A closed room in which everything has the same Kd and Ke, with a box that hangs in it.
Scene furnace() {
  PlainScene scene;
  add_box(scene, "room", {0, 0, 0}, {4, 4, 3}, Fronts::kInside);
  add_box(scene, "box", {1, 1.5, 0.5}, {2, 2.5, 1.25}, Fronts::kOutside);
  return generate::build(scene);
}

// Two plates that look at each other, 1 apart, with a lamp of two colours beside the upper one.
PlainScene plain_plates() {
  PlainScene scene;
  add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0.5, 0.25, 1.0}, {});
  add(scene, "ceiling", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, {0.125, 0.5, 0.25}, {});
  add(scene, "lamp", {{1, 0, 1}, {1, 1, 1}, {1.5, 1, 1}, {1.5, 0, 1}}, {}, {4, 2, 8});
  return scene;
}
Scene plates() { return generate::build(plain_plates()); }

Radiosities same_everywhere(const Scene& scene, const Rgb& b) {
  Radiosities all{.name = "by hand", .patches = patches_of(scene)};
  all.value = all.lower = all.upper = std::vector<Rgb>(all.patches.size(), b);
  return all;
}

Radiosities by_hand(const Scene& scene, const std::vector<Rgb>& b) {
  Radiosities all = same_everywhere(scene, {});
  all.value = all.lower = all.upper = b;
  return all;
}

const render::Camera kInFurnace{.eye = {3.5, 0.4, 2.0}, .look = {1.0, 2.5, 0.75}, .up = {0, 0, 1}, .fov = 80.0};
const render::Camera kOverFloor{.eye = {0.5, 0.5, 0.875}, .look = {0.5, 0.5, 0}, .up = {0, 1, 0}, .ortho = 0.8};

render::Picture picture_of(const Scene& scene, Radiosities radiosities, const render::Camera& camera,
                           Quantity quantity = Quantity::kRadiosity, render::Size size = {12, 12}) {
  return render::render({.scene = &scene,
                         .view = render::View(camera, size),
                         .radiosities = std::move(radiosities),
                         .quantity = quantity,
                         .bounds = render::Bounds::kAll});
}

double channel(const Rgb& colour, std::size_t c) { return c == 0 ? colour.r : c == 1 ? colour.g : colour.b; }

TEST(Gather, OfAFurnaceShowsItsRadiosityInEveryPixelToTheLastDigit) {
  const Scene scene = furnace();
  const render::Picture picture = picture_of(scene, same_everywhere(scene, kGreyB), kInFurnace);
  EXPECT_EQ(picture.not_certified, 0U);
  for (std::size_t i = 0; i < picture.values.size(); ++i) ASSERT_EQ(picture.values[i], channel(kGreyB, i % 3)) << i;
}

TEST(Gather, OfEqualRadiositiesIsEmissionAndWhatTheSumOfFormFactorsReflects) {
  const Scene scene = plates();
  const render::Picture shares = render::render({.scene = &scene,
                                                 .view = render::View(kOverFloor, {6, 6}),
                                                 .sources = patches_of(scene),
                                                 .quantity = Quantity::kFormFactor});
  const render::Picture picture =
      picture_of(scene, same_everywhere(scene, {2, 4, 8}), kOverFloor, Quantity::kRadiosity, {6, 6});
  const Rgb kd{0.5, 0.25, 1.0}, b{2, 4, 8};  // powers of two: the product is the rounded value
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    ASSERT_EQ(picture.values[i], channel(kd, i % 3) * channel(b, i % 3) * shares.values[i]) << i;
    ASSERT_GT(picture.values[i], 0.0);
  }
}

TEST(Gather, BoundsOfASolvedFurnaceHoldItsRadiosity) {
  const Scene scene = furnace();
  const Solution solution = solve(scene, {.factors = {.accuracy = 1e-2, .budget = 2000}});
  ASSERT_TRUE(solution.is_bounded());
  const render::Picture picture = picture_of(scene, radiosities_of(solution), kInFurnace);
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    const double b = channel(kGreyB, i % 3);
    ASSERT_LT(picture.lower[i], b);
    ASSERT_GT(picture.upper[i], b);
    ASSERT_LE(picture.lower[i], picture.values[i]);
    ASSERT_GE(picture.upper[i], picture.values[i]);
    ASSERT_LT(picture.upper[i] - picture.lower[i], 0.5 * b);
  }
}

// A patch does not light itself, and each channel has radiosities of its own.
TEST(Gather, TakesTheChannelsOfOtherPatches) {
  const Scene scene = plates();
  const auto of = [&](const std::vector<Rgb>& radiosities, Quantity quantity) {
    return picture_of(scene, by_hand(scene, radiosities), kOverFloor, quantity, {3, 3}).values;
  };
  for (const double v : of({{100, 100, 100}, {}, {}}, Quantity::kIrradiance)) EXPECT_EQ(v, 0.0);
  const std::vector<double> arriving = of({{}, {1, 2, 4}, {}}, Quantity::kIrradiance),
                            leaving = of({{}, {1, 2, 4}, {}}, Quantity::kRadiosity);
  for (std::size_t i = 0; i < arriving.size(); i += 3) {
    EXPECT_GT(arriving[i], 0.1);
    EXPECT_EQ(arriving[i + 1], 2.0 * arriving[i]);
    EXPECT_EQ(arriving[i + 2], 4.0 * arriving[i]);
    EXPECT_EQ(leaving[i], 0.5 * arriving[i]);  // Kd of the floor, not of the ceiling
    EXPECT_EQ(leaving[i + 1], 0.25 * arriving[i + 1]);
    EXPECT_EQ(leaving[i + 2], arriving[i + 2]);
  }
}

TEST(Gather, BoundsAreThoseOfTheRadiosities) {
  const Scene scene = plates();
  Radiosities wide = by_hand(scene, {{}, {2, 2, 2}, {}});
  wide.lower = {{}, {1, 1, 1}, {}};
  wide.upper = {{}, {4, 4, 4}, {}};
  const render::Picture picture = picture_of(scene, wide, kOverFloor, Quantity::kIrradiance, {3, 3});
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    EXPECT_NEAR(picture.lower[i], 0.5 * picture.values[i], 1e-15);
    EXPECT_LE(picture.lower[i], 0.5 * picture.values[i]);
    EXPECT_NEAR(picture.upper[i], 2.0 * picture.values[i], 1e-15);
    EXPECT_GE(picture.upper[i], 2.0 * picture.values[i]);
  }
  ASSERT_EQ(picture.layers.size(), 6U);
  EXPECT_EQ(picture.layers[1].name, "lower.G");
  EXPECT_EQ(picture.layers[1].values[4], picture.lower[3 * 4 + 1]);
  EXPECT_EQ(picture.layers[5].name, "upper.B");
}

TEST(Gather, RefusesWhatHasNoMeaning) {
  const Scene scene = plates();
  const auto refused = [&](render::Request request) {
    request.scene = &scene;
    request.radiosities = same_everywhere(scene, {1, 1, 1});
    return complaint([&] { (void)render::render(request); });
  };
  EXPECT_NE(refused({.quantity = Quantity::kFormFactor}).find("form factors"), std::string::npos);
  EXPECT_NE(refused({.sources = {scene.select("lamp")}}).find("sources"), std::string::npos);
  EXPECT_NE(refused({.sky = true}).find("sources"), std::string::npos);
  EXPECT_NE(refused({.sides = render::Sides::kBoth}).find("backs"), std::string::npos);
}

TEST(Variation, IsNoneInAFurnaceAndLargestWhereLightFalls) {
  const Scene box = furnace();
  Solution even;
  even.patches = patches_of(box);
  for (std::size_t c = 0; c < 3; ++c) {
    even.channels[c].radiosity.assign(even.patches.size(), {channel(kGreyB, c), 0.0, 100.0});
  }
  set_variation(box, even);
  for (const Channel& one : even.channels) {
    for (const double v : one.variation) EXPECT_EQ(v, 0.0);
  }
  const Scene scene = plates();
  Solution solution = solve(scene, {.factors = {.accuracy = 1e-4}});
  EXPECT_TRUE(solution.channels[0].variation.empty());
  set_variation(scene, solution);
  const std::vector<double>& red = solution.channels[0].variation;
  EXPECT_GT(red[0], 0.05);                                     // the floor, near the lamp
  EXPECT_LT(red[0], solution.channels[0].radiosity[0].value);  // nowhere twice as bright
  EXPECT_EQ(red[2], 0.0);                                      // the lamp reflects nothing
}

class SolutionFiles : public testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& text) const { return folder_.write("s.csv", text).string(); }
  [[nodiscard]] std::string said(const Scene& scene, const std::string& text) const {
    return complaint([&] { (void)radiosities_of(scene, read_solution(file(text))); });
  }
  static std::string csv_of(const Scene& scene, const Solution& solution, const Origin& origin = {}) {
    return table::csv_text(table_of(scene, solution, {}, origin));
  }
  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  const validation::TemporaryDirectory folder_;
};

TEST_F(SolutionFiles, ReadBackToTheSameBits) {
  const Scene scene = plates();
  const Solution solution = solve(scene, {.factors = {.accuracy = 1e-3}});
  const Origin origin{.divided = 0.1, .two_sided = {"a,b", "c"}};
  const SolutionFile read = read_solution(file(csv_of(scene, solution, origin)));
  EXPECT_EQ(read.origin.divided, origin.divided);
  EXPECT_EQ(read.origin.two_sided, origin.two_sided);
  const Radiosities a = radiosities_of(solution), b = radiosities_of(scene, read);
  EXPECT_EQ(a.patches, b.patches);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(b.name, "s.csv");
  EXPECT_EQ(solution.claim, Claim::kEstimated);
  EXPECT_EQ(a.claim, Claim::kEstimated);
  EXPECT_EQ(b.claim, Claim::kEstimated);
}

TEST_F(SolutionFiles, KeepTheirClaim) {
  const Scene scene = plates();
  const Solution proved = solve(scene, {.factors = {.accuracy = 1e-2, .certify = true}});
  const std::string text = csv_of(scene, proved);
  EXPECT_EQ(read_solution(file(text)).claim, Claim::kCertified);
  EXPECT_EQ(read_solution(file(replaced(text, ",certified,", ",estimated,"))).claim, Claim::kEstimated);
  EXPECT_NE(said(scene, replaced(text, ",certified,", ",rubbish,")).find("column 'claim' has an impossible value"),
            std::string::npos);
}

TEST_F(SolutionFiles, OfOtherScenesOrWithoutBoundsAreRefused) {
  const Scene scene = plates();
  const std::string text = csv_of(scene, solve(scene, {.factors = {.accuracy = 1e-2}}));
  EXPECT_EQ(said(scene, text), "");
  EXPECT_NE(said(furnace(), text).find("another scene"), std::string::npos);
  EXPECT_NE(said(divided(scene, 0.5).scene, text).find("another scene"), std::string::npos);
  EXPECT_NE(said(scene, replaced(text, "ceiling,green", "floor,green")).find("of 'floor' twice in one channel"),
            std::string::npos);
  EXPECT_NE(
      said(scene, replaced(text, "ceiling,green", "roof,green")).find("of 'roof', which is no patch of the scene"),
      std::string::npos);
  EXPECT_NE(said(scene, text.substr(0, text.find("lamp,"))).find("no radiosity of 'lamp' in red"), std::string::npos);
  EXPECT_NE(said(scene, replaced(text, "\"scene_hash\"", "\"hash\"")).find("of which scene"), std::string::npos);
  EXPECT_NE(said(scene, replaced(text, "lamp,red,4", "lamp,red,5")).find("within its bounds"), std::string::npos);
  const std::size_t row = text.find("floor,blue,");
  std::string unbounded = text.substr(row, text.find('\n', row) - row);
  std::size_t comma = 0;
  for (int k = 0; k < 4; ++k) comma = unbounded.find(',', comma) + 1;
  unbounded.erase(comma, unbounded.find(',', comma) - comma);
  const std::string whole = text.substr(row, text.find('\n', row) - row);
  EXPECT_NE(said(scene, replaced(text, whole, unbounded)).find("no bound for blue"), std::string::npos);
}

class AllTheLight : public testing::Test {
 protected:
  [[nodiscard]] int run(std::vector<std::string> flags) const {
    return validation::run_program(EXACTFF_PROGRAM, flags).exit_code;
  }
  [[nodiscard]] std::string file(const char* name) const { return (folder_.path() / name).string(); }

  const validation::TemporaryDirectory folder_;
  const std::string mtl_ = folder_.write("scene.mtl", generate::to_mtl(plain_plates())).string();
  const std::string scene_ = folder_.write("scene.obj", generate::to_obj(plain_plates(), "scene.mtl")).string();
};

TEST_F(AllTheLight, OfADividedSceneComesFromItsFile) {
  ASSERT_EQ(
      run({"radiosity", scene_, "--divide", "0.5", "--two-sided", "floor", "--accuracy", "1e-2", "-o", file("s.csv")}),
      0);
  const std::string solution = validation::text_of(file("s.csv"));
  EXPECT_NE(solution.find("\"divided\":0.5,\"two_sided\":[\"floor\"]"), std::string::npos) << solution.substr(0, 400);
  EXPECT_NE(solution.find("area,variation\n"), std::string::npos);
  EXPECT_NE(solution.find("floor:1 (back),red"), std::string::npos);
  EXPECT_EQ(run({"render", scene_, "--radiosity", file("s.csv"), "--size", "8x8", "-o", file("a.exr")}), 0);
  std::vector<std::string> names;
  const exr::ExrFile image(file("a.exr"));
  for (const auto& one : image.channels()) names.push_back(one.name);
  for (const char* name : {"R", "lower.R", "upper.B"}) EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  EXPECT_EQ(run({"render", scene_, "--radiosity", file("s.csv"), "--divide", "0.25", "-o", file("b.png")}), 2);
  EXPECT_EQ(
      run({"render", EXACTFF_DATA_DIR "/scenes/blinds_room.obj", "--radiosity", file("s.csv"), "-o", file("b.png")}),
      2);
  EXPECT_EQ(run({"render", scene_, "--radiosity", file("s.csv"), "--source", "lamp", "-o", file("b.png")}), 2);
}

TEST_F(AllTheLight, InATruthFileIsTheIrradianceWithBounds) {
  const Scene scene = plates();
  Radiosities wide = by_hand(scene, {{}, {2, 2, 2}, {}});
  wide.lower = {{}, {1, 1, 1}, {}};
  wide.upper = {{}, {4, 4, 4}, {}};
  truth::Request request;
  request.scene = &scene;
  request.receivers = {{{0.5, 0.5, 0}, {0, 0, 1}, {FaceId{0}}, "here"}};
  request.sources = {scene.select("lamp")};
  request.radiosities = wide;
  EXPECT_NE(complaint([&] { (void)truth::write(request, file("t.csv")); }).find("no quantity"), std::string::npos);
  request.total = Quantity::kIrradiance;
  (void)truth::write(request, file("t.csv"));
  const std::string text = validation::text_of(file("t.csv"));
  EXPECT_NE(text.find("total_r,total_g,total_b,total_lower_r,total_lower_g,total_lower_b,total_upper_r"),
            std::string::npos);
  const FormFactor f = exact_form_factor(scene, request.receivers[0], ExactSource(scene, scene.select("ceiling")));
  std::string number(32, '\0');
  number.resize(static_cast<std::size_t>(std::snprintf(number.data(), 32, "%.17g", 2 * f.value)));
  EXPECT_NE(text.find(number.substr(0, 15)), std::string::npos) << text;
}

TEST_F(SolutionFiles, WithPatchesWithoutAreaAreRefused) {
  generate::PlainScene plain = plain_plates();
  plain.add_ring(plain.patch("thread"), {{0, 0, 2}, {1, 0, 2}, {1, 0, 2}});
  const Scene scene = generate::build(plain);
  const std::string text = csv_of(scene, solve(scene, {.factors = {.accuracy = 1e-2}}));
  EXPECT_NE(said(scene, replaced(text, "ceiling,green", "thread,green")).find("of 'thread', which has no area"),
            std::string::npos);
}

}  // namespace
}  // namespace exactff::radiosity
