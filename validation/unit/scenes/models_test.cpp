#include "exactff/models.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "exactff/exact.h"
#include "exactff/scene_files.h"
#include "exactff/view.h"
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

TEST(Models, TheRoomIsTheSceneInData) {
  EXPECT_EQ(make_scene("room").hash(), read_obj(EXACTFF_DATA_DIR "/scenes/blinds_room.obj").hash());
}

// --- the forest ---

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
