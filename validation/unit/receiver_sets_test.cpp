// Receivers at corners, at the centres of faces, and at random.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "exactff/receiver.h"
#include "kernel/exact_vec.h"

namespace exactff {
namespace {

using Ring = std::vector<std::uint32_t>;

struct Polygon {
  std::vector<Vec3> vertices;
  std::vector<Ring> rings;
  std::string patch = "face";
};

Scene scene_of(const std::vector<Polygon>& polygons) {
  SceneBuilder builder("test");
  const MaterialId material = builder.add_material({});
  for (const Polygon& polygon : polygons) {
    const auto first = static_cast<std::uint32_t>(builder.vertex_count());
    for (const Vec3& v : polygon.vertices) builder.add_vertex(v);
    std::vector<Ring> rings = polygon.rings;
    for (Ring& ring : rings) {
      for (std::uint32_t& v : ring) v += first;
    }
    builder.add_face(builder.patch(polygon.patch), material, std::move(rings));
  }
  return builder.build();
}

// One ring through all of the points.
Polygon polygon(std::vector<Vec3> vertices, std::string patch = "face") {
  Ring ring(vertices.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<std::uint32_t>(i);
  return {std::move(vertices), {std::move(ring)}, std::move(patch)};
}

std::vector<FaceId> every_face(const Scene& scene) {
  std::vector<FaceId> faces;
  for (std::size_t i = 0; i < scene.faces().size(); ++i) faces.push_back(FaceId(static_cast<std::uint32_t>(i)));
  return faces;
}

std::vector<Receiver> vertices_of(const Scene& scene) { return vertex_receivers(scene, every_face(scene)); }
std::vector<Receiver> centres_of(const Scene& scene) { return centre_receivers(scene, every_face(scene)); }
std::vector<Receiver> samples_of(const Scene& scene, std::uint64_t count, std::uint64_t seed = 1) {
  return sample_receivers(scene, every_face(scene), count, seed);
}
Vec3 centre_of(const Polygon& face) { return centres_of(scene_of({face})).at(0).point; }

std::vector<std::string> ids_of(const std::vector<Receiver>& receivers) {
  std::vector<std::string> ids;
  for (const Receiver& receiver : receivers) ids.push_back(receiver.id);
  return ids;
}

bool all_differ(std::vector<std::string> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) == ids.end();
}

// Exact test for a point in the plane z = 0: strictly inside a convex piece of the face.
bool strictly_in_a_piece(const Scene& scene, FaceId face, const Vec3& p) {
  const auto left_of = [&](const Vec3& a, const Vec3& b) {
    return kernel::orientation(a, b, p, {a.x, a.y, a.z + 1}) > 0;
  };
  return std::ranges::any_of(scene.pieces_of(face), [&](const Piece& piece) {
    const auto corners = scene.corners(piece);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!left_of(scene.vertices()[corners[i]], scene.vertices()[corners[(i + 1) % corners.size()]])) return false;
    }
    return true;
  });
}

// A square of side 3 with a hole: the square in its middle is missing.
Polygon window_frame() {
  return {{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}},
          {{0, 1, 2, 3}, {4, 5, 6, 7}}};
}

// Three unit squares.
Polygon letter_l() { return polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}); }

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

TEST(VertexReceivers, CornersOfHolesFollowThoseOfTheOuterRing) {
  const auto receivers = vertices_of(scene_of({window_frame()}));
  ASSERT_EQ(receivers.size(), 8U);
  EXPECT_EQ(receivers[4].point, (Vec3{1, 1, 0}));
  EXPECT_EQ(receivers[4].id, "face:1/5");
}

TEST(VertexReceivers, APositionVisitedTwiceHasOne) {
  const auto receivers = vertices_of(scene_of({bow_tie()}));
  EXPECT_EQ(ids_of(receivers), (std::vector<std::string>{"face:1/1", "face:1/2", "face:1/3", "face:1/4", "face:1/6"}));
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

TEST(CentreReceivers, AnLInASlantedPlaneHasItsCentroidToo) {
  // The same L along (2, 1, 2) and (-2, 2, 1), which are perpendicular: 5/6 of their sum is (0, 5/2, 5/2).
  const auto at = [](double s, double t) { return Vec3{2 * s - 2 * t, s + 2 * t, 2 * s + t}; };
  EXPECT_EQ(centre_of(polygon({at(0, 0), at(2, 0), at(2, 1), at(1, 1), at(1, 2), at(0, 2)})), (Vec3{0, 2.5, 2.5}));
}

TEST(CentreReceivers, ACentroidInAHoleIsReplacedByAPointInside) {
  const Scene scene = scene_of({window_frame()});
  const Vec3 centre = centres_of(scene).at(0).point;
  EXPECT_NE(centre, (Vec3{1.5, 1.5, 0}));
  EXPECT_TRUE(strictly_in_a_piece(scene, FaceId{0}, centre));
}

TEST(CentreReceivers, ACentroidOutsideAUIsReplacedByAPointInside) {
  const Scene scene =
      scene_of({polygon({{0, 0, 0}, {10, 0, 0}, {10, 9, 0}, {9, 9, 0}, {9, 1, 0}, {1, 1, 0}, {1, 9, 0}, {0, 9, 0}})});
  EXPECT_TRUE(strictly_in_a_piece(scene, FaceId{0}, centres_of(scene).at(0).point));
}

TEST(CentreReceivers, ACentroidOnTheOutlineIsReplacedByAPointInside) {
  const Vec3 centre = centre_of(bow_tie());  // its centroid is the corner where the triangles touch
  EXPECT_EQ(std::abs(centre.x), 4.0 / 3.0);
  EXPECT_EQ(centre.y, 0.0);
}

TEST(CentreReceivers, AKeyholeIsLikeAHole) {
  const Polygon keyhole = {window_frame().vertices, {{0, 1, 2, 3, 0, 4, 7, 6, 5, 4}}};
  const Scene scene = scene_of({keyhole});
  EXPECT_TRUE(strictly_in_a_piece(scene, FaceId{0}, centres_of(scene).at(0).point));
}

TEST(CentreReceivers, AHoleThatMissesTheCentroidShiftsIt) {
  // A square of side 4 at the origin without half a unit of area at (5/4, 0): (0 - 1/2 * 5/4) / (16 - 1/2).
  const Polygon holed = {
      {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {1, -0.5, 0}, {1.5, -0.5, 0}, {1.5, 0.5, 0}, {1, 0.5, 0}},
      {{0, 1, 2, 3}, {4, 5, 6, 7}}};
  EXPECT_EQ(centre_of(holed), (Vec3{-0.625 / 15.5, 0, 0}));
}

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

TEST(CentreReceivers, ANonPlanarQuadrilateralHasTheCentreOfItsBilinearPatch) {
  const Polygon saddle = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}});
  EXPECT_EQ(centre_of(saddle), (Vec3{0.5, 0.5, 0.25}));
}

TEST(CentreReceivers, ANonPlanarFaceIsWeighedAsSeenAlongItsNewellVector) {
  // An L with one corner lifted, and the opposite corner lifted by the same amount; its view from above is unchanged.
  Polygon bent = letter_l();
  bent.vertices[2].z = bent.vertices[4].z = 0.125;
  bent.vertices[3].z = 0.25;
  const Scene scene = scene_of({bent});
  ASSERT_EQ(scene.faces()[0].shape, FaceShape::kTriangulated);
  const Receiver centre = centres_of(scene).at(0);
  EXPECT_EQ(centre.on, std::vector{FaceId{0}});
  EXPECT_NEAR(centre.point.x, 5.0 / 6.0, 0.05);
  EXPECT_NEAR(centre.point.y, 5.0 / 6.0, 0.05);
  EXPECT_GT(centre.point.z, 0.0);
  EXPECT_LT(centre.point.z, 0.25);
}

TEST(CentreReceivers, HugeAndTinyFacesKeepTheirCentres) {
  const double h = 0x1p1020, t = 0x1p-1060;
  EXPECT_EQ(centre_of(polygon({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}})), (Vec3{0, 0, 0}));
  EXPECT_EQ(centre_of(polygon({{0, 0, 0}, {t, 0, 0}, {t, t, 0}, {0, t, 0}})), (Vec3{t / 2, t / 2, 0}));
}

// --- Samples -------------------------------------------------------------------------------------------

// Pearson's statistic of the counts lies within the central 1 - 2e-5 of its distribution. The expected counts here are
// in the hundreds, where that is chi-squared to far better than the bounds are wide. Both ends matter: too even is not
// random either.
void expect_shares(const std::vector<std::uint64_t>& counts, const std::vector<double>& shares) {
  ASSERT_EQ(counts.size(), shares.size());
  double count = 0.0, whole = 0.0, statistic = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    count += static_cast<double>(counts[i]);
    whole += shares[i];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = count * shares[i] / whole;
    ASSERT_GT(expected, 100.0);
    statistic += (static_cast<double>(counts[i]) - expected) * (static_cast<double>(counts[i]) - expected) / expected;
  }
  const boost::math::chi_squared distribution(static_cast<double>(counts.size() - 1));
  EXPECT_LT(statistic, quantile(complement(distribution, 1e-5)));
  EXPECT_GT(statistic, quantile(distribution, 1e-5));
}

std::vector<std::uint64_t> counts_by(const std::vector<Receiver>& receivers, std::size_t cells,
                                     const std::function<std::size_t(const Receiver&)>& cell_of) {
  std::vector<std::uint64_t> counts(cells, 0);
  for (const Receiver& receiver : receivers) ++counts.at(cell_of(receiver));
  return counts;
}

TEST(SampleReceivers, AreTheSameOnEveryMachine) {
  // From a separate computation with Python's integers and a separate implementation of Matsumoto and Nishimura's
  // generator.
  const Scene scene =
      scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), polygon({{0, 0, 2}, {3, 0, 2.5}, {3, 1, 2.5}, {0, 1, 2}})});
  const auto receivers = samples_of(scene, 6, 42);
  EXPECT_EQ(receivers[0].point, (Vec3{0x1.4babd9a0b0d7cp+1, 0x1.ebc13264515e2p-1, 0x1.37474ef01d795p+1}));
  EXPECT_EQ(receivers[1].point, (Vec3{0x1.187273d8bae7fp-2, 0x1.8fa32b81059dfp-2, 0}));
  EXPECT_EQ(receivers[4].point, (Vec3{0x1.0f714d13ed6aep-1, 0x1.c8e7d9eeb4942p-2, 0}));
  EXPECT_EQ(receivers[5].point, (Vec3{0x1.03ad44e185a1cp+1, 0x1.d9bd4cdf31f72p-1, 0x1.2b478b7aeb9afp+1}));
  EXPECT_EQ(receivers[4].on, std::vector{FaceId{0}});
  EXPECT_EQ(receivers[5].on, std::vector{FaceId{1}});
}

TEST(SampleReceivers, FacesAreChosenByTheirArea) {
  // Triangles in many planes, with areas of 1/2 |a x b| that have no common unit.
  std::vector<Polygon> faces;
  std::vector<double> areas;
  for (int i = 1; i <= 12; ++i) {
    const double a = 1.0 + i % 5, b = 0.5 * i, c = 0.25 * (i % 3), d = 7.0 * i;
    faces.push_back(polygon({{d, 0, 0}, {d + a, 0, c}, {d, b, 1}}));
    areas.push_back(0.5 * std::sqrt(c * b * (c * b) + a * a + a * b * (a * b)));
  }
  const Scene scene = scene_of(faces);
  const auto receivers = samples_of(scene, 20000);
  expect_shares(counts_by(receivers, faces.size(), [](const Receiver& r) { return index_of(r.on.front()); }), areas);
}

TEST(SampleReceivers, ATriangleIsFilledEvenly) {
  // 64 congruent triangles: by column and row, and by which half of the little square.
  const Scene scene = scene_of({polygon({{0, 0, 0}, {8, 0, 0}, {0, 8, 0}})});
  std::map<std::array<int, 3>, std::uint64_t> cells;
  for (const Receiver& r : samples_of(scene, 20000)) {
    const double column = std::floor(r.point.x), row = std::floor(r.point.y);
    const bool upper = r.point.x - column + (r.point.y - row) > 1.0;
    ++cells[{static_cast<int>(column), static_cast<int>(row), upper ? 1 : 0}];
  }
  ASSERT_EQ(cells.size(), 64U);
  std::vector<std::uint64_t> counts;
  for (const auto& [cell, count] : cells) counts.push_back(count);
  expect_shares(counts, std::vector<double>(64, 1.0));
}

std::size_t cell_of_three(const Receiver& r) {
  return static_cast<std::size_t>(std::floor(r.point.x)) + 3 * static_cast<std::size_t>(std::floor(r.point.y));
}

TEST(SampleReceivers, AHoleStaysEmptyAndTheRestIsFilledEvenly) {
  const auto receivers = samples_of(scene_of({window_frame()}), 8000);
  auto counts = counts_by(receivers, 9, cell_of_three);
  EXPECT_EQ(counts[4], 0U);
  counts.erase(counts.begin() + 4);
  expect_shares(counts, std::vector<double>(8, 1.0));
}

TEST(SampleReceivers, AFaceThatIsNotConvexIsFilledEvenly) {
  const Scene scene = scene_of({letter_l()});
  const auto receivers = samples_of(scene, 6000);
  for (const Receiver& r : receivers) EXPECT_FALSE(r.point.x >= 1 && r.point.y >= 1);
  expect_shares(
      counts_by(receivers, 3, [](const Receiver& r) { return r.point.x >= 1   ? 1U
                                                             : r.point.y >= 1 ? 2U
                                                                              : 0U; }),
      {1, 1, 1});
}

TEST(SampleReceivers, LieStrictlyInsideTheFaceTheyRemember) {
  const Scene scene = scene_of({window_frame(), letter_l(), polygon({{0, 0, 0}, {1, 0, 0}, {0.3, 0x1p-30, 0}})});
  std::set<std::uint32_t> seen;
  for (const Receiver& r : samples_of(scene, 2000)) {
    ASSERT_FALSE(r.on.empty());
    EXPECT_EQ(r.normal, scene.face(r.on.front()).newell);
    if (index_of(r.on.front()) == 2) continue;  // a sliver: rounding may move points onto its edge
    EXPECT_GT(r.point.x, 0.0);
    EXPECT_GT(r.point.y, 0.0);
    EXPECT_EQ(r.point.z, 0.0);
    seen.insert(static_cast<std::uint32_t>(r.on.front()));
  }
  EXPECT_EQ(seen.size(), 2U);
}

TEST(SampleReceivers, OfASliverLieInItToTheLastBit) {
  // In the plane y = 0 the two short coordinates differ by an ulp: every sample is one of the corners' values.
  const double next = std::nextafter(1.0, 2.0);
  const Scene scene = scene_of({polygon({{0, 0, 1}, {1, 0, next}, {1, 0, 1}})});
  for (const Receiver& r : samples_of(scene, 200)) {
    EXPECT_TRUE(r.point.z == 1.0 || r.point.z == next);
    EXPECT_GE(r.point.x, 0.0);
    EXPECT_LE(r.point.x, 1.0);
  }
}

TEST(SampleReceivers, ASeedAlwaysGivesTheSameAndTheFirstOnesDoNotDependOnTheirNumber) {
  const Scene scene = scene_of({window_frame(), letter_l()});
  const auto few = samples_of(scene, 10, 7), many = samples_of(scene, 100, 7), others = samples_of(scene, 10, 8);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].point, many[i].point);
    EXPECT_EQ(few[i].on, many[i].on);
    EXPECT_EQ(few[i].id, many[i].id);
    EXPECT_NE(few[i].point, others[i].point);
  }
}

TEST(SampleReceivers, IdsCountFromOne) {
  const auto ids = ids_of(samples_of(scene_of({letter_l(), window_frame()}), 12));
  EXPECT_EQ(ids.front(), "1");
  EXPECT_EQ(ids.back(), "12");
  EXPECT_TRUE(all_differ(ids));
}

TEST(SampleReceivers, MagnitudesMayBeAnywhere) {
  const double t = 1e-300, h = 1e300;
  const Polygon tiny = polygon({{0, 0, 0}, {t, 0, 0}, {0, t, 0}}), huge = polygon({{0, 0, 5}, {h, 0, 5}, {0, h, 5}});
  for (const Receiver& r : samples_of(scene_of({tiny, huge}), 100)) EXPECT_EQ(r.on, std::vector{FaceId{1}});
  for (const Receiver& r : samples_of(scene_of({tiny}), 100)) {
    EXPECT_GT(r.point.x, 0.0);
    EXPECT_LT(r.point.x, t);
    EXPECT_NE(r.normal, (Vec3{}));
  }
}

TEST(SampleReceivers, FacesFarApartInScaleKeepTheirShares) {
  // Faces of equal area: a square of side 1 and a strip of 2^500 by 2^-500.
  const double wide = 0x1p500, narrow = 0x1p-500;
  const Scene scene = scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
                                polygon({{0, 0, 1}, {wide, 0, 1}, {wide, narrow, 1}, {0, narrow, 1}})});
  expect_shares(counts_by(samples_of(scene, 2000), 2, [](const Receiver& r) { return index_of(r.on.front()); }),
                {1, 1});
}

TEST(SampleReceivers, APowerOfTwoScalesThem) {
  std::vector<Polygon> faces = {letter_l(), polygon({{0, 0, 0}, {3, 0, 0}, {0, 1, 0}}),
                                polygon({{0, 0, 0.3}, {1, 0.1, 0}, {0, 1, 0.7}})};
  const auto before = samples_of(scene_of(faces), 50);
  for (Polygon& face : faces) {
    for (Vec3& v : face.vertices) v = {v.x * 0x1p-301, v.y * 0x1p-301, v.z * 0x1p-301};
  }
  const auto after = samples_of(scene_of(faces), 50);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vec3& p = before[i].point;
    EXPECT_EQ(after[i].on, before[i].on);
    EXPECT_EQ(after[i].point, (Vec3{p.x * 0x1p-301, p.y * 0x1p-301, p.z * 0x1p-301}));
  }
}

TEST(SampleReceivers, OfANonPlanarFaceLieOnItsTriangles) {
  const Scene scene = scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}})});
  ASSERT_EQ(scene.faces()[0].shape, FaceShape::kTriangulated);
  for (const Receiver& r : samples_of(scene, 200)) {
    // The diagonal from the origin: below it z = y, above it z = x.
    EXPECT_NEAR(r.point.z, std::min(r.point.x, r.point.y), 0x1p-52);
    EXPECT_EQ(r.normal, scene.faces()[0].newell);
  }
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.problems().front().message();
  }
  return "not refused";
}

TEST(SampleReceivers, ImpossibleCountsAreRefused) {
  const Scene scene = scene_of({letter_l()});
  EXPECT_EQ(refusal([&] { (void)samples_of(scene, 0); }),
            "0 samples (the number of receivers must be between 1 and 4194304); give at least 1");
  EXPECT_EQ(refusal([&] { (void)samples_of(scene, 4194305); }),
            "4194305 samples (the number of receivers must be between 1 and 4194304); use fewer samples");
}

TEST(SampleReceivers, WithoutAreaThereIsNothingToSample) {
  const Scene scene = scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})});
  EXPECT_EQ(refusal([&] { (void)samples_of(scene, 5); }),
            "no face to sample has area (samples are distributed by area); choose another patch");
}

}  // namespace
}  // namespace exactff
