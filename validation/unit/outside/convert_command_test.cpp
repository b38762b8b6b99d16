#include <sys/resource.h>

#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

class ConvertCommand : public testing::Test {
 protected:
  static ProgramRun convert(const Words& arguments) { return run_exactff(joined({"convert"}, arguments)); }
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
  EXPECT_EQ(convert({room_, path("three.obj"), "--triangulate"}).exit_code, 0);
  const Scene triangles = read_scene(path("three.obj"));
  for (const Face& face : triangles.faces()) EXPECT_EQ(face.rings.front().size(), 3U);
  EXPECT_EQ(convert({"@tiles:n=2", path("t.stl"), "--encoding", "binary"}).exit_code, 0);
  EXPECT_TRUE(fs::file_size(path("t.stl")) % 50 == 84 % 50);
}

TEST_F(ConvertCommand, DividesFacesIntoCellsThatAreNamed) {
  const ProgramRun done = convert({"@closed-room", path("s.obj"), "--divide", "0.5"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_HOLDS(done.error, "cells; ");
  EXPECT_HOLDS(done.error, "corners are off by at most");
  const Scene cells = read_scene(path("s.obj"));
  EXPECT_EQ(cells.open_edge_count(), 0U);
  EXPECT_EQ(cells.select_all("floor").size(), 12U * 8U);
  EXPECT_EQ(cells.patch(cells.select("floor:96").patch).faces.size(), 1U);
  EXPECT_EQ(convert({"@closed-room", path("t.obj"), "--divide", "0"}).exit_code, 2);
  EXPECT_EQ(convert({"@closed-room", path("t.obj"), "--divide", "1e-9"}).exit_code, 2);
}

TEST_F(ConvertCommand, ExistingFilesAreReplacedOnlyOnRequest) {
  (void)directory_.write("s.mtl", "mine");
  const ProgramRun refused = convert({room_, path("s.obj")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_HOLDS(refused.error, "s.mtl: already exists");
  EXPECT_FALSE(fs::exists(path("s.obj")));
  EXPECT_EQ(text_of(directory_.path() / "s.mtl"), "mine");
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

// Back to the same bytes by either way.
TEST_F(ConvertCommand, TakesTablesAndGivesThemBack) {
  const std::string csv = path("t.csv");
  ASSERT_EQ(run_exactff({"truth", room_, "--on", "floor", "--grid", "3x3", "--gradient", "-o", csv}).exit_code, 0);
  for (const char* name : {"t.npz", "t.jsonl"}) {
    EXPECT_EQ(convert({csv, path(name)}).exit_code, 0);
    EXPECT_EQ(convert({path(name), path("back.csv"), "--force"}).exit_code, 0);
    EXPECT_EQ(text_of(path("back.csv")), text_of(csv));
  }
  EXPECT_EQ(convert({csv, path("t.obj")}).exit_code, 2);
  EXPECT_EQ(convert({csv, csv, "--force"}).exit_code, 2);
  EXPECT_EQ(convert({csv, path("u.npz"), "--triangulate"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(path("u.npz")));
}

}  // namespace
}  // namespace exactff
