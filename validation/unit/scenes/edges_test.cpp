// Welds the edges of a scene; its tree leaves out most that are no silhouettes (property/silhouettes_test.cpp: no
// other).
#include "scene/edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "generate/plain_scene.h"

namespace exactff {
namespace {

using generate::PlainScene;

PlainScene scene_of(const std::vector<std::vector<Vec3>>& faces) {
  PlainScene plain;
  for (const auto& face : faces) plain.add_ring(plain.patch("source"), face);
  return plain;
}

// n x n squares over [-1, 1]^2, each cut in two, at the heights that are given.
template <class Height>
std::vector<std::vector<Vec3>> sheet(int n, const Height& height) {
  std::vector<std::vector<Vec3>> faces;
  const auto at = [&](int i, int j) {
    const double x = 2.0 * i / n - 1.0, y = 2.0 * j / n - 1.0;
    return Vec3{x, y, height(x, y)};
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return faces;
}

double hill(double x, double y) { return 1.0 - x * x - 0.5 * y * y; }

std::size_t edge_count(const std::vector<std::vector<Vec3>>& faces) {
  return scene_edges(generate::build(scene_of(faces))).size();
}

TEST(SceneEdges, AreWeldedByEqualCoordinatesAlone) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, -1, 0};
  const Vec3 moved{std::nextafter(1.0, 2.0), 0, 0};
  EXPECT_EQ(edge_count({{a, b, c}, {b, a, d}}), 5U);
  EXPECT_EQ(edge_count({{a, b, c}, {a, b, d}}), 5U) << "whichever way the faces run";
  EXPECT_EQ(edge_count({{a, b, c}, {moved, a, d}}), 6U);
  const Scene scene = generate::build(scene_of({{a, b, c}, {b, a, d}}));
  const SceneEdges& edges = scene_edges(scene);
  std::size_t shared = 0;
  for (std::uint32_t edge = 0; edge < edges.size(); ++edge) {
    if (edges.uses(edge).size() == 1) continue;
    ++shared;
    ASSERT_EQ(edges.uses(edge).size(), 2U);
    EXPECT_NE(edges.uses(edge)[0].upwards(), edges.uses(edge)[1].upwards());
  }
  EXPECT_EQ(shared, 1U);
}

std::set<std::uint32_t> visited(const Scene& scene, const Vec3& x, bool in_front) {
  const HalfSpace everything{{}, -1.0}, front = in_front ? everything : HalfSpace{{}, 0.0};
  const std::vector<HalfSpace> all{front, everything, everything, everything, everything};
  std::set<std::uint32_t> edges;
  scene_edges(scene).query(x, HalfSpaceGroups(all), [&](std::uint32_t edge, bool) { edges.insert(edge); });
  return edges;
}

TEST(SceneEdges, AreMostlyLeftOutIfTheyAreSmooth) {
  const Scene scene = generate::build(scene_of(sheet(64, hill)));
  const std::size_t all = scene_edges(scene).size();
  const Vec3 above{0.1, 0.2, 9.0}, beside{5.0, 0.2, 0.5};
  EXPECT_LT(visited(scene, above, true).size(), all / 8);
  EXPECT_LT(visited(scene, beside, true).size(), all / 3);
  EXPECT_EQ(visited(scene, above, false).size(), all) << "edges of pieces that may be cut or left out are kept";
}

}  // namespace
}  // namespace exactff
