// Several files as one scene, and units of length.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include "exactff/exact.h"
#include "exactff/scene_files.h"
#include "support/program.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using validation::error_of;
using validation::TemporaryDirectory;
using validation::warnings_of;
using Patches = std::vector<std::string>;

constexpr const char* kFloor = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\ng floor\n";
const std::string kRoom = std::string(kFloor) + "f 1/1 2/2 3/3 4/4\n";
const std::string kLamp =
    "v 1 1 3\nv 2 1 3\nv 2 2 3\nv 1 2 3\nv 1 1 2\nv 2 1 2.5\nv 1.5 2 2\nf 4 3 2 1\ng floor\nf 5 6 7\nf 5 6 7\n";

class SeveralFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return (folder_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& text) { return folder_.write(name, text).string(); }
  static Patches patches(const Scene& scene) { return validation::patch_names(scene); }

  const TemporaryDirectory folder_;
};

TEST_F(SeveralFiles, AreWhatOneFileOfTheirLinesIs) {
  const std::string several = write("room.obj", kRoom) + '+' + write("lamp.obj", kLamp);
  const std::string one = write("one.obj", kRoom +
                                               "v 1 1 3\nv 2 1 3\nv 2 2 3\nv 1 2 3\nv 1 1 2\nv 2 1 2.5\nv 1.5 2 2\n"
                                               "g lamp\nf 8 7 6 5\ng lamp/floor\nf 9 10 11\nf 9 10 11\n");
  const Scene joined = read_scene(several), whole = read_scene(one);
  EXPECT_EQ(patches(joined), (Patches{"room/floor", "lamp", "lamp/floor"}));
  ASSERT_EQ(joined.faces().size(), whole.faces().size());
  const Receiver receiver{.point = {1.5, 0.5, 0.25}, .normal = {0.1, 0.2, 1}, .on = {}, .id = {}};
  for (std::size_t p = 0; p < 3; ++p) {
    const Selection patch{static_cast<PatchId>(p), {}};
    for (const Engine engine : {Engine::kEdges, Engine::kBoolean}) {
      EXPECT_EQ(exact_form_factor(joined, receiver, ExactSource(joined, patch), {.engine = engine}).value,
                exact_form_factor(whole, receiver, ExactSource(whole, patch), {.engine = engine}).value);
    }
  }
  EXPECT_EQ(joined.texture(FaceId{0}).size(), 4U);
  EXPECT_TRUE(joined.texture(FaceId{1}).empty());
  EXPECT_EQ(joined.files().size(), 2U);
  EXPECT_EQ(joined.select("lamp/floor:2").face, FaceId{3});
  EXPECT_EQ(patches(read_scene(several, {.patches = PatchMode::kPlanes})),
            (Patches{"room/floor/1", "lamp/1", "lamp/floor/1"}));
}

TEST_F(SeveralFiles, AreFoundByTheLongestNamesThatExist) {
  const std::string a = write("a+b.obj", kLamp), b = write("b.obj", kRoom);
  EXPECT_EQ(patches(read_scene(a)), (Patches{"default", "floor"}));
  EXPECT_EQ(patches(read_scene(a + '+' + b)), (Patches{"a+b", "a+b/floor", "b/floor"}));
  EXPECT_EQ(patches(read_scene(b + '+' + b)), (Patches{"b/floor", "b/floor_2"}));
  EXPECT_TRUE(error_of([&] { return read_scene(b + "+none.obj"); }).starts_with("none.obj: cannot be opened"));
  EXPECT_TRUE(error_of([&] { return read_scene("none.obj+" + b); }).starts_with("none.obj: cannot be opened"));
  EXPECT_TRUE(error_of([&] { return read_scene("no+ne.obj"); }).starts_with("no+ne.obj: cannot be opened"));
  const std::string bad = write("bad.obj", "v 0 0\nf 1 1 1\n"), worse = write("worse.obj", "f 1 2 3\n");
  const std::string message = error_of([&] { return read_scene(bad + '+' + worse); });
  EXPECT_NE(message.find("bad.obj:1: "), std::string::npos) << message;
  EXPECT_NE(message.find("worse.obj:1: "), std::string::npos) << message;
}

TEST_F(SeveralFiles, AreConvertedIntoTheUnitOfTheFirst) {
  const std::string metres = write("m.obj", "# unit m\n" + kRoom);
  const std::string feet = write("ft.obj", "# unit ft\nv 0.1 2 3\nv 5 7.25 3\nv 1e-3 9 4\nf 1 2 3\n");
  const Scene scene = read_scene(metres + '+' + feet);
  EXPECT_EQ(scene.unit(), Unit::kMetre);
  EXPECT_NE(warnings_of(scene).find("ft.obj: was converted from ft to m (every one of 3 vertices rounded, once)"),
            std::string::npos)
      << warnings_of(scene);
  const Scene alone = read_scene(feet);
  for (std::size_t v = 0; v < 3; ++v) {
    const mpq_class exact = mpq_class(alone.vertices()[v].x) * mpq_class(3048, 10000);
    const double made = scene.vertices()[4 + v].x;
    const mpq_class off = abs(mpq_class(made) - exact);
    EXPECT_TRUE(off <= abs(mpq_class(std::nextafter(made, 1e9)) - exact) &&
                off <= abs(mpq_class(std::nextafter(made, -1e9)) - exact));
  }
  const std::string none = write("none.obj", kLamp);
  EXPECT_NE(error_of([&] { return read_scene(metres + '+' + none); }).find("none.obj: does not say its unit of length"),
            std::string::npos);
  EXPECT_NE(error_of([&] { return read_scene(none + '+' + metres); }).find("none.obj: does not say its unit of length"),
            std::string::npos);
  const Scene stated = read_scene(none + '+' + metres, {.unit = Unit::kMillimetre});
  EXPECT_EQ(stated.unit(), Unit::kMillimetre);
  EXPECT_EQ(stated.vertices()[8], (Vec3{4000, 0, 0}));
  EXPECT_NE(warnings_of(stated).find("m.obj: was converted from m to mm (exactly)"), std::string::npos);
}

TEST_F(SeveralFiles, UnitsStayInCopiesAndFiles) {
  const Scene scene = read_scene(kRoom, "s.obj", {.unit = Unit::kInch});
  for (const Scene& copy : {scene.with_flipped(scene.select("floor")), triangulated(scene), welded(scene, 0.1).scene,
                            divided(scene, 1.0).scene, with_patches(scene, {.patches = PatchMode::kParts})})
    EXPECT_EQ(copy.unit(), Unit::kInch);
  for (const char* name : {"s.obj", "s.off", "s.ply"}) {
    const SceneFiles files = scene_files(scene, name);
    EXPECT_TRUE(files.losses.empty() || name != std::string("s.obj"));
    EXPECT_EQ(read_scene(files.files.back().bytes, name).unit(), Unit::kInch) << name;
  }
  EXPECT_EQ(scene_files(scene, "s.stl").losses.back().what, "the unit in is lost");
  EXPECT_EQ(read_scene("# unit of choice\n# unit parsec\n" + kRoom, "s.obj").unit(), Unit::kNone);
  EXPECT_NE(error_of([] { return unit_named("parsec"); }).find("'parsec' is no unit of length"), std::string::npos);
}

}  // namespace
}  // namespace exactff
