// Welds the edges of a scene; its tree leaves out no edge that is a silhouette.
#include "scene/edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <span>
#include <vector>

#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/numbers.h"

namespace exactff {
namespace {

using generate::PlainScene;
using generate::Random;

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

std::vector<std::vector<Vec3>> box(double x, double size) {
  const auto at = [&](int corner) {
    return Vec3{x + size * (corner & 1), size * (corner / 2 & 1), size * (corner / 4 & 1)};
  };
  return {{at(0), at(2), at(3), at(1)}, {at(4), at(5), at(7), at(6)}, {at(0), at(1), at(5), at(4)},
          {at(2), at(6), at(7), at(3)}, {at(0), at(4), at(6), at(2)}, {at(1), at(3), at(7), at(5)}};
}

std::vector<std::vector<Vec3>> moebius_strip(int n) {
  std::vector<std::vector<Vec3>> faces;
  const auto at = [&](int i, double side) {
    const double turn = 6.283185307179586 * i / n, half = 0.5 * turn, r = 1.0 + 0.25 * side * std::cos(half);
    return Vec3{r * std::cos(turn), r * std::sin(turn), 0.25 * side * std::sin(half)};
  };
  for (int i = 0; i < n; ++i) {
    const bool last = i + 1 == n;  // the strip closes with its sides exchanged
    const Vec3 a = at(i, -1), b = at(i, 1), c = last ? at(0, 1) : at(i + 1, -1), d = last ? at(0, -1) : at(i + 1, 1);
    faces.push_back({a, c, b});
    faces.push_back({b, c, d});
  }
  return faces;
}

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

TEST(SceneEdges, AreNoneOfTransparentPieces) {
  PlainScene plain = scene_of(box(0.0, 1.0));
  plain.add_ring(plain.patch("pane"), {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
  const Scene opaque = generate::build(plain);
  const auto pane = opaque.select("pane");
  EXPECT_EQ(scene_edges(opaque).size(), 15U);
  EXPECT_EQ(scene_edges(opaque.with_transparent(std::span(&pane, 1))).size(), 12U);
}

// The change of the number of pieces across an edge, as x sees it.
int jump(const Scene& scene, std::uint32_t edge, const Vec3& x) {
  int sum = 0;
  for (const EdgeUse& use : scene_edges(scene).uses(edge)) {
    const auto corner = [&](int c) { return scene.vertices()[scene.pieces()[use.piece()].frame[c]]; };
    const int facing = kernel::orientation(x, corner(0), corner(1), corner(2));
    sum += use.upwards() ? facing : -facing;
  }
  return sum;
}

std::set<std::uint32_t> visited(const Scene& scene, const Vec3& x, bool in_front) {
  const HalfSpace everything{{}, -1.0}, front = in_front ? everything : HalfSpace{{}, 0.0};
  const std::vector<HalfSpace> all{front, everything, everything, everything, everything};
  std::set<std::uint32_t> edges;
  scene_edges(scene).query(x, HalfSpaceGroups(all), [&](std::uint32_t edge, bool) { edges.insert(edge); });
  return edges;
}

void expect_all_silhouettes(const std::vector<std::vector<Vec3>>& faces) {
  const Scene scene = generate::build(scene_of(faces));
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Vec3 x{random.integer(-40, 40) / 16.0, random.integer(-40, 40) / 16.0, random.integer(-40, 40) / 16.0};
    const auto edges = visited(scene, x, true);
    for (std::uint32_t edge = 0; edge < scene_edges(scene).size(); ++edge) {
      EXPECT_TRUE(jump(scene, edge, x) == 0 || edges.contains(edge)) << "edge " << edge << " in round " << i;
    }
  }
}

TEST(SceneEdges, AreNotLeftOutIfTheyAreSilhouettes) {
  expect_all_silhouettes(sheet(12, hill));
  expect_all_silhouettes(sheet(4, [](double, double) { return 0.25; }));
  expect_all_silhouettes(moebius_strip(40));
  expect_all_silhouettes(box(0.0, 1.0));
  auto twice = sheet(6, hill);
  twice.insert(twice.end(), twice.begin(), twice.begin() + 30);
  expect_all_silhouettes(twice);
}

TEST(SceneEdges, AreMostlyLeftOutIfTheyAreSmooth) {
  const Scene scene = generate::build(scene_of(sheet(64, hill)));
  const std::size_t all = scene_edges(scene).size();
  const Vec3 above{0.1, 0.2, 9.0}, beside{5.0, 0.2, 0.5};
  EXPECT_LT(visited(scene, above, true).size(), all / 8);
  EXPECT_LT(visited(scene, beside, true).size(), all / 3);
  EXPECT_EQ(visited(scene, above, false).size(), all) << "edges of pieces that may be cut or left out are kept";
}

TEST(SceneEdges, OfFacesTurnedOverAreLeftOutAllTheSame) {
  auto faces = sheet(64, hill);
  for (std::size_t f = 0; f < faces.size(); f += 3) std::swap(faces[f][0], faces[f][1]);
  const Scene scene = generate::build(scene_of(faces));
  EXPECT_LT(visited(scene, {0.1, 0.2, 9.0}, true).size(), scene_edges(scene).size() / 8);
}

double saving(const std::vector<std::vector<Vec3>>& faces) {
  return edges_per_silhouette(generate::build(scene_of(faces)));
}

TEST(EdgesPerSilhouette, AreManyOnlyOfLargeMeshes) {
  std::vector<std::vector<Vec3>> boxes, soup;
  for (int i = 0; i < 200; ++i) {
    const auto next = box(2.0 * i, 1.0);
    boxes.insert(boxes.end(), next.begin(), next.end());
    soup.push_back({{2.0 * i, 0, 0}, {2.0 * i + 1, 0, 0}, {2.0 * i, 1, 0}});
  }
  EXPECT_EQ(saving(soup), 1.0);
  EXPECT_LT(saving(boxes), 2.0);
  for (int i = 0; i + 1 < 200; ++i) boxes.push_back({{2.0 * i + 1, 0, 0}, {2.0 * i + 2, 0, 0}, {2.0 * i + 1, -1, 0}});
  EXPECT_LT(saving(boxes), 3.0) << "boxes that hang together are not smooth";
  EXPECT_GT(saving(sheet(16, hill)), 4.0);
  EXPECT_GT(saving(sheet(64, hill)), 2.0 * saving(sheet(16, hill)));
}

}  // namespace
}  // namespace exactff
