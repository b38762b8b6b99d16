#include <gtest/gtest.h>

#include "exactff/scene_files.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using validation::error_of;
using validation::ring;
using validation::warnings_of;

const std::string kOffSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

Scene from_off(const std::string& text, const std::string& name = "s.off") { return read_scene(text, name); }
std::string off_error(const std::string& text) {
  return error_of([&] { return from_off(text); });
}

TEST(OffReader, ReadsPolygons) {
  const Scene scene = from_off("OFF\n4 2 0\n" + kOffSquare + "4 0 1 2 3\n3 0 1 2\n");
  EXPECT_EQ(ring(scene), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(scene.faces()[1].line, 8U);
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(OffReader, OddSpellingsOfTheSameFileAgree) {
  const std::string hash = from_off("OFF\n4 1 0\n" + kOffSquare + "4 0 1 2 3\n").hash();
  const std::string spellings[] = {
      "\xEF\xBB\xBF# a square\r\nOFF # keyword\r\n\r\n4 1\r\n0 0 0\r\n1 0 0 # corner\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 "
      "3\r\n",
      "OFF 4 1 4\n" + kOffSquare + "4 0 1 2 3\n",
      "OFF4 1 4\n" + kOffSquare + "4 0 1 2 3\n",
      "COFF\n4 1 0\n0 0 0 255 0 0 255\n1 0 0 0 0 0 0\n1 1 0 1 1 1 1\n0 1 0 2 2 2 2\n4 0 1 2 3 0.5 0.5 0.5\n",
      "STCNOFF\r4 1 0\r0 0 0 0 0 1\r1 0 0 0 0 1\r1 1 0 0 0 1\r0 1 0 0 0 1\r4 0 1 2 3\r",
  };
  for (const std::string& text : spellings) {
    EXPECT_EQ(from_off(text).hash(), hash) << text;
    EXPECT_EQ(from_off(text, "unnamed").hash(), hash) << text;
  }
}

TEST(OffReader, MalformedFilesAreNamedByLine) {
  struct Case {
    std::string text;
    std::string message;
  };
  const Case cases[] = {
      {"4 1 0\n" + kOffSquare, "s.off:1: the first word is not OFF, but ''"},
      {"4OFF\n1 1 1\n", "a file of kind '4OFF' (its points are not in three dimensions)"},
      {"OFF BINARY\n", "a binary OFF file"},
      {"OFF\n", "the file ends before its counts"},
      {"OFF\n0 x 0\n", "s.off:2: 'x' is not a count"},
      {"OFF\n-4 1 0\n", "s.off:2: '-4' is not a count"},
      {"OFF\n4000000000 1 0\n" + kOffSquare,
       "s.off:2: the file declares 4000000000 vertices or faces (only 24 bytes follow)"},
      {"OFF\n4 4000000000 0\n" + kOffSquare, "the file declares 4000000000 vertices or faces"},
      {"OFF\n4 1 0\n0 0 0\n1 0\n1 1 nan\n0 1 0\n3 0 1 2\n", "s.off:4: a vertex has fewer than three coordinates"},
      {"OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 nan\n0 1 0\n3 0 1 2\n", "s.off:5: 'nan' is not a finite number"},
      {"OFF\n4 1 0\n" + kOffSquare + "3 0 1 4\n",
       "s.off:7: vertex 4 does not exist (the file has 4 vertices, counted from 0)"},
      {"OFF\n4 1 0\n" + kOffSquare + "3 0 1 -1\n", "s.off:7: vertex -1 does not exist"},
      {"OFF\n4 1 0\n" + kOffSquare + "3 0 1\n", "s.off:7: '' is not an index"},
      {"OFF\n4 1 0\n" + kOffSquare + "-3 0 1 2\n", "s.off:7: '-3' is not the number of vertices of a face"},
      {"OFF\n4 1 0\n" + kOffSquare + "4294967295 0 1 2\n", "'4294967295' is not the number of vertices of a face"},
      {"OFF\n4 1 0\n" + kOffSquare + "2 0 1\n", "s.off:7: a face has 2 vertices"},
      {"OFF\n4 2 0\n" + kOffSquare + "3 0 1 2\n", "s.off:7: the file ends after 1 of 2 faces"},
      {"OFF\n4 1 0\n0 0 0\n1 1 1\n", "s.off:4: the file ends after 2 of 4 vertices"},
      {"OFF\n4 0 0\n" + kOffSquare, "s.off: has no faces"},
  };
  for (const Case& bad : cases)
    EXPECT_NE(off_error(bad.text).find(bad.message), std::string::npos) << off_error(bad.text);
}

TEST(OffReader, WhatFollowsIsWarnedAbout) {
  const std::string text = "OFF\n4 1 0\n" + kOffSquare + "4 0 1 2 3\n";
  EXPECT_NE(warnings_of(from_off(text + "3 0 1 2\n")).find("s.off:8: the file goes on after its last face"),
            std::string::npos);
  EXPECT_NE(warnings_of(from_off(text.substr(0, text.size() - 1))).find("does not end with a newline"),
            std::string::npos);
}

}  // namespace
}  // namespace exactff
