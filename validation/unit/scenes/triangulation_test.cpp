#include "scene/triangulation.h"

#include "kernel/numbers.h"
#include "scene/face_points.h"
#include "support/test.h"

namespace exactff {
namespace {

using kernel::Rational;
using kernel::to_rational;
using Vector = std::array<Rational, 3>;
using Vertices = std::vector<Vec3>;

Vector exact(const Vec3& p) { return {to_rational(p.x), to_rational(p.y), to_rational(p.z)}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector newell(const Vertices& vertices, std::span<const std::uint32_t> ring) {
  Vector twice{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    twice = twice + cross(exact(vertices[ring[i]]), exact(vertices[ring[(i + 1) % ring.size()]]));
  }
  return twice;
}

// Every part turns left or goes straight on, seen along the normal, and its frame turns left.
void expect_convex(const Vertices& vertices, const CutFace& face, const Vector& normal) {
  const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return sgn(
        Rational(dot(normal, cross(exact(vertices[b]) - exact(vertices[a]), exact(vertices[c]) - exact(vertices[a])))));
  };
  for (const ConvexPart& part : face.parts) {
    const std::size_t n = part.corners.size();
    ASSERT_GE(n, 3U);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_GE(turn(part.corners[i], part.corners[(i + 1) % n], part.corners[(i + 2) % n]), 0);
    }
    EXPECT_GT(turn(part.frame[0], part.frame[1], part.frame[2]), 0);
  }
}

Ring iota_ring(std::uint32_t first, std::uint32_t count) {
  Ring ring(count);
  std::iota(ring.begin(), ring.end(), first);
  return ring;
}

// A polygon of the plane z = 0, lifted into a tilted plane with exactly representable coordinates.
Vertices tilted(const std::vector<std::pair<double, double>>& points) {
  Vertices vertices;
  for (const auto& [x, y] : points) vertices.push_back({x, y, 2 * x - y + 3});
  return vertices;
}

Vertices flat(const std::vector<std::pair<double, double>>& points) {
  Vertices vertices;
  for (const auto& [x, y] : points) vertices.push_back({x, y, 0.0});
  return vertices;
}

using Triangle = std::set<std::uint32_t>;
std::set<Triangle> triangles(const CutFace& face) {
  std::set<Triangle> result;
  for (const ConvexPart& part : face.parts) result.insert(Triangle(part.corners.begin(), part.corners.end()));
  return result;
}

TEST(CutFace, ConvexPlanarPolygonStaysOnePiece) {
  const Vertices vertices = tilted({{0, 0}, {2, 0}, {4, 0}, {4, 3}, {1, 5}});  // with a straight corner
  const CutFace face = cut_face(vertices, {iota_ring(0, 5)});
  EXPECT_EQ(face.shape, FaceShape::kPlanar);
  ASSERT_EQ(face.parts.size(), 1U);
  EXPECT_EQ(face.parts[0].corners, iota_ring(0, 5));
  expect_convex(vertices, face, newell(vertices, iota_ring(0, 5)));
}

TEST(CutFace, FacesWithoutAreaAreIgnored) {
  const Vertices vertices = flat({{0, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 0}});
  for (const Ring& ring :
       {Ring{}, Ring{0}, Ring{0, 1}, Ring{0, 1, 2}, Ring{0, 2, 1}, Ring{0, 4, 0}, Ring{0, 1, 3, 1}}) {
    const CutFace face = cut_face(vertices, {ring});
    EXPECT_EQ(face.shape, FaceShape::kZeroArea);
    EXPECT_FALSE(face.fault);
    EXPECT_TRUE(face.parts.empty());
    EXPECT_EQ(face.area, 0.0);
  }
  EXPECT_EQ(cut_face(vertices, {}).shape, FaceShape::kZeroArea);
}

struct BadFace {
  Vertices vertices;
  std::vector<Ring> rings;
  std::string what;
};

TEST(CutFace, UnusableFacesSayWhy) {
  const Vertices bow_tie = flat({{0, 0}, {4, 3}, {4, 0}, {0, 4}});
  const Vertices spatial = {{0, 0, 0}, {4, 0, 1}, {4, 4, 0}, {0, 4, 1}, {1, 1, 0}, {2, 1, 0}, {1, 2, 0}};
  const BadFace table[] = {
      {bow_tie, {iota_ring(0, 4)}, "crosses itself: edge 1-2 and edge 3-4 (vertex numbers) intersect"},
      {flat({{0, 0}, {1, 1}, {2, 2}, {2, 0}, {0, 2}}),
       {{0, 2, 3, 4}},
       "crosses itself: edge 1-3 and edge 4-5 (vertex numbers) intersect"},
      // Two lobes of opposite sense that share a vertex, with and without a Newell vector.
      {flat({{0, 0}, {1, 1}, {2, 0}, {2, 2}, {0, 2}}),
       {{0, 1, 3, 2, 1, 4}},
       "encloses area, but its Newell vector (area times normal) is zero"},
      {flat({{0, 0}, {1, 1}, {2, 0}, {2, 2}, {0, 3}}),
       {{0, 1, 3, 2, 1, 4}},
       "winds around a part of its interior twice, or in the opposite direction"},
      {flat({{0, 0}, {1, 0}, {0, 1}}),
       {{0, 1, 2, 0, 1, 2}},
       "winds around a part of its interior twice, or in the opposite direction"},
      {flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 1}, {6, 1}, {6, 2}}),
       {iota_ring(0, 4), {4, 5, 6}},
       "crosses itself: edge 2-3 and edge 5-6 (vertex numbers) intersect"},
      {flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {5, 1}, {6, 1}, {6, 2}}),
       {iota_ring(0, 4), {4, 5, 6}},
       "has a hole that reaches outside its outer ring"},
      {spatial, {iota_ring(0, 4), {4, 5, 6}}, "has holes, but its vertices are not exactly in one plane"},
      {{{0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {3, 3, 0.001}},
       {iota_ring(0, 4)},
       "crosses itself: edge 2-3 and edge 4-1 (vertex numbers) intersect"},
      // Three triangles at one vertex whose area vectors cancel.
      {{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {1, -1, 0}},
       {{0, 1, 2, 0, 2, 3, 0, 4, 2}},
       "has area, but its Newell vector (area times normal) is zero"},
  };
  for (const BadFace& entry : table) {
    const CutFace face = cut_face(entry.vertices, entry.rings);
    ASSERT_TRUE(face.fault) << entry.what;
    EXPECT_EQ(face.fault->what, entry.what);
    EXPECT_EQ(face.shape, FaceShape::kSkipped);
    EXPECT_TRUE(face.parts.empty());
  }
}

// The rule exactly as it is written, step by step, without optimisations.
std::set<Triangle> clip_by_the_book(const Vertices& vertices, Ring ring) {
  const Vector n = newell(vertices, ring);
  const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return sgn(
        Rational(dot(n, cross(exact(vertices[b]) - exact(vertices[a]), exact(vertices[c]) - exact(vertices[a])))));
  };
  std::set<Triangle> result;
  while (ring.size() > 2) {
    const std::size_t size = ring.size();
    std::size_t best = size;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t a = ring[(i + size - 1) % size], b = ring[i], c = ring[(i + 1) % size];
      const auto blocks = [&](std::uint32_t v) {
        return !(vertices[v] == vertices[a]) && !(vertices[v] == vertices[b]) && !(vertices[v] == vertices[c]) &&
               turn(a, b, v) >= 0 && turn(b, c, v) >= 0 && turn(c, a, v) >= 0;
      };
      const bool valid = turn(a, b, c) > 0 && std::none_of(ring.begin(), ring.end(), blocks);
      if (valid && (best == size || b < ring[best])) best = i;
    }
    if (best == size) return {};
    result.insert({ring[(best + size - 1) % size], ring[best], ring[(best + 1) % size]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return result;
}

// A star-shaped polygon with random radii, nearly in the plane z = 0, its indices shuffled.
struct Star {
  Vertices vertices;
  Ring ring;
};

Star random_star(std::mt19937& random, std::uint32_t size) {
  Star star;
  star.vertices.resize(size);
  star.ring = iota_ring(0, size);
  std::shuffle(star.ring.begin(), star.ring.end(), random);
  std::uniform_real_distribution<double> radius(0.3, 1.0), height(-0.01, 0.01);
  for (std::uint32_t i = 0; i < size; ++i) {
    const double angle = 2 * std::numbers::pi * i / size, r = radius(random);
    // A coarse lattice makes straight corners and vertices on diagonals likely.
    star.vertices[star.ring[i]] = {std::round(32 * r * std::cos(angle)), std::round(32 * r * std::sin(angle)),
                                   height(random)};
  }
  return star;
}

TEST(EarClipping, FollowsTheRuleByTheBookWhateverTheStartAndDirection) {
  std::mt19937 random(20240607);
  int compared = 0;
  for (int round = 0; round < 40; ++round) {
    Star star = random_star(random, 5 + static_cast<std::uint32_t>(round) % 9);
    const std::set<Triangle> expected = clip_by_the_book(star.vertices, star.ring);
    if (expected.empty()) continue;  // rounding to the lattice made the ring touch itself
    ++compared;
    for (std::size_t start = 0; start < star.ring.size(); start += 3) {
      std::rotate(star.ring.begin(), star.ring.begin() + 1, star.ring.end());
      EXPECT_EQ(triangles(cut_face(star.vertices, {star.ring})), expected) << "round " << round;
      const Ring reversed(star.ring.rbegin(), star.ring.rend());
      EXPECT_EQ(triangles(cut_face(star.vertices, {reversed})), expected) << "round " << round << ", reversed";
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(EarClipping, CornersThatCoincideOnlyAsSeenAlongTheNewellVectorMakeNoGap) {
  // The Newell vector is along (1, -1, 0), and so is the side between the first two corners. The triangle of these two
  // and the fourth corner is seen edge-on.
  const Vertices end_on = {{-1, 1, 2}, {1, -1, 2}, {-1, -1, 2}, {0, 0, 1}, {1, 1, 2}};
  const CutFace refused = cut_face(end_on, {{4, 0, 1, 2, 3}});
  ASSERT_TRUE(refused.fault);
  EXPECT_HOLDS(refused.fault->what, "coincide");
  EXPECT_TRUE(refused.parts.empty());

  // Corners that coincide in space do no harm, whether they share a vertex or not.
  Vertices lobes = flat({{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {0, 2}, {2, 2}});
  lobes[0].z = 0.125;
  const CutFace touching = cut_face(lobes, {{0, 1, 2, 3, 4, 5, 7, 6}});
  ASSERT_FALSE(touching.fault) << touching.fault->what;
  EXPECT_EQ(touching.parts.size(), 4U);
}

}  // namespace
}  // namespace exactff
