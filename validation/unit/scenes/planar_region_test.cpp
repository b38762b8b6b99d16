// Random rings on a small lattice, where edges often overlap, touch and pass through vertices. The result is compared
// with the definition: winding numbers and parities at points that lie on no edge.
#include "scene/planar_region.h"

#include "scene/triangulation.h"
#include "support/test.h"

namespace exactff {
namespace {

struct Point {
  long x = 0;
  long y = 0;
};

long turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

using Polygon = std::vector<Point>;

// How often the polygon winds counter-clockwise around a point that is on none of its edges.
int winding_number(const Polygon& polygon, const Point& p) {
  int winding = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a.y <= p.y && b.y > p.y && turn(a, b, p) > 0) ++winding;
    if (b.y <= p.y && a.y > p.y && turn(a, b, p) < 0) --winding;
  }
  return winding;
}

bool cross_properly(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto sign = [](long v) { return v > 0 ? 1 : v < 0 ? -1 : 0; };
  return sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 && sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0;
}

bool any_crossing(const std::vector<Polygon>& rings) {
  std::vector<std::pair<Point, Point>> edges;
  for (const Polygon& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) edges.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
  }
  for (const auto& [a, b] : edges) {
    for (const auto& [c, d] : edges) {
      if (cross_properly(a, b, c, d)) return true;
    }
  }
  return false;
}

long twice_area(const Polygon& ring) {
  long sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

constexpr long kUnit = 1009;  // lattice spacing; a prime, so that the probe points lie on no lattice line
constexpr long kSize = 4;

std::vector<Point> probes() {
  std::vector<Point> points;
  for (long i = 0; i < 3 * (kSize - 1); ++i) {
    for (long j = 0; j < 3 * (kSize - 1); ++j)
      points.push_back({kUnit * i / 3 + 101 + 7 * j, kUnit * j / 3 + 53 + 11 * i});
  }
  return points;
}

Polygon random_ring(std::mt19937& random, std::size_t size) {
  Polygon ring;
  while (ring.size() < size) {
    const Point p{static_cast<long>(random() % kSize) * kUnit, static_cast<long>(random() % kSize) * kUnit};
    const bool repeated = !ring.empty() && ring.back().x == p.x && ring.back().y == p.y;
    if (!repeated) ring.push_back(p);
  }
  return ring;
}

CutFace cut(const std::vector<Polygon>& rings) {
  std::vector<Vec3> vertices;
  std::vector<Ring> indices;
  for (const Polygon& ring : rings) {
    indices.emplace_back();
    for (const Point& p : ring) {
      indices.back().push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back({static_cast<double>(p.x), static_cast<double>(p.y), 0.0});
    }
  }
  return cut_face(vertices, indices);
}

Polygon corners_of(const ConvexPart& part, const std::vector<Polygon>& rings) {
  Polygon all;
  for (const Polygon& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
  Polygon corners;
  for (const std::uint32_t v : part.corners) corners.push_back(all[v]);
  return corners;
}

// The definition, evaluated at the probe points.
struct Truth {
  bool ambiguous = false;  // a part is wound around twice or in the opposite direction
  bool hole_outside = false;
  std::vector<int> inside;
};

Truth truth(const std::vector<Polygon>& rings, const std::vector<Point>& points) {
  Truth result;
  const int front = twice_area(rings[0]) > 0 ? 1 : -1;
  for (const Point& p : points) {
    const int winding = front * winding_number(rings[0], p);
    int holes = 0;
    for (std::size_t r = 1; r < rings.size(); ++r) holes += winding_number(rings[r], p);
    result.ambiguous |= winding < 0 || winding > 1;
    result.hole_outside |= winding == 0 && holes % 2 != 0;
    result.inside.push_back(winding == 1 && holes % 2 == 0 ? 1 : 0);
  }
  return result;
}

// Turns left or goes straight on at every corner, never back, and winds around once.
bool is_strictly_convex_ring(const Polygon& ring) {
  int changes = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()], &c = ring[(i + 2) % ring.size()];
    const long ahead = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y);
    if (turn(a, b, c) < 0 || (turn(a, b, c) == 0 && ahead <= 0)) return false;
    const auto upward = [](const Point& p, const Point& q) { return q.y != p.y ? q.y > p.y : q.x > p.x; };
    changes += upward(a, b) != upward(b, c) ? 1 : 0;
  }
  return changes == 2;
}

class RandomRings : public testing::TestWithParam<bool> {};

TEST_P(RandomRings, AreCutAsWindingNumbersSay) {
  std::mt19937 random(20250101);
  const std::vector<Point> points = probes();
  int accepted = 0, refused = 0, crossings = 0;
  for (int round = 0; round < 800; ++round) {
    std::vector<Polygon> rings = {random_ring(random, 3 + random() % 5)};
    if (GetParam()) {
      rings[0] = {{0, 0}, {3 * kUnit, 0}, {3 * kUnit, (2 + round % 2) * kUnit}, {0, 3 * kUnit}};
      rings.push_back(random_ring(random, 3 + random() % 3));
      if (round % 3 == 0) rings.push_back(random_ring(random, 3));
    }
    const CutFace face = cut(rings);
    if (twice_area(rings[0]) == 0) continue;
    const Truth expected = truth(rings, points);
    if (expected.ambiguous || expected.hole_outside) {
      ASSERT_TRUE(face.fault) << "round " << round;
      ++refused;
    }
    if (face.fault) continue;
    // Edges may cross only at a vertex, and the winding numbers must stay 0 and 1.
    crossings += any_crossing(rings) ? 1 : 0;
    ++accepted;
    for (const ConvexPart& part : face.parts) {
      Polygon corners = corners_of(part, rings);
      if (twice_area(rings[0]) < 0) std::reverse(corners.begin(), corners.end());  // seen from the back
      ASSERT_TRUE(is_strictly_convex_ring(corners)) << "round " << round;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      int covered = 0;
      for (const ConvexPart& part : face.parts) {
        covered += winding_number(corners_of(part, rings), points[i]) != 0 ? 1 : 0;
      }
      ASSERT_EQ(covered, expected.inside[i]) << "round " << round << ", probe " << i;
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(refused, 5);
  EXPECT_LT(crossings, accepted / 50);
}

INSTANTIATE_TEST_SUITE_P(PlanarRegion, RandomRings, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "WithHoles" : "Alone"; });

}  // namespace
}  // namespace exactff
