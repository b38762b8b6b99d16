// Transparent patches: no method lets them hide anything, and they may still be sources and have receivers on them.
#include "scene/closed_surfaces.h"
#include "support/test.h"
#include "unit/rivals/methods_support.h"

namespace exactff::validation {
namespace {

// Every method, with as few rays as make a difference.
const std::vector<std::string> kMethods = {
    "exact",
    "exact:engine=boolean",
    "exact:engine=both",
    "adaptive:eps_B=1e-3,rays=16",
    "adaptive:eps_B=1e-3,rays=16,variant=literal",
    "adaptive-exact-visibility:eps_B=1e-3",
    "hemicube:resolution=64",
    "nettle:splits=4,rays=4",
    "wallace:splits=8",
    "area-sampling:samples=256",
};

// A lamp, a plate that hides a part of it, and a window between the lamp and the receivers. Many slats make the lists
// of candidates so long that rays are traced by the library.
PlainScene room(bool with_window, int slats) {
  PlainScene plain;
  add(plain, "floor", {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  add(plain, "lamp", square_above(1.0, 2.0));
  add(plain, "plate", {{0.1, -0.5, 1.5}, {0.9, -0.4, 1.5}, {0.8, 0.6, 1.6}});
  for (int i = 0; i < slats; ++i) {
    const double x = -0.9 + 1.8 * i / slats;
    add(plain, "slats", {{x, -0.8, 1.2}, {x + 0.01, -0.8, 1.2}, {x + 0.01, 0.7, 1.3}, {x, 0.7, 1.3}});
  }
  if (with_window) {
    add(plain, "window", {{-0.7, -0.9, 1}, {0.6, -0.9, 1}, {0.6, 0.8, 1}, {-0.7, 0.8, 1}});
    add(plain, "window", {{-0.7, -0.9, 0.5}, {-0.7, 0.8, 0.5}, {0.6, 0.8, 0.6}, {0.6, -0.9, 0.6}});
  }
  return plain;
}

Scene transparent(const Scene& scene, const char* name) {
  const Selection selection = scene.select(name);
  return scene.with_transparent(std::span(&selection, 1));
}

double value_at(const Scene& scene, const Vec3& point, const char* on, const char* source, const std::string& method) {
  Receiver receiver{point, {0, 0, 1}, {}, ""};
  if (on != nullptr) receiver.on = own_faces_named(scene, on);
  return estimate(scene, receiver, source, method).form_factor;
}

// No receiver sees a sample at the edge of a slat, where Embree may decide either way. The control with exact
// visibility adds up in the order of the tree, so its last bit may differ.
TEST(Transparent, PatchesHideNothingInAnyMethod) {
  for (const int slats : {0, 40}) {
    const Scene opaque = generate::build(room(true, slats)), without = generate::build(room(false, slats));
    const Scene through = transparent(opaque, "window");
    for (const std::string& method : kMethods) {
      for (const Vec3& point : {Vec3{0.013, 0.027, 0}, Vec3{0.7, -0.3, 0}, Vec3{-1.5, 1.2, 0}}) {
        const double truth = value_at(without, point, "floor", "lamp", method);
        const double value = value_at(through, point, "floor", "lamp", method);
        EXPECT_DOUBLE_EQ(value, truth) << method << ", " << slats << " slats";
        if (method.starts_with("exact")) {
          EXPECT_EQ(value, truth) << method << ", " << slats << " slats";
        }
        EXPECT_GT(truth, 0.0) << method;
      }
      EXPECT_LT(value_at(opaque, {0, 0, 0}, "floor", "lamp", method),
                value_at(through, {0, 0, 0}, "floor", "lamp", method))
          << method << ": the window must matter";
    }
  }
}

TEST(Transparent, PatchesAreARecordOfTheScene) {
  const Scene opaque = generate::build(room(true, 0)), through = transparent(opaque, "window");
  EXPECT_NE(through.hash(), opaque.hash());
  EXPECT_NE(transparent(opaque, "window:1").hash(), through.hash());
  ASSERT_EQ(through.transparent().size(), 1U);
  EXPECT_EQ(through.name_of(through.transparent().front()), "window");
  const Scene half = transparent(opaque, "window:2");
  EXPECT_EQ(half.name_of(half.transparent().front()), "window:2");
  EXPECT_TRUE(opaque.transparent().empty());
  const Scene flipped = opaque.with_flipped(opaque.select("plate"));
  ASSERT_EQ(flipped.flipped().size(), 1U);
  EXPECT_EQ(flipped.name_of(flipped.flipped().front()), "plate");
  EXPECT_NE(flipped.hash(), opaque.hash());
  EXPECT_EQ(flipped.with_flipped(flipped.select("plate")).hash(), opaque.hash());
  EXPECT_TRUE(flipped.with_flipped(flipped.select("plate")).flipped().empty());
}

// A tetrahedron under the lamp. Seen from the origin, its bottom (face 1) and not its back is what hides the lamp; with
// the bottom transparent, its other faces are seen from behind and must hide it.
TEST(Transparent, AClosedSurfaceWithATransparentFaceKeepsItsBacks) {
  PlainScene plain;
  add(plain, "source", square_above(1.0, 2.0));
  const Vec3 a{-1, -1, 0.5}, b{1.5, -1, 0.5}, c{-1, 1.5, 0.5}, top{0, 0, 1.5};
  for (const std::vector<Vec3>& face : std::vector<std::vector<Vec3>>{{a, c, b}, {a, b, top}, {b, c, top}, {c, a, top}})
    add(plain, "solid", face);
  const Scene solid = generate::build(plain), glass = transparent(solid, "solid:1");
  EXPECT_EQ(closed_surfaces(solid).surfaces().size(), 1U);
  EXPECT_TRUE(closed_surfaces(glass).empty());
  for (const std::string& method : kMethods) {
    const double hidden = value_at(solid, {0, 0, 0}, nullptr, "source", method);
    EXPECT_EQ(value_at(glass, {0, 0, 0}, nullptr, "source", method), hidden) << method;
    EXPECT_GT(value_at(transparent(solid, "solid"), {0, 0, 0}, nullptr, "source", method), hidden + 0.01) << method;
  }
}

// --- what a material file says about light that passes ---

Scene with_materials(const std::string& mtl) {
  const TemporaryDirectory directory;
  (void)directory.write("a.mtl", mtl);
  return read_obj(directory.write("a.obj",
                                  "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl m\ng pane one\nf 1 2 3\n"
                                  "g the,other\nf 1 3 4\nusemtl plain\nf 2 3 4\n"));
}

std::string glass_warning(const Scene& scene) {
  for (const Problem& warning : scene.warnings()) {
    if (warning.what.find("lets light through") != std::string::npos)
      return std::to_string(warning.line) + ": " + warning.what + " (" + warning.why + "); " + warning.suggestion;
  }
  return "none";
}

TEST(Glass, IsToldOncePerMaterialWithTheFlag) {
  const Scene scene = with_materials("newmtl plain\nKd 1\nnewmtl m\nKd .5\nd 0.25\n");
  EXPECT_EQ(glass_warning(scene),
            "5: material 'm' lets light through (d 0.25), but 'pane' and 'the,other:1' occlude (every material is "
            "treated as opaque); if it does not hide what is behind it, give --transparent the,other:1 --transparent "
            "pane");
}

TEST(Glass, IsWhatDTrAndIllumSay) {
  const std::pair<const char*, const char*> table[] = {
      {"d 0.5", "d 0.5"},
      {"d -halo 0.5", "d 0.5"},
      {"Tr 0.7", "Tr 0.7"},
      {"illum 7", "illum 7"},
      {"d 1", ""},
      {"Tr 0", ""},
      {"illum 2", ""},
      {"d 1\nTr 1", ""},
      {"Tr 1\nd 1", ""},
      {"d .5\nTr .5", "d 0.5"},
      {"d 1\nillum 7", "illum 7"},
      {"illum 4\nd .5", "d 0.5"},
      {"d what", ""},
      {"d .5 # pane", "d 0.5"},
  };
  for (const auto& [lines, said] : table) {
    const Scene scene = with_materials("newmtl m\n" + std::string(lines) + "\nnewmtl plain\n");
    EXPECT_EQ(scene.materials()[1].name, "m");
    EXPECT_EQ(scene.materials()[1].see_through, said) << lines;
    EXPECT_EQ(glass_warning(scene) == "none", std::string(said).empty()) << lines;
  }
}

}  // namespace
}  // namespace exactff::validation
