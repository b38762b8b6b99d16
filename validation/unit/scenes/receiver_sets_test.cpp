// Receivers at corners and at the centres of faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "kernel/numbers.h"
#include "unit/scenes/polygon_faces.h"

namespace exactff {
namespace {

using Polygon = validation::PolygonFace;
using Ring = Polygon::Ring;
using validation::all_differ;
using validation::every_face;
using validation::ids_of;
using validation::letter_l;
using validation::polygon;
using validation::samples_of;
using validation::scene_of;

std::vector<Receiver> vertices_of(const Scene& scene) { return vertex_receivers(scene, every_face(scene)); }
std::vector<Receiver> centres_of(const Scene& scene) { return centre_receivers(scene, every_face(scene)); }
Vec3 centre_of(const Polygon& face) { return centres_of(scene_of({face})).at(0).point; }

// Two triangles that touch at the origin.
Polygon bow_tie() { return {{{-2, -1, 0}, {0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}}, {{0, 1, 2, 3, 1, 4}}}; }

// --- Vertices ------------------------------------------------------------------------------------------

TEST(VertexReceivers, LieExactlyOnTheCornersWithTheNormalOfTheFace) {
  const Scene scene = scene_of({polygon({{0.1, 0.2, 0}, {0.7, 0.2, 0}, {0.7, 0.9, 0}}, "floor")});
  const auto receivers = vertices_of(scene);
  ASSERT_EQ(receivers.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(receivers[i].point, scene.vertices()[i]);
    EXPECT_EQ(receivers[i].normal, scene.faces()[0].newell);
    EXPECT_EQ(receivers[i].on, std::vector{FaceId{0}});
  }
  EXPECT_EQ(ids_of(receivers), (std::vector<std::string>{"floor:1/1", "floor:1/2", "floor:1/3"}));
}

TEST(VertexReceivers, WhereFacesMeetThereIsOneForEachNormal) {
  SceneBuilder builder("test");
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) builder.add_vertex(v);
  const MaterialId material = builder.add_material({});
  builder.add_face(builder.patch("tent"), material, {{0, 1, 2}});
  builder.add_face(builder.patch("tent"), material, {{1, 0, 3}});
  const Scene scene = builder.build();
  const auto receivers = vertices_of(scene);
  ASSERT_EQ(receivers.size(), 6U);
  EXPECT_EQ(receivers[0].point, receivers[4].point);
  EXPECT_EQ(receivers[0].id, "tent:1/1");
  EXPECT_EQ(receivers[4].id, "tent:2/2");
  EXPECT_EQ(receivers[0].normal, (Vec3{0, 0, 0.5}));
  EXPECT_EQ(receivers[4].normal, (Vec3{0, 0.5, 0}));
  EXPECT_EQ(receivers[4].on, std::vector{FaceId{1}});
}

TEST(VertexReceivers, TwoVerticesAtOnePositionAreOne) {
  Polygon twice = bow_tie();  // with a separate vertex for the second visit
  twice.vertices.push_back({0, 0, 0});
  twice.rings = {{0, 1, 2, 3, 5, 4}};
  EXPECT_EQ(vertices_of(scene_of({twice})).size(), 5U);
}

TEST(VertexReceivers, IdsDifferEvenWhereFacesSeemToBeCalledTheSame) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Scene scene = scene_of({polygon(corners, "a"), polygon(corners, "a"), polygon(corners, "a:1"),
                                polygon(corners, "a:1/1"), polygon(corners, "a:1:1")});
  EXPECT_TRUE(all_differ(ids_of(vertices_of(scene))));
  EXPECT_TRUE(all_differ(ids_of(centres_of(scene))));
}

TEST(VertexReceivers, AFaceWithoutAreaHasNone) {
  const Scene scene =
      scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})});
  EXPECT_EQ(ids_of(vertices_of(scene)), (std::vector<std::string>{"face:2/1", "face:2/2", "face:2/3"}));
  EXPECT_EQ(ids_of(centres_of(scene)), (std::vector<std::string>{"face:2"}));
}

// --- Centres -------------------------------------------------------------------------------------------

TEST(CentreReceivers, RememberTheFaceAndCarryItsNewellVector) {
  const auto receivers = centres_of(scene_of({polygon({{0, 0, 0}, {0, 2, 0}, {0, 2, 3}, {0, 0, 3}}, "wall")}));
  ASSERT_EQ(receivers.size(), 1U);
  EXPECT_EQ(receivers[0].point, (Vec3{0, 1, 1.5}));
  EXPECT_EQ(receivers[0].normal, (Vec3{6, 0, 0}));
  EXPECT_EQ(receivers[0].on, std::vector{FaceId{0}});
  EXPECT_EQ(receivers[0].id, "wall:1");
}

TEST(CentreReceivers, AConvexFaceHasTheMeanOfItsCorners) {
  const Polygon trapezoid = polygon({{0, 0, 0}, {8, 0, 0}, {5, 4, 0}, {3, 4, 0}});
  EXPECT_EQ(centre_of(trapezoid), (Vec3{4, 2, 0}));
  const Scene scene = scene_of({trapezoid});
  EXPECT_EQ(centre_of(trapezoid), grid_receivers(scene, every_face(scene), {1, 1}).at(0).point);
  EXPECT_EQ(centre_of(polygon({{0, 0, 0}, {4, 0, 0}, {5, 3, 0}, {2, 6, 0}, {-1, 1, 0}})), (Vec3{2, 2, 0}));
}

TEST(CentreReceivers, ACentreIsTheNearestDoubleOfTheTrueOne) {
  // The sums of these need more than 53 bits; a long double holds them.
  const Vec3 centre = centre_of(polygon({{0.1, 0, 0}, {0.7, 0, 0}, {0.7, 0.3, 0}, {0.1, 0.3, 0}}));
  EXPECT_EQ(centre.x, static_cast<double>((static_cast<long double>(0.1) + static_cast<long double>(0.7)) / 2));
  // 1/3 is not a dyadic number.
  EXPECT_EQ(centre_of(polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})), (Vec3{1.0 / 3.0, 1.0 / 3.0, 0}));
}

TEST(CentreReceivers, AnLHasTheCentroidOfItsArea) { EXPECT_EQ(centre_of(letter_l()), (Vec3{5.0 / 6.0, 5.0 / 6.0, 0})); }

// A star around the origin with random radii, and a smaller copy of it as a hole.
Polygon random_star(std::mt19937_64& random, bool holed) {
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const std::uint32_t corners = 5 + static_cast<std::uint32_t>(random() % 20);
  Polygon star;
  star.rings.resize(holed ? 2 : 1);
  std::vector<Vec3> outer;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.9 * uniform()) / corners, radius = 0.05 + uniform();
    outer.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    star.rings[0].push_back(i);
    if (holed) star.rings[1].push_back(corners + i);
  }
  star.vertices = outer;
  for (const Vec3& v : outer) star.vertices.push_back({0.6 * v.x, 0.6 * v.y, 0});
  return star;
}

// Exact test for a point in the plane z = 0: an odd number of edges crosses the line from it towards larger x.
bool within_rings(const Polygon& polygon, const Vec3& p) {
  bool inside = false;
  for (const Ring& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 &a = polygon.vertices[ring[i]], &b = polygon.vertices[ring[(i + 1) % ring.size()]];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if ((kernel::orientation(a, b, p, {a.x, a.y, 1}) > 0) == (b.y > p.y)) inside = !inside;
    }
  }
  return inside;
}

TEST(CentreReceivers, AndSamplesLieInsideRandomFaces) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 60; ++i) {
    const Polygon star = random_star(random, i % 2 == 0);
    const Scene scene = scene_of({star});
    EXPECT_TRUE(within_rings(star, centres_of(scene).at(0).point)) << i;
    for (const Receiver& r : samples_of(scene, 20)) EXPECT_TRUE(within_rings(star, r.point)) << i;
  }
}

// The centre of its bilinear patch, (1/2, 1/2, 1/4), is put on the fold between its triangles along (-1, -1, 2).
// Rounding leaves it behind neither.
TEST(CentreReceivers, ANonPlanarQuadrilateralHasItsCentreOnATriangle) {
  const Scene scene = scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}})});
  const Receiver centre = centres_of(scene).at(0);
  for (const double c : {centre.point.x, centre.point.y, centre.point.z}) EXPECT_NEAR(c, 5.0 / 12.0, 0x1p-48);
  EXPECT_GE(centre.point.z, std::max(centre.point.x, centre.point.y));
  EXPECT_TRUE(centre.normal == (Vec3{0, -0.5, 0.5}) || centre.normal == (Vec3{-0.5, 0, 0.5}));
}

}  // namespace
}  // namespace exactff
