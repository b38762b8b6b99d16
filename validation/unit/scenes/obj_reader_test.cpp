#include "support/test.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene read(const std::string& text, SceneOptions options = {}) {
  std::istringstream in(text);
  return read_obj(in, "s.obj", options);
}

std::string refusal_of(const std::string& text) {
  return error_of([&] { return read(text); });
}

using Ring = std::vector<std::uint32_t>;

TEST(ObjReader, ReadsVerticesAndFaces) {
  const Scene scene = read("# a square\n" + kSquare + "f 1 2 3 4\n");
  ASSERT_EQ(scene.vertices().size(), 4U);
  EXPECT_EQ(scene.vertices()[2], (Vec3{1, 1, 0}));
  EXPECT_EQ(ring(scene), (Ring{0, 1, 2, 3}));
  EXPECT_EQ(scene.faces()[0].line, 6U);
  EXPECT_EQ(scene.patches()[0].name, "default");
  EXPECT_EQ(scene.materials()[0].name, "(none)");
  EXPECT_TRUE(scene.warnings().empty());
}

TEST(ObjReader, EveryFormOfACornerIsRead) {
  for (const char* corners : {"1 2 3", "1/1 2/5 3/-1", "1//1 2//2 3//3", "1/1/1 2/2/2 3/3/3", "1/ 2// 3//", "+1 2 3"}) {
    EXPECT_EQ(ring(read(kSquare + "f " + corners)), (Ring{0, 1, 2})) << corners;
  }
}

TEST(ObjReader, NamesInLatin1AreConvertedAndToldOnce) {
  const Scene scene = read(kSquare + "g T\xFCr\nf 1 2 3\ng W\xE4nde\nf 1 2 4\ng T\xFCr\nf 1 3 4\n");
  ASSERT_EQ(scene.patches().size(), 2U);
  EXPECT_EQ(scene.patches()[0].name, "T\u00FCr");
  EXPECT_EQ(scene.patches()[1].name, "W\u00E4nde");
  EXPECT_EQ(warnings_of(scene),
            "s.obj:5: the name 'T\u00FCr' is not written in UTF-8, nor is 1 other name (it is read as Latin-1 "
            "(Windows-1252)); save the file as UTF-8 if the name looks wrong\n");
  for (const char* name : {"T\u00FCr:2", "T\xFCr:2"}) EXPECT_EQ(scene.name_of(scene.select(name)), "T\u00FCr:2");
  EXPECT_TRUE(read(kSquare + "g T\u00FCr\nf 1 2 3\n").warnings().empty());
}

TEST(ObjReader, NamesInTwoEncodingsAreRefusedWhereTheyWouldBecomeOne) {
  const std::string refusal =
      "s.obj: the name 'T\u00FCr' is written in UTF-8 and in Latin-1 (they might be meant as two names); save the file "
      "as "
      "UTF-8";
  EXPECT_EQ(refusal_of(kSquare + "g T\xFCr\nf 1 2 3\ng T\u00FCr\nf 1 2 4\n"), refusal);
  EXPECT_EQ(refusal_of(kSquare + "usemtl T\u00FCr\nf 1 2 3\nusemtl T\xFCr\nf 1 2 4\n"), refusal);
  EXPECT_EQ(refusal_of(kSquare + "usemtl T\xFCr\ng T\u00FCr\nf 1 2 3\n"), "no error") << "a material and a group";
}

TEST(ObjReader, MaterialsMatchWhateverTheEncodingOfEitherFile) {
  const TemporaryDirectory directory;
  for (const std::string mtl : {"l\xFC.mtl", "u.mtl"}) {
    const std::string name = mtl == "u.mtl" ? "L\u00E4mp" : "L\xE4mp";
    (void)directory.write(mtl, "newmtl " + name + "\nKe 3 2 1\n");
    for (const std::string used : {"L\u00E4mp", "L\xE4mp"}) {
      const Scene scene =
          read_obj(directory.write("s.obj", "mtllib " + mtl + "\n" + kSquare + "usemtl " + used + "\nf 1 2 3\n"));
      EXPECT_EQ(scene.emitters().size(), 1U) << mtl << ' ' << used;
      EXPECT_EQ(scene.warnings().size(), (mtl == "u.mtl" ? 0U : 1U) + (used == "L\xE4mp" ? 1U : 0U));
    }
  }
}

TEST(ObjReader, NegativeIndicesCountFromTheEndSoFar) {
  const Scene scene = read(kSquare + "f -4 -3 -2\nv 5 5 5\nf -4/1 -3/1 -1/1\n");
  EXPECT_EQ(ring(scene, 0), (Ring{0, 1, 2}));
  EXPECT_EQ(ring(scene, 1), (Ring{1, 2, 4}));
}

TEST(ObjReader, PositiveIndicesMayReferForward) { EXPECT_EQ(ring(read("f 1 2 3\n" + kSquare)), (Ring{0, 1, 2})); }

TEST(ObjReader, OddSpellingsOfTheSameFileAgree) {
  const std::string hash = read(kSquare + "f 1 2 3 4\n").hash();
  const std::string spellings[] = {
      "\xEF\xBB\xBFv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n",
      "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4",
      "v\t0\t0 0  \n  v 1 0 0#c\nv +1. 1e0 -0 # comment \\\nv .0 1 0 1.0\nf 1 2 \\\n3\\\n 4",
      "v 0 0 0 .5 .5 .5\nv 1 0 0 what follows z is not looked at\nv 1 1 0\nv 0 1 0\nfo 1 2 3 4\nvt 0 0\nvn 0 0 1\ns "
      "off\n",
  };
  for (const std::string& text : spellings) EXPECT_EQ(read(text).hash(), hash) << text;
}

TEST(ObjReader, CoordinatesAreCorrectlyRounded) {
  const Scene scene = read("v 1e-400 -1e-400 4.9406564584124654e-324\nv 0.1 1e300 1e-300\nv 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(scene.vertices()[0], (Vec3{0.0, 0.0, 0x1p-1074}));
  EXPECT_EQ(scene.vertices()[1], (Vec3{0.1, 1e300, 1e-300}));
}

TEST(ObjReader, GroupsMakePatchesInTheOrderOfTheirFirstFace) {
  const Scene scene = read(kSquare + "f 1 2 3\ng unused\ng b c\nf 1 2 4\ng a\nf 2 3 4\ng b\nf 1 3 4\ng\nf 1 2 3 4\n");
  ASSERT_EQ(scene.patches().size(), 3U);
  EXPECT_EQ(scene.patches()[0].name, "default");
  EXPECT_EQ(scene.patches()[0].faces, (std::vector<FaceId>{FaceId{0}, FaceId{4}}));
  EXPECT_EQ(scene.patches()[1].name, "b");
  EXPECT_EQ(scene.patches()[1].faces, (std::vector<FaceId>{FaceId{1}, FaceId{3}}));
  EXPECT_EQ(scene.faces()[3].number, 2U);
  EXPECT_EQ(warnings_of(scene),
            "s.obj:7: g 'b c' names several groups (a face belongs to one patch); the first name is used\n");
}

TEST(ObjReader, ObjectsMakePatchesWhereThereAreNoGroups) {
  const Scene objects = read(kSquare + "o big box\nf 1 2 3\no\nf 1 2 4\n");
  EXPECT_EQ(objects.patches()[0].name, "big box");
  EXPECT_EQ(objects.patches()[1].name, "default");
  const Scene groups = read(kSquare + "o box\nf 1 2 3\ng side\nf 1 2 4\n");
  EXPECT_EQ(groups.patches()[0].name, "default");
  EXPECT_EQ(groups.patches()[1].name, "side");
}

struct Malformed {
  std::string text;
  std::string message;
};

TEST(ObjReader, MalformedFilesAreNamedByLine) {
  const Malformed table[] = {
      {"", "s.obj: is empty (there is nothing to compute with); give a Wavefront OBJ file"},
      {"\n\n", "s.obj: has no faces (there is nothing to compute with); is it a Wavefront OBJ file?"},
      {kSquare, "s.obj: has no faces (there is nothing to compute with); is it a Wavefront OBJ file?"},
      {"v 1 2\n", "s.obj:1: a vertex has fewer than three coordinates (a point needs all three); write v x y z"},
      {"\xEF\xBB\xBF# dos\r\n\rv 1 2\r\n", "s.obj:3: a vertex has fewer than three coordinates ("},
      {"v\n", "s.obj:1: a vertex has fewer than three coordinates ("},
      {"\n v 1 2 x\n", "s.obj:2: 'x' is not a number (a coordinate is one exact number); write a decimal number such"},
      {"v 1 2 3y\n", "s.obj:1: '3y' is not a number ("},
      {"v 1 nan 3\n", "s.obj:1: 'nan' is not a finite number (a coordinate is one exact number); give a finite number"},
      {"v 1 2 -Inf\n", "s.obj:1: '-Inf' is not a finite number ("},
      {"v 1e400 2 3\n",
       "s.obj:1: '1e400' is too large for a double (a coordinate is one exact number); give a smaller"},
      {"v 0x1 2 3\n", "s.obj:1: '0x1' is hexadecimal ("},
      {"v 1,5 2 3\n", "s.obj:1: '1,5' has a decimal comma (a coordinate is one exact number); write a decimal point"},
      {"v 1 \\\n2 \\\nz\n", "s.obj:1: 'z' is not a number ("},
      {kSquare + "f 1 2 3 0\n",
       "s.obj:5: vertex 0 does not exist (vertices are numbered from 1, or backwards from -1)"},
      {kSquare + "f 1 2 5\n", "s.obj:5: vertex 5 does not exist (the file has 4 vertices); correct the index"},
      {kSquare + "f 1 2 -5\n", "s.obj:5: vertex -5 does not exist (the lines before define 4 vertices)"},
      {"f -1 -2 -3\n", "s.obj:1: vertex -3 does not exist (the lines before define 0 vertices); correct the index"},
      {kSquare + "f 1 2 99999999999999999999\n", "s.obj:5: vertex 99999999999999999999 does not exist ("},
      {kSquare + "f 1 2 4294967297\n", "s.obj:5: vertex 4294967297 does not exist ("},
      {kSquare + "f 1 2 a\n",
       "s.obj:5: 'a' is not a valid corner of a face (a corner is a vertex number); write v, v/vt"},
      {kSquare + "f 1 2 3.0\n", "s.obj:5: '3.0' is not a valid corner"},
      {kSquare + "f 1 2 /3\n", "s.obj:5: '/3' is not a valid corner"},
      {kSquare + "f 1 2 3/1/1/1\n", "s.obj:5: '3/1/1/1' is not a valid corner"},
      {kSquare + "f 1 2 3/x\n", "s.obj:5: '3/x' is not a valid corner"},
      {kSquare + "f 1, 2, 3\n", "s.obj:5: '2,' is not a valid corner"},
      {kSquare + "f 1 2\n",
       "s.obj:5: a face has 2 vertices (a polygon has at least three); remove it, or skip bad faces"},
      {kSquare + "f\n", "s.obj:5: a face has 0 vertices ("},
      {kSquare + "g bow\nf 1 2 4 3\n", "s.obj:6: face 'bow:1' crosses itself: edge 2-4 and edge 3-1 (vertex numbers)"},
      {"f 1 2 9\nv 1 2 x\nf 1 0 1\n", "s.obj:3: vertex 0 does not exist ("},  // and what is before
  };
  for (const Malformed& entry : table) EXPECT_HOLDS(refusal_of(entry.text), entry.message) << entry.text;
  EXPECT_EQ(std::ranges::count(refusal_of(table[std::size(table) - 1].text), '\n'), 3);
}

TEST(ObjReader, ShortFacesAreSkippedOnRequest) {
  const Scene scene = read(kSquare + "g a\nf 1 2\nf\nf 1 2 3\n", {BadFaces::kSkip, PatchMode::kGroups});
  EXPECT_EQ(scene.faces().size(), 3U);
  EXPECT_EQ(scene.select("a:3").face, FaceId{2});
  EXPECT_EQ(warnings_of(scene), "s.obj:6: 2 faces have no area and are ignored, the first is face 'a:1'\n");
}

TEST(ObjReader, UnknownWordsAndCurvedGeometryAreMentionedOnce) {
  const Scene scene = read(kSquare + "cstype bezier\nsurf 0 1 0 1 1 2 3\nend\nF 1 2 3\nface 1 2 3\nf 1 2 3\n");
  EXPECT_EQ(warnings_of(scene),
            "s.obj:6: 'surf' is not read (curves, surfaces and references to other files are not polygons); convert "
            "them to faces\n"
            "s.obj:8: unknown keyword 'F' (and on 1 more line) (the line is ignored); is it a Wavefront OBJ file?\n");
}

Scene read_with_mtl(const std::string& mtl, const std::string& head = "mtllib m.mtl\nusemtl a\n") {
  const TemporaryDirectory directory;
  (void)directory.write("m.mtl", mtl);
  return read_obj(directory.write("s.obj", head + kSquare + "f 1 2 3\n"));
}

TEST(MtlReader, KdIsTheReflectanceAndKeTheRadiosity) {
  const Scene scene =
      read_with_mtl("# c\r\nnewmtl b\nKd 1 1 1\nnewmtl a\n Ka 9 9 9\n\tKd .25 .5 .75#x\nKe 2\nmap_Kd x.png\n");
  const Material& material = scene.material(scene.faces()[0].material);
  EXPECT_EQ(material.name, "a");
  EXPECT_EQ(material.reflectance, (Rgb{0.25, 0.5, 0.75}));
  EXPECT_EQ(material.radiosity, (Rgb{2, 2, 2}));
  ASSERT_EQ(scene.warnings().size(), 1U);
  EXPECT_EQ(scene.warnings()[0].what, "map_Kd of material 'a' is an image");
}

TEST(MtlReader, MalformedFilesAreNamedByLine) {
  const Malformed table[] = {
      {"newmtl a\nKd 1 x 1\n", "m.mtl:2: Kd of material 'a': 'x' is not a number (colours are finite numbers); write"},
      {"newmtl a\nKe 1 2\n", "m.mtl:2: Ke of material 'a' has two values (a colour has one or three values); give one"},
      {"newmtl a\nKd\n", "m.mtl:2: Kd of material 'a' has no value ("},
      {"newmtl a\nKe 1 -2 1\n", "m.mtl:2: Ke of material 'a' is negative (a radiosity cannot be negative); correct it"},
      {"newmtl a\nKd -.1\n", "m.mtl:2: Kd of material 'a' is negative (a reflectance lies between 0 and 1)"},
      {"Kd 1\n", "m.mtl:1: Kd before any newmtl (it does not belong to a material); move it"},
      {"newmtl\n", "m.mtl:1: newmtl without a name (no face can use it); give the material a name"},
      {"newmtl a\nKe inf\n", "m.mtl:2: Ke of material 'a': 'inf' is not a finite number ("},
  };
  for (const Malformed& entry : table) {
    EXPECT_HOLDS(error_of([&] { return read_with_mtl(entry.text); }), entry.message);
  }
}

TEST(MtlReader, DoubtfulFilesAreWarnedAbout) {
  const Malformed table[] = {
      {"newmtl a\nKd 1.5\n", "m.mtl:2: Kd of material 'a' exceeds 1 (such a surface reflects more than it receives)"},
      {"newmtl a\nKd spectral x.rfl\n", "m.mtl:2: Kd of material 'a' is given as 'spectral' (exactff reads only RGB"},
      {"newmtl a\nKd xyz 1 1 1\n", "m.mtl:2: Kd of material 'a' is given as 'xyz' ("},
      {"newmtl a\nKd .5\nnewmtl a\nKd .25\n", "m.mtl:3: material 'a' is defined again (the first definition is used)"},
      {"newmtl b\n", "s.obj:2: material 'a' is not defined (it gets Kd 1, Ke 0); define it in a file named by mtllib"},
  };
  for (const Malformed& entry : table) EXPECT_HOLDS(warnings_of(read_with_mtl(entry.text)), entry.message);
}

TEST(MtlReader, AMissingFileIsAWarningAndGivesDefaults) {
  const Scene scene = read("mtllib none.mtl\n" + kSquare + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\n");
  EXPECT_EQ(warnings_of(scene),
            "s.obj:1: material file 'none.mtl' cannot be read (its materials get Kd 1, Ke 0); add the file if colours "
            "or emission matter\n");
  EXPECT_EQ(scene.material(scene.faces()[1].material).name, "b");
}

TEST(MtlReader, SeveralLibrariesAndBackslashesAreFound) {
  EXPECT_TRUE(read_with_mtl("newmtl a\n", "mtllib .\\m.mtl m.mtl\nusemtl a\n").warnings().empty());
}

}  // namespace
}  // namespace exactff
