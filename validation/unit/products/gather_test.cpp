// The light of given radiosities at points: in images, in truth files, over patches; files of solutions.
#include "support/test.h"

namespace exactff::radiosity {
namespace {

const Rgb kGreyKd{0.5, 0.25, 0.75}, kGreyKe{1.0, 3.0, 0.5}, kGreyB{2.0, 4.0, 2.0};  // B = Ke / (1 - Kd)

void add_sides(PlainScene& scene, const std::string& name, const Vec3& a, const Vec3& b, Fronts fronts) {
  for (auto& [side, corners] : sides_of(a, b)) {
    std::vector<Vec3> ring = corners;
    if (fronts == Fronts::kOutside) std::ranges::reverse(ring);
    add(scene, name + '_' + side, ring, kGreyKd, kGreyKe);
  }
}

// A closed room in which everything has the same Kd and Ke, with a box that hangs in it.
Scene furnace() {
  PlainScene scene;
  add_sides(scene, "room", {0, 0, 0}, {4, 4, 3}, Fronts::kInside);
  add_sides(scene, "box", {1, 1.5, 0.5}, {2, 2.5, 1.25}, Fronts::kOutside);
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
  EXPECT_HOLDS(refused({.quantity = Quantity::kFormFactor}), "form factors");
  EXPECT_HOLDS(refused({.sources = {scene.select("lamp")}}), "sources");
  EXPECT_HOLDS(refused({.sky = true}), "sources");
  EXPECT_HOLDS(refused({.sides = render::Sides::kBoth}), "backs");
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

  const TemporaryDirectory folder_;
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
  EXPECT_HOLDS(said(scene, replaced(text, ",certified,", ",rubbish,")), "column 'claim' has an impossible value");
}

TEST_F(SolutionFiles, OfOtherScenesOrWithoutBoundsAreRefused) {
  const Scene scene = plates();
  const std::string text = csv_of(scene, solve(scene, {.factors = {.accuracy = 1e-2}}));
  EXPECT_EQ(said(scene, text), "");
  EXPECT_HOLDS(said(furnace(), text), "another scene");
  EXPECT_HOLDS(said(divided(scene, 0.5).scene, text), "another scene");
  EXPECT_HOLDS(said(scene, replaced(text, "ceiling,green", "floor,green")), "of 'floor' twice in one channel");
  EXPECT_HOLDS(said(scene, replaced(text, "ceiling,green", "roof,green")), "of 'roof', which is no patch of the scene");
  EXPECT_HOLDS(said(scene, text.substr(0, text.find("lamp,"))), "no radiosity of 'lamp' in red");
  EXPECT_HOLDS(said(scene, replaced(text, "\"scene_hash\"", "\"hash\"")), "of which scene");
  EXPECT_HOLDS(said(scene, replaced(text, "lamp,red,4", "lamp,red,5")), "within its bounds");
  const std::size_t row = text.find("floor,blue,");
  std::string unbounded = text.substr(row, text.find('\n', row) - row);
  std::size_t comma = 0;
  for (int k = 0; k < 4; ++k) comma = unbounded.find(',', comma) + 1;
  unbounded.erase(comma, unbounded.find(',', comma) - comma);
  const std::string whole = text.substr(row, text.find('\n', row) - row);
  EXPECT_HOLDS(said(scene, replaced(text, whole, unbounded)), "no bound for blue");
}

class AllTheLight : public testing::Test {
 protected:
  [[nodiscard]] int run(std::vector<std::string> flags) const { return run_exactff(flags).exit_code; }
  [[nodiscard]] std::string file(const char* name) const { return (folder_.path() / name).string(); }

  const TemporaryDirectory folder_;
  const std::string mtl_ = folder_.write("scene.mtl", generate::to_mtl(plain_plates())).string();
  const std::string scene_ = folder_.write("scene.obj", generate::to_obj(plain_plates(), "scene.mtl")).string();
};

TEST_F(AllTheLight, OfADividedSceneComesFromItsFile) {
  ASSERT_EQ(
      run({"radiosity", scene_, "--divide", "0.5", "--two-sided", "floor", "--accuracy", "1e-2", "-o", file("s.csv")}),
      0);
  const std::string solution = text_of(file("s.csv"));
  EXPECT_HOLDS(solution, "\"divided\":0.5,\"two_sided\":[\"floor\"]");
  EXPECT_HOLDS(solution, "area,variation\n");
  EXPECT_HOLDS(solution, "floor:1 (back),red");
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
  EXPECT_HOLDS(complaint([&] { (void)truth::write(request, file("t.csv")); }), "no quantity");
  request.total = Quantity::kIrradiance;
  (void)truth::write(request, file("t.csv"));
  const std::string text = text_of(file("t.csv"));
  EXPECT_HOLDS(text, "total_r,total_g,total_b,total_lower_r,total_lower_g,total_lower_b,total_upper_r");
  const FormFactor f = exact_form_factor(scene, request.receivers[0], ExactSource(scene, scene.select("ceiling")));
  std::string number(32, '\0');
  number.resize(static_cast<std::size_t>(std::snprintf(number.data(), 32, "%.17g", 2 * f.value)));
  EXPECT_HOLDS(text, number.substr(0, 15));
}

}  // namespace
}  // namespace exactff::radiosity
