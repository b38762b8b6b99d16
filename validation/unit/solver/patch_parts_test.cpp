// A patch of triangles in one plane has the parts, and the factors, of the polygon that they make.
#include "support/test.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {
namespace {

// The square from (x, y) to (x + 1, y + 1) at a height, with its front upwards or downwards: whole, or n x n squares
// cut in two.
void add_tiles(PlainScene& scene, const std::string& name, const Vec3& at, bool up, int n) {
  generate::PlainPatch& patch = scene.patch(name);
  const auto corner = [&](int i, int j) {
    const int k = n == 0 ? 1 : n;
    return Vec3{at.x + 1.0 * (up ? i : k - i) / k, at.y + 1.0 * j / k, at.z};
  };
  if (n == 0) scene.add_ring(patch, {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      scene.add_ring(patch, {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
      scene.add_ring(patch, {corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  }
}

// Between two squares an L, as one polygon or in triangles.
Scene three_plates(int n) {
  PlainScene scene;
  add_tiles(scene, "floor", {0, 0, 0}, true, n);
  if (n == 0) {
    scene.add_ring(
        scene.patch("table"),
        {{0.25, 0.5, 0.5}, {2.25, 0.5, 0.5}, {2.25, 1.5, 0.5}, {1.25, 1.5, 0.5}, {1.25, 2.5, 0.5}, {0.25, 2.5, 0.5}});
  } else {
    for (const Vec3& at : {Vec3{0.25, 0.5, 0.5}, {1.25, 0.5, 0.5}, {0.25, 1.5, 0.5}})
      add_tiles(scene, "table", at, true, n);
  }
  for (Vec3& v : scene.vertices) {
    if (v.z == 0.5) v = {0.5 * v.x, 0.5 * v.y, v.z};
  }
  add_tiles(scene, "ceiling", {0, 0, 1}, false, n);
  return generate::build(scene);
}

double area_of_patch(const Scene& scene, const char* name) {
  const ExactScene exact(scene);
  const std::vector<Part> parts = parts_of(exact, scene.select(name));
  return areas_of(exact, scene.select(name), parts).second;
}

TEST(PatchParts, OfJoinedFacesThatOverlapOthersCountOnce) {
  PlainScene plain;
  add_tiles(plain, "floor", {0, 0, 0}, true, 2);
  add_tiles(plain, "floor", {0.25, 0.25, 0}, true, 3);
  add_tiles(plain, "floor", {0.5, 0, 0}, true, 0);
  const Scene scene = generate::build(plain);
  // 1, and what is beyond: 7/16 of the second, 1/2 of the third less 3/16 that the second has.
  EXPECT_NEAR(area_of_patch(scene, "floor"), 1.0 + 7.0 / 16 + 0.5 - 3.0 / 16, 1e-14);
}

TEST(PatchParts, OfTrianglesGiveTheFactorsOfPolygons) {
  const Scene whole = three_plates(0), cut = three_plates(4);
  const std::vector<std::string> names{"floor", "table", "ceiling"};
  for (const std::string& from : names) {
    for (const std::string& to : names) {
      SCOPED_TRACE(from + " to " + to);
      const ViewFactorOptions options{.accuracy = 1e-5, .certify = true};
      const ViewFactor a = view_factor(whole, whole.select(from), whole.select(to), options),
                       b = view_factor(cut, cut.select(from), cut.select(to), options);
      EXPECT_EQ(a.claim, b.claim);
      EXPECT_LE(a.lower, b.upper);
      EXPECT_LE(b.lower, a.upper);
    }
  }
}

}  // namespace
}  // namespace exactff::view_factors
