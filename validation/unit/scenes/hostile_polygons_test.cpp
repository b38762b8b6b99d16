// Faces with tens of thousands of vertices in shapes that make simple algorithms quadratic, and random faces compared
// with simple algorithms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <numeric>
#include <random>

#include "scene/planar_region.h"
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

PlanePoints seen_from_above(const FacePoints& points) {
  return {points, kernel::ExactVec3{0, 0, 1}, PlanePoints::Projection::kAlongNormal};
}

bool parts(const PlanePoints& plane, std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
  return plane.orientation(a, b, c) * plane.orientation(a, b, d) < 0;
}

bool cross_properly(const FacePoints& points, const PlanePoints& plane, EdgeIndex a, EdgeIndex b) {
  const std::size_t a_end = next_in_ring(points, a), b_end = next_in_ring(points, b);
  return parts(plane, a, a_end, b, b_end) && parts(plane, b, b_end, a, a_end);
}

bool any_crossing(const FacePoints& points, const PlanePoints& plane) {
  for (EdgeIndex a = 0; a < points.size(); ++a) {
    for (EdgeIndex b = a + 1; b < points.size(); ++b) {
      if (cross_properly(points, plane, a, b)) return true;
    }
  }
  return false;
}

// The rule itself: repeatedly cut off the valid ear with the lowest index, judging each ear from scratch.
class PlainEarClipper {
 public:
  PlainEarClipper(const PlanePoints& plane, Ring index) : plane_(plane), index_(std::move(index)) {
    for (std::size_t i = 0; i < index_.size(); ++i) left_.push_back(i);
  }

  std::optional<std::vector<TriangleIndices>> run() {
    std::vector<TriangleIndices> triangles;
    while (left_.size() > 2) {
      const auto tip = lowest_ear();
      if (!tip) return std::nullopt;
      triangles.push_back(ear(*tip));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(*tip));
    }
    return triangles;
  }

 private:
  [[nodiscard]] std::size_t at(std::size_t place) const { return left_[place % left_.size()]; }
  [[nodiscard]] TriangleIndices ear(std::size_t place) const {
    return {at(place + left_.size() - 1), at(place), at(place + 1)};
  }
  [[nodiscard]] bool runs_left(const TriangleIndices& t) const { return plane_.orientation(t[0], t[1], t[2]) > 0; }

  [[nodiscard]] bool is_valid(std::size_t place) const {
    const auto [a, tip, c] = ear(place);
    if (!runs_left({a, tip, c})) return false;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const std::size_t v = at(i);
      if (v == a || v == tip || v == c || runs_left(ear(i))) continue;
      if (plane_.orientation(a, tip, v) >= 0 && plane_.orientation(tip, c, v) >= 0 && plane_.orientation(c, a, v) >= 0)
        return false;
    }
    return true;
  }

  [[nodiscard]] std::optional<std::size_t> lowest_ear() const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if ((!best || index_[at(i)] < index_[at(*best)]) && is_valid(i)) best = i;
    }
    return best;
  }

  const PlanePoints& plane_;
  const Ring index_;
  std::vector<std::size_t> left_;
};

// A vertex on an edge to which it does not belong.
bool touches_itself(const FacePoints& points, const PlanePoints& plane) {
  for (EdgeIndex edge = 0; edge < points.size(); ++edge) {
    const std::size_t end = next_in_ring(points, edge);
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (v == edge || v == end || plane.orientation(edge, end, v) != 0) continue;
      if (plane.compare(edge, v) == plane.compare(v, end)) return true;
    }
  }
  return false;
}

// Distinct points of a small lattice, ordered without crossings (each crossing is removed by reversing the points
// between). Straight corners are common.
struct LatticePolygon {
  Vertices vertices;
  Ring ring;
  FacePoints points;
};

LatticePolygon lattice_polygon(std::mt19937_64& random, std::size_t count, int side) {
  LatticePolygon polygon;
  Vertices lattice;
  for (int i = 0; i < side * side; ++i) lattice.push_back({double(i % side), double(i / side), 0.0});
  std::shuffle(lattice.begin(), lattice.end(), random);
  polygon.vertices.assign(lattice.begin(), lattice.begin() + static_cast<std::ptrdiff_t>(count));
  polygon.ring = whole_ring(count);
  for (int round = 0; round < 1000; ++round) {
    polygon.points = face_points(polygon.vertices, {polygon.ring});
    const auto crossing = find_crossing(polygon.points, seen_from_above(polygon.points));
    if (!crossing) break;
    std::reverse(polygon.ring.begin() + static_cast<std::ptrdiff_t>(crossing->first + 1),
                 polygon.ring.begin() + static_cast<std::ptrdiff_t>(crossing->second + 1));
  }
  if (kernel::sign(newell(polygon.points, 0, count).z) < 0) {
    std::reverse(polygon.ring.begin(), polygon.ring.end());
    polygon.points = face_points(polygon.vertices, {polygon.ring});
  }
  return polygon;
}

TEST(HostilePolygons, EarsAreThoseOfThePlainRule) {
  constexpr unsigned kSeed = 20;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  int cut = 0;
  for (int i = 0; i < 1500; ++i) {
    const LatticePolygon polygon = lattice_polygon(random, 5 + random() % 20, 5 + static_cast<int>(random() % 12));
    const PlanePoints plane = seen_from_above(polygon.points);
    if (touches_itself(polygon.points, plane)) continue;
    const auto expected = PlainEarClipper(plane, polygon.ring).run();
    EXPECT_EQ(clip_ears(plane, polygon.ring), expected) << "polygon " << i;
    if (expected) ++cut;
  }
  EXPECT_GT(cut, 100);
}

TEST(HostilePolygons, CrossingsAreFoundWhereThereAreAny) {
  constexpr unsigned kSeed = 21;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  int crossed = 0, clear = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::size_t count = 3 + random() % 8;
    const auto side = static_cast<double>(2 + random() % 6);
    Vertices vertices;
    for (std::size_t v = 0; v < count; ++v) {
      vertices.push_back({std::floor(side * static_cast<double>(random() % 1000) / 1000),
                          std::floor(side * static_cast<double>(random() % 1000) / 1000), 0.0});
    }
    const FacePoints points = face_points(vertices, {whole_ring(count)});
    const PlanePoints plane = seen_from_above(points);
    const auto found = find_crossing(points, plane);
    ASSERT_EQ(found.has_value(), any_crossing(points, plane)) << "polygon " << i;
    const bool truly = !found || cross_properly(points, plane, found->first, found->second);
    ASSERT_TRUE(truly) << "polygon " << i;
    ++(found ? crossed : clear);
  }
  EXPECT_GT(crossed, 300);
  EXPECT_GT(clear, 300);
}

// --- large shapes ---

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

TEST(HostilePolygons, PetalsAroundOneVertexAreCutInNearlyLinearTime) {
  constexpr std::uint32_t kPetals = 8000;
  Vertices vertices{{0, 0, 0}};
  Ring ring;
  for (std::uint32_t i = 0; i < 2 * kPetals; ++i) {
    const double angle = std::numbers::pi * i / kPetals;
    vertices.push_back({1000 * std::cos(angle), 1000 * std::sin(angle), 0});
    if (i % 2 == 0) ring.push_back(0);
    ring.push_back(i + 1);
  }
  const std::clock_t start = std::clock();
  const CutFace face = cut_face(vertices, {ring});
  EXPECT_FALSE(face.fault);
  EXPECT_EQ(face.parts.size(), kPetals);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  if (kAtFullSpeed) {
    EXPECT_LT(seconds, 1.0);
  }
}

}  // namespace
}  // namespace exactff
