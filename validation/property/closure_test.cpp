// In a closed room all form factors from an inner point add up to exactly one, whatever stands in the room.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/random_scenes.h"
#include "support/solve.h"

namespace exactff::validation {
namespace {

using generate::PlainPatch;
using generate::PlainScene;
using generate::Random;

// The faces of a box as six patches, fronts inward or outward.
void add_box(PlainScene& scene, const std::string& name, const Vec3& a, const Vec3& b, bool inward) {
  const std::vector<std::vector<Vec3>> outward{{{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}},
                                               {{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}},
                                               {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}},
                                               {{a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}},
                                               {{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}},
                                               {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}};
  for (std::size_t k = 0; k < 6; ++k) {
    std::vector<Vec3> corners = outward[k];
    if (inward) std::ranges::reverse(corners);
    scene.add_ring(scene.patch(name + std::to_string(k)), corners);
  }
}

Enclosure sum_over_patches(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  Enclosure sum;
  for (const Patch& patch : scene.patches()) {
    const ExactSource source(scene, scene.select(patch.name));
    sum += exact_form_factor(scene, generate::receiver_of(plain), source).enclosure;
  }
  return sum;
}

void expect_one(const PlainScene& scene) {
  const Enclosure sum = sum_over_patches(scene);
  ASSERT_TRUE(sum.contains(1.0)) << sum.midpoint() << " +/- " << sum.radius() << '\n' << generate::to_obj(scene);
  ASSERT_LT(sum.upper() - sum.lower(), 0x1p-40);
}

PlainScene cube_room(Random& random) {
  PlainScene scene;
  add_box(scene, "wall", {-1, -1, -1}, {1, 1, 1}, true);
  const double x = random.integer(-3, 3) / 4.0;
  const double y = random.integer(-3, 3) / 4.0;
  scene.point = {x, y, random.between(-0.99, 0.99)};
  scene.normal = {random.between(-1, 1), random.integer(-1, 1) * 1.0, random.integer(0, 1) + 0.25};
  return scene;
}

TEST(Closure, SixWallsOfACube) {
  for (std::uint64_t i = 0; i < scaled_count(20); ++i) {
    Random random(seed_of(i));
    SCOPED_TRACE(seed_of(i));
    ASSERT_NO_FATAL_FAILURE(expect_one(cube_room(random)));
  }
}

// Boxes on a lattice touch the walls, each other and themselves; the receiver stays clear of them below.
TEST(Closure, ACubeWithBoxesInside) {
  for (std::uint64_t i = 0; i < scaled_count(12); ++i) {
    Random random(seed_of(i));
    PlainScene scene = cube_room(random);
    scene.point.z = random.between(-0.9, -0.6);
    for (const double z : {-0.5, 0.25}) {
      const Vec3 low{random.integer(-4, 2) / 4.0, random.integer(-4, 2) / 4.0, z};
      add_box(scene, z < 0 ? "low" : "high", low, {low.x + 0.5, low.y + 0.5, z + 0.75}, false);
    }
    SCOPED_TRACE(seed_of(i));
    ASSERT_NO_FATAL_FAILURE(expect_one(scene));
  }
}

// A receiver on the wall itself: its own wall gives 0 and the five others make up for it.
TEST(Closure, ReceiverOnAWall) {
  Random random(seed_of(0));
  PlainScene scene = cube_room(random);
  scene.point = {0.25, -0.375, -1};
  scene.normal = {0, 0, 3};
  expect_one(scene);
}

// The same room as one patch of six faces: their F is one ball, and it rounds to 1 and to nothing else.
TEST(Closure, AWholeRoomAsOneSourceIsOne) {
  for (std::uint64_t i = 0; i < scaled_count(10); ++i) {
    Random random(seed_of(i));
    PlainScene scene = cube_room(random);
    scene.source = "room";
    PlainPatch whole{"room", {}, {}};
    for (const PlainPatch& patch : scene.patches) whole.faces.push_back(patch.faces.front());
    scene.patches = {whole};
    const FormFactor result = solve(scene);
    EXPECT_EQ(result.value, 1.0) << "seed " << seed_of(i);
    EXPECT_EQ(result.upper, 1.0);
    EXPECT_EQ(result.status, Status::kCertified);
  }
}

}  // namespace
}  // namespace exactff::validation
