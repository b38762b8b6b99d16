#include "kernel/vec.h"
#include "support/test.h"

namespace exactff {
namespace {

using VertexRing = std::vector<std::uint32_t>;

// Faces of one patch.
Scene scene_of(const std::vector<Vec3>& vertices, const std::vector<std::vector<VertexRing>>& faces) {
  SceneBuilder builder;
  for (const Vec3& v : vertices) builder.add_vertex(v);
  const MaterialId material = builder.add_material({.name = "grey", .reflectance = {0.5, 0.5, 0.5}});
  const PatchId patch = builder.patch("wall");
  for (const auto& rings : faces) builder.add_face(patch, material, rings);
  return builder.build();
}

double area_of(const Scene& scene) { return total_area(summarise(scene)); }

// A cell that is cut into triangles has a diagonal that may be longer.
void expect_short_sides(const Scene& cells, double length) {
  for (const Face& face : cells.faces()) {
    for (const VertexRing& ring : face.rings) {
      const double most = (ring.size() == 3 ? 2.0 : 1.0) * length * (1.0 + 1e-8);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec3 &a = cells.vertices()[ring[k]], &b = cells.vertices()[ring[(k + 1) % ring.size()]];
        EXPECT_LE(kernel::distance(a, b), most);
      }
    }
  }
}

void expect_planar_cells(const Scene& cells) {
  for (const Face& face : cells.faces()) {
    EXPECT_EQ(face.shape, FaceShape::kPlanar) << cells.patch(face.patch).name;
    EXPECT_EQ(cells.patch(face.patch).faces.size(), 1U);
  }
}

// What holds for any scene.
DividedScene expect_cells(const Scene& scene, double length) {
  DividedScene divided = exactff::divided(scene, length);
  EXPECT_EQ(divided.cells, divided.scene.faces().size());
  EXPECT_NEAR(area_of(divided.scene), area_of(scene), 1e-12 * area_of(scene));
  expect_short_sides(divided.scene, length);
  expect_planar_cells(divided.scene);
  return divided;
}

// A cube turned by no special angle, with its fronts outside.
Scene turned_cube(const std::vector<std::vector<VertexRing>>& faces) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) {
    const double x = k & 1, y = k >> 1 & 1, z = k >> 2 & 1;
    corners.push_back({0.36 * x - 0.48 * y + 0.8 * z, 0.8 * x + 0.6 * y, -0.48 * x + 0.64 * y + 0.6 * z});
  }
  return scene_of(corners, faces);
}
const std::vector<std::vector<VertexRing>> kCube = {{{0, 2, 3, 1}}, {{4, 5, 7, 6}}, {{0, 1, 5, 4}},
                                                    {{2, 6, 7, 3}}, {{0, 4, 6, 2}}, {{1, 3, 7, 5}}};

TEST(Division, RectangleBecomesAGrid) {
  const Scene scene = scene_of({{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}}, {{{0, 1, 2, 3}}});
  const DividedScene divided = expect_cells(scene, 0.5);
  EXPECT_EQ(divided.cells, 24U);
  EXPECT_EQ(divided.faces_cut, 1U);
  EXPECT_EQ(divided.largest_deviation, 0.0);
  for (const Face& face : divided.scene.faces()) {
    EXPECT_EQ(face.area, 0.25);
    EXPECT_EQ(face.rings.front().size(), 4U);
    EXPECT_GT(face.newell.z, 0.0);
  }
}

// 7 steps of 1/7 of a length that is not quite 7 steps long.
TEST(Division, RoundingsOfALengthAddNoCell) {
  const double side = 7 * 0.1;  // 0.70000000000000007
  const Scene scene = scene_of({{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}}, {{{0, 1, 2, 3}}});
  EXPECT_EQ(expect_cells(scene, 0.1).cells, 49U);
}

TEST(Division, ClosedSurfacesStayClosed) {
  for (const char* model : {"closed-room", "closed-room:lamp=hanging"}) {
    const Scene scene = models::make_scene(model);
    ASSERT_EQ(scene.open_edge_count(), 0U) << model;
    EXPECT_EQ(expect_cells(scene, 0.3).scene.open_edge_count(), 0U) << model;
  }
  const Scene cube = turned_cube(kCube);
  ASSERT_EQ(cube.open_edge_count(), 0U);
  const DividedScene divided = expect_cells(cube, 0.3);
  EXPECT_EQ(divided.scene.open_edge_count(), 0U);
  EXPECT_GT(divided.cells, 6U * 16U);  // roundings bend some
  EXPECT_GT(divided.largest_deviation, 0.0);
  EXPECT_LT(divided.largest_deviation, 1e-15);
}

// Two faces of the cube end at the middle of an edge of a third one, in whose ring this point is not.
TEST(Division, PointsAreSharedAtJunctions) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({0.1 * (k & 1), 0.3 * (k >> 1 & 1), 0.7 * (k >> 2 & 1)});
  corners.push_back({0.1, 0.3, 0.2});
  corners.push_back({0.1, 0.0, 0.2});
  std::vector<std::vector<VertexRing>> faces = kCube;
  faces[5] = {{1, 3, 8, 9}};
  faces.push_back({{9, 8, 7, 5}});
  const Scene scene = scene_of(corners, faces);
  ASSERT_GT(scene.open_edge_count(), 0U);
  for (const double length : {0.11, 0.07, 0.03}) {
    EXPECT_EQ(expect_cells(scene, length).scene.open_edge_count(), 0U) << length;
  }
}

TEST(Division, FacesOfAnyShapeAreCovered) {
  const Scene trapezoid = scene_of({{0, 0, 0}, {5.3, 0, 0}, {4.1, 2.2, 0}, {1.2, 2.2, 0}}, {{{0, 1, 2, 3}}});
  EXPECT_GT(expect_cells(trapezoid, 0.5).cells, 4U * 9U);
  const Scene frame = scene_of({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 3, 0}, {3, 2, 0}},
                               {{{0, 1, 2, 3}, {4, 5, 6}}});
  EXPECT_GT(expect_cells(frame, 0.4).cells, 16U * 6U);
  const Scene needle = scene_of({{0, 0, 0}, {100, 1e-3, 3}, {100, 0, 3}}, {{{0, 1, 2}}});
  EXPECT_GE(expect_cells(needle, 1.0).cells, 100U);
  std::vector<Vec3> round;
  VertexRing ring;
  for (int k = 0; k < 60; ++k) {
    round.push_back({std::cos(k * 0.1047), std::sin(k * 0.1047), 0.25});
    ring.push_back(static_cast<std::uint32_t>(k));
  }
  EXPECT_GT(expect_cells(scene_of(round, {{ring}}), 0.2).cells, 60U);
  EXPECT_EQ(expect_cells(scene_of(round, {{ring}}), 2.1).cells, 1U);
}

TEST(Division, CellsAreNamedByTheirPatch) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  const DividedScene divided = expect_cells(scene, 140.0);
  const Scene& cells = divided.scene;
  EXPECT_EQ(cells.select_all("light").size(), 1U);  // 130 x 105: a single cell keeps its name
  EXPECT_EQ(cells.select("light").face, std::nullopt);
  const std::vector<Selection> floor = cells.select_all("floor");
  EXPECT_EQ(floor.size(), 16U);
  EXPECT_EQ(cells.name_of(floor[2]), "floor:3");
  EXPECT_EQ(cells.select_all("floor:3"), std::vector{floor[2]});
  double area = 0.0;
  for (const Selection& cell : floor) area += summarise(cells, cell.patch).area;
  EXPECT_NEAR(area, summarise(scene, scene.select("floor").patch).area, 1e-6);
  const Scene smaller = exactff::divided(cells, 70.0).scene;
  EXPECT_GE(smaller.select_all("floor").size(), 64U);
  EXPECT_GE(smaller.select_all("floor:3").size(), 4U);
  EXPECT_THROW((void)cells.select_all("flor"), InputError);
}

TEST(Division, WhatIsFlippedOrTransparentStaysSo) {
  const Scene room = read_scene(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  const Scene flipped = room.with_flipped(room.select("floor"));
  const Scene cells = divided(flipped.with_transparent(std::vector{flipped.select("left")}), 200.0).scene;
  EXPECT_EQ(cells.flipped(), cells.select_all("floor"));
  EXPECT_EQ(cells.transparent(), cells.select_all("left"));
  for (const Selection& cell : cells.select_all("floor")) {
    EXPECT_LT(cells.face(cells.faces_of(cell).front()).newell.y, 0.0);
  }
}

// The same cells with the same corners, scaled, to the ends of the range of doubles.
TEST(Division, CommutesWithPowersOfTwo) {
  std::size_t rounded = 0;
  for (std::uint64_t s = 0; s < validation::scaled_count(60); ++s) {
    generate::Random random(validation::seed_of(s));
    const generate::PlainScene plain = validation::random_scene(random);
    const Scene scene = generate::build(plain);
    double largest = 0.0;
    for (const Vec3& v : scene.vertices()) largest = std::max(largest, kernel::max_norm(v));
    const double length = largest / static_cast<double>(1 + random.below(9));
    const DividedScene divided = exactff::divided(scene, length);
    for (const int exponent : {-940, -500, 500, 1023 - std::ilogb(largest)}) {
      generate::PlainScene copy = plain;
      generate::scale(copy, std::ldexp(1.0, exponent));
      const DividedScene scaled = exactff::divided(generate::build(copy), std::ldexp(length, exponent));
      EXPECT_EQ(scaled.cells, divided.cells) << s << ' ' << exponent;
      EXPECT_EQ(scaled.faces_cut, divided.faces_cut) << s << ' ' << exponent;
      EXPECT_EQ(scaled.largest_deviation, std::ldexp(divided.largest_deviation, exponent)) << s << ' ' << exponent;
      ASSERT_EQ(scaled.scene.vertices().size(), divided.scene.vertices().size()) << s << ' ' << exponent;
      for (std::size_t f = 0; f < divided.scene.faces().size(); ++f) {
        ASSERT_EQ(scaled.scene.faces()[f].rings, divided.scene.faces()[f].rings) << s << ' ' << exponent;
      }
      for (std::size_t v = 0; v < divided.scene.vertices().size(); ++v) {
        const Vec3 &a = divided.scene.vertices()[v], &b = scaled.scene.vertices()[v];
        const auto is_scaled = [&](double Vec3::*c) { return b.*c == std::ldexp(a.*c, exponent); };
        ASSERT_TRUE(is_scaled(&Vec3::x) && is_scaled(&Vec3::y) && is_scaled(&Vec3::z)) << s << ' ' << exponent;
      }
    }
    rounded += divided.largest_deviation > 0.0 ? 1 : 0;
  }
  EXPECT_GE(rounded, 10U);
}

TEST(Division, SaysWhyItRefuses) {
  const Scene scene = models::make_scene("closed-room");
  for (const double length : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    EXPECT_THROW((void)divided(scene, length), InputError) << length;
  }
  EXPECT_HOLDS(complaint([&] { (void)divided(scene, 1e-6); }), "cells");
}

// NAME means all of its cells, found by their names: a patch of a similar name must not be among them.
TEST(Division, NoPatchMayCountAsCellsOfAnother) {
  const auto scene_of = [](const char* small, const char* large) {
    SceneBuilder builder;
    for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 1, 0}, Vec3{0, 1, 0}, Vec3{8, 0, 1}, Vec3{8, 1, 1}})
      builder.add_vertex(v);
    const MaterialId material = builder.add_material({});
    builder.add_face(builder.patch(small), material, {{0, 1, 2, 3}});
    builder.add_face(builder.patch(large), material, {{0, 4, 5, 3}});
    return builder.build();
  };
  const auto said = [](const Scene& scene, double length) { return complaint([&] { (void)divided(scene, length); }); };
  EXPECT_EQ(said(scene_of("a", "a:7"), 20.0), "");  // nothing is cut
  EXPECT_HOLDS(said(scene_of("a", "a:7"), 1.0), "the patch 'a:7' would count as cells of 'a'");
  EXPECT_HOLDS(said(scene_of("a", "a:1"), 3.0), "'a:1' would count as cells of 'a'");
  EXPECT_HOLDS(said(scene_of("a:1:1", "a"), 3.0), "'a:1:1' would count as cells of 'a'");
  EXPECT_EQ(said(scene_of("a:1", "a:2"), 1.0), "");
  EXPECT_EQ(said(scene_of("a", "a:b"), 1.0), "");
}

}  // namespace
}  // namespace exactff
