// Regions: a flat surface gives the same receivers, however it is cut into faces.
#include "support/test.h"

namespace exactff {
namespace {

using Rings = std::vector<std::vector<std::uint32_t>>;
using Map = std::function<Vec3(double, double)>;

// A patch `floor` of faces with the corners (u, v), put into space by a map.
Scene surface(const Map& at, const std::vector<std::pair<double, double>>& corners, const Rings& faces) {
  SceneBuilder builder("test");
  for (const auto& [u, v] : corners) builder.add_vertex(at(u, v));
  const MaterialId material = builder.add_material({});
  for (const auto& face : faces) builder.add_face(builder.patch("floor"), material, {face});
  return builder.build();
}

std::vector<Receiver> grid(const Scene& scene, int u, int v) {
  return grid_receivers(scene, scene.select("floor"), {u, v});
}

// Exactly planar: every coordinate is a small multiple of 1/4.
Vec3 tilted(double u, double v) { return {4 * u + v, 3 * v - u, 2 * u + 5 * v + 7}; }

const std::vector<std::pair<double, double>> kSquare = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

// The square as a fan of triangles around an inner point, with n corners on each side.
Scene fan(const Map& at, int n) {
  std::vector<std::pair<double, double>> corners;
  const double step = 1.0 / n;
  for (int i = 0; i < n; ++i) corners.emplace_back(i * step, 0.0);
  for (int i = 0; i < n; ++i) corners.emplace_back(1.0, i * step);
  for (int i = 0; i < n; ++i) corners.emplace_back(1.0 - i * step, 1.0);
  for (int i = 0; i < n; ++i) corners.emplace_back(0.0, 1.0 - i * step);
  const auto rim = static_cast<std::uint32_t>(corners.size());
  corners.emplace_back(0.375, 0.625);
  Rings faces;
  for (std::uint32_t i = 0; i < rim; ++i) faces.push_back({i, (i + 1) % rim, rim});
  return surface(at, corners, faces);
}

void expect_same_points(const std::vector<Receiver>& a, const std::vector<Receiver>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    const Vec3 &p = a[i].point, &q = b[i].point;
    if (tolerance == 0.0) {
      EXPECT_EQ(p, q) << a[i].id;
    } else {
      EXPECT_LT(std::hypot(p.x - q.x, p.y - q.y, p.z - q.z), tolerance) << a[i].id;
    }
  }
}

TEST(Regions, OneFloorGivesTheSameReceiversHoweverItIsCut) {
  const Scene whole = surface(tilted, kSquare, {{0, 1, 2, 3}});
  for (const auto& [u, v] : {std::pair(7, 5), std::pair(1, 1), std::pair(16, 16)}) {
    expect_same_points(grid(whole, u, v), grid(surface(tilted, kSquare, {{0, 1, 2}, {0, 2, 3}}), u, v), 0.0);
    expect_same_points(grid(whole, u, v), grid(surface(tilted, kSquare, {{0, 1, 3}, {1, 2, 3}}), u, v), 0.0);
    expect_same_points(grid(whole, u, v), grid(fan(tilted, 4), u, v), 0.0);
    expect_same_points(grid(whole, u, v), grid(fan(tilted, 16), u, v), 0.0);
  }
}

TEST(Regions, AreJoinedOnlyByEdges) {
  const std::vector<std::pair<double, double>> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 1}, {2, 2}, {1, 2}};
  const Scene corner_to_corner = surface(tilted, corners, {{0, 1, 2, 3}, {2, 4, 5, 6}});
  EXPECT_EQ(regions(corner_to_corner, corner_to_corner.select("floor")).size(), 2U);
  const Scene opposite = surface(tilted, kSquare, {{0, 1, 2}, {0, 3, 2}});
  EXPECT_EQ(regions(opposite, opposite.select("floor")).size(), 2U);
  const Scene doubled = surface(tilted, kSquare, {{0, 1, 2, 3}, {0, 1, 2, 3}});
  EXPECT_EQ(regions(doubled, doubled.select("floor")).size(), 2U);
}

// Next to the diagonal of a floor that is not quite planar, the triangle beyond the diagonal would hide a good part of
// the view if it were not the receiver's own as well.
TEST(Regions, NextToADiagonalBothTrianglesAreOwn) {
  SceneBuilder builder("test");
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 2e-7}, Vec3{0, 1, 0}}) builder.add_vertex(v);
  for (const Vec3& v : {Vec3{0, 0, 1}, Vec3{0, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 0, 1}}) builder.add_vertex(v);
  const MaterialId material = builder.add_material({});
  builder.add_face(builder.patch("floor"), material, {{1, 2, 3}});
  builder.add_face(builder.patch("floor"), material, {{3, 0, 1}});
  builder.add_face(builder.patch("light"), material, {{4, 5, 6, 7}});
  const Scene scene = builder.build();
  const auto receivers = grid(scene, 3, 3);
  ASSERT_EQ(receivers.size(), 9U);
  const Receiver& on_diagonal = receivers[4];
  EXPECT_EQ(scene.name_of(on_diagonal.on), "floor:1+2");
  const ExactSource light(scene, scene.select("light"));
  const double both = exact_form_factor(scene, on_diagonal, light).value;
  EXPECT_NEAR(both, 0.2395, 1e-3);
  Receiver one = on_diagonal;
  one.on = {FaceId{0}};
  one.point.z -= 1e-9;
  EXPECT_LT(exact_form_factor(scene, one, light).value, 0.9 * both);
  EXPECT_EQ(receivers[2].on.size(), 1U);
}

}  // namespace
}  // namespace exactff
