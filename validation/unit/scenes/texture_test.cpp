// Texture coordinates survive what is done to faces.
#include "support/test.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

Scene textured_obj(const std::string& text) {
  std::istringstream in(text);
  return read_obj(in, "s.obj");
}

// An affine function of the place, one for each set: every new corner must have the value of its place.
TexturePoint at(const Vec3& x, int set) {
  if (set == 1) return {x.z - x.x, 3.0 * x.y};
  return {0.5 * x.x + 0.25 * x.y - x.z, x.y + 0.125 * x.z + 1.0};
}

Scene textured(const Scene& scene) {
  SceneBuilder builder;
  for (const Vec3& v : scene.vertices()) builder.add_vertex(v);
  for (const Material& material : scene.materials()) builder.add_material(material);
  for (const Face& face : scene.faces()) {
    builder.add_face(builder.patch(scene.patch(face.patch).name), face.material, face.rings);
    for (int set = 0; set < kTextureSets; ++set) {
      std::vector<TexturePoint> points;
      for (const auto& ring : face.rings) {
        for (const std::uint32_t v : ring) points.push_back(at(scene.vertices()[v], set));
      }
      builder.state_texture(set, points);
    }
  }
  return builder.build();
}

void expect_affine(const Scene& scene, int sets, const std::string& what) {
  for (int set = 0; set < sets; ++set) {
    EXPECT_TRUE(scene.has_texture(set)) << what;
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      const auto texture = scene.texture(static_cast<FaceId>(f), set);
      std::size_t k = 0;
      for (const auto& ring : scene.faces()[f].rings) {
        for (const std::uint32_t v : ring) {
          ASSERT_LT(k, texture.size()) << what;
          const TexturePoint wanted = at(scene.vertices()[v], set), found = texture[k++];
          ASSERT_NEAR(found.u, wanted.u, 1e-12) << what;
          ASSERT_NEAR(found.v, wanted.v, 1e-12) << what;
        }
      }
      ASSERT_EQ(k, texture.size()) << what;
    }
  }
}

// Concave faces, faces with corners of others on their edges, corners apart by less than the welding length.
Scene awkward() {
  SceneBuilder builder;
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{{0, 0},
                                                                   {2, 0},
                                                                   {2, 2},
                                                                   {1, 1},
                                                                   {0, 2},
                                                                   {1, 0},
                                                                   {0, -1},
                                                                   {2, -1},
                                                                   {1.0625, 0},
                                                                   {0, 1e-4},
                                                                   {-1, 0},
                                                                   {-1, 2}}) {
    builder.add_vertex({x, y, 0.5 * x});
  }
  const MaterialId grey = builder.add_material({.name = "grey"});
  builder.add_face(builder.patch("concave"), grey, {{0, 1, 2, 3, 4}});
  builder.add_face(builder.patch("left"), grey, {{6, 5, 0}});
  builder.add_face(builder.patch("right"), grey, {{7, 1, 8, 5, 6}});
  builder.add_face(builder.patch("repeats"), grey, {{9, 9, 4, 11, 10, 9}});
  return textured(builder.build());
}

TEST(Texture, CornersKeepTheirsInAllChangesOfFaces) {
  for (const Scene& scene : {awkward(), textured(models::make_scene("room")), textured(models::make_scene("teapot"))}) {
    expect_affine(scene, 2, "as built");
    std::vector<Selection> all;
    for (const Face& face : scene.faces()) all.push_back({face.patch, {}, scene.id()});
    const Scene flipped = scene.with_flipped(all);
    expect_affine(flipped, 2, "flipped");
    std::vector<Selection> of_flipped = all;
    for (Selection& one : of_flipped) one.scene = flipped.id();
    expect_affine(flipped.with_transparent(of_flipped), 2, "transparent");
    expect_affine(triangulated(scene), 2, "triangulated");
    expect_affine(with_patches(scene, scene_options("parts")), 2, "parts");
    const double length = std::sqrt(total_area(summarise(scene))) / 9.0;
    expect_affine(divided(scene, length).scene, 2, "divided");
    expect_affine(divided(flipped, length).scene, 2, "flipped and divided");
    const SceneFiles files = scene_files(scene, "s.obj");
    expect_affine(read_scene(files.files.back().bytes, "s.obj"), 1, "written and read");
    EXPECT_HOLDS(files.losses.front().message(), "set 1");
  }
}

// A corner that moved keeps its own; a corner that was added to an edge lies between those beside it.
TEST(Texture, WeldedFacesHaveSomeAtEveryCorner) {
  const Scene scene = awkward();
  const WeldedScene welded = exactff::welded(scene, 1e-3);
  EXPECT_GT(welded.junctions, 0U);
  expect_affine(exactff::welded(scene, 1e-9).scene, 2, "junctions only");
  for (std::size_t f = 0; f < welded.scene.faces().size(); ++f) {
    const auto texture = welded.scene.texture(static_cast<FaceId>(f));
    const auto& ring = welded.scene.faces()[f].rings[0];
    ASSERT_EQ(texture.size(), ring.size());
    for (std::size_t k = 0; k < ring.size(); ++k) {
      EXPECT_NEAR(texture[k].v, at(welded.scene.vertices()[ring[k]], 0).v, 2e-4);
    }
  }
}

const std::string kTexturedSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1\nvt .5 1 7 # w is ignored\nvt a 0\n";

TEST(Texture, ObjFacesHaveTheirsOrNone) {
  const Scene scene = textured_obj(kTexturedSquare + "f 1/1 2/2 3/-2\nf 1 2 4\nf 2/3/1 3/5 4/1/\nvt 2 1e0\n");
  EXPECT_TRUE(scene.warnings().empty());
  const auto first = scene.texture(FaceId{0});
  ASSERT_EQ(first.size(), 3U);
  EXPECT_EQ(first[1], (TexturePoint{1, 0}));
  EXPECT_EQ(first[2], (TexturePoint{0.5, 1}));
  EXPECT_TRUE(scene.texture(FaceId{1}).empty());
  EXPECT_EQ(scene.texture(FaceId{2})[1], (TexturePoint{2, 1}));
  EXPECT_TRUE(scene.texture(FaceId{0}, 1).empty());
  for (const char* corners :
       {"1/9 2/1 3/1", "1/4 2/1 3/1", "1/0 2/1 3/1", "1/-9 2/1 3/1", "1 2/1 3/1", "1/99999999999999999999 2/1 3/1"}) {
    const Scene faulty = textured_obj(kTexturedSquare + "f 1/1 2/1 3/1\nf " + corners + "\n");
    EXPECT_TRUE(faulty.texture(FaceId{1}).empty()) << corners;
    EXPECT_EQ(faulty.texture(FaceId{0}).size(), 3U) << corners;
    EXPECT_HOLDS(warnings_of(faulty), "s.obj:10: a face has no valid vt") << corners;
  }
}

}  // namespace
}  // namespace exactff
