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
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using validation::error_of;
using validation::TemporaryDirectory;

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene read_text(const std::string& text, const SceneOptions& options = {}) {
  std::istringstream in(text);
  return read_obj(in, "s.obj", options);
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

TEST(HostileFiles, WhatIsNoTextIsRefused) {
  const auto message = [](const std::string& text) { return error_of([&] { return read_text(text); }); };
  EXPECT_EQ(message(kCorners + std::string("g a\0b\n", 6)),
            "s.obj: is not a text file (it contains zero bytes); give a Wavefront OBJ file");
  EXPECT_EQ(message(std::string("\xFF\xFEv\0 \0", 6)), "s.obj: is UTF-16 text (only UTF-8 is read); save it as UTF-8");
  EXPECT_EQ(message(std::string("\xFE\xFF\0v\0 ", 6)), "s.obj: is UTF-16 text (only UTF-8 is read); save it as UTF-8");
  EXPECT_EQ(message("\x80\x91\xFF garbage \x01\n"),
            "s.obj: has no faces (there is nothing to compute with); is it a Wavefront OBJ file?");
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

TEST(HostileFiles, ALongNameIsLegalButNotForManyFaces) {
  const std::string name(1'000'000, 'x');
  const Scene scene = read_text(kCorners + "g " + name + "\nf 1 2 3 4\n");
  EXPECT_EQ(scene.name_of(scene.select(name)), name);
  const std::string unknown = error_of([&] { return scene.select(name + "y"); });
  EXPECT_LT(unknown.size(), 1000U);
  const std::string bad = error_of([&] { return read_text(kCorners + "g " + name + "\nf 1 3 2 4\n"); });
  EXPECT_LT(bad.size(), 1000U);
  EXPECT_NE(bad.find("crosses itself"), std::string::npos);
  EXPECT_EQ(error_of([&] { return read_text(kCorners + "g " + name + "\n" + repeated("f 1 2 3\n", 1000)); }),
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
      error_of([&] {
        return grid_receivers(scene, all, {1'000'000'000, 1'000'000'000});
      }),
      "a grid of 1000000000x1000000000 cells on 10 regions (the limit is 4194304 cells in total); use fewer cells or "
      "a smaller patch");
  EXPECT_NE(error_of([&] { return grid_receivers(scene, all, {1000, 1000}); }), "no error");
  EXPECT_EQ(grid_receivers(scene, all, {3, 2}).size(), 60U);
}

}  // namespace
}  // namespace exactff
