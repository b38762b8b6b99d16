#include "exactff/models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "exactff/exact.h"
#include "exactff/scene_files.h"
#include "exactff/view.h"
#include "generate/families.h"
#include "models/registry.h"
#include "support/complaint.h"
#include "support/holds.h"
#include "support/program.h"

namespace exactff::validation {
namespace {

using models::make_scene;
using models::Model;

// Each model, small.
const std::vector<std::string> kSmall = {"teapot:segments=2",
                                         "forest:n=50,trees=3",
                                         "forest:n=50,trees=3,light=sun",
                                         "closed-room:boxes=3",
                                         "closed-room:lamp=hanging",
                                         "emitters:n=5",
                                         "room:n=3",
                                         "karkanis:n=20",
                                         "soup:n=20",
                                         "blinds:n=4",
                                         "tiles:n=3",
                                         "mesh:n=30",
                                         "lattice:n=20"};

std::string complaint_about(const std::string& text) {
  return complaint([&] { (void)make_scene(text); });
}

// --- all of them ---

TEST(Models, EachIsListedOnceAndDescribesItsSettings) {
  std::set<std::string> names, small;
  for (const Model* model : models::all_models()) {
    EXPECT_TRUE(names.insert(model->name).second) << model->name;
    const std::string text = models::description(*model);
    EXPECT_TRUE(text.starts_with(model->name + ": " + model->summary + "\n")) << text;
    for (const auto& setting : model->settings) EXPECT_TRUE(holds(text, "\n  " + setting.name + "=")) << text;
  }
  for (const std::string& text : kSmall) small.insert(text.substr(0, text.find(':')));
  EXPECT_EQ(names, small);
}

TEST(Models, AnUnknownOneIsToldTheClosest) {
  const std::string text = complaint_about("tepot:segments=2");
  EXPECT_TRUE(holds(text, "there is no model 'tepot' (models are teapot, ")) << text;
  EXPECT_TRUE(holds(text, "did you mean teapot")) << text;
  EXPECT_TRUE(holds(complaint_about(""), "there is no model ''"));
}

TEST(Models, EverythingWrongWithTheSettingsIsSaidAtOnce) {
  const std::string text = complaint_about("karkanis:n=0,sed=1,cover,n=2,floor=-1");
  for (const char* part : {"model 'karkanis': '0' is not a valid value of n", "a whole number from 1 to 10000000",
                           "there is no setting 'sed'", "did you mean seed?", "'cover' has no value",
                           "setting 'n' is given twice", "a number from 0 to 100"}) {
    EXPECT_TRUE(holds(text, part)) << part << "\nis not in\n" << text;
  }
}

TEST(Models, TheFileReadsBackToTheSameScene) {
  const TemporaryDirectory directory;
  for (const std::string& text : kSmall) {
    (void)directory.write("scene.mtl", models::make_mtl(text));
    const Scene read = read_obj(directory.write("scene.obj", models::make_obj(text, "scene.mtl")));
    EXPECT_EQ(read.hash(), make_scene(text).hash()) << text;
  }
}

TEST(Models, WithoutAFileOfMaterialsNothingIsMissing) {
  const TemporaryDirectory directory;
  const Scene scene = read_obj(directory.write("scene.obj", models::make_obj("room:n=3")));
  EXPECT_TRUE(scene.warnings().empty());
  EXPECT_TRUE(scene.emitters().empty());
}

TEST(Models, TheFirstCommentMakesTheSceneAgain) {
  const std::string obj = models::make_obj(" tiles : n = 3 ");
  const std::string start = "# exactff model ";
  ASSERT_TRUE(obj.starts_with(start));
  const std::string text = obj.substr(start.size(), obj.find('\n') - start.size());
  EXPECT_EQ(text, "tiles:n=3,drop=0,floor=1");
  EXPECT_EQ(make_scene(text).hash(), make_scene("tiles:n=3").hash());
}

// These bits cannot be derived in advance. The test checks that they are the same on every machine.
TEST(Models, BitsAreTheSameOnEveryMachine) {
  const std::map<std::string, std::string> hashes = {{"teapot:segments=3", "39a0f0f183acde91"},
                                                     {"forest:n=100", "61fe630f2369489b"},
                                                     {"forest:n=100,light=sun", "b1903b1eb3fa870e"},
                                                     {"closed-room", "f059258cc9a42927"},
                                                     {"emitters", "4ceb02fae85e5271"},
                                                     {"karkanis:n=200,seed=3", "b07491c610f656b9"}};
  for (const auto& [text, hash] : hashes) EXPECT_EQ(make_scene(text).hash(), hash) << text;
}

TEST(Models, AnotherSeedGivesAnotherScene) {
  for (const char* name : {"forest:n=50", "closed-room:boxes=3", "emitters:n=5", "karkanis:n=9", "soup:n=9"}) {
    const std::string text = name;
    EXPECT_NE(make_scene(text + ",seed=2").hash(), make_scene(text).hash()) << text;
  }
}

TEST(Models, HaveARectangleToPutAGridOnAndAnEmitter) {
  for (const std::string& text : kSmall) {
    const Scene scene = make_scene(text);
    EXPECT_FALSE(scene.emitters().empty()) << text;
    const Selection floor = scene.select(text.starts_with("forest") ? "ground" : "floor");
    ASSERT_EQ(scene.faces_of(floor).size(), 1U) << text;
    EXPECT_EQ(scene.face(scene.faces_of(floor)[0]).rings[0].size(), 4U) << text;
    if (!text.starts_with("lattice")) {
      EXPECT_TRUE(scene.warnings().empty()) << text;
    }
  }
}

TEST(Models, FacesBecomePatchesOnRequest) {
  const Scene scene = make_scene("blinds:n=4", {.patches = PatchMode::kFaces});
  EXPECT_EQ(scene.patches().size(), 6U);
}

TEST(Models, TheRoomIsTheSceneInData) {
  EXPECT_EQ(make_scene("room").hash(), read_obj(EXACTFF_DATA_DIR "/scenes/blinds_room.obj").hash());
}

std::vector<models::Ring> rings_of(const models::PlainScene& scene) {
  std::vector<models::Ring> rings;
  for (const auto& patch : scene.patches) {
    for (const auto& face : patch.faces) rings.push_back(face.rings.front());
  }
  return rings;
}

TEST(Models, WithoutAFloorAFamilyIsLeftAsItWas) {
  for (const models::Family& family : models::families()) {
    const std::string name(family.name);
    if (name == "room" || name == "karkanis") continue;  // without a floor to leave out, and with a turned one
    const models::PlainScene before = family.make({.n = 7});
    const models::PlainScene after = models::make_plain(name + ":n=7,floor=0");
    EXPECT_EQ(after.vertices, before.vertices) << name;
    EXPECT_EQ(rings_of(after), rings_of(before)) << name;
  }
}

// --- Karkanis' triangles ---

TEST(KarkanisModel, EveryTriangleIsASourceThatFacesTheReceiver) {
  const Scene scene = make_scene("karkanis:n=60");
  const std::vector<FaceId> occluders = scene.faces_of(scene.select("occ"));
  ASSERT_EQ(occluders.size(), 60U);
  for (std::size_t k = 0; k < occluders.size(); ++k) {
    EXPECT_EQ(scene.select("occ:" + std::to_string(k + 1)).face, occluders[k]);
    const Vec3 normal = scene.face(occluders[k]).newell;
    EXPECT_TRUE(normal.x == 0.0 && normal.y == 0.0 && normal.z < 0.0) << k;
  }
}

// --- the teapot ---

// Edges of a patch by the positions of their ends, with the number of times they occur in each direction.
using Position = std::tuple<double, double, double>;
using Edges = std::map<std::pair<Position, Position>, std::pair<int, int>>;

Position position(const Vec3& p) { return {p.x, p.y, p.z}; }

Edges edges_of(const Scene& scene, const std::string& patch) {
  Edges edges;
  for (const FaceId id : scene.faces_of(scene.select(patch))) {
    const auto& ring = scene.face(id).rings[0];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Position a = position(scene.vertices()[ring[i]]);
      const Position b = position(scene.vertices()[ring[(i + 1) % ring.size()]]);
      a < b ? ++edges[{a, b}].first : ++edges[{b, a}].second;
    }
  }
  return edges;
}

std::vector<Vec3> corners_of(const Scene& scene, const std::string& patch) {
  std::vector<Vec3> corners;
  for (const FaceId id : scene.faces_of(scene.select(patch))) {
    for (const std::uint32_t v : scene.face(id).rings[0]) corners.push_back(scene.vertices()[v]);
  }
  return corners;
}

// The corners of each triangle in order, starting with a fixed one, so that images can be compared.
std::set<std::set<Position>> triangles_of(const Scene& scene, const std::string& patch, double x_sign, double y_sign) {
  std::set<std::set<Position>> triangles;
  for (const FaceId id : scene.faces_of(scene.select(patch))) {
    std::set<Position> corners;
    for (const std::uint32_t v : scene.face(id).rings[0]) {
      const Vec3& p = scene.vertices()[v];
      corners.insert({x_sign * p.x, y_sign * p.y, p.z});
    }
    triangles.insert(corners);
  }
  return triangles;
}

constexpr const char* kParts[] = {"body", "lid", "handle", "spout"};

TEST(TeapotModel, HasItsTrianglesAndNoneWithoutArea) {
  for (const int s : {2, 3, 7, 8}) {
    const Scene scene = make_scene("teapot:segments=" + std::to_string(s));
    EXPECT_EQ(scene.faces().size(), static_cast<std::size_t>(64 * s * s - 8 * s + 2));
    for (const Face& face : scene.faces()) EXPECT_EQ(face.shape, FaceShape::kPlanar);
  }
}

// The body is 4 wide and 3.15 high. The handle ends at x = -3. The lip of the spout is a cubic curve that stays behind
// its farthest control point, 3.525.
TEST(TeapotModel, HasTheKnownSize) {
  const Scene scene = make_scene("teapot:segments=8");
  Vec3 low{9, 9, 9}, high{-9, -9, -9};
  for (const char* part : kParts) {
    for (const Vec3& p : corners_of(scene, part)) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  EXPECT_EQ(low, (Vec3{-3.0, -2.0, 0.0}));
  EXPECT_EQ(high.y, 2.0);
  EXPECT_EQ(high.z, 3.15);
  EXPECT_NEAR(high.x, 3.434, 0.005);
}

// The centres, u = v = 1/2, of the ten patches that are not mirrored, computed from the published points by another
// program.
TEST(TeapotModel, LiesOnTheBezierPatches) {
  const std::map<std::string, Vec3> middles = {
      {"rim", {0.99621875, 0.99621875, 2.4984375}},   {"upper body", {1.3090625, 1.3090625, 1.621875}},
      {"lower body", {1.2425, 1.2425, 0.384375}},     {"bottom", {0.91190625, 0.91190625, 0.046875}},
      {"knob", {0.23103125, 0.23103125, 2.98125}},    {"lid", {0.58575, 0.58575, 2.55}},
      {"upper handle", {-2.51875, 0.225, 2.0953125}}, {"lower handle", {-2.634375, 0.225, 1.25390625}},
      {"spout", {2.5375, 0.34125, 1.621875}},         {"lip", {3.1265625, 0.15, 2.466796875}}};
  const Scene scene = make_scene("teapot:segments=2");
  for (const auto& [name, m] : middles) {
    const auto near = [&m = m](const Vec3& p) { return std::hypot(p.x - m.x, p.y - m.y, p.z - m.z) < 1e-12; };
    EXPECT_TRUE(std::ranges::any_of(scene.vertices(), near)) << name;
  }
}

TEST(TeapotModel, IsItsOwnMirrorImageToTheLastBit) {
  const Scene scene = make_scene("teapot:segments=5");
  for (const char* part : kParts) {
    EXPECT_EQ(triangles_of(scene, part, 1, -1), triangles_of(scene, part, 1, 1)) << part;
  }
  for (const char* part : {"body", "lid"}) {
    EXPECT_EQ(triangles_of(scene, part, -1, 1), triangles_of(scene, part, 1, 1)) << part;
  }
}

TEST(TeapotModel, ItsFormFactorsAreSymmetric) {
  const Scene scene = make_scene("teapot:segments=4");
  const ExactSource light(scene, scene.select("light"));
  const auto at = [&](double x, double y) {
    const Receiver receiver{.point = {x, y, 0.0}, .normal = {0, 0, 1}, .on = {}, .id = {}};
    return exact_form_factor(scene, receiver, light, {.visible_fraction = true});
  };
  for (const Vec3 p : {Vec3{2.5, 1.0, 0}, Vec3{-2.75, 0.5, 0}, Vec3{3.0, 0.25, 0}}) {
    const FormFactor here = at(p.x, p.y), there = at(p.x, -p.y);
    EXPECT_EQ(here.value, there.value);
    EXPECT_GT(here.value, 0.0);
    EXPECT_LT(here.visible_fraction.value(), 1.0);
  }
}

// If two vertices of a seam differed in the last bit, the seam would have a gap.
TEST(TeapotModel, PatchesJoinInTheSameDoubles) {
  constexpr int s = 5;
  const Scene scene = make_scene("teapot:segments=" + std::to_string(s));
  for (const char* part : kParts) {
    std::size_t open = 0;
    for (const auto& [edge, uses] : edges_of(scene, part)) open += uses.first + uses.second == 1 ? 1 : 0;
    EXPECT_EQ(open, 4U * s) << part;  // the rim, the brim, the two ends of handle and of spout
  }
  const auto vertices = scene.vertices();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 &a = vertices[i], &b = vertices[j];
      ASSERT_GT(std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z), 1e-6) << i << ' ' << j;
    }
  }
}

double signed_volume(const std::vector<Vec3>& corners, const Vec3& origin) {
  double six_times = 0.0;
  const auto from = [&](const Vec3& p) { return Vec3{p.x - origin.x, p.y - origin.y, p.z - origin.z}; };
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const Vec3 a = from(corners[i]), b = from(corners[i + 1]), c = from(corners[i + 2]);
    six_times += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  }
  return six_times / 6;
}

// If each edge occurs once in each direction, the fronts agree. The sign of the volume then says which side they face.
TEST(TeapotModel, FrontsLookOutward) {
  const Scene scene = make_scene("teapot:segments=4");
  for (const char* part : kParts) {
    for (const auto& [edge, uses] : edges_of(scene, part)) {
      EXPECT_TRUE(uses.first <= 1 && uses.second <= 1) << part;
    }
    const std::vector<Vec3> corners = corners_of(scene, part);
    Vec3 middle;
    for (const Vec3& p : corners) middle = {middle.x + p.x, middle.y + p.y, middle.z + p.z};
    const double n = static_cast<double>(corners.size());
    EXPECT_GT(signed_volume(corners, {middle.x / n, middle.y / n, middle.z / n}), 0.1) << part;
  }
}

// --- the forest ---

TEST(ForestModel, LeavesHaveTheAreaAskedForAndHangBetweenGroundAndSky) {
  const Scene scene = make_scene("forest:n=2000,cover=1.5");
  const std::vector<FaceId> leaves = scene.faces_of(scene.select("leaves"));
  ASSERT_EQ(leaves.size(), 2000U);
  double area = 0.0;
  for (const FaceId leaf : leaves) area += scene.face(leaf).area;
  EXPECT_NEAR(area, 1.5 * scene.face(scene.faces_of(scene.select("ground"))[0]).area, 1e-6);
  for (const Vec3& p : corners_of(scene, "leaves")) EXPECT_TRUE(p.z > 0.0 && p.z < 16.0) << p.z;
}

TEST(ForestModel, FewLeavesDoNotGrowWithoutEnd) {
  const Scene scene = make_scene("forest:n=3");
  for (const Vec3& p : corners_of(scene, "leaves")) EXPECT_TRUE(p.z > 0.0 && p.z < 16.0) << p.z;
}

// The test of bits pins the scene with the sky alone; the sun adds to it.
TEST(ForestModel, WithASunTheForestIsTheSame) {
  const Scene sky = make_scene("forest:n=80,trees=3"), sun = make_scene("forest:n=80,trees=3,light=sun");
  for (const char* patch : {"ground", "trunks", "leaves"}) EXPECT_EQ(corners_of(sun, patch), corners_of(sky, patch));
  EXPECT_EQ(sky.patches().size(), 4U);
  EXPECT_EQ(sun.emitters().size(), 2U);
}

Receiver on_the_ground(double x, double y) {
  return {.point = {x, y, 0.0}, .normal = {0.0, 0.0, 1.0}, .on = {}, .id = {}};
}

// Half a degree wide; the ground receives what the model says, and a level receiver F = sin^2 a cos(th) of a cone of
// half angle a. The polygon has 3 / pi of the area of its circle.
TEST(ForestModel, TheSunIsHalfADegreeWide) {
  const Scene scene = make_scene("forest:n=1,trees=1,light=sun");
  const Selection sun = scene.select("sun");
  EXPECT_EQ(scene.face(scene.faces_of(sun)[0]).shape, FaceShape::kPlanar);
  const FormFactor f = exact_form_factor(scene, on_the_ground(19.0, -19.0), ExactSource(scene, sun));
  const double sine = std::sin(0.00465);
  EXPECT_NEAR(f.value, sine * sine * (2.0 / 3.0) * 3.0 / 3.14159265, 0.07 * f.value);
  EXPECT_NEAR(scene.source_radiosity(sun).r * f.value, 3.0, 0.2);
  double widest = 0.0;
  for (const Vec3& a : corners_of(scene, "sun")) {
    for (const Vec3& b : corners_of(scene, "sun")) {
      const double cosine = (a.x * b.x + a.y * b.y + a.z * b.z) / std::hypot(a.x, a.y, a.z) / std::hypot(b.x, b.y, b.z);
      widest = std::max(widest, std::acos(std::min(cosine, 1.0)));
    }
  }
  EXPECT_NEAR(widest, 0.0093, 1e-4);
}

TEST(ForestModel, NothingIsOpenUnderTheSun) {
  const Scene scene = make_scene("forest:n=60,trees=2,light=sun");
  EXPECT_TRUE(scene.warnings().empty());
  for (const Vec3 normal : {Vec3{0, 0, 1}, Vec3{1, 0.25, 0.5}, Vec3{-0.5, 1, -0.25}}) {
    WholeView seen;
    Workspace workspace;
    view(scene, {.point = {0.5, 0.25, 1.0}, .normal = normal, .on = {}, .id = {}}, {}, seen, workspace);
    EXPECT_EQ(seen.open.value, 0.0);
    EXPECT_GT(seen.patches.size(), 2U);
  }
}

// --- the closed room ---

TEST(ClosedRoomModel, HasNoOpenEdge) {
  for (const char* text : {"closed-room", "closed-room:lamp=hanging", "closed-room:boxes=0", "closed-room:boxes=25"}) {
    EXPECT_EQ(make_scene(text).open_edge_count(), 0U) << text;
  }
}

TEST(ClosedRoomModel, FormFactorsOfAllPatchesMakeUpOne) {
  const Vec3 points[] = {{3.0, 0.0, 1.375}, {0.125, 1.5, 2.0}, {3.0, 2.5625, 0.5}};
  const Vec3 normals[] = {{0, 1, 0}, {1, 0.5, -0.25}, {0, -1, 0.125}};
  for (const char* text : {"closed-room", "closed-room:lamp=hanging,boxes=9,seed=4"}) {
    const Scene scene = make_scene(text);
    for (std::size_t i = 0; i < 3; ++i) {
      Enclosure sum;
      for (const Patch& patch : scene.patches()) {
        const ExactSource source(scene, scene.select(patch.name));
        const Receiver receiver{.point = points[i], .normal = normals[i], .on = {}, .id = {}};
        sum += exact_form_factor(scene, receiver, source).enclosure;
      }
      EXPECT_TRUE(sum.contains(1.0)) << text << ' ' << i << ": " << sum.midpoint();
    }
  }
}

// --- many small lamps ---

TEST(EmittersModel, EachLampIsASourceOfItsOwn) {
  const Scene scene = make_scene("emitters:n=30");
  const std::vector<Selection> emitters = scene.emitters();
  ASSERT_EQ(emitters.size(), 30U);
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    EXPECT_EQ(scene.name_of(emitters[i]), "lamp" + std::to_string(i + 1));
    EXPECT_LT(scene.face(scene.faces_of(emitters[i])[0]).newell.y, 0.0);
  }
}

TEST(EmittersModel, TogetherShineTheSameWhateverTheirNumberAndSize) {
  for (const char* text : {"emitters", "emitters:n=7", "emitters:n=100,size=0.001"}) {
    const Scene scene = make_scene(text);
    double power = 0.0;
    for (const Selection& lamp : scene.emitters()) {
      power += scene.source_radiosity(lamp).g * scene.face(scene.faces_of(lamp)[0]).area;
    }
    EXPECT_NEAR(power, 100.0, 1e-9) << text;
  }
}

// The pixels of a 100 x 100 hemicube are a fiftieth of the distance wide, straight above.
TEST(EmittersModel, LampsAreSmallerThanAPixelOfAHemicubeOnTheFloor) {
  const Scene scene = make_scene("emitters");
  for (const Selection& lamp : scene.emitters()) {
    const Face& face = scene.face(scene.faces_of(lamp)[0]);
    const double height = scene.vertices()[face.rings[0][0]].y;
    EXPECT_LT(std::sqrt(face.area), height / 50);
    EXPECT_GT(height, 2.5);
  }
}

// --- the program ---

TEST(ModelsInTheProgram, InfoListsThem) {
  const ProgramRun run = run_program(EXACTFF_PROGRAM, {"info", "@"});
  EXPECT_EQ(run.exit_code, 0);
  for (const Model* model : models::all_models()) EXPECT_TRUE(holds(run.output, models::description(*model)));
  const ProgramRun json = run_program(EXACTFF_PROGRAM, {"info", "@", "--json"});
  EXPECT_EQ(json.exit_code, 0);
  EXPECT_TRUE(holds(json.output, "\"name\": \"teapot\""));
}

// The leaves have more area than the ground, but a grid on each leaf is not useful.
TEST(ModelsInTheProgram, InfoSuggestsThePatchOfTheLargestFaces) {
  const ProgramRun run = run_program(EXACTFF_PROGRAM, {"info", "@forest:n=3000"});
  EXPECT_TRUE(holds(run.output, "next: exactff compare @forest:n=3000 --on ground --source sky ")) << run.output;
}

TEST(ModelsInTheProgram, ACommandTakesOneForAScene) {
  const std::vector<std::string> receiver = {"--at", "2.5", "1", "0", "--normal", "0", "0", "1", "--on", "floor"};
  const auto point = [&](const std::string& scene) {
    std::vector<std::string> arguments = {"point", scene, "--source", "light", "--plain"};
    arguments.insert(arguments.end(), receiver.begin(), receiver.end());
    return run_program(EXACTFF_PROGRAM, arguments);
  };
  const TemporaryDirectory directory;
  const ProgramRun made = point("@teapot:segments=2");
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_EQ(made.output, point(directory.write("teapot.obj", models::make_obj("teapot:segments=2")).string()).output);
  EXPECT_EQ(point("@teapt").exit_code, 2);
}

TEST(ModelsInTheProgram, AFileThatBeginsLikeOneIsReachedByItsFolder) {
  const TemporaryDirectory directory;
  (void)directory.write("@teapot", models::make_obj("tiles:n=2"));
  const auto info = [&](const std::string& scene) {
    const std::string command = "cd '" + directory.path().string() + "' && '" EXACTFF_PROGRAM "' info " + scene;
    return run_program("/bin/sh", {"-c", command}).output;
  };
  EXPECT_TRUE(holds(info("./@teapot"), "\nocc "));
  EXPECT_TRUE(holds(info("@teapot"), "\nspout "));
}

TEST(ModelsInTheProgram, TruthFilesNameThemInFull) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "truth.csv").string();
  const ProgramRun run = run_program(EXACTFF_PROGRAM, {"truth", "@tiles:n=2,drop=3", "--on", "floor", "--grid", "2x2",
                                                       "--source", "source", "-o", file});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(holds(text_of(file), "@tiles:n=2,drop=3")) << text_of(file).substr(0, 400);
}

}  // namespace
}  // namespace exactff::validation
