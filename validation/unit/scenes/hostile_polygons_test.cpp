// Faces with tens of thousands of vertices in shapes that make simple algorithms quadratic.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <numeric>

#include "scene/triangulation.h"
#include "unit/outside/sanitized.h"

namespace exactff {
namespace {

using Vertices = std::vector<Vec3>;

Ring whole_ring(std::size_t count) {
  Ring ring(count);
  std::iota(ring.begin(), ring.end(), 0U);
  return ring;
}

constexpr std::size_t kLarge = 30'000;

Vertices comb(double slant) {
  Vertices vertices{{0, -1, 0}, {kLarge / 2, -1, 0}};
  for (std::size_t i = kLarge / 2 - 1; i-- > 0;) {
    const auto x = static_cast<double>(i);
    vertices.push_back({x + 0.5 + 1000 * slant, 1000, 0});
    vertices.push_back({x, 0, 0});
  }
  return vertices;
}

Vertices spiral() {
  Vertices outer, inner;
  for (std::size_t i = 0; i < kLarge / 2; ++i) {
    const double angle = 0.05 * static_cast<double>(i), r = 1.0 + angle;
    inner.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    outer.push_back({(r + 2) * std::cos(angle), (r + 2) * std::sin(angle), 0});
  }
  outer.insert(outer.end(), inner.rbegin(), inner.rend());
  return outer;
}

Vertices star() {
  Vertices vertices;
  for (std::size_t i = 0; i < kLarge; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kLarge;
    const double r = i % 2 == 1 ? 1000.0 : 1.0 + static_cast<double>(i % 7);
    vertices.push_back({r * std::cos(angle), r * std::sin(angle), 0});
  }
  return vertices;
}

// Nested V-shaped teeth: the ear of each would contain all inner ones.
Vertices chevrons() {
  Vertices vertices;
  for (std::size_t i = 0; i < kLarge / 6; ++i) {
    const auto y = -static_cast<double>(i);
    for (const Vec3& p : {Vec3{-1000, 1000.3, 0}, Vec3{0, 0.3, 0}, Vec3{1000, 1000.3, 0}, Vec3{1000, 999.7, 0},
                          Vec3{0, -0.3, 0}, Vec3{-1000, 999.7, 0}}) {
      vertices.push_back({p.x, p.y + y, 0});
    }
  }
  vertices.push_back({-1001, 1000 - static_cast<double>(kLarge / 6), 0});
  vertices.push_back({-1001, 1001, 0});
  return vertices;
}

Vertices wavy(Vertices vertices) {
  for (Vec3& v : vertices) v.z = 0.001 * std::sin(12.9898 * v.x + 78.233 * v.y);
  return vertices;
}

// Sufficient for near-linear time, too little for quadratic time.
void expect_cut_quickly(const Vertices& vertices, FaceShape shape) {
  const std::clock_t start = std::clock();
  const CutFace face = cut_face(vertices, {whole_ring(vertices.size())});
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_FALSE(face.fault) << face.fault->what;
  EXPECT_EQ(face.shape, shape);
  std::size_t sides = 0;
  for (const ConvexPart& part : face.parts) sides += part.corners.size() - 2;
  EXPECT_EQ(sides, vertices.size() - 2);
  if (kAtFullSpeed) {
    EXPECT_LT(seconds, 2.5);
  }
}

class LargePolygon : public testing::TestWithParam<std::pair<std::string, Vertices (*)()>> {};

TEST_P(LargePolygon, PlanarIsCutInNearlyLinearTime) { expect_cut_quickly(GetParam().second(), FaceShape::kPlanar); }

TEST_P(LargePolygon, WavyIsCutInNearlyLinearTime) {
  expect_cut_quickly(wavy(GetParam().second()), FaceShape::kTriangulated);
}

INSTANTIATE_TEST_SUITE_P(HostilePolygons, LargePolygon,
                         testing::Values(std::pair(
                                             "Comb", +[] { return comb(0); }),
                                         std::pair(
                                             "SlantingComb", +[] { return comb(50); }),
                                         std::pair("Spiral", &spiral), std::pair("Star", &star),
                                         std::pair("Chevrons", &chevrons)),
                         [](const auto& shape) { return shape.param.first; });

}  // namespace
}  // namespace exactff
