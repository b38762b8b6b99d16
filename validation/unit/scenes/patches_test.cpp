// Patches from geometry, and names for faces.
#include "support/test.h"
#include "support/transform.h"
#include "unit/scenes/format_support.h"

namespace exactff::validation {
namespace {

// Boxes with sides in triangles.
PlainScene boxes(const std::vector<std::pair<Vec3, Vec3>>& corners) {
  PlainScene scene;
  for (const auto& [low, high] : corners) add_box(scene, "things", low, high);
  return in_triangles(scene);
}

std::size_t count(const PlainScene& scene, const std::string& patches) {
  return generate::build(scene, {}, scene_options(patches)).patches().size();
}

TEST(PatchesFromGeometry, AreThePlanesTheSmoothAndTheConnected) {
  const PlainScene two = boxes({{{0, 0, 0}, {1, 2, 3}}, {{5, 0, 0}, {7, 2, 3}}});
  EXPECT_EQ(count(two, "groups"), 1U);
  EXPECT_EQ(count(two, "faces"), 24U);
  EXPECT_EQ(count(two, "planes"), 12U);
  EXPECT_EQ(count(two, "smooth"), 12U);
  EXPECT_EQ(count(two, "smooth:90"), 12U);  // edges bend by exactly 90 degrees, not by less
  EXPECT_EQ(count(two, "smooth:90.001"), 2U);
  EXPECT_EQ(count(two, "parts"), 2U);
  const Scene scene = generate::build(two, {}, scene_options("planes"));
  EXPECT_EQ(patch_names(scene)[0], "things/1");
  const std::vector<PatchSummary> rows = summarise(scene);
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_LE(rows[i].area, rows[i - 1].area);
  // Six sides have an area of 6: the lowest corners decide.
  EXPECT_EQ(rows[0].low, (Vec3{0, 0, 0}));
  EXPECT_EQ(rows[0].high, (Vec3{0, 2, 3}));
  EXPECT_EQ(rows[0].centre, (Vec3{0, 1, 1.5}));
  EXPECT_EQ(scene.select_all("things").size(), 12U);
  EXPECT_EQ(patch_names(with_patches(generate::build(two), scene_options("planes"))), patch_names(scene));
}

// A sheet folded along an edge.
TEST(PatchesFromGeometry, DecideAnglesExactly) {
  const auto folded = [](double x) {
    PlainScene scene;
    scene.add_ring(scene.patch("a"), {{0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}});
    scene.add_ring(scene.patch("a"), {{0, 0, 0}, {3, 0, x}, {3, 1, x}, {0, 1, 0}});
    return scene;
  };
  EXPECT_EQ(count(folded(4), "smooth:54"), 1U);  // 53.13 degrees
  EXPECT_EQ(count(folded(4), "smooth:53"), 2U);
  EXPECT_EQ(count(folded(3), "smooth:45"), 2U);
  EXPECT_EQ(count(folded(0x1.7ffffffffffffp+1), "smooth:45.00000000000001"), 1U);
  EXPECT_EQ(count(folded(3), "smooth:45.00000000000001"), 1U);
  EXPECT_EQ(count(folded(0x1.8000000000001p+1), "smooth:45"), 2U);
  EXPECT_EQ(count(folded(0x1.7ffffffffffffp+1), "smooth:45"), 1U);
  EXPECT_EQ(count(folded(0), "smooth:0"), 2U);
  EXPECT_EQ(count(folded(0), "smooth:4.9e-324"), 1U);
}

TEST(PatchesFromGeometry, HaveNamesThatNoOrderChanges) {
  for (std::uint64_t s = 0; s < scaled_count(40); ++s) {
    Random random(seed_of(s));
    PlainScene scene;
    for (int k = random.integer(2, 5); k > 0; --k) {
      const Vec3 at{random.integer(0, 9) * 4.0, random.integer(0, 9) * 4.0, 0.0};
      add_box(scene, "things", at, {at.x + 1, at.y + 1, at.z + random.integer(1, 3)});
    }
    const auto shapes = [](const PlainScene& of, const char* way) {
      std::map<std::string, std::multiset<std::tuple<double, double, double>>> found;
      const Scene made = generate::build(of, {}, scene_options(way));
      for (const Face& face : made.faces()) {
        for (const std::uint32_t v : face.rings[0]) {
          const Vec3& x = made.vertices()[v];
          found[made.patch(face.patch).name].insert({x.x, x.y, x.z});
        }
      }
      return found;
    };
    const PlainScene other = shuffled(scene, random);
    for (const char* way : {"planes", "smooth", "parts"}) EXPECT_EQ(shapes(scene, way), shapes(other, way)) << way;
  }
}

TEST(PatchesFromGeometry, RefuseOtherWays) {
  for (const char* way : {"", "Faces", "smooth:", "smooth:-1", "smooth:181", "smooth:x", "parts:2"}) {
    EXPECT_HOLDS(complaint([&] { (void)scene_options(way); }), "is not a way to make patches") << way;
  }
}

TEST(FaceNames, AreThoseThatSelectorsFind) {
  const Scene scene = generate::build(boxes({{{0, 0, 0}, {1, 2, 3}}, {{5, 0, 0}, {7, 2, 3}}}));
  const auto faces = [&](const std::string& selector) {
    const Scene named = with_names(scene, std::vector<FaceName>{face_name("it = " + selector)});
    return named.faces_of(named.select("it")).size();
  };
  EXPECT_EQ(faces("box:0,0,0,1,2,3"), 12U);
  EXPECT_EQ(faces("box:7,2,3,-1,-1,3"), 4U);
  EXPECT_EQ(faces("normal:0,0,1"), 4U);
  EXPECT_EQ(faces("normal:0,1,1:45"), 8U);
  EXPECT_THROW((void)faces("normal:0,1,1:44.99999999999999"), InputError);
  EXPECT_EQ(faces("normal:0,-1,-1:135"), 24U);
  EXPECT_EQ(faces("normal:0,-1,-1:134.99999999999997"), 16U);
  EXPECT_EQ(faces("normal:0,0,1:90"), 20U);
  EXPECT_EQ(faces("normal:0,0,1:0"), 4U);
  EXPECT_EQ(faces("normal:0,0,1:180"), 24U);
  EXPECT_EQ(faces("normal:0,1,1:46 & box:0,0,0,1,2,3"), 4U);
  EXPECT_EQ(faces("plane:0,0,2,6"), 4U);
  EXPECT_EQ(faces("plane:0,0,1,3.5:0.5"), 4U);
  EXPECT_EQ(faces("plane:1,0,0,0"), 2U);
  EXPECT_EQ(faces("things:1-5,7"), 6U);
  EXPECT_EQ(faces("things"), 24U);
  const Scene both = with_names(scene, std::vector<FaceName>{{"top", "normal:0,0,1"}, {"left", "box:0,0,0,1,2,3"}});
  EXPECT_EQ(both.faces_of(both.select("top")).size(), 2U);
  EXPECT_EQ(both.faces_of(both.select("left")).size(), 12U);
  EXPECT_EQ(patch_names(both), (std::vector<std::string>{"things", "top", "left"}));
}

TEST(FaceNames, RefuseWhatCannotBeRead) {
  const Scene scene = generate::build(boxes({{{0, 0, 0}, {1, 2, 3}}}));
  const auto words = [&](const std::string& text) {
    return complaint([&] { (void)with_names(scene, std::vector<FaceName>{face_name(text)}); });
  };
  EXPECT_HOLDS(words("a"), "is not NAME=SELECTOR");
  EXPECT_HOLDS(words("=box:0,0,0,1,1,1"), "is not NAME=SELECTOR");
  EXPECT_HOLDS(words("a=box:0,0,0,1,1"), "it has 6 numbers");
  EXPECT_HOLDS(words("a=box:0,0,0,1,1,x"), "'x' is not a number");
  EXPECT_HOLDS(words("a=normal:0,0,0"), "no direction");
  EXPECT_HOLDS(words("a=normal:0,0,1:200"), "from 0 to 180");
  EXPECT_HOLDS(words("a=plane:0,0,0,1"), "no normal");
  EXPECT_HOLDS(words("a=things:3-99"), "no range of the patch's faces 1 to 12");
  EXPECT_HOLDS(words("a=plane:0,0,1,1:-1"), "a distance is not negative");
  for (const char* word : {"sky", "all", "(open)"}) {
    EXPECT_HOLDS(words(std::string(word) + "=things:1"), "stands for something else");
  }
  EXPECT_HOLDS(words("a=nothing"), "there is no patch named");
  EXPECT_HOLDS(words("a=box:8,8,8,9,9,9"), "finds no face");
}

TEST(FaceNames, ComeFromFilesAndFlagsAndStayInWhatIsWritten) {
  const TemporaryDirectory directory;
  const std::string room = EXACTFF_DATA_DIR "/scenes/cornell_box.obj", out = (directory.path() / "o.obj").string();
  const std::string names =
      directory.write("names", "# sides\nsides = plane:1,0,0,0 # green\ntops=normal:0,1,0 & tall_block\n").string();
  const ProgramRun done = run_exactff({"convert", room, out, "--names", names, "--name", "tops=light"});
  EXPECT_EQ(done.exit_code, 0) << done.error;
  const Scene made = read_scene(out);
  EXPECT_EQ(made.faces_of(made.select("tops")).size(), 2U);
  EXPECT_EQ(made.faces_of(made.select("tall_block")).size(), 4U);
  const auto patches = patch_names(made);
  EXPECT_TRUE(std::ranges::find(patches, "light") == patches.end());
  const ProgramRun info = run_exactff({"info", room, "--patches", "parts"});
  EXPECT_HOLDS(info.output, "tall_block/1");
  EXPECT_HOLDS(info.output, "centre");
  const std::string bad = directory.write("bad", "a=light\nb\n").string();
  EXPECT_HOLDS(run_exactff({"info", room, "--names", bad}).error, "bad:2: 'b' is not NAME=SELECTOR");
  EXPECT_EQ(run_exactff({"info", room, "--patches", "smooth:x"}).exit_code, 2);
}

TEST(FaceNames, OfPatchesThatKeepFacesAreTold) {
  const Scene scene = generate::build(boxes({{{0, 0, 0}, {1, 2, 3}}}), {}, scene_options("faces"));
  const auto warnings = [&](const std::string& text) {
    const Scene named = with_names(scene, std::vector<FaceName>{face_name(text)});
    return named.warnings().empty() ? std::string() : named.warnings().back().message();
  };
  EXPECT_HOLDS(warnings("things:1=things:2"),
               "the name 'things:1' is that of a patch of 1 face, and 1 face was added to it (faces of one name");
  EXPECT_HOLDS(warnings("things:1=normal:0,0,1"), "2 faces were added");
  EXPECT_EQ(warnings("things:1=things:1"), "");
  EXPECT_EQ(warnings("new=things:1"), "");
}

}  // namespace
}  // namespace exactff::validation
