// The scenes of data/scenes have their documented properties.
#include <iterator>

#include "generate/families.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

const std::string kScenes = EXACTFF_DATA_DIR "/scenes/";

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> patch_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Patch& patch : scene.patches()) names.push_back(patch.name);
  std::ranges::sort(names);
  return names;
}

FormFactor form_factor(const Scene& scene, const Receiver& receiver, const std::string& source) {
  return exact_form_factor(scene, receiver, ExactSource(scene, scene.select(source)), {.engine = Engine::kBoth});
}

TEST(CornellBox, HasItsPatchesAndNothingToWarnOf) {
  const Scene scene = read_obj(kScenes + "cornell_box.obj");
  EXPECT_EQ(patch_names(scene), (std::vector<std::string>{"back", "ceiling", "floor", "left", "light", "right",
                                                          "short_block", "tall_block"}));
  EXPECT_TRUE(scene.warnings().empty());
  EXPECT_TRUE(std::ranges::all_of(scene.faces(), [](const Face& f) { return f.shape == FaceShape::kPlanar; }));
  ASSERT_EQ(scene.emitters().size(), 1u);
  EXPECT_EQ(scene.source_radiosity(scene.select("light")), (Rgb{17, 12, 4}));
}

TEST(CornellBox, FrontsFaceIntoTheRoomAndOutOfTheBlocks) {
  const Scene scene = read_obj(kScenes + "cornell_box.obj");
  const auto newell = [&](const char* name) { return scene.face(scene.faces_of(scene.select(name)).front()).newell; };
  EXPECT_GT(newell("floor").y, 0.0);
  EXPECT_LT(newell("ceiling").y, 0.0);
  EXPECT_LT(newell("light").y, 0.0);
  EXPECT_LT(newell("back").z, 0.0);
  EXPECT_GT(newell("right").x, 0.0);
  EXPECT_LT(newell("left:1").x, 0.0);
  EXPECT_LT(newell("left:2").x, 0.0);
  EXPECT_GT(newell("short_block:1").y, 0.0);
  EXPECT_GT(newell("tall_block:1").y, 0.0);
}

// From inside the closed blocks or just outside them, no side may show its back to the room.
TEST(CornellBox, BlocksHideTheLightFromTheirInside) {
  const Scene scene = read_obj(kScenes + "cornell_box.obj");
  for (const Vec3& inside : {Vec3{186, 80, 169}, Vec3{368, 160, 351}}) {
    const FormFactor result = form_factor(scene, {inside, {0, 1, 0}, {}, {}}, "light");
    EXPECT_EQ(result.status, Status::kZero);
    EXPECT_EQ(form_factor(scene, {inside, {0, 1, 0}, {}, {}}, "short_block").status, Status::kZero);
    EXPECT_EQ(form_factor(scene, {inside, {0, 1, 0}, {}, {}}, "tall_block").status, Status::kZero);
  }
}

// The room is closed except for its front. With a wall there, the form factors of all patches sum to 1.
TEST(CornellBox, ClosesToOneWithAFrontWall) {
  std::istringstream text(text_of(kScenes + "cornell_box.obj") +
                          "g front\nv 0 0 0\nv 552.8 0 0\nv 556 548.8 0\nv 0 548.8 0\nf -4 -3 -2 -1\n");
  const Scene scene = read_obj(text, kScenes + "cornell_box.obj");
  Enclosure sum;
  for (const Patch& patch : scene.patches()) {
    sum += form_factor(scene, {{278, 400, 100}, {1, -2, 3}, {}, {}}, patch.name).enclosure;
  }
  EXPECT_TRUE(sum.contains(1.0)) << sum.midpoint() << " +/- " << sum.radius();
}

TEST(BlindsRoom, IsWhatTheGeneratorWrites) {
  generate::PlainScene scene = generate::room({.n = 32});
  scene.comments = {"exactff_generate room --n 32 --seed 1 --cover 1 --scale 1"};
  EXPECT_EQ(text_of(kScenes + "blinds_room.obj"), generate::to_obj(scene, "blinds_room.mtl"));
  EXPECT_EQ(text_of(kScenes + "blinds_room.mtl"), generate::to_mtl(scene));
}

TEST(BlindsRoom, WindowIsPartlyHiddenByTheBlind) {
  const generate::PlainScene plain = generate::room({.n = 32});
  const Scene scene = read_obj(kScenes + "blinds_room.obj");
  EXPECT_TRUE(scene.warnings().empty());
  ExactOptions options;
  options.visible_fraction = true;
  options.engine = Engine::kBoth;
  const FormFactor result =
      exact_form_factor(scene, generate::receiver_of(plain), ExactSource(scene, scene.select("window")), options);
  EXPECT_GT(result.visible_fraction.value(), 0.0);
  EXPECT_LT(result.visible_fraction.value(), 1.0);
}

// A point in front of every slat sees only fronts.
TEST(BlindsRoom, ClosesToOne) {
  const Scene scene = read_obj(kScenes + "blinds_room.obj");
  Enclosure sum;
  for (const Patch& patch : scene.patches()) {
    sum += form_factor(scene, {{2.5, 1.25, 4}, {0, -1, 0.5}, {}, {}}, patch.name).enclosure;
  }
  EXPECT_TRUE(sum.contains(1.0)) << sum.midpoint() << " +/- " << sum.radius();
}

}  // namespace
}  // namespace exactff::validation
