#include "formats/view3d.h"
#include "support/test.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using Names = std::vector<std::string>;

const std::string kSamples = EXACTFF_DATA_DIR "/scenes/formats/";
// The unit square in four vertices, and the square [1/4, 3/4]^2 in it.
const std::string kView3dVertices =
    "F 3\nV 1 0 0 0\nV 2 1 0 0\nV 3 1 1 0\nV 4 0 1 0\n"
    "V 5 .25 .25 0\nV 6 .75 .25 0\nV 7 .75 .75 0\nV 8 .25 .75 0\nV 9 .25 .75 .5\n";

Scene from_view3d(const std::string& text, const SceneOptions& options = {}) {
  return read_scene(text, "s.vs3", options);
}
std::string view3d_error(const std::string& text) {
  return error_of([&] { return from_view3d(text); });
}
double area(const Scene& scene, const std::string& name) {
  double sum = 0.0;
  for (const FaceId face : scene.faces_of(scene.select(name))) sum += scene.face(face).area;
  return sum;
}

TEST(View3dReader, ReadsVerticesSurfacesAndObstructions) {
  const Scene scene =
      from_view3d("T a title\n! comment\n/ comment\nC eps=1e-4\n" + kView3dVertices +
                  "S 1 1 2 3 4 0 0 0.9 floor ! seen from above\ns 2 1 2 3 0 0 0 .25 half\nO 3 5 6 7 8\nO 4 5 6 7 0\n"
                  "End of data\nS 99 is not read\n");
  EXPECT_EQ(patch_names(scene), (Names{"floor", "half", "obstructions"}));
  EXPECT_EQ(ring(scene, 1), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(scene.material(scene.faces()[0].material).reflectance, (Rgb{0.1, 0.1, 0.1}));
  EXPECT_EQ(scene.material(scene.faces()[1].material).reflectance, (Rgb{0.75, 0.75, 0.75}));
  EXPECT_EQ(scene.patches()[2].faces.size(), 2U);
  EXPECT_EQ(scene.faces()[0].line, 15U);
  EXPECT_EQ(warnings_of(scene), "");
}

// As other programs write them: with a name, or with all that a surface has.
TEST(View3dReader, ObstructionsKeepTheirNames) {
  const Scene scene = from_view3d(kView3dVertices +
                                  "S 1 1 2 3 4 0 0 0.9 floor\nO 2 5 6 7 8 pillar\nO 3 5 6 7 0 0 0 0.5 12 ! a name\n"
                                  "O 4 5 6 8 0\nO 5 6 7 8 0 pillar\nO 6 6 7 8 0 floor\nO 7 5 6 7 0 0 0 0.5\nE\n");
  EXPECT_EQ(patch_names(scene), (Names{"floor", "pillar", "12", "obstructions", "floor#6"}));
  EXPECT_EQ(scene.faces_of(scene.select("pillar")), (std::vector<FaceId>{FaceId{1}, FaceId{4}}));
  EXPECT_EQ(scene.faces_of(scene.select("obstructions")), (std::vector<FaceId>{FaceId{3}, FaceId{6}}));
  const SceneFiles files = scene_files(scene, "s.vs3");
  const Scene again = read_scene(files.files.front().bytes, "s.vs3");
  EXPECT_EQ(patch_names(again), patch_names(scene));
  EXPECT_HOLDS(files.files.front().bytes, "\nO 2 5 6 7 8 pillar\n");
}

TEST(View3dReader, SubsurfacesAreCutFromTheirBase) {
  const Scene scene = from_view3d(kView3dVertices + "S 1 1 2 3 4 0 0 .9 wall\nS 2 5 6 7 8 1 0 .9 window\nE\n");
  EXPECT_EQ(scene.faces()[0].rings.size(), 2U);
  EXPECT_EQ(area(scene, "wall"), 0.75);
  EXPECT_EQ(area(scene, "window"), 0.25);
  // The two together are seen as the whole wall is.
  const Scene whole = from_view3d(kView3dVertices + "S 1 1 2 3 4 0 0 .9 wall\nE\n");
  const Receiver receiver{.point = {0.5, 0.5, 2.0}, .normal = {0.0, 0.0, -1.0}, .on = {}, .id = {}};
  const auto value = [&](const Scene& s, const char* name) {
    return exact_form_factor(s, receiver, ExactSource(s, s.select(name))).value;
  };
  EXPECT_NEAR(value(scene, "wall") + value(scene, "window"), value(whole, "wall"), 1e-16);
  EXPECT_GT(value(scene, "wall"), 0.05);
}

TEST(View3dReader, SubsurfacesMayTouchEachOtherAndTheBase) {
  const std::string halves = "V 10 .5 0 0\nV 11 .5 1 0\nV 12 .5 .25 0\nV 13 .5 .75 0\n";
  const std::string base = kView3dVertices + halves + "S 1 1 2 3 4 0 0 .9 base\n";
  const Scene split = from_view3d(base + "S 2 1 10 11 4 1 0 .9 left\nE\n");
  EXPECT_EQ(area(split, "base"), 0.5);
  const Scene two = from_view3d(base + "S 2 5 12 13 8 1 0 .9 left\nS 3 12 6 7 13 1 0 .9 right\nE\n");
  EXPECT_EQ(area(two, "base"), 0.75);
  const Scene all = from_view3d(base + "S 2 1 10 11 4 1 0 .9 left\nS 3 10 2 3 11 1 0 .9 right\nE\n");
  EXPECT_EQ(all.faces()[0].shape, FaceShape::kZeroArea);
  const Scene nested = from_view3d(base + "S 2 5 6 7 8 1 0 .9 window\nS 3 5 12 13 8 2 0 .9 pane\nE\n");
  EXPECT_EQ(area(nested, "base"), 0.75);
  EXPECT_EQ(area(nested, "window"), 0.125);
}

TEST(View3dReader, SubsurfacesThatCannotBeCutAreRefused) {
  const std::string base = kView3dVertices + "V 10 .5 .5 0\nV 11 2 .5 0\nS 1 1 2 3 4 0 0 .9 base\n";
  const auto refused = [&](const std::string& more) { return view3d_error(base + more + "E\n"); };
  EXPECT_HOLDS(refused("S 2 5 6 7 9 1 0 .9 x\n"),
               "s.vs3:14: surface 2 ('x') is not exactly in the plane of its base 1 ('base')");
  EXPECT_HOLDS(refused("S 2 8 7 6 5 1 0 .9 x\n"), "s.vs3:14: surface 2 ('x') faces away from its base");
  EXPECT_HOLDS(refused("S 2 5 6 11 0 1 0 .9 x\n"), "s.vs3:13: face 'base:1' crosses itself");
  // The same place twice, and one in the other: no edges cross, but even and odd would be wrong.
  const std::string overlap = "s.vs3:13: subsurfaces of surface 1 ('base') overlap, or reach beyond it";
  EXPECT_HOLDS(refused("S 2 5 6 7 8 1 0 .9 x\nS 3 5 6 7 8 1 0 .9 y\n"), overlap);
  EXPECT_HOLDS(refused("S 2 5 6 7 8 1 0 .9 x\nS 3 5 6 10 0 1 0 .9 y\n"), overlap);
  EXPECT_HOLDS(refused("O 2 5 6 7 8\nS 3 5 6 7 8 2 0 .9 x\n"), "the base of surface 3 ('x') is an obstruction");
}

TEST(View3dReader, MalformedRecordsAreNamedByLine) {
  struct Case {
    std::string record;
    std::string message;
  };
  const Case cases[] = {
      {"M 1 1 2 3 4 0 0 .9 m", "s.vs3:11: record 'M': masking and null surfaces are not read"},
      {"n 1 1 2 3 4 0 0 .9 m", "s.vs3:11: record 'n': masking and null surfaces"},
      {"X 1", "s.vs3:11: unknown record 'X'"},
      {"1 1 2 3", "s.vs3:11: unknown record '1'"},
      {"F 3a", "s.vs3:11: geometry '3a' is not read"},
      {"F 2", "geometry '2' is not read"},
      {"V 11 0 0 0",
       "s.vs3:11: vertex '11' is out of sequence (View3D numbers them from 1 without gaps); its number must be 10"},
      {"V 10 0 0", "s.vs3:11: a vertex has fewer than three coordinates"},
      {"V 10 0 0 nan", "s.vs3:11: 'nan' is not a finite number"},
      {"S 2 1 2 3 4 0 0 .9 a", "s.vs3:11: surface '2' is out of sequence"},
      {"S 1 1 2 3 10 0 0 .9 a", "s.vs3:11: vertex 10 does not exist (the file has 9 vertices)"},
      {"S 1 0 2 3 4 0 0 .9 a", "s.vs3:11: '0' is not the number of a vertex"},
      {"S 1 1 2 3 -4 0 0 .9 a", "s.vs3:11: '-4' is not the number of a vertex"},
      {"S 1 1 2 3 4294967296 0 0 .9 a", "is not the number of a vertex"},
      {"S 1 1 2 3", "s.vs3:11: '' is not the number of a vertex"},
      {"S 1 1 2 3 4 1 0 .9 a", "s.vs3:11: base '1' is not the number of a surface before this one"},
      {"S 1 1 2 3 4 0 5 .9 a", "s.vs3:11: combination '5' is not the number of a surface before"},
      {"S 1 1 2 3 4 0 0 1.5 a", "s.vs3:11: emittance '1.5' is not a number between 0 and 1"},
      {"S 1 1 2 3 4 0 0", "s.vs3:11: emittance '' is not a number"},
      {"O 1 1 2 3 4\nS 2 1 2 3 4 0 1 .9 a", "s.vs3:12: surface 2 ('a') is combined with surface 1"},
      {"S 1 1 2 3 4 0 0 .9 a\nS 2 1 2 3 4 0 1 .9 b\nS 3 1 2 3 4 0 2 .9 c",
       "s.vs3:13: surface 3 ('c') is combined with surface 2 ('b')"},
      {"", "s.vs3: has no faces"},
  };
  for (const Case& bad : cases) {
    const std::string message = view3d_error(kView3dVertices + bad.record + "\nE\n");
    EXPECT_HOLDS(message, bad.message) << bad.record << '\n' << message;
  }
}

TEST(View3dReader, ReadsWaltonsFiles) {
  const auto total = [](const Scene& scene) {
    return std::accumulate(scene.faces().begin(), scene.faces().end(), 0.0,
                           [](double sum, const Face& face) { return sum + face.area; });
  };
  const Scene facet = read_scene(kSamples + "facet.vs3");
  EXPECT_EQ(facet.faces().size(), 8U);
  EXPECT_DOUBLE_EQ(total(facet), 6.5);
  EXPECT_EQ(warnings_of(facet), "");
  const Scene room = read_scene(kSamples + "test4.vs3");
  EXPECT_EQ(room.faces().size(), 12U);
  EXPECT_EQ(room.patches().size(), 8U);
  EXPECT_DOUBLE_EQ(total(room), 46.0);
  EXPECT_EQ(room.select("srf-7").patch, room.face(FaceId{8}).patch);
}

}  // namespace
}  // namespace exactff
