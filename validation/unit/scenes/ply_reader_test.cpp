// PLY and OFF files: what they mean, and what is refused.
#include "support/test.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

const std::string kPlyVertices = "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n";
const std::string kPlySquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string header(const std::string& faces, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\ncomment a square\n" + kPlyVertices + faces + "end_header\n";
}
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";

Scene from_ply(const std::string& bytes, const SceneOptions& options = {}) {
  return read_scene(bytes, "s.ply", options);
}
std::string ply_error(const std::string& bytes) {
  return error_of([&] { return from_ply(bytes); });
}

template <class T>
std::string raw(T value, bool big = false) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big) std::reverse(bytes.begin(), bytes.end());
  return {bytes.data(), bytes.size()};
}

TEST(PlyReader, ReadsTextWithPolygons) {
  const Scene scene = from_ply(header(kFaces) + kPlySquare + "4 0 1 2 3\n");
  EXPECT_EQ(scene.vertices().size(), 4U);
  EXPECT_EQ(ring(scene), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(patch_names(scene), std::vector<std::string>{"default"});
  EXPECT_EQ(scene.faces()[0].line, 15U);
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(PlyReader, TriangleStripsAloneAreRefusedWithAConverter) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  EXPECT_HOLDS(ply_error(header(strips) + kPlySquare + "4 0 1 3 2\n"),
               "s.ply:8: triangle strips (tristrips) are not read");
  const Scene both = from_ply(header(kFaces + strips) + kPlySquare + "4 0 1 2 3\n4 0 1 3 2\n");
  EXPECT_EQ(both.faces().size(), 1U);
  EXPECT_HOLDS(warnings_of(both), "are not read");
}

TEST(PlyReader, BinaryInBothByteOrdersIsTheSameScene) {
  const std::string hash = from_ply(header(kFaces) + "0.1 0 0\n1 0 0\n1 1 0\n0 1e300 0\n3 0 1 2\n").hash();
  for (const bool big : {false, true}) {
    std::string bytes = header(kFaces, big ? "binary_big_endian" : "binary_little_endian");
    for (const double c : {0.1, 0., 0., 1., 0., 0., 1., 1., 0., 0., 1e300, 0.}) bytes += raw(c, big);
    bytes += raw<std::uint8_t>(3);
    for (const int i : {0, 1, 2}) bytes += raw(i, big);
    EXPECT_EQ(from_ply(bytes).hash(), hash) << big;
  }
}

TEST(PlyReader, FloatsAndWholeNumbersAreExact) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty short y\n"
      "property uchar z\n" +
      kFaces + "end_header\n";
  bytes += raw(0.1F) + raw<std::int16_t>(-3) + raw<std::uint8_t>(200);
  bytes += raw(1.0F) + raw<std::int16_t>(0) + raw<std::uint8_t>(0);
  bytes += raw(1.0F) + raw<std::int16_t>(1) + raw<std::uint8_t>(0);
  bytes += raw<std::uint8_t>(3) + raw(0) + raw(1) + raw(2);
  EXPECT_EQ(from_ply(bytes).vertices()[0], (Vec3{0.1F, -3.0, 200.0}));
}

TEST(PlyReader, OtherElementsAndPropertiesArePassedOver) {
  const std::string more =
      "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
      "element face 2\nproperty uchar red\nproperty list uchar int vertex_index\nproperty list uchar float texcoord\n";
  const Scene scene = from_ply(header(more) + kPlySquare + "0 1\n255 3 0 1 2 2 .5 .5\n0 3 0 2 3 0\n");
  EXPECT_EQ(ring(scene, 1), (std::vector<std::uint32_t>{0, 2, 3}));
  std::string bytes = header(more, "binary_little_endian");
  for (const double c : {0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.}) bytes += raw(c);
  bytes += raw(0) + raw(1);
  bytes += raw<std::uint8_t>(255) + raw<std::uint8_t>(3) + raw(0) + raw(1) + raw(2) + raw<std::uint8_t>(2) + raw(.5F) +
           raw(.5F);
  bytes += raw<std::uint8_t>(0) + raw<std::uint8_t>(3) + raw(0) + raw(2) + raw(3) + raw<std::uint8_t>(0);
  EXPECT_EQ(from_ply(bytes).hash(), scene.hash());
}

TEST(PlyReader, AnIntegerPropertyMakesPatches) {
  const auto with = [](const std::string& properties, const std::string& comments, const std::string& faces) {
    return patch_names(from_ply("ply\nformat ascii 1.0\n" + comments + kPlyVertices +
                                "element face 3\nproperty list uchar int vertex_indices\n" + properties +
                                "end_header\n" + kPlySquare + faces));
  };
  using Names = std::vector<std::string>;
  const std::string three = "3 0 1 2 7\n3 0 1 3 -1\n3 0 2 3 7\n";
  EXPECT_EQ(with("property int patch\n", "", three), (Names{"patch_7", "patch_-1"}));
  EXPECT_EQ(with("property int material_index\n", "", three), (Names{"material_7", "material_-1"}));
  EXPECT_EQ(with("property int patch\n", "comment patch 7 the floor\n", three), (Names{"the floor", "patch_-1"}));
  EXPECT_EQ(with("property int material_index\nproperty int patch\n", "", "3 0 1 2 0 4\n3 0 1 3 1 4\n3 0 1 2 2 4\n"),
            Names{"patch_4"});
  EXPECT_EQ(with("property float patch\n", "", three), Names{"default"});
  EXPECT_EQ(with("property int colour\n", "", three), Names{"default"});
}

TEST(PlyReader, LineEndsOfAllKinds) {
  const std::string text = header(kFaces) + kPlySquare + "4 0 1 2 3\n";
  for (const char* end : {"\r\n", "\r"}) {
    std::string other = "\xEF\xBB\xBF";
    for (const char c : text) other += c == '\n' ? std::string(end) : std::string(1, c);
    EXPECT_EQ(from_ply(other).hash(), from_ply(text).hash());
  }
}

struct BadPly {
  std::string bytes;
  std::string message;  // a part of it
};

TEST(PlyReader, MalformedHeadersAreNamedByLine) {
  const BadPly cases[] = {
      {"ply\nformat ascii 2.0\n", "s.ply:2: unknown format 'ascii 2.0'"},
      {"ply\nformat xml 1.0\n", "s.ply:2: unknown format 'xml 1.0'"},
      {"ply\nelement vertex 3\nend_header\n", "the header has no format"},
      {"ply\nformat ascii 1.0\n", "s.ply:2: the header has no end"},
      {"ply\nformat ascii 1.0\nelement vertex -1\nend_header\n",
       "s.ply:3: an element needs a name and a count, and '-1'"},
      {"ply\nformat ascii 1.0\nelement vertex 1e9\nend_header\n", "and '1e9' is no count"},
      {"ply\nformat ascii 1.0\nproperty int x\nend_header\n", "s.ply:3: a property before any element"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty long x\nend_header\n", "s.ply:4: unknown type 'long'"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int x\nend_header\n",
       "'x' is declared twice"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nelement vertex 1\nend_header\n", "'vertex' is declared twice"},
      {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_indices\nend_header\n",
       "the count of a list is not an integer"},
      {"ply\nformat ascii 1.0\nvertex 3\nend_header\n", "s.ply:3: unknown keyword 'vertex' in the header"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n", "the vertices have no coordinate y"},
      {header("element face 1\nproperty list uchar float vertex_indices\n") + kPlySquare + "3 0 1 2\n",
       "the faces have no list of integers vertex_indices"},
      {header("") + kPlySquare, "s.ply: has no faces"},
      {"ply\rformat ascii 1.0\relement vertex 1\nproperty int x\rend_header\r",
       "the lines of the header end differently"},
  };
  for (const BadPly& bad : cases) EXPECT_HOLDS(ply_error(bad.bytes), bad.message);
}

TEST(PlyReader, MalformedLinesAreNamedAndAllFound) {
  const std::string text = header("element face 6\nproperty list char int vertex_indices\n") +
                           "0 0 nan\n1 0\n1 1 0 5\n0 x 0\n3 0 1 4\n3 0 1 -1\n-3 0 1 2\n99 0 1 2\n2 0 1\n3 0 1 2.5\n";
  const std::string found = ply_error(text);
  const char* const messages[] = {
      "s.ply:11: 'nan' is not a finite number (a coordinate is one exact number)",
      "s.ply:12: a line has fewer values than the header declares",
      "s.ply:13: a line has more values than the header declares",
      "s.ply:14: 'x' is not a number",
      "s.ply:15: vertex 4 does not exist (the file has 4 vertices, counted from 0)",
      "s.ply:16: vertex -1 does not exist",
      "s.ply:17: a list of -3 items",
      "s.ply:18: a list of 99 items (the line does not hold them)",
      "s.ply:19: a face has 2 vertices (a polygon has at least three)",
      "s.ply:20: '2.5' is not a whole number",
  };
  for (const char* message : messages) EXPECT_HOLDS(found, message) << message << "\nin " << found;
}

TEST(PlyReader, NoMemoryIsTakenOnTheHeadersWord) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    std::string text = header(kFaces, format) + kPlySquare;
    text.replace(text.find("vertex 4"), 8, "vertex 4000000000");
    EXPECT_HOLDS(ply_error(text), "4000000000 times 'vertex' of at least ");
    text = header(kFaces, format);
    text.replace(text.find("face 1"), 6, "face 9223372036854775807");
    text.replace(text.find("vertex 4"), 8, "vertex 0");
    EXPECT_HOLDS(ply_error(text + kPlySquare), "9223372036854775807 times 'face'");
  }
  std::string bytes = header("element face 1\nproperty list uint int vertex_indices\n", "binary_little_endian");
  bytes += std::string(96, '\0') + raw(0xFFFFFFFFU);
  EXPECT_HOLDS(ply_error(bytes),
               ": byte " + std::to_string(bytes.size() - 4) + ": a list of 4294967295 items (only 0 bytes follow)");
}

TEST(PlyReader, EveryCutOffFileIsRefusedOrWarnedAbout) {
  for (const char* format : {"ascii", "binary_little_endian"}) {
    std::string whole = header(kFaces, format);
    if (format == std::string("ascii")) {
      whole += kPlySquare + "4 0 1 2 3\n";
    } else {
      for (const double c : {0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.}) whole += raw(c);
      whole += raw<std::uint8_t>(3) + raw(0) + raw(1) + raw(2);
    }
    EXPECT_EQ(warnings_of(from_ply(whole)), "");
    for (std::size_t length = 4; length < whole.size(); ++length) {
      const std::string message = ply_error(whole.substr(0, length));
      if (message != "no error") continue;
      EXPECT_NE(warnings_of(from_ply(whole.substr(0, length))), "") << length;
    }
    EXPECT_HOLDS(warnings_of(from_ply(whole + "7 7 7\n")), "declares fewer");
  }
}

TEST(PlyReader, BinaryFaultsAreNamedByByte) {
  std::string bytes = header(kFaces, "binary_little_endian");
  const std::size_t start = bytes.size();
  for (const double c : {0., 0., 0., 1., 0., std::numeric_limits<double>::infinity(), 1., 1., 0., 0., 1., 0.})
    bytes += raw(c);
  bytes += raw<std::uint8_t>(3) + raw(0) + raw(-1) + raw(4);
  const std::string found = ply_error(bytes);
  EXPECT_HOLDS(found, "s.ply: byte " + std::to_string(start + 24) + ": a coordinate is not a finite number");
  EXPECT_HOLDS(found, "s.ply: byte " + std::to_string(start + 96) + ": vertex -1 does not exist");
  EXPECT_HOLDS(found, "vertex 4 does not exist");
  EXPECT_HOLDS(ply_error(header(kFaces) + std::string("0 0 0\0", 6)), "a zero byte in a text file");
}

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
  for (const Case& bad : cases) EXPECT_HOLDS(off_error(bad.text), bad.message);
}

TEST(OffReader, WhatFollowsIsWarnedAbout) {
  const std::string text = "OFF\n4 1 0\n" + kOffSquare + "4 0 1 2 3\n";
  EXPECT_HOLDS(warnings_of(from_off(text + "3 0 1 2\n")), "s.off:8: the file goes on after its last face");
  EXPECT_HOLDS(warnings_of(from_off(text.substr(0, text.size() - 1))), "does not end with a newline");
}

}  // namespace
}  // namespace exactff
