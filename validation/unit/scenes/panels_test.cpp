// Neighbouring faces of one plane become few convex panels; what does not lie side by side does not.
#include "scene/panels.h"

#include <gtest/gtest.h>

#include <algorithm>
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

// In the plane of x and y.
double area(const Scene& scene, std::span<const std::uint32_t> corners) {
  double doubled = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &p = scene.vertices()[corners[i]], &q = scene.vertices()[corners[(i + 1) % corners.size()]];
    doubled += p.x * q.y - q.x * p.y;
  }
  return 0.5 * doubled;
}

double area_of_panels(const Scene& scene, const Sheet& sheet) {
  double sum = 0.0;
  for (PanelId k = 0; k < sheet.panel_count; ++k) {
    const double one = area(scene, panels(scene).corners(sheet.first_panel + k));
    EXPECT_GT(one, 0.0);
    sum += one;
  }
  return sum;
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
  EXPECT_EQ(area_of_panels(scene, all.sheets()[0]), 1.0);
}

TEST(Panels, HaveNoCornersInsideOrOnStraightSides) {
  const Scene scene = generate::build(patch_of(split_squares(block_of(5))));
  const Panels& all = panels(scene);
  ASSERT_EQ(all.sheets().size(), 1U);
  ASSERT_EQ(all.sheets()[0].panel_count, 1U);
  EXPECT_EQ(all.corners(all.sheets()[0].first_panel).size(), 4U);
}

TEST(Panels, LeaveHolesOpen) {
  std::vector<std::pair<int, int>> at = block_of(5);
  std::erase(at, std::pair(1, 1));
  std::erase(at, std::pair(3, 2));
  const Scene scene = generate::build(patch_of(split_squares(at)));
  const Panels& all = panels(scene);
  ASSERT_EQ(all.sheets().size(), 1U);
  EXPECT_LT(all.sheets()[0].panel_count, 12U);
  EXPECT_EQ(area_of_panels(scene, all.sheets()[0]), 23.0);
}

// Holes that meet each other, and the outside, in corners.
TEST(Panels, MayTouchThemselves) {
  std::vector<std::pair<int, int>> at = block_of(5);
  for (const auto& gone : {std::pair(1, 1), {2, 2}, {3, 3}, {0, 0}}) std::erase(at, gone);
  const Scene scene = generate::build(patch_of(split_squares(at)));
  for (const Sheet& sheet : panels(scene).sheets())
    EXPECT_EQ(area_of_panels(scene, sheet), 0.5 * static_cast<double>(sheet.pieces.size()));
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

// Three triangles about a line of which two lie in one plane: the line is shared by three.
TEST(Panels, AreNotJoinedAlongAnEdgeOfThree) {
  std::vector<Corners> faces = split_squares({{0, 0}});
  faces.push_back({faces[0][0], faces[0][2], {0, 0, 5}});
  EXPECT_TRUE(panels(generate::build(patch_of(faces))).empty());
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

TEST(Panels, OfOneFaceAreItsPieces) {
  const Corners l_shape{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const Scene scene = generate::build(patch_of({l_shape}));
  EXPECT_GT(scene.pieces().size(), 1U);
  EXPECT_TRUE(panels(scene).empty());
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

// Long and short bars, none of which share a whole edge, around six openings.
TEST(Panels, OfALadderLeaveItsOpenings) {
  std::vector<Corners> faces;
  const auto rectangle = [&](double x, double y, double u, double v) {
    faces.push_back({{x, y, 0}, {u, y, 0}, {u, v, 0}, {x, v, 0}});
  };
  for (int k = 0; k < 7; ++k) {
    rectangle(0, 2.0 * k, 5, 2.0 * k + 1);
    if (k == 6) break;
    rectangle(0, 2.0 * k + 1, 1, 2.0 * k + 2);
    rectangle(4, 2.0 * k + 1, 5, 2.0 * k + 2);
  }
  const Scene scene = generate::build(patch_of(faces));
  ASSERT_EQ(panels(scene).sheets().size(), 1U);
  EXPECT_LT(panels(scene).sheets()[0].panel_count, faces.size());
  EXPECT_EQ(area_of_panels(scene, panels(scene).sheets()[0]), 35.0 + 12.0);
}

TEST(Panels, KnowTheirClosedSurface) {
  PlainScene plain;
  const auto at = [](int i) { return Vec3{1.0 * (i & 1), 1.0 * (i / 2 & 1), 1.0 * (i / 4 & 1)}; };
  const std::vector<std::array<int, 4>> sides{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& [a, b, c, d] : sides) {
    plain.add_ring(plain.patch("source"), {at(a), at(b), at(c)});
    plain.add_ring(plain.patch("source"), {at(a), at(c), at(d)});
  }
  const Scene closed = generate::build(plain);
  ASSERT_EQ(panels(closed).sheets().size(), 6U);
  for (const Sheet& sheet : panels(closed).sheets()) EXPECT_EQ(sheet.surface, 0U);
  plain.patch("source").faces.pop_back();
  const Scene open = generate::build(plain);
  ASSERT_EQ(panels(open).sheets().size(), 5U);
  for (const Sheet& sheet : panels(open).sheets()) EXPECT_EQ(sheet.surface, ClosedSurfaces::kNone);
}

}  // namespace
}  // namespace exactff
