// Neighbouring faces of one plane become few convex panels; what does not lie side by side does not.
#include "scene/panels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "generate/plain_scene.h"
#include "scene/closed_surfaces.h"

namespace exactff {
namespace {

using generate::PlainScene;
using Corners = std::vector<Vec3>;

PlainScene patch_of(const std::vector<Corners>& faces) {
  PlainScene plain;
  for (const Corners& face : faces) plain.add_ring(plain.patch("source"), face);
  return plain;
}

// The squares with these lower corners, each cut in two, in the plane z = x + y / 2.
std::vector<Corners> split_squares(const std::vector<std::pair<int, int>>& at) {
  std::vector<Corners> faces;
  const auto corner = [](int x, int y) { return Vec3{1.0 * x, 1.0 * y, x + 0.5 * y}; };
  for (const auto& [x, y] : at) {
    faces.push_back({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
    faces.push_back({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
  }
  return faces;
}

std::vector<std::pair<int, int>> block_of(int n) {
  std::vector<std::pair<int, int>> at;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) at.emplace_back(x, y);
  }
  return at;
}

TEST(Panels, OfTwoTrianglesIsTheSquare) {
  const Scene scene = generate::build(patch_of(split_squares({{0, 0}})));
  const Panels& all = panels(scene);
  ASSERT_EQ(all.sheets().size(), 1U);
  EXPECT_EQ(all.sheets()[0].pieces, (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(all.end(), 3U);
  EXPECT_TRUE(all.is_joined(2));
  EXPECT_EQ(all.corners(2).size(), 4U);
  EXPECT_EQ(all.sheet_of_piece(1), 0U);
}

TEST(Panels, AreThePiecesOfACurvedMesh) {
  std::vector<Corners> faces = split_squares(block_of(4));
  for (Corners& face : faces) {
    for (Vec3& corner : face) corner.z += corner.x * corner.y;
  }
  const Scene scene = generate::build(patch_of(faces));
  EXPECT_TRUE(panels(scene).empty());
  EXPECT_EQ(&panel_tree(scene), &shaft_tree(scene));
}

TEST(Panels, JoinNothingThatIsOffThePlaneByAnUlp) {
  std::vector<Corners> faces = split_squares({{1, 1}});
  faces[1][2].z = std::nextafter(faces[1][2].z, 10.0);
  EXPECT_TRUE(panels(generate::build(patch_of(faces))).empty());
  // A pyramid that is an ulp high: its rim lies in one plane.
  const Vec3 apex{0.5, 0.5, std::nextafter(0.75, 1.0)}, a{0, 0, 0}, b{1, 0, 1}, c{1, 1, 1.5}, d{0, 1, 0.5};
  EXPECT_TRUE(panels(generate::build(patch_of({{a, b, apex}, {b, c, apex}, {c, d, apex}, {d, a, apex}}))).empty());
}

TEST(Panels, JoinNoFacesWithOppositeFronts) {
  std::vector<Corners> faces = split_squares({{0, 0}});
  std::swap(faces[1][0], faces[1][1]);
  EXPECT_TRUE(panels(generate::build(patch_of(faces))).empty());
  // Folded over: both on one side of the edge that they share.
  const Corners folded{faces[0][2], faces[0][1], {0.5, 0, 0.5}};
  EXPECT_TRUE(panels(generate::build(patch_of({faces[0], folded}))).empty());
}

TEST(Panels, JoinNothingThatOverlaps) {
  std::vector<Corners> faces = split_squares({{0, 0}});
  faces.push_back(faces[0]);
  EXPECT_TRUE(panels(generate::build(patch_of(faces))).empty());
  // A spiral in one plane, once and a half around.
  std::vector<Corners> spiral;
  const auto at = [](int i, double radius) {
    const double turn = 0.5 * i;
    return Vec3{radius * std::cos(turn), radius * std::sin(turn), 0.0};
  };
  for (int i = 0; i < 19; ++i) {
    const double inner = 1.0 + i / 16.0, next = inner + 1.0 / 16;
    spiral.push_back({at(i, inner), at(i, inner + 1.0), at(i + 1, next + 1.0)});
    spiral.push_back({at(i, inner), at(i + 1, next + 1.0), at(i + 1, next)});
  }
  const Scene scene = generate::build(patch_of(spiral));
  EXPECT_TRUE(panels(scene).empty());
}

TEST(Panels, AreOfOnePatchAndTransparentAsAWhole) {
  const std::vector<Corners> faces = split_squares(block_of(2));
  PlainScene plain;
  for (std::size_t f = 0; f < faces.size(); ++f) plain.add_ring(plain.patch(f < 4 ? "a" : "b"), faces[f]);
  const Scene scene = generate::build(plain);
  EXPECT_EQ(panels(scene).sheets().size(), 2U);
  const std::vector<Selection> glass{scene.select("a:1"), scene.select("a:2")};
  const Scene with_glass = scene.with_transparent(glass);
  const Panels& all = panels(with_glass);
  ASSERT_EQ(all.sheets().size(), 3U);
  for (const Sheet& sheet : all.sheets()) {
    for (const std::uint32_t piece : sheet.pieces) {
      EXPECT_EQ(with_glass.pieces()[piece].transparent, all.piece(sheet.first_panel).transparent);
    }
  }
}

// One side of a rectangle is cut, its neighbour's is not.
TEST(Panels, AreJoinedAtJunctions) {
  const Corners left{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}}, low{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}},
      high{{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
  const Scene scene = generate::build(patch_of({left, low, high}));
  ASSERT_EQ(panels(scene).sheets().size(), 1U);
  EXPECT_EQ(panels(scene).sheets()[0].pieces, (std::vector<std::uint32_t>{0, 1, 2}));
  ASSERT_EQ(panels(scene).sheets()[0].panel_count, 1U);
  EXPECT_EQ(panels(scene).corners(3).size(), 4U);
}

}  // namespace
}  // namespace exactff
