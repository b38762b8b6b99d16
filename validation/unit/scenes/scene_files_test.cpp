// Which format a file has, what the writers keep, and what they say they lose.
#include <gmpxx.h>

#include "support/test.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using Patches = std::vector<std::string>;

std::string refusal(const std::string& bytes, const std::string& name = "s") {
  return error_of([&] { return read_scene(bytes, name); });
}

TEST(SceneFiles, ForeignKindsAreRefusedByNameAndWithAConverter) {
  struct File {
    std::string bytes, name, kind;
  };
  const std::string idf = "! a comment\n  Version,23.1;\nBuildingSurface:Detailed,\n  wall,\n";
  const std::string gmsh = "$MeshFormat\n4.1 0 8\n", radiance = "# room\nvoid plastic grey\n0\n0\n5 .5 .5 .5 0 0\n";
  const File files[] = {
      {"# vtk DataFile Version 3.0\n", "s.obj", "a VTK file"},
      {"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));", "s.obj", "a STEP file"},
      {"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));", "s.obj", "an IFC file"},
      {"Kaydara FBX Binary  ", "s.obj", "an FBX file"},
      {"; FBX 7.4.0 project file", "s.obj", "an FBX file"},
      {"<?xml version=\"1.0\"?><COLLADA>", "s.obj", "a Collada file"},
      {"BLENDER-v300", "s.obj", "a Blender file"},
      {std::string("MM\x0c\0\0\0\2\0\n\0\0\0", 12), "s.obj", "a 3DS file"},
      {"  0\r\nSECTION\r\n", "s.obj", "a DXF file"},
      {std::string(72, ' ') + "S      1\n", "s.obj", "an IGES file"},
      {"PK\3\4", "s.obj", "a ZIP archive"},
      {"\x1f\x8b\x08", "s.obj", "a file compressed by gzip"},
      {"\x89HDF\r\n\x1a\n", "s.obj", "an HDF5 file"},
      {"#VRML V2.0 utf8\n", "s.obj", "a VRML file"},
      {"** made by hand\n*Part, name=a\n*NODE\n1, 0, 0, 0\n", "a", "an Abaqus or CalculiX file"},
      {"$ a comment\nSOL 101\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\n", "a", "a Nastran file"},
      {"$ a comment\nGRID           1\n", "a.txt", "a Nastran file"},
      {radiance, "a", "a Radiance scene"},
      {"grey polygon wall\n0\n0\n9 0 0 0 1 0 0 1 1 0\n", "a", "a Radiance scene"},
      {"!genbox grey a 1 1 1\n", "a.rad", "a Radiance scene"},
      {idf, "a", "an EnergyPlus input file"},
      {"{\"Building\": {\"a\": {}}}", "a", "an EnergyPlus input file (epJSON)"},
      {gmsh, "a", "a Gmsh file"},
      {"(0 \"made by hand\")\n(2 3)\n", "a.msh", "a Fluent mesh"},
      {"<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">", "a.vtu", "a VTK file"},
      {"LookAt 0 0 0 1 1 1 0 0 1\nWorldBegin\nShape \"sphere\"\n", "a", "a pbrt scene"},
      {"FoamFile\n{\n    class vectorField;\n    object points;\n}\n8\n(\n(0 0 0)\n", "points", "an OpenFOAM file"},
      {"<?xml version=\"1.0\"?><gbXML>", "a.xml", "a gbXML file"},
      {"<scene version=\"3.0.0\">", "a.xml", "a Mitsuba scene"},
      {std::string("\1\2\0\3", 4), "a.skp", "a SketchUp file"},
  };
  for (const File& file : files) {
    const std::string message = refusal(file.bytes, file.name);
    EXPECT_TRUE(message.starts_with(file.name + ": is " + file.kind + " (")) << message;
    EXPECT_HOLDS(message, "; convert it, for example with ");
  }
  const std::string obj = "# GRID of void plastic\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng FoamFile\nf 1 2 3\n";
  for (const char* name : {"s.inp", "s.msh", "s.rad", "s"}) EXPECT_EQ(read_scene(obj, name).faces().size(), 1U) << name;
  EXPECT_EQ(read_scene("lid\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "s").faces().size(), 1U) << "with a warning";
}

TEST(SceneFiles, TheContentGoesBeforeTheExtension) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* name : {"s.off", "s.obj", "s.ply", "s.stl", "s", "s.OFF"})
    EXPECT_EQ(read_scene(off, name).faces().size(), 1U) << name;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* name : {"s.obj", "s", "s.txt"}) EXPECT_EQ(read_scene(obj, name).faces().size(), 1U) << name;
  EXPECT_HOLDS(refusal(obj, "s.ply"), "the first line is not 'ply'");
  EXPECT_HOLDS(refusal(obj, "s.STL"), "unknown keyword 'v'");
}

TEST(SceneFiles, WhatIsNoSceneIsRefused) {
  EXPECT_EQ(refusal(""),
            "s: is empty (there is nothing to compute with); give an OBJ, glTF, PLY, STL, OFF or View3D file");
  EXPECT_HOLDS(refusal(std::string("\1\2\0\3", 4)), "is not a text file (it contains zero bytes)");
  const auto file = [](const char* path) { return error_of([&] { return read_scene(path); }); };
  EXPECT_HOLDS(file("/dev/zero"), "it contains zero bytes");
  EXPECT_HOLDS(file("/dev/null"), "is empty");
  EXPECT_HOLDS(file("/proc/self/mem"), "cannot be read to its end (");
  EXPECT_HOLDS(file("/tmp"), "is a folder");
  EXPECT_HOLDS(file("/nowhere.stl"), "cannot be opened");
}

// The plate hides a part of the upper square from the lower one.
TEST(SceneFiles, FilesOfOtherProgramsGiveTheSameValues) {
  const std::string folder = EXACTFF_DATA_DIR "/scenes/formats/";
  const Receiver receiver{.point = {0.3, 0.6, 0.1}, .normal = {0.1, 0.2, 1.0}, .on = {}, .id = {}};
  const auto value = [&](const Scene& scene, const std::string& first, const std::string& second) {
    double sum = 0.0;
    for (const std::string& name : {first, second}) {
      if (!name.empty()) sum += exact_form_factor(scene, receiver, ExactSource(scene, scene.select(name))).value;
    }
    return sum;
  };
  const Scene facet = read_scene(folder + "facet.vs3");
  const Scene ply = read_scene(folder + "facet_meshio.ply");
  EXPECT_EQ(value(ply, "default:3", ""), value(facet, "srf3-Z=1", ""));
  EXPECT_EQ(value(ply, "default:1", ""), value(facet, "srf1-Z=0", ""));
  EXPECT_GT(value(facet, "srf3-Z=1", ""), 0.1);
  const Scene stl = read_scene(folder + "facet_admesh.stl");
  ASSERT_EQ(stl.faces().size(), 16U);
  EXPECT_NEAR(value(stl, "default:5", "default:6"), value(facet, "srf3-Z=1", ""), 1e-16);
  const Scene text = read_scene(folder + "facet_admesh_text.stl");
  for (int k = 1; k <= 16; ++k) {
    const std::string number = ":" + std::to_string(k);
    EXPECT_EQ(value(text, text.patches()[0].name + number, ""), value(stl, "default" + number, "")) << number;
  }
}

// Writes the scene and reads it again.
Scene again(const Scene& scene, const std::string& extension, Encoding encoding = Encoding::kDefault,
            std::vector<Problem>* losses = nullptr) {
  const TemporaryDirectory directory;
  const SceneFiles written = scene_files(scene, directory.path() / ("s" + extension), encoding);
  if (losses != nullptr) *losses = written.losses;
  for (const SceneFiles::File& file : written.files) (void)directory.write(file.path.filename().string(), file.bytes);
  return read_scene(written.files.back().path);
}

std::string words_of(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += problem.what + "\n";
  return text;
}

// The corners of all faces as positions, face by face: what every format must keep.
std::vector<std::vector<Vec3>> corners(const Scene& scene) {
  std::vector<std::vector<Vec3>> all;
  for (const Face& face : scene.faces()) {
    all.emplace_back();
    for (const auto& ring : face.rings) {
      for (const std::uint32_t v : ring) all.back().push_back(scene.vertices()[v]);
    }
  }
  return all;
}

// Triangles with coordinates of all magnitudes, named patches, unused vertices, and some faces without area.
PlainScene random_triangles(std::uint64_t seed) {
  Random random(seed);
  PlainScene scene;
  const auto coordinate = [&] { return (random.unit() - 0.5) * std::ldexp(1.0, random.integer(-300, 300)); };
  for (int i = 0; i < 30; ++i) scene.vertices.push_back({coordinate(), coordinate(), coordinate()});
  for (int patch = 0; patch < 3; ++patch) {
    for (int i = 0; i < 5; ++i) {
      generate::Ring ring;
      for (int k = 0; k < 3; ++k) ring.push_back(static_cast<std::uint32_t>(random.below(30)));
      scene.patch("patch" + std::to_string(patch)).faces.push_back({{ring}});
    }
  }
  return scene;
}

TEST(RoundTrip, TextAndBinaryKeepEveryDouble) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Scene scene = generate::build(random_triangles(validation::seed_of(i)));
    EXPECT_EQ(again(scene, ".obj").hash(), scene.hash());
    EXPECT_EQ(again(scene, ".ply").hash(), scene.hash());
    EXPECT_EQ(again(scene, ".ply", Encoding::kText).hash(), scene.hash());
    EXPECT_EQ(corners(again(scene, ".off")), corners(scene));
    EXPECT_EQ(patch_names(again(scene, ".stl")), patch_names(scene));
    // STL shares vertices at one position, and has no faces without area but triangles.
    EXPECT_EQ(corners(again(again(scene, ".stl"), ".stl")), corners(again(scene, ".stl")));
    EXPECT_EQ(again(again(scene, ".vs3"), ".vs3").hash(), again(scene, ".vs3").hash());
  }
}

TEST(RoundTrip, BinaryStlRefusesWhatNoFloatHolds) {
  const Scene huge = read_scene("v 0 0 1e39\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "s.obj");
  EXPECT_THROW((void)scene_files(huge, "s.stl", Encoding::kBinary), InputError);
}

TEST(RoundTrip, MaterialsStayInWavefrontFiles) {
  SceneBuilder builder;
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) (void)builder.add_vertex(v);
  (void)builder.add_material({"(none)"});
  (void)builder.add_material({"never used", {0.1, 0.2, 0.3}, {}});
  const MaterialId lamp = builder.add_material({"lamp", {0.0, 0.0, 0.0}, {17, 12, 4}});
  builder.add_face(builder.patch("the lamp"), lamp, {{0, 1, 2}});
  builder.add_face(builder.patch("wall"), MaterialId{0}, {{0, 2, 1}});
  const Scene scene = builder.build();
  std::vector<Problem> losses;
  EXPECT_EQ(again(scene, ".obj", Encoding::kDefault, &losses).hash(), scene.hash());
  EXPECT_TRUE(losses.empty());
  EXPECT_EQ(patch_names(again(scene, ".ply", Encoding::kDefault, &losses)), patch_names(scene));
  EXPECT_EQ(words_of(losses), "Kd and Ke of 2 materials are lost\n");
  (void)again(scene, ".vs3", Encoding::kDefault, &losses);
  EXPECT_EQ(words_of(losses),
            "Ke of 1 material is lost\nKd of 1 material becomes one number within 0 and 1\n"
            "the patch 'the lamp' is called 'the_lamp'\n");
  (void)again(scene, ".off", Encoding::kDefault, &losses);
  EXPECT_EQ(words_of(losses), "Kd and Ke of 2 materials are lost\nthe patches and their names are lost\n");
}

// A square with a square hole, a square, a triangle with a float that is none, and a bow tie.
Scene odd_scene() {
  SceneBuilder builder({}, {.bad_faces = BadFaces::kSkip});
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{4, 4, 0}, Vec3{0, 4, 0}, Vec3{1, 1, 0}, Vec3{1, 2, 0},
                        Vec3{2, 2, 0}, Vec3{2, 1, 0}, Vec3{0.1, 0, 5}})
    (void)builder.add_vertex(v);
  const MaterialId none = builder.add_material({"(none)"});
  const PatchId patch = builder.patch("default");
  builder.add_face(patch, none, {{0, 1, 2, 3}, {4, 5, 6, 7}});
  builder.add_face(patch, none, {{4, 5, 6, 7}});
  builder.add_face(patch, none, {{0, 1, 8}});
  builder.add_face(patch, none, {{0, 2, 1, 3}});
  builder.add_face(patch, none, {{0, 1, 1, 0, 1}});
  return builder.build();
}

TEST(RoundTrip, WhatIsLostIsTold) {
  const Scene scene = odd_scene();
  const auto told = [&](const char* extension, Encoding encoding = Encoding::kDefault) {
    std::vector<Problem> losses;
    (void)again(scene, extension, encoding, &losses);
    return words_of(losses);
  };
  const std::string hole = "1 face with holes is cut into polygons without holes\n", out = "1 face is left out\n";
  EXPECT_EQ(told(".obj"), hole + out);
  EXPECT_EQ(told(".ply"), hole + out);
  EXPECT_EQ(told(".off"), hole + out);
  EXPECT_EQ(told(".stl"), hole + "1 face is cut into smaller polygons\n" + out + out);
  EXPECT_EQ(told(".stl", Encoding::kBinary),
            hole + "1 face is cut into smaller polygons\n" + out + out + "1 of 9 vertices is moved by rounding\n");
  EXPECT_EQ(told(".vs3"), hole + out + out);
}

TEST(RoundTrip, NamesThatAFormatCannotHoldAreChangedAndTold) {
  SceneBuilder builder;
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) (void)builder.add_vertex(v);
  const MaterialId none = builder.add_material({"(none)"});
  for (const char* name : {"a_b", "a b", "#c", "d\\", "e!f", " ", "", "g\nh", "a\tb"})
    builder.add_face(builder.patch(name), none, {{0, 1, 2}});
  const Scene scene = builder.build();
  for (const char* extension : {".obj", ".ply", ".stl", ".vs3"}) {
    std::vector<Problem> losses;
    const Scene other = again(scene, extension, Encoding::kDefault, &losses);
    EXPECT_EQ(other.patches().size(), scene.patches().size()) << extension;
    EXPECT_EQ(other.patches()[0].name, "a_b");
    EXPECT_EQ(losses.size(), 1U) << words_of(losses);
    EXPECT_EQ(warnings_of(other), "");
  }
}

TEST(RoundTrip, TransparencyIsLostAndTold) {
  const Scene scene = read_scene("v 0 0 0\nv 1 0 0\nv 0 1 0\ng a\nf 1 2 3\ng b\nf 3 2 1\n", "s.obj");
  const Selection a = scene.select("a");
  std::vector<Problem> losses;
  (void)again(scene.with_transparent(std::span(&a, 1)), ".obj", Encoding::kDefault, &losses);
  EXPECT_EQ(words_of(losses), "1 face is no longer transparent\n");
}

// --- Several files as one scene, and units of length ---

constexpr const char* kFloor = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\ng floor\n";
const std::string kRoom = std::string(kFloor) + "f 1/1 2/2 3/3 4/4\n";
const std::string kLamp =
    "v 1 1 3\nv 2 1 3\nv 2 2 3\nv 1 2 3\nv 1 1 2\nv 2 1 2.5\nv 1.5 2 2\nf 4 3 2 1\ng floor\nf 5 6 7\nf 5 6 7\n";

class SeveralFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return (folder_.path() / name).string(); }
  std::string write(const std::string& name, const std::string& text) { return folder_.write(name, text).string(); }
  static Patches patches(const Scene& scene) { return patch_names(scene); }

  const TemporaryDirectory folder_;
};

TEST_F(SeveralFiles, AreWhatOneFileOfTheirLinesIs) {
  const std::string several = write("room.obj", kRoom) + '+' + write("lamp.obj", kLamp);
  const std::string one = write("one.obj", kRoom +
                                               "v 1 1 3\nv 2 1 3\nv 2 2 3\nv 1 2 3\nv 1 1 2\nv 2 1 2.5\nv 1.5 2 2\n"
                                               "g lamp\nf 8 7 6 5\ng lamp/floor\nf 9 10 11\nf 9 10 11\n");
  const Scene joined = read_scene(several), whole = read_scene(one);
  EXPECT_EQ(patches(joined), (Patches{"room/floor", "lamp", "lamp/floor"}));
  ASSERT_EQ(joined.faces().size(), whole.faces().size());
  const Receiver receiver{.point = {1.5, 0.5, 0.25}, .normal = {0.1, 0.2, 1}, .on = {}, .id = {}};
  for (std::size_t p = 0; p < 3; ++p) {
    const auto id = static_cast<PatchId>(p);
    for (const Engine engine : {Engine::kEdges, Engine::kBoolean}) {
      EXPECT_EQ(
          exact_form_factor(joined, receiver, ExactSource(joined, {id, {}, joined.id()}), {.engine = engine}).value,
          exact_form_factor(whole, receiver, ExactSource(whole, {id, {}, whole.id()}), {.engine = engine}).value);
    }
  }
  EXPECT_EQ(joined.texture(FaceId{0}).size(), 4U);
  EXPECT_TRUE(joined.texture(FaceId{1}).empty());
  EXPECT_EQ(joined.files().size(), 2U);
  EXPECT_EQ(joined.select("lamp/floor:2").face, FaceId{3});
  EXPECT_EQ(patches(read_scene(several, {.patches = PatchMode::kPlanes})),
            (Patches{"room/floor/1", "lamp/1", "lamp/floor/1"}));
}

TEST_F(SeveralFiles, AreFoundByTheLongestNamesThatExist) {
  const std::string a = write("a+b.obj", kLamp), b = write("b.obj", kRoom);
  EXPECT_EQ(patches(read_scene(a)), (Patches{"default", "floor"}));
  EXPECT_EQ(patches(read_scene(a + '+' + b)), (Patches{"a+b", "a+b/floor", "b/floor"}));
  EXPECT_EQ(patches(read_scene(b + '+' + b)), (Patches{"b/floor", "b/floor_2"}));
  EXPECT_TRUE(error_of([&] { return read_scene(b + "+none.obj"); }).starts_with("none.obj: cannot be opened"));
  EXPECT_TRUE(error_of([&] { return read_scene("none.obj+" + b); }).starts_with("none.obj: cannot be opened"));
  EXPECT_TRUE(error_of([&] { return read_scene("no+ne.obj"); }).starts_with("no+ne.obj: cannot be opened"));
  const std::string bad = write("bad.obj", "v 0 0\nf 1 1 1\n"), worse = write("worse.obj", "f 1 2 3\n");
  const std::string message = error_of([&] { return read_scene(bad + '+' + worse); });
  EXPECT_HOLDS(message, "bad.obj:1: ");
  EXPECT_HOLDS(message, "worse.obj:1: ");
}

TEST_F(SeveralFiles, AreConvertedIntoTheUnitOfTheFirst) {
  const std::string metres = write("m.obj", "# unit m\n" + kRoom);
  const std::string feet = write("ft.obj", "# unit ft\nv 0.1 2 3\nv 5 7.25 3\nv 1e-3 9 4\nf 1 2 3\n");
  const Scene scene = read_scene(metres + '+' + feet);
  EXPECT_EQ(scene.unit(), Unit::kMetre);
  EXPECT_HOLDS(warnings_of(scene), "ft.obj: was converted from ft to m (every one of 3 vertices rounded, once)");
  const Scene alone = read_scene(feet);
  for (std::size_t v = 0; v < 3; ++v) {
    const mpq_class exact = mpq_class(alone.vertices()[v].x) * mpq_class(3048, 10000);
    const double made = scene.vertices()[4 + v].x;
    const mpq_class off = abs(mpq_class(made) - exact);
    EXPECT_TRUE(off <= abs(mpq_class(std::nextafter(made, 1e9)) - exact) &&
                off <= abs(mpq_class(std::nextafter(made, -1e9)) - exact));
  }
  const std::string none = write("none.obj", kLamp);
  EXPECT_HOLDS(error_of([&] { return read_scene(metres + '+' + none); }), "none.obj: does not say its unit of length");
  EXPECT_HOLDS(error_of([&] { return read_scene(none + '+' + metres); }), "none.obj: does not say its unit of length");
  const Scene stated = read_scene(none + '+' + metres, {.unit = Unit::kMillimetre});
  EXPECT_EQ(stated.unit(), Unit::kMillimetre);
  EXPECT_EQ(stated.vertices()[8], (Vec3{4000, 0, 0}));
  EXPECT_HOLDS(warnings_of(stated), "m.obj: was converted from m to mm (exactly)");
}

TEST_F(SeveralFiles, UnitsStayInCopiesAndFiles) {
  const Scene scene = read_scene(kRoom, "s.obj", {.unit = Unit::kInch});
  for (const Scene& copy : {scene.with_flipped(scene.select("floor")), triangulated(scene), welded(scene, 0.1).scene,
                            divided(scene, 1.0).scene, with_patches(scene, {.patches = PatchMode::kParts})})
    EXPECT_EQ(copy.unit(), Unit::kInch);
  for (const char* name : {"s.obj", "s.off", "s.ply"}) {
    const SceneFiles files = scene_files(scene, name);
    EXPECT_TRUE(files.losses.empty() || name != std::string("s.obj"));
    EXPECT_EQ(read_scene(files.files.back().bytes, name).unit(), Unit::kInch) << name;
  }
  EXPECT_EQ(scene_files(scene, "s.stl").losses.back().what, "the unit in is lost");
  EXPECT_EQ(read_scene("# unit of choice\n# unit parsec\n" + kRoom, "s.obj").unit(), Unit::kNone);
  EXPECT_HOLDS(error_of([] { return unit_named("parsec"); }), "'parsec' is no unit of length");
}

}  // namespace
}  // namespace exactff
