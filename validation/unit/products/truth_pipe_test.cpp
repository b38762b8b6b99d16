// exactff truth in pipes: standard input and output, truth files as receivers, unit normals.
#include "support/test.h"
#include "truth/columns.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

class TruthPipe : public testing::Test {
 protected:
  // Runs `exactff truth SCENE` and what follows, in a shell; standard error goes to a file.
  std::string shell(const std::string& command) const {
    const std::string program = "exactff() { '" EXACTFF_PROGRAM "' \"$@\"; }; ";
    const ProgramRun run = run_program(
        "/bin/sh", {"-c", program + "cd '" + directory_.path().string() + "'; (" + command + ") 2> stderr"});
    code_ = run.exit_code;
    error_ = text_of(directory_.path() / "stderr");
    return run.output;
  }
  bool said(const std::string& part) const { return error_.find(part) != std::string::npos; }

  static constexpr const char* kScene = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";
  const TemporaryDirectory directory_;
  const std::string truth_ = std::string("exactff truth '") + kScene + "' ";
  mutable std::string error_;
  mutable int code_ = -1;
};

// The text from this key of the head on.
std::string behind(const std::string& key, const std::string& text) { return text.substr(text.find('"' + key + '"')); }

TEST_F(TruthPipe, StandardOutputGetsTheBytesOfTheFile) {
  const std::string flags = "--on floor,ceiling --grid 20x20 --source light,left --unoccluded ";
  (void)shell(truth_ + flags + "-o file.csv");
  EXPECT_EQ(code_, 0) << error_;
  for (const char* threads : {"1", "3"}) {
    EXPECT_EQ(shell(truth_ + flags + "-o - --threads " + threads), text_of(directory_.path() / "file.csv"));
    EXPECT_EQ(code_, 0) << error_;
  }
  EXPECT_EQ(error_, "note: 'left' emits nothing (Ke 0): as a named source it counts with a radiosity of 1\n");
  EXPECT_FALSE(fs::exists(directory_.path() / "-"));
  EXPECT_FALSE(fs::exists(directory_.path() / "-.part"));
}

TEST_F(TruthPipe, WhatAPipeCannotHaveIsRefused) {
  EXPECT_EQ(shell(truth_ + "--on floor --grid 2x2 --shard 1/2 --resume -o -"), "");
  EXPECT_EQ(code_, 2);
  EXPECT_EQ(error_,
            "exactff: --shard and --resume are given with -o - (standard output has no journal to continue from, no "
            "shards to merge and nothing to replace); remove them, or name a file\n");
  EXPECT_EQ(shell(truth_ + "--on floor --grid 2x2 --force -o -"), "");
  EXPECT_TRUE(said("--force is given with -o - ")) << error_;
}

TEST_F(TruthPipe, SceneAndReceiversComeFromStandardInput) {
  (void)directory_.write("points.csv", "x,y,z,nx,ny,nz,on\n278,0,279,0,1,0,floor\n100,0,100,0,1,0,floor\n");
  const std::string by_file = shell(truth_ + "--receivers points.csv -o -");
  const std::string by_pipe = shell("cat points.csv | " + truth_ + "--receivers - -o -");
  EXPECT_EQ(code_, 0) << error_;
  EXPECT_HOLDS(by_pipe, "\"receivers\":\"standard input\"");
  EXPECT_EQ(behind("receivers_hash", by_pipe), behind("receivers_hash", by_file));
  const std::string folder = fs::path(kScene).parent_path().string();
  const std::string scene =
      shell("cd '" + folder + "'; cat cornell_box.obj | exactff truth - --on floor --grid 3x3 -o -");
  EXPECT_EQ(code_, 0) << error_;
  EXPECT_HOLDS(scene, "\"scene\":\"standard input\"");
  const std::string direct = shell(truth_ + "--on floor --grid 3x3 -o -");
  EXPECT_EQ(behind("scene_hash", scene), behind("scene_hash", direct));
  (void)shell("exactff truth - --receivers - -o -");
  EXPECT_EQ(code_, 2);
  EXPECT_TRUE(said("the scene and the receivers are both to be read from standard input")) << error_;
}

TEST_F(TruthPipe, UnitNormalsAreFurtherColumns) {
  const std::string flags = "--on left,floor --grid 2x2 --source light -o - ";
  (void)directory_.write("plain.csv", shell(truth_ + flags));
  (void)directory_.write("with.csv", shell(truth_ + flags + "--unit-normals"));
  const table::Table plain = table::read(directory_.path() / "plain.csv");
  const table::Table with = table::read(directory_.path() / "with.csv");
  EXPECT_FALSE(plain.column("ux"));
  EXPECT_EQ(plain.head(), with.head());
  ASSERT_EQ(plain.rows(), with.rows());
  for (std::size_t row = 0; row < with.rows(); ++row) {
    const auto component = [&](const char* name) { return with.numbers(with.column(name).value())[row]; };
    EXPECT_NEAR(std::hypot(component("ux"), component("uy"), component("uz")), 1.0, 1e-15);
    for (std::size_t i = 0; i < plain.columns().size(); ++i) {
      EXPECT_EQ(plain.at(row, i), with.at(row, with.column(plain.columns()[i].name).value()));
    }
  }
}

// With an error of less than half an ulp, by an independent computation in long double.
TEST(UnitNormal, IsTheNearestOfEveryNormal) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 n{random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1e-3, 1e-3)};
    const Vec3 u = truth::unit_normal(n);
    const long double x = n.x, y = n.y, z = n.z, length = std::sqrt(x * x + y * y + z * z);
    for (const auto& [exact, found] : {std::pair{x / length, u.x}, {y / length, u.y}, {z / length, u.z}}) {
      const double ulp = std::nextafter(std::abs(found), 2.0) - std::abs(found);
      ASSERT_LE(std::abs(static_cast<double>(exact - static_cast<long double>(found))), 0.501 * ulp) << i;
    }
  }
}

}  // namespace
}  // namespace exactff
