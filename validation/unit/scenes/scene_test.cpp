#include "support/test.h"

namespace exactff {
namespace {

// Patches: wall (faces 1 to 3, the second without area), "wall:1" (one face), lamp (emits, one face).
SceneBuilder rooms(SceneOptions options = {}) {
  SceneBuilder builder("rooms.obj", options);
  const MaterialId grey = builder.add_material({"grey", {0.5, 0.25, 0.125}, {}});
  const MaterialId bright = builder.add_material({"bright", {}, {4, 2, 1}});
  const MaterialId dim = builder.add_material({"dim", {}, {1, 1, 1}});
  for (const Vec3& v : {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) builder.add_vertex(v);
  builder.add_face(builder.patch("wall"), grey, {{0, 1, 2}}, 10);
  builder.add_face(builder.patch("wall"), bright, {{0, 1, 0}}, 11);
  builder.add_face(builder.patch("wall:1"), grey, {{0, 1, 3}}, 12);
  builder.add_face(builder.patch("wall"), grey, {{0, 2, 3}}, 13);
  builder.add_face(builder.patch("lamp"), bright, {{3, 2, 1}}, 14);
  builder.add_face(builder.patch("mixed"), bright, {{3, 1, 2}}, 15);
  builder.add_face(builder.patch("mixed"), dim, {{3, 1, 0}}, 16);
  return builder;
}

constexpr PatchId kWall{0}, kWallOne{1}, kLamp{2}, kMixed{3};

TEST(SceneNames, AnExactNameWins) {
  const Scene scene = rooms().build();
  EXPECT_EQ(scene.select("wall:1"), (Selection{kWallOne, {}, scene.id()}));
  EXPECT_EQ(scene.select("wall:1:1"), (Selection{kWallOne, FaceId{2}, scene.id()}));
  ASSERT_EQ(scene.warnings().size(), 2U);
  EXPECT_EQ(scene.warnings()[1].message(),
            "rooms.obj:10: face 'wall:1' cannot be named (a patch has the same name, and patch names take precedence); "
            "rename the patch");
}

TEST(SceneNames, NamesReadBack) {
  const Scene scene = rooms().build();
  for (const char* name : {"wall", "wall:3", "wall:1", "lamp:1", "mixed:2"}) {
    EXPECT_EQ(scene.name_of(scene.select(name)), name);
  }
  EXPECT_EQ(scene.name_of(FaceId{3}), "wall:3");
  EXPECT_EQ(scene.name_of(FaceId{4}), "lamp");
}

TEST(SceneNames, UnknownNamesListTheClosest) {
  const Scene scene = rooms().build();
  EXPECT_EQ(complaint([&] { (void)scene.select("Lamb"); }),
            "rooms.obj: there is no patch named 'Lamb' (names must match exactly); the patches are: 'lamp', 'wall', "
            "'wall:1', 'mixed'");
  EXPECT_EQ(complaint([&] { (void)scene.select("wall:4"); }),
            "rooms.obj: there is no face 'wall:4' (patch 'wall' has 3 faces); faces are numbered from 1");
  EXPECT_EQ(complaint([&] { (void)scene.select("lamp:0"); }),
            "rooms.obj: there is no face 'lamp:0' (patch 'lamp' has 1 face); faces are numbered from 1");
  for (const char* name : {"", ":", "lamp:", "lamp:x", "lamp:-1", "lamp:+1", "lamp:1 ", "lamp:99999999999999999999"}) {
    EXPECT_THROW((void)scene.select(name), InputError) << name;
  }
}

// One triangle for each name, or a face without area after a '-'.
Scene scene_of_names(const std::vector<std::string>& names) {
  SceneBuilder builder("names");
  const MaterialId material = builder.add_material({});
  for (const Vec3& v : {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}) builder.add_vertex(v);
  for (const std::string& name : names) {
    const bool is_flat = name.starts_with('-');
    builder.add_face(builder.patch(name.substr(is_flat ? 1 : 0)), material, {{0, 1, is_flat ? 1U : 2U}});
  }
  return builder.build();
}

std::vector<std::string> all_like(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const Selection& selection : scene.select_all(name)) names.push_back(scene.name_of(selection));
  return names;
}

TEST(SceneNames, APatternSelectsEveryPatchThatMatchesInTheOrderOfTheFile) {
  using Names = std::vector<std::string>;
  const Scene scene = scene_of_names({"person_2", "wall", "person_1", "desk/left", "-person_flat", "p\303\251"});
  EXPECT_EQ(all_like(scene, "person_*"), (Names{"person_2", "person_1"}));
  EXPECT_EQ(all_like(scene, "person_?"), (Names{"person_2", "person_1"}));
  EXPECT_EQ(all_like(scene, "[dw]*"), (Names{"wall", "desk/left"}));
  EXPECT_EQ(all_like(scene, "[!p]*[!t]"), Names{"wall"});
  EXPECT_EQ(all_like(scene, "*"), (Names{"person_2", "wall", "person_1", "desk/left", "p\303\251"}));
  EXPECT_EQ(all_like(scene, "*flat"), Names{"person_flat"}) << "without area, but no other matches";
  EXPECT_EQ(all_like(scene, "p\xe9*"), Names{"p\303\251"}) << "in Latin-1";
  EXPECT_TRUE(complaint([&] { (void)scene.select_all("persom_*"); })
                  .starts_with("names: no patch or face has a name like 'persom_*' (* stands for any text, ? for one "
                               "character, [...] for one of several); the patches are: 'person_2', 'person_1', "));
  EXPECT_THROW((void)scene.select("person_*"), InputError) << "one name is wanted";
}

TEST(SceneNames, AnExactNameWinsOverAPattern) {
  using Names = std::vector<std::string>;
  const Scene scene = scene_of_names({"a*", "ab", "a[1]", "a1", "box", "box", "c?:1", "c?:2", "cd"});
  EXPECT_EQ(all_like(scene, "a*"), Names{"a*"});
  EXPECT_EQ(all_like(scene, "a[1]"), Names{"a[1]"});
  EXPECT_EQ(all_like(scene, "a\\*"), Names{"a*"});
  EXPECT_EQ(all_like(scene, "c?"), (Names{"c?:1", "c?:2"})) << "the cells of a patch with this name";
  EXPECT_EQ(all_like(scene, "box:*"), (Names{"box:1", "box:2"})) << "faces, since no patch matches";
  EXPECT_EQ(all_like(scene, "b*"), Names{"box"});
}

TEST(SceneMaterials, SourceRadiosityIsKeOrOne) {
  const Scene scene = rooms().build();
  EXPECT_EQ(scene.source_radiosity(scene.select("lamp")), (Rgb{4, 2, 1}));
  EXPECT_EQ(scene.source_radiosity(scene.select("wall")), (Rgb{1, 1, 1}));  // the ignored face does not count
  EXPECT_EQ(scene.source_radiosity(scene.select("mixed:2")), (Rgb{1, 1, 1}));
  EXPECT_EQ(complaint([&] { (void)scene.source_radiosity(scene.select("mixed")); }),
            "rooms.obj:16: the faces of source 'mixed' differ in Ke ('mixed:1' has material 'bright', 'mixed:2' has "
            "'dim'; a source has one radiosity); name a single face, or put the faces into separate groups");
}

TEST(SceneFaces, IgnoredFacesAreKeptButStandForNothing) {
  const Scene scene = rooms().build();
  EXPECT_EQ(scene.face(FaceId{1}).shape, FaceShape::kZeroArea);
  EXPECT_EQ(scene.faces_of({kWall, {}, scene.id()}), (std::vector<FaceId>{FaceId{0}, FaceId{3}}));
  EXPECT_TRUE(scene.faces_of({kWall, FaceId{1}, scene.id()}).empty());
  EXPECT_TRUE(scene.pieces_of(FaceId{1}).empty());
  EXPECT_EQ(scene.warnings()[0].message(), "rooms.obj:11: face 'wall:2' has no area and is ignored");
}

TEST(SceneBuilder, SkipsBadFacesOnRequest) {
  const auto with_bow_tie = [](BadFaces bad_faces) {
    SceneBuilder builder("bow.obj", {bad_faces, PatchMode::kGroups});
    const MaterialId material = builder.add_material({});
    for (const Vec3& v : {Vec3{0, 0, 0}, {4, 3, 0}, {4, 0, 0}, {0, 4, 0}}) builder.add_vertex(v);
    builder.add_face(builder.patch("bow"), material, {{0, 1, 2, 3}}, 5);
    builder.add_face(builder.patch("bow"), material, {{0, 1, 2}}, 6);
    return builder.build();
  };
  EXPECT_EQ(complaint([&] { (void)with_bow_tie(BadFaces::kReject); }),
            "bow.obj:5: face 'bow:1' crosses itself: edge 1-2 and edge 3-4 (vertex numbers) intersect (its interior is "
            "ambiguous); split it into simple polygons, or skip bad faces with --skip-bad-faces");
  const Scene scene = with_bow_tie(BadFaces::kSkip);
  EXPECT_EQ(scene.face(FaceId{0}).shape, FaceShape::kSkipped);
  EXPECT_EQ(scene.faces_of({PatchId{0}, {}, scene.id()}), std::vector<FaceId>{FaceId{1}});
  ASSERT_EQ(scene.warnings().size(), 1U);
  EXPECT_EQ(scene.warnings()[0].suggestion, "the face is skipped");
  EXPECT_EQ(complaint([&] { (void)scene.select("bow:1"); }),
            "bow.obj:5: face 'bow:1' cannot be used (it was skipped as a bad face); see the warning about it");
}

TEST(SceneBuilder, WarnsAboutFacesOutOfPlaneByMoreThanAMillionth) {
  for (const double height : {0x1p-10, 0x1p-30}) {
    SceneBuilder builder;
    const MaterialId material = builder.add_material({});
    for (const Vec3& v : {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, height}, {0, 1, 0}}) builder.add_vertex(v);
    builder.add_face(builder.patch("a"), material, {{0, 1, 2, 3}});
    const Scene scene = builder.build();
    EXPECT_EQ(scene.face(FaceId{0}).shape, FaceShape::kTriangulated);
    EXPECT_EQ(scene.warnings().size(), height > 1e-5 ? 1U : 0U);
    if (height < 1e-5) continue;
    EXPECT_EQ(scene.warnings()[0].what, "face 'a:1' is out of plane by 0.00017 of the diameter");
  }
}

TEST(SceneBuilder, CollectsEveryMistake) {
  SceneBuilder builder("api");
  const MaterialId material = builder.add_material({"black hole", {-1, 0, 0}, {}});
  builder.add_vertex({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  builder.add_vertex({0, std::numeric_limits<double>::infinity(), 0});
  builder.add_face(builder.patch("a"), material, {{0, 1, 2}});
  EXPECT_EQ(complaint([&] { (void)builder.build(); }),
            "api: vertex 1 is not finite (a coordinate is one exact number); give finite coordinates\n"
            "api: vertex 2 is not finite (a coordinate is one exact number); give finite coordinates\n"
            "api: material 'black hole' has a negative or infinite Kd or Ke (reflectances and radiosities are finite "
            "and not negative); correct it");
}

TEST(SceneHash, DependsOnWhatAffectsValuesOnly) {
  const std::string hash = rooms().build().hash();
  EXPECT_EQ(hash, rooms({BadFaces::kSkip, PatchMode::kGroups}).build().hash());
  EXPECT_NE(hash, rooms({BadFaces::kReject, PatchMode::kFaces}).build().hash());
  SceneBuilder more = rooms();
  more.add_vertex({0, 0, 0});
  EXPECT_NE(hash, more.build().hash());
  const auto with_vertex = [](double x) {
    SceneBuilder builder;
    builder.add_vertex({x, 0, 0});
    return builder.build().hash();
  };
  EXPECT_EQ(with_vertex(0.0), with_vertex(-0.0));
  EXPECT_NE(with_vertex(0.0), with_vertex(0x1p-1074));
}

// Fixed values: truth files from other machines and versions must recognise their scenes.
TEST(SceneHash, IsTheSameEverywhere) { EXPECT_EQ(rooms().build().hash(), "4b98b6de23c40d7a"); }

TEST(SceneBuilder, RefusesIndicesBeyondTheVertices) {
  SceneBuilder builder;
  const MaterialId material = builder.add_material({});
  builder.add_vertex({});
  builder.add_face(builder.patch("a"), material, {{0, 0, 7}});
  EXPECT_EQ(complaint([&] { (void)builder.build(); }), "face 'a:1' refers to vertex 8 (there are 1 vertices)");
}

}  // namespace
}  // namespace exactff
