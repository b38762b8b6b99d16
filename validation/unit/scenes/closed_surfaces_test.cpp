// Finds closed surfaces; removing their back faces changes no result.
#include "scene/closed_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
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
