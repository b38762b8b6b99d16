// Files that are damaged, contradictory or far too large give either one helpful message of limited length, or the
// right scene.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <sstream>

#include "exactff/receiver.h"
#include "exactff/scene_files.h"
#include "support/program.h"
#include "text/names.h"

namespace exactff {
namespace {

using validation::TemporaryDirectory;

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene read_text(const std::string& text, const SceneOptions& options = {}) {
  std::istringstream in(text);
  return read_obj(in, "s.obj", options);
}

// The message about a text, or "no error".
template <class Read>
std::string message_of(const Read& read_it) {
  try {
    (void)read_it();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

TEST(HostileFiles, WhatIsNoTextIsRefused) {
  const auto message = [](const std::string& text) { return message_of([&] { return read_text(text); }); };
  EXPECT_EQ(message(kCorners + std::string("g a\0b\n", 6)),
            "s.obj: is not a text file (it contains zero bytes); give a Wavefront OBJ file");
  EXPECT_EQ(message(std::string("\xFF\xFEv\0 \0", 6)), "s.obj: is UTF-16 text (only UTF-8 is read); save it as UTF-8");
  EXPECT_EQ(message(std::string("\xFE\xFF\0v\0 ", 6)), "s.obj: is UTF-16 text (only UTF-8 is read); save it as UTF-8");
  EXPECT_EQ(message("\x80\x91\xFF garbage \x01\n"),
            "s.obj: has no faces (there is nothing to compute with); is it a Wavefront OBJ file?");
}

TEST(HostileFiles, WhatCannotBeReadIsRefused) {
  EXPECT_NE(message_of([] { return read_obj("/dev/zero"); }).find("it contains zero bytes"), std::string::npos);
  EXPECT_NE(message_of([] { return read_obj("/dev/null"); }).find("is empty"), std::string::npos);
  // It can be opened, but reading its first byte fails.
  EXPECT_NE(message_of([] { return read_obj("/proc/self/mem"); }).find("cannot be read to its end ("),
            std::string::npos);
}

TEST(HostileFiles, ACutOffLastLineIsWarnedAbout) {
  const Scene scene = read_text(kCorners + "f 1 2 3 4\nf 1 2 3");  // it may have been a quadrilateral
  ASSERT_EQ(scene.warnings().size(), 1U);
  EXPECT_EQ(scene.warnings()[0].message(),
            "s.obj:6: the last line does not end with a newline (the file may have been cut off there); add a newline "
            "if the file is complete");
  EXPECT_TRUE(read_text(kCorners + "f 1 2 3\n").warnings().empty());
  EXPECT_TRUE(read_text(kCorners + "f 1 2 3\r").warnings().empty());
}

TEST(HostileFiles, ControlCharactersDoNotReachTheTerminal) {
  const Problem problem{"a\nb\x1b[31m.obj", 3, "face '\x07' is bad", "", ""};
  EXPECT_EQ(problem.message(), "a\\x0ab\\x1b[31m.obj:3: face '\\x07' is bad");
}

TEST(HostileFiles, ThousandsOfProblemsGiveTwentyLinesAndACount) {
  const std::string text = kCorners + repeated("f 1 3 2 4\n", 5000);
  try {
    (void)read_text(text);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 1001U);
    EXPECT_EQ(error.problems().back().what, "4000 more problems");
    const std::string shown = error.what();
    EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 20);
    EXPECT_TRUE(shown.ends_with("\n... and more than 981 more problems"));
  }
}

TEST(HostileFiles, ThousandsOfWarningsAreKeptToALimit) {
  const Scene scene = read_text("v 0 0 0\nv 1 0 0\nv 1 1 .1\nv 0 1 0\n" + repeated("f 1 2 3 4\n", 3000));
  ASSERT_EQ(scene.warnings().size(), 1001U);
  EXPECT_EQ(scene.warnings().back().what, "2000 more warnings");
}

TEST(HostileFiles, ALongNameIsLegalButNotForManyFaces) {
  const std::string name(1'000'000, 'x');
  const Scene scene = read_text(kCorners + "g " + name + "\nf 1 2 3 4\n");
  EXPECT_EQ(scene.name_of(scene.select(name)), name);
  const std::string unknown = message_of([&] { return scene.select(name + "y"); });
  EXPECT_LT(unknown.size(), 1000U);
  const std::string bad = message_of([&] { return read_text(kCorners + "g " + name + "\nf 1 3 2 4\n"); });
  EXPECT_LT(bad.size(), 1000U);
  EXPECT_NE(bad.find("crosses itself"), std::string::npos);
  EXPECT_EQ(message_of([&] { return read_text(kCorners + "g " + name + "\n" + repeated("f 1 2 3\n", 1000)); }),
            "s.obj:6: the name 'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...' of 1000000 characters belongs to 1000 "
            "faces (the name of every face contains it); choose a name of at most 255 characters");
}

TEST(HostileFiles, TheClosestOfManyAlikeNamesAreFound) {
  std::vector<std::string> patches;
  for (int i = 0; i < 20'000; ++i) patches.push_back("patch_with_a_similar_name_" + std::to_string(i));
  const std::vector<std::string_view> names(patches.begin(), patches.end());
  EXPECT_EQ(text::nearest_names(names, "PATCH_with_a_similar_nam_17", 2),
            (std::vector<std::string_view>{names[17], names[1]}));
  EXPECT_EQ(text::edit_distance("kitten", "sitting", 10), 3U);
  EXPECT_EQ(text::edit_distance("kitten", "sitting", 3), 3U);
  EXPECT_GT(text::edit_distance("kitten", "sitting", 2), 2U);
}

TEST(HostileFiles, MaterialFilesThatAreNoneAreNeverWaitedFor) {
  const TemporaryDirectory directory;
  ASSERT_EQ(::mkfifo((directory.path() / "pipe.mtl").c_str(), 0600), 0);
  (void)directory.write("zero.mtl", std::string("newmtl a\0\nKe 5\n", 15));
  for (const char* library : {"pipe.mtl", "/dev/zero", ".", "zero.mtl"}) {
    const auto path =
        directory.write("s.obj", std::string("mtllib ") + library + "\n" + kCorners + "usemtl a\nf 1 2 3\n");
    const Scene scene = read_obj(path);
    ASSERT_EQ(scene.warnings().size(), 1U) << library;
    EXPECT_NE(scene.warnings()[0].what.find("cannot be read"), std::string::npos);
    EXPECT_FALSE(scene.materials()[1].emits());
  }
}

TEST(HostileFiles, AHugeGridIsRefusedBeforeItIsBegun) {
  const Scene scene = read_text(kCorners + repeated("f 1 2 3 4\n", 10));
  const Selection all = scene.select("default");
  EXPECT_EQ(
      message_of([&] {
        return grid_receivers(scene, all, {1'000'000'000, 1'000'000'000});
      }),
      "a grid of 1000000000x1000000000 cells on 10 regions (the limit is 4194304 cells in total); use fewer cells or "
      "a smaller patch");
  EXPECT_NE(message_of([&] { return grid_receivers(scene, all, {1000, 1000}); }), "no error");
  EXPECT_EQ(grid_receivers(scene, all, {3, 2}).size(), 60U);
}

class HostileReceivers : public testing::Test {
 protected:
  std::string message(const std::string& text) {
    const auto path = directory_.write("r.csv", text);
    const std::string all = message_of([&] { return read_receivers(path, scene_); });
    const std::size_t start = all.find("r.csv:");
    return start == std::string::npos ? all : all.substr(start);
  }

  const TemporaryDirectory directory_;
  const Scene scene_ = read_text(kCorners + "g floor\nf 1 2 3 4\n");
  const std::string head_ = "x,y,z,nx,ny,nz,on\n";
};

TEST_F(HostileReceivers, AnyLineEndWillDo) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const auto path =
        directory_.write("r.csv", std::string("x,y,z,nx,ny,nz") + end + "1,2,3,0,0,1" + end + "4,5,6,0,0,1");
    EXPECT_EQ(read_receivers(path, scene_).size(), 2U);
  }
}

TEST_F(HostileReceivers, NonsenseIsRefused) {
  EXPECT_EQ(message(std::string("x,y\0z", 5)),
            "r.csv: is not a text file (it contains zero bytes); give a CSV file of receivers");
  EXPECT_EQ(message(""),
            "r.csv: the file has no header (columns are identified by their names); begin the file with the line "
            "id,x,y,z,nx,ny,nz,on");
  EXPECT_EQ(message(head_ + "1,2,3,0,0,1e999,\n"),
            "r.csv:2: '1e999' is too large for a double in column nz (points and normals are made of finite doubles); "
            "give a smaller number; the largest double is about 1.8e308");
  EXPECT_EQ(message(head_ + "1,2,3,0,0,0,\n"),
            "r.csv:2: the normal is zero (it says which way the receiver faces); give a normal of any other length");
  EXPECT_LT(message(std::string(5'000'000, 'x')).size(), 3000U);
}

TEST_F(HostileReceivers, ThousandsOfProblemsStayBounded) {
  const std::string numbers = message(head_ + repeated("a,b,c,d,e,f,\n", 2000));
  EXPECT_EQ(std::count(numbers.begin(), numbers.end(), '\n'), 20);
  std::string unknown_faces = head_;
  for (int i = 0; i < 3000; ++i) unknown_faces += "1,2,3,0,0,1,flor" + std::to_string(i) + "\n";
  const std::string names = message(unknown_faces);
  EXPECT_EQ(std::count(names.begin(), names.end(), '\n'), 20);
  EXPECT_NE(names.find("there is no patch named 'flor0'"), std::string::npos);
  EXPECT_TRUE(names.ends_with("... and more than 981 more problems"));
}

}  // namespace
}  // namespace exactff
