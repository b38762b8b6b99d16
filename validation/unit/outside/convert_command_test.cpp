#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>

#include "exactff/exact.h"
#include "exactff/scene_files.h"
#include "support/program.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::RunningProgram;
using validation::TemporaryDirectory;

class ConvertCommand : public testing::Test {
 protected:
  static validation::ProgramRun convert(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "convert");
    return validation::run_exactff(arguments);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (directory_.path() / name).string(); }

  const TemporaryDirectory directory_;
  const std::string room_ = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";
};

TEST_F(ConvertCommand, WritesEveryFormat) {
  const std::size_t faces = read_scene(room_).faces().size();
  for (const char* name : {"s.obj", "s.ply", "s.off", "s.vs3"}) {
    EXPECT_EQ(convert({room_, path(name)}).exit_code, 0);
    EXPECT_EQ(read_scene(path(name)).faces().size(), faces) << name;
  }
  EXPECT_EQ(read_scene(path("s.obj")).hash(), read_scene(room_).hash());
  EXPECT_EQ(convert({"@tiles:n=2", path("t.stl"), "--encoding", "binary"}).exit_code, 0);
  EXPECT_TRUE(fs::file_size(path("t.stl")) % 50 == 84 % 50);
}

TEST_F(ConvertCommand, TellsWhatIsLost) {
  const validation::ProgramRun off = convert({room_, path("s.off")});
  EXPECT_EQ(off.exit_code, 0);
  EXPECT_NE(off.error.find("s.off: the patches and their names are lost"), std::string::npos) << off.error;
  EXPECT_NE(off.error.find("materials are lost"), std::string::npos);
  EXPECT_EQ(convert({room_, path("s.obj")}).error, "");
}

// A bent quadrilateral, a frame with a hole that is a keyhole ring, and corners on a straight side.
TEST_F(ConvertCommand, TriangulatesWithTheSameValues) {
  const std::string bent =
      directory_
          .write(
              "bent.obj",
              "v 0 0 0\nv 4 0 0\nv 4 4 1\nv 0 4 0\nv 1 1 3\nv 3 1 3\nv 3 3 3\nv 1 3 3\nv 2 1 3\nv 1.5 2 3\nv 2.5 2 3\n"
              "v 2 2.5 3\ng floor\nf 1 2 3 4\ng lamp\nf 5 8 7 6 9\ng frame\nf 5 10 11 12 10 5 8 7 6 9\n")
          .string();
  EXPECT_EQ(convert({bent, path("t.obj"), "--triangulate"}).exit_code, 0);
  const Scene before = read_scene(bent), after = read_scene(path("t.obj"));
  EXPECT_EQ(before.faces().size(), 3U);
  for (const Face& face : after.faces()) {
    EXPECT_EQ(face.rings.front().size(), 3U);
    EXPECT_EQ(face.shape, FaceShape::kPlanar);
  }
  ASSERT_EQ(after.patches().size(), before.patches().size());
  for (const Vec3& point : {Vec3{2, 2, -1}, {0.5, 3, 2}, {2, 2, 5}, {3.5, 1, 0.5}}) {
    for (const Patch& patch : before.patches()) {
      for (const double z : {1.0, -1.0}) {
        const Receiver at{point, {0.25, 0.5, z}, {}, {}};
        const auto value = [&](const Scene& scene) {
          return exact_form_factor(scene, at, ExactSource(scene, scene.select(patch.name))).value;
        };
        EXPECT_EQ(value(after), value(before)) << patch.name;
      }
    }
  }
}

TEST_F(ConvertCommand, DividesFacesIntoCellsThatAreNamed) {
  const validation::ProgramRun done = convert({"@closed-room", path("s.obj"), "--divide", "0.5"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.error.find("cells; "), std::string::npos) << done.error;
  EXPECT_NE(done.error.find("corners are off by at most"), std::string::npos) << done.error;
  const Scene cells = read_scene(path("s.obj"));
  EXPECT_EQ(cells.open_edge_count(), 0U);
  EXPECT_EQ(cells.select_all("floor").size(), 12U * 8U);
  EXPECT_EQ(cells.patch(cells.select("floor:96").patch).faces.size(), 1U);
  EXPECT_EQ(convert({"@closed-room", path("t.obj"), "--divide", "0"}).exit_code, 2);
  EXPECT_EQ(convert({"@closed-room", path("t.obj"), "--divide", "1e-9"}).exit_code, 2);
}

TEST_F(ConvertCommand, ExistingFilesAreReplacedOnlyOnRequest) {
  (void)directory_.write("s.mtl", "mine");
  const validation::ProgramRun refused = convert({room_, path("s.obj")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.error.find("s.mtl: already exists"), std::string::npos) << refused.error;
  EXPECT_FALSE(fs::exists(path("s.obj")));
  EXPECT_EQ(validation::text_of(directory_.path() / "s.mtl"), "mine");
  EXPECT_EQ(convert({room_, path("s.obj"), "--force"}).exit_code, 0);
  EXPECT_EQ(convert({room_, path("s.obj")}).exit_code, 2);
}

TEST_F(ConvertCommand, NothingIsLeftWhereNothingCanBeWritten) {
  EXPECT_EQ(convert({room_, path("nowhere/s.ply")}).exit_code, 2);
  EXPECT_EQ(convert({room_, path("s.dae")}).exit_code, 2);
  EXPECT_EQ(convert({room_, path("s.off"), "--encoding", "binary"}).exit_code, 2);
  EXPECT_EQ(convert({path("missing.obj"), path("s.ply")}).exit_code, 2);
  EXPECT_TRUE(fs::is_empty(directory_.path()));
}

// The MTL file fits on the disk, the OBJ file does not.
TEST_F(ConvertCommand, AFullDiskLeavesNeitherFile) {
  for (const bool replaces : {false, true}) {
    if (replaces) {
      (void)directory_.write("s.mtl", "mine");
      (void)directory_.write("s.obj", "mine, too");
    }
    const auto limit = [] {
      const rlimit bytes{400, 400};
      ::setrlimit(RLIMIT_FSIZE, &bytes);
    };
    const RunningProgram program(EXACTFF_PROGRAM, {"convert", room_, path("s.obj"), "--force"},
                                 directory_.path() / "error", limit);
    EXPECT_EQ(program.wait(), 2);
    EXPECT_NE(program.error().find("s.obj: cannot be written: File too large (nothing was written); "),
              std::string::npos)
        << program.error();
    for (const auto& entry : fs::directory_iterator(directory_.path())) {
      const std::string name = entry.path().filename();
      EXPECT_TRUE(name == "error" || (replaces && validation::text_of(entry.path()).starts_with("mine"))) << name;
    }
  }
  ASSERT_EQ(convert({room_, path("s.obj"), "--force"}).exit_code, 0);
  EXPECT_LT(fs::file_size(path("s.mtl")), 400U);
  EXPECT_GT(fs::file_size(path("s.obj")), 400U);
}

// Back to the same bytes by either way.
TEST_F(ConvertCommand, TakesTablesAndGivesThemBack) {
  const std::string csv = path("t.csv");
  ASSERT_EQ(
      validation::run_exactff({"truth", room_, "--on", "floor", "--grid", "3x3", "--gradient", "-o", csv}).exit_code,
      0);
  for (const char* name : {"t.npz", "t.jsonl"}) {
    EXPECT_EQ(convert({csv, path(name)}).exit_code, 0);
    EXPECT_EQ(convert({path(name), path("back.csv"), "--force"}).exit_code, 0);
    EXPECT_EQ(validation::text_of(path("back.csv")), validation::text_of(csv));
  }
  EXPECT_EQ(convert({csv, path("t.obj")}).exit_code, 2);
  EXPECT_EQ(convert({csv, csv, "--force"}).exit_code, 2);
  EXPECT_EQ(convert({csv, path("u.npz"), "--triangulate"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(path("u.npz")));
}

}  // namespace
}  // namespace exactff
