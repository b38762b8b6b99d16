#include "support/test.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using Ring = std::vector<std::uint32_t>;

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
}
const std::string kLower = facet("0 0 0", "1 0 0", "1 1 0");
const std::string kUpper = facet("0 0 0", "1 1 0", "0 1 0");

Scene from_stl(const std::string& bytes, const SceneOptions& options = {}) {
  return read_scene(bytes, "s.stl", options);
}
std::string stl_error(const std::string& bytes) {
  return error_of([&] { return from_stl(bytes); });
}

std::string little(std::uint32_t value) {
  const auto raw = std::bit_cast<std::array<char, 4>>(value);
  return {raw.data(), raw.size()};
}

// Corners of triangles, nine numbers each.
std::string binary(const std::vector<std::array<float, 9>>& triangles, const std::string& title = "a title") {
  std::string bytes =
      title + std::string(80 - title.size(), '\0') + little(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& corners : triangles) {
    bytes += std::string(12, '\0');
    for (const float c : corners) bytes += little(std::bit_cast<std::uint32_t>(c));
    bytes += std::string("\1\2", 2);
  }
  return bytes;
}
const std::array<float, 9> kTriangle = {0, 0, 0, 1, 0, 0, 1, 1, 0};
const std::array<float, 9> kOther = {0, 0, 0, 1, 1, 0, 0, 1, 0};

TEST(StlReader, VerticesAreOneIfTheirDoublesAreEqual) {
  const Scene scene =
      from_stl("solid\n" + kLower + kUpper + facet("-0 0 -0.0", "1e0 0 0", "1 1.0000000000000002 0") + "endsolid\n");
  EXPECT_EQ(scene.vertices().size(), 5U);
  EXPECT_EQ(ring(scene, 1), (Ring{0, 2, 3}));
  EXPECT_EQ(ring(scene, 2), (Ring{0, 1, 4}));
  EXPECT_EQ(scene.open_edge_count(), 5U);  // two edges of the square are shared by all, and one by two
}

TEST(StlReader, SolidsArePatchesByName) {
  using Names = std::vector<std::string>;
  const auto names = [](const std::string& text) { return patch_names(from_stl(text)); };
  EXPECT_EQ(names("solid\n" + kLower + "endsolid\n"), Names{"default"});
  EXPECT_EQ(names("solid the floor # 1\n" + kLower + "endsolid the floor # 1\nsolid wall\n" + kUpper + "endsolid\n"),
            (Names{"the floor # 1", "wall"}));
  EXPECT_EQ(names("solid a\n" + kLower + "endsolid\nsolid b\nendsolid\nsolid a\n" + kUpper + "endsolid\n"), Names{"a"});
  EXPECT_EQ(names("solid\n" + kLower + "endsolid\nsolid\n" + kUpper + "endsolid\n"), (Names{"default", "solid_2"}));
}

TEST(StlReader, OddSpellingsOfTheSameFileAgree) {
  const std::string hash = from_stl("solid\n" + kLower + "endsolid\n").hash();
  const std::string spellings[] = {
      "\xEF\xBB\xBFSOLID\r\n  FACET NORMAL nan nan nan\r\n OUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\nVertex 1 1 "
      "0\r\n"
      "ENDLOOP\r\nENDFACET\r\nENDSOLID\r\n",
      "solid\rfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 endloop endfacet\rendsolid\r",
      "\n\n solid\n" + kLower + "\n\nendsolid whatever\n",
  };
  for (const std::string& text : spellings) EXPECT_EQ(from_stl(text).hash(), hash) << text;
}

TEST(StlReader, BinaryIsRecognisedByItsLengthEvenIfItBeginsWithSolid) {
  for (const char* title : {"a title", "solid", "solid facet normal", "ISO-10303-21;"}) {
    const Scene scene = read_scene(binary({kTriangle, kOther}, title), "s.dat");
    EXPECT_EQ(scene.faces().size(), 2U);
    EXPECT_EQ(scene.vertices().size(), 4U);
    EXPECT_EQ(patch_names(scene), std::vector<std::string>{"default"});
    EXPECT_EQ(warnings_of(scene), "");
  }
  const Scene scene = from_stl(binary({{0.1F, 0, 0, 1, 0, 0, 1, 1, 0}}));
  EXPECT_EQ(scene.vertices()[0].x, double{0.1F});
}

TEST(StlReader, BinaryFaultsAreNamedByByte) {
  const std::string whole = binary({kTriangle, kOther});
  EXPECT_EQ(
      stl_error(whole.substr(0, whole.size() - 1)),
      "s.stl: byte 80: the file declares 2 triangles (its length is enough for 1); is it a complete binary STL file?");
  EXPECT_HOLDS(stl_error(whole.substr(0, 50)), "s.stl: byte 50: the file ends within its header");
  std::string many = whole;
  many.replace(80, 4, little(0xFFFFFFFFU));
  EXPECT_HOLDS(stl_error(many), "the file declares 4294967295 triangles (its length is enough for 2)");
  EXPECT_HOLDS(stl_error("solid" + many.substr(5)), "the file declares 4294967295");
  EXPECT_HOLDS(warnings_of(from_stl(whole + "x")), "s.stl: byte 184: the file goes on after its last triangle");
  EXPECT_HOLDS(stl_error(binary({})), "the file declares 0 triangles (there is nothing");
  std::string none = whole;
  none.replace(80, 4, little(0));
  EXPECT_HOLDS(stl_error(none), "the file declares 0 triangles (its length is enough for 2 triangles");
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_HOLDS(stl_error(binary({kTriangle, {0, 0, 0, 1, 0, nan, 1, 1, 0}})),
               "s.stl: byte 134: triangle 2 has a coordinate that is not finite");
  EXPECT_HOLDS(stl_error(binary({{0, 0, 0, 1, 0, -inf, 1, 1, 0}})), "triangle 1 has a coordinate");
}

TEST(StlReader, MalformedTextIsNamedByLine) {
  struct Case {
    std::string text;
    std::string message;
  };
  const Case cases[] = {
      {"facet normal 0 0 1\nouter loop\nvertex 0 0\n", "s.stl:4: a vertex has fewer than three coordinates"},
      {"facet normal 0 0 1\nouter loop\nvertex 0 0 inf\n", "s.stl:4: 'inf' is not a finite number"},
      {"facet 0 0 1\n", "s.stl:2: '0' instead of normal"},
      {"facet normal 0 0 1\ninner loop\n", "s.stl:3: unknown keyword 'inner'"},
      {"facet normal 0 0 1\nouter ring\n", "s.stl:3: 'ring' instead of loop"},
      {"vertex 0 0 0\n", "s.stl:2: a vertex outside a facet"},
      {"endfacet\n", "s.stl:2: endfacet without a facet"},
      {"facet normal 0 0 1\nfacet normal 0 0 1\n", "s.stl:3: a facet within a facet"},
      {"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n",
       "s.stl:7: a facet has 2 vertices"},
      {"facet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "the file ends within a facet"},
      {"endsolid\n", "s.stl: has no faces"},
  };
  for (const Case& bad : cases) {
    const std::string message = stl_error("solid a\n" + bad.text);
    EXPECT_HOLDS(message, bad.message) << bad.text << message;
  }
}

TEST(StlReader, EveryCutOffTextIsRefusedOrWarnedAbout) {
  const std::string whole = "solid a\n" + kLower + kUpper + "endsolid a\n";
  EXPECT_EQ(warnings_of(from_stl(whole)), "");
  for (std::size_t length = 6; length < whole.size() - 12; ++length) {
    const std::string part = whole.substr(0, length);
    const bool complete = part.ends_with("endfacet\n");
    if (complete || stl_error(part) != "no error") continue;
    EXPECT_NE(warnings_of(from_stl(part)), "") << part;
  }
}

}  // namespace
}  // namespace exactff
