// Finds closed surfaces; removing their back faces changes no result.
#include "scene/closed_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/filter.h"
#include "support/solve.h"

namespace exactff {
namespace {

using generate::PlainScene;
using generate::Random;
using RingOfFace = std::vector<std::uint32_t>;

// Source [-1,1]^2 at z = 1 facing down, receiver at the origin facing up.
PlainScene scene_with_source() {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}});
  return scene;
}

// Adds vertices, and faces whose indices count from the first of these vertices.
void add_solid(PlainScene& scene, const std::vector<Vec3>& vertices, std::vector<RingOfFace> faces) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
  for (RingOfFace& ring : faces) {
    for (std::uint32_t& corner : ring) corner += first;
    scene.patch("o" + std::to_string(scene.patches.size())).faces.push_back({{ring}});
  }
}

const std::vector<RingOfFace> kTetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
const std::vector<RingOfFace> kOctahedron{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
const std::vector<Vec3> kCorners{{0, 0, 0.5}, {0.25, 0, 0.5}, {0, 0.25, 0.5}, {0, 0, 0.75}};

std::vector<RingOfFace> reversed(std::vector<RingOfFace> faces) {
  for (RingOfFace& ring : faces) std::reverse(ring.begin(), ring.end());
  return faces;
}

std::size_t count_of(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  return closed_surfaces(scene).surfaces().size();
}

TEST(ClosedSurfaces, AreTellableByTheirEdges) {
  PlainScene scene = scene_with_source();
  EXPECT_EQ(count_of(scene), 0U);
  add_solid(scene, kCorners, kTetrahedron);
  EXPECT_EQ(count_of(scene), 1U);
  PlainScene open = scene;
  open.patches.pop_back();
  EXPECT_EQ(count_of(open), 0U);
  PlainScene turned = scene;
  std::ranges::reverse(turned.patches.back().faces.front().rings.front());
  EXPECT_EQ(count_of(turned), 0U);
}

// Holes in one plane: the face of a tetrahedron, and one corner of an octahedron.
TEST(ClosedSurfaces, WithHolesInOnePlaneAreToldOnRequest) {
  const auto rims_of = [](const PlainScene& plain) {
    const Scene scene = generate::build(plain);
    const ClosedSurfaces found(scene, ClosedSurfaces::Edges::kCutAtJunctions);
    std::vector<std::optional<ClosedSurface::Rim>> rims;
    for (const ClosedSurface& surface : found.surfaces()) rims.push_back(surface.rim);
    EXPECT_EQ(closed_surfaces(scene).surfaces().size(), 0U) << "only on request";
    return rims;
  };
  PlainScene tetrahedron;
  add_solid(tetrahedron, kCorners, {kTetrahedron.begin() + 1, kTetrahedron.end()});
  const auto rims = rims_of(tetrahedron);
  ASSERT_EQ(rims.size(), 1U);
  ASSERT_TRUE(rims.front());
  EXPECT_EQ(rims.front()->edges.size(), 3U);
  const auto& [a, b, c] = rims.front()->plane;
  EXPECT_GT(kernel::PlaneThrough(a, b, c).side_of(kCorners.back()), 0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(kernel::PlaneThrough(a, b, c).side_of(kCorners[i]), 0);

  const std::vector<Vec3> corners{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  PlainScene half, two_holes, bent;
  add_solid(half, corners, {kOctahedron.begin(), kOctahedron.begin() + 4});
  EXPECT_EQ(rims_of(half).size(), 1U);
  add_solid(two_holes, corners, {kOctahedron.begin() + 1, kOctahedron.end() - 1});
  EXPECT_EQ(rims_of(two_holes).size(), 0U) << "their planes differ";
  add_solid(bent, corners, {kOctahedron.begin() + 2, kOctahedron.end()});
  EXPECT_EQ(rims_of(bent).size(), 0U) << "the hole is bent";
  PlainScene sheet;
  add_solid(sheet, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
            {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  EXPECT_EQ(rims_of(sheet).size(), 0U) << "it lies in the plane of its edges";
}

TEST(ClosedSurfaces, AreToldByPositionsAndKeptApart) {
  PlainScene scene = scene_with_source();
  for (const RingOfFace& face : kTetrahedron) {  // no two faces have a vertex in common
    add_solid(scene, {kCorners[face[0]], kCorners[face[1]], kCorners[face[2]]}, {{0, 1, 2}});
  }
  std::vector<Vec3> elsewhere = kCorners;
  for (Vec3& v : elsewhere) v.z += 2.0;
  add_solid(scene, elsewhere, reversed(kTetrahedron));
  const Scene built = generate::build(scene);
  const ClosedSurfaces& found = closed_surfaces(built);
  ASSERT_EQ(found.surfaces().size(), 2U);
  EXPECT_FALSE(found.surfaces()[0].turned_inside_out);
  EXPECT_TRUE(found.surfaces()[1].turned_inside_out);
  EXPECT_EQ(found.surfaces()[0].box.low, (Vec3{0, 0, 0.5}));
  EXPECT_EQ(found.surfaces()[1].box.high, (Vec3{0.25, 0.25, 2.75}));
  EXPECT_EQ(found.of_piece(0), ClosedSurfaces::kNone);
  EXPECT_EQ(found.of_piece(1), 0U);
  EXPECT_EQ(found.of_piece(5), 1U);
}

TEST(ClosedSurfaces, WithAFinAreOpen) {
  PlainScene scene = scene_with_source();
  add_solid(scene, kCorners, kTetrahedron);
  add_solid(scene, {{0, 0, 0.5}, {0.25, 0, 0.5}, {0, 0.25, 0.5}}, {{0, 1, 2}});  // the first face, reversed
  EXPECT_EQ(count_of(scene), 0U);
  PlainScene loose = scene_with_source();
  add_solid(loose, kCorners, kTetrahedron);
  add_solid(loose, {{0, 0, 0.5}, {0.25, 0, 0.5}, {0, 0, 0}}, {{0, 1, 2}});  // an unshared corner: certainly open
  EXPECT_EQ(count_of(loose), 1U);
}

std::uint64_t pairs_of(const PlainScene& scene) {
  return validation::solve_by(Engine::kEdges, scene).planes.at(0).pairs;
}

// A fin is left out, also if a transparent face shares its tip.
TEST(ClosedSurfaces, WithAFinUnderGlassAreClosed) {
  PlainScene plain;
  add_solid(plain, kCorners, kTetrahedron);
  plain.add_ring(plain.patch("fin"), {kCorners[0], kCorners[1], {0.125, -0.5, 0.5}});
  plain.add_ring(plain.patch("glass"), {{0.125, -0.5, 0.5}, {1, -0.5, 0.5}, {1, -0.5, 0.75}});
  const Scene scene = generate::build(plain);
  const Scene with_glass = scene.with_transparent(std::vector{scene.select("glass")});
  EXPECT_EQ(closed_surfaces(with_glass).surfaces().size(), 1U);
}

TEST(ClosedSurfaces, SpareTheirBacks) {
  PlainScene scene = scene_with_source();
  add_solid(scene, kCorners, kTetrahedron);
  PlainScene open = scene;
  open.patches.push_back(open.patches.back());  // one face twice
  open.patches.back().name = "again";
  EXPECT_LT(pairs_of(scene), pairs_of(open));
  EXPECT_EQ(validation::solve(scene).value, validation::solve(open).value);
}

void expect_agreement(const PlainScene& plain, const Receiver& receiver, const ExactOptions& options = {}) {
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select("source"));
  ExactOptions both = options;
  both.engine = Engine::kBoth;
  both.visible_fraction = true;
  EXPECT_NO_THROW((void)exact_form_factor(scene, receiver, source, both));
}

TEST(ClosedSurfaces, HideByTheirBacksWhoeverIsInside) {
  PlainScene scene = scene_with_source();
  add_solid(scene, {{-4, -4, -1}, {4, -4, -1}, {0, 4, -1}, {0, 0, 0.5}}, kTetrahedron);
  EXPECT_EQ(validation::solve(scene).status, Status::kZero);
  expect_agreement(scene, generate::receiver_of(scene));
}

TEST(ClosedSurfaces, HideByTheirFrontsASourceInside) {
  for (const bool inside_out : {false, true}) {
    PlainScene scene = scene_with_source();
    add_solid(scene, {{-4, -4, 0.5}, {4, -4, 0.5}, {0, 4, 0.5}, {0, 0, 8}},
              inside_out ? reversed(kTetrahedron) : kTetrahedron);
    EXPECT_EQ(validation::solve(scene).status, Status::kZero);
    expect_agreement(scene, generate::receiver_of(scene));
  }
}

TEST(ClosedSurfaces, HideByBacksWhereFrontsAreLeftOut) {
  PlainScene plain = scene_with_source();
  add_solid(plain, kCorners, kTetrahedron);
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select("source"));
  const Receiver receiver = generate::receiver_of(plain);
  const double whole = exact_form_factor(scene, receiver, source).value;
  for (std::uint32_t face = 1; face < 5; ++face) {
    const std::vector<FaceId> only{FaceId{face}};
    expect_agreement(plain, receiver, {.only_occluders = &only});
    Receiver on_face = receiver;
    on_face.on = {FaceId{face}};
    expect_agreement(plain, on_face);
    EXPECT_GE(exact_form_factor(scene, on_face, source).value, whole);
  }
}

Vec3 random_point(Random& random, double reach, double z) {
  return {random.between(-reach, reach), random.between(-reach, reach), z + random.between(-reach, reach)};
}

// Solids that intersect each other and themselves, around x and near the source's plane, some inside out, some on a
// lattice.
TEST(ClosedSurfaces, HideWhatTheBooleansFind) {
  Random random(4);
  for (int round = 0; round < 60; ++round) {
    PlainScene scene = scene_with_source();
    const double lattice = random.one_in(2) ? 8.0 : 0x1p40;
    for (int solid = random.integer(1, 4); solid > 0; --solid) {
      const bool is_tetrahedron = random.one_in(2);
      std::vector<Vec3> vertices;
      const double reach = random.between(0.1, 0.6), z = random.between(0.1, 1.2);
      for (int i = 0; i < (is_tetrahedron ? 4 : 6); ++i) {  // an octahedron of random corners crosses itself
        const Vec3 p = random_point(random, reach, z);
        vertices.push_back({std::round(lattice * p.x) / lattice, std::round(lattice * p.y) / lattice,
                            std::round(lattice * p.z) / lattice});
      }
      const std::vector<RingOfFace>& faces = is_tetrahedron ? kTetrahedron : kOctahedron;
      add_solid(scene, vertices, random.one_in(2) ? reversed(faces) : faces);
    }
    Receiver receiver = generate::receiver_of(scene);
    if (random.one_in(4)) receiver.on = {FaceId{1}};
    SCOPED_TRACE(round);
    expect_agreement(scene, receiver);
  }
}

}  // namespace
}  // namespace exactff
