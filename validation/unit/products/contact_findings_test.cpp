// What closed solids bury, and what touches without being buried.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/slips.h"
#include "generate/plain_scene.h"

namespace exactff::slips {
namespace {

using generate::PlainScene;
using Kinds = std::vector<Kind>;

enum class Fronts { kOutside, kInside };
constexpr std::size_t kBottom = 0;

// Six faces, or five without the bottom.
void add_box(PlainScene& scene, const std::string& patch, const Vec3& a, const Vec3& b,
             Fronts fronts = Fronts::kOutside, bool has_bottom = true) {
  const std::array<Vec3, 8> c{a, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z},
                              b, {a.x, b.y, b.z}};
  const std::array<std::array<std::size_t, 4>, 6> sides{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {3, 0, 4, 7}}};
  for (std::size_t side = has_bottom ? kBottom : 1; side < sides.size(); ++side) {
    std::vector<Vec3> corners;
    for (const std::size_t i : sides[side]) corners.push_back(c[i]);
    if (fronts == Fronts::kInside) std::ranges::reverse(corners);
    scene.add_ring(scene.patch(patch), corners);
  }
}
void add_floor(PlainScene& scene) {
  scene.add_ring(scene.patch("floor"), {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
}

// Of those that are about contacts.
Kinds kinds_in(const PlainScene& plain) {
  Kinds kinds;
  for (const Finding& finding : diagnose(generate::build(plain))) {
    if (finding.kind >= Kind::kOpenFloor && finding.kind <= Kind::kOverlappingSolids) kinds.push_back(finding.kind);
  }
  return kinds;
}

TEST(BuriedParts, AreListedWithTheirAreas) {
  PlainScene plain;
  add_box(plain, "room", {0, 0, 0}, {4, 4, 4}, Fronts::kInside);
  add_box(plain, "lower", {1, 1, 0}, {3, 3, 1});
  add_box(plain, "upper", {2, 2, 1}, {4, 3, 2});
  const Scene scene = generate::build(plain);
  struct Expected {
    std::string patch, under;
    double area;
  };
  std::vector<Expected> expected{{"room", "lower", 4},  {"lower", "room", 4}, {"lower", "upper", 1},
                                 {"upper", "lower", 1}, {"room", "upper", 1}, {"upper", "room", 1}};
  const std::vector<Contact> found = buried_parts(scene);
  EXPECT_EQ(found.size(), expected.size());
  EXPECT_TRUE(std::ranges::is_sorted(found, std::greater{}, &Contact::area));
  for (const auto& [patch, under, area] : expected) {
    const auto one = std::ranges::find_if(found, [&, p = patch, u = under](const Contact& contact) {
      return scene.name_of(contact.patch) == p && scene.name_of(contact.under) == u;
    });
    ASSERT_NE(one, found.end()) << patch << " under " << under;
    EXPECT_NEAR(one->area, area, 1e-12);
    EXPECT_NEAR(one->share, area / (patch == "room" ? 96.0 : patch == "lower" ? 16.0 : 10.0), 1e-12);
  }
  EXPECT_EQ(kinds_in(plain), Kinds{});
}

TEST(TouchFindings, TellBottomsOnOpenFloors) {
  PlainScene plain;
  add_floor(plain);
  add_box(plain, "box", {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(kinds_in(plain), Kinds{Kind::kOpenFloor});
}

TEST(TouchFindings, TellBlocksWithoutBottoms) {
  PlainScene plain;
  add_floor(plain);
  add_box(plain, "block", {0, 0, 0}, {1, 1, 1}, Fronts::kOutside, false);
  EXPECT_EQ(kinds_in(plain), Kinds{Kind::kNoBottom});
  PlainScene above;
  add_floor(above);
  add_box(above, "block", {0, 0, 1}, {1, 1, 2}, Fronts::kOutside, false);
  EXPECT_EQ(kinds_in(above), Kinds{});
}

TEST(TouchFindings, TellContactsThatMissByLittle) {
  for (const double gap : {1e-13, 1e-7, -1e-13, -1e-7}) {
    PlainScene plain;
    add_box(plain, "lower", {0, 0, 0}, {2, 2, 1});
    add_box(plain, "upper", {0.5, 0.5, 1 + gap}, {1, 1, 2});
    EXPECT_EQ(kinds_in(plain), Kinds{Kind::kNearContact}) << gap;
    EXPECT_TRUE(buried_parts(generate::build(plain)).empty());
  }
  PlainScene apart;
  add_box(apart, "lower", {0, 0, 0}, {2, 2, 1});
  add_box(apart, "upper", {0.5, 0.5, 1.001}, {1, 1, 2});
  EXPECT_EQ(kinds_in(apart), Kinds{});
}

TEST(TouchFindings, TellSolidsThatOverlapHoweverTheyDo) {
  const std::array<std::array<Vec3, 2>, 4> others{{
      {{{1, 1, 1}, {3, 3, 3}}},        // corners inside
      {{{0.5, 0.5, -1}, {1, 1, 3}}},   // through it
      {{{1, 0, 0}, {3, 2, 2}}},        // along it
      {{{0.5, 0.5, 0.5}, {1, 1, 1}}},  // within it
  }};
  for (const auto& [low, high] : others) {
    PlainScene plain;
    add_box(plain, "one", {0, 0, 0}, {2, 2, 2});
    add_box(plain, "other", low, high);
    EXPECT_EQ(kinds_in(plain), Kinds{Kind::kOverlappingSolids}) << low.x << ' ' << high.x;
  }
}

TEST(TouchFindings, LeaveAloneWhatStandsInAHollow) {
  PlainScene plain;
  add_box(plain, "shell", {-1, -1, -1}, {5, 5, 5});
  add_box(plain, "room", {0, 0, 0}, {4, 4, 4}, Fronts::kInside);
  add_box(plain, "box", {1, 1, 1}, {2, 2, 2});
  EXPECT_EQ(kinds_in(plain), Kinds{});
}

// Both rooms have all edges of their common wall.
TEST(BuriedParts, OfABoxOnAPartyWallAreThoseInItsOwnRoom) {
  PlainScene plain;
  add_box(plain, "A", {0, 0, 0}, {2, 2, 2}, Fronts::kInside);
  add_box(plain, "B", {2, 0, 0}, {4, 2, 2}, Fronts::kInside);
  add_box(plain, "box", {1, 0, 0}, {2, 1, 1});
  const Scene scene = generate::build(plain);
  const std::vector<Contact> found = buried_parts(scene);
  ASSERT_EQ(found.size(), 2U);
  for (const Contact& one : found) {
    EXPECT_NEAR(one.area, 3.0, 1e-12);
    EXPECT_NE(scene.name_of(one.patch), "B");
    EXPECT_NE(scene.name_of(one.under), "B");
  }
}

// An edge that the room has as a whole, and the box, too; their other faces have it in parts.
TEST(BuriedParts, AreFoundWhereFacesMeetInPartsOfEdges) {
  PlainScene plain;
  add_box(plain, "room", {0, 0, 0}, {3, 3, 3}, Fronts::kInside, false);
  for (const double x : {0.0, 1.0, 2.0}) {
    plain.add_ring(plain.patch("room"), {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 3, 0}, {x, 3, 0}});
  }
  add_box(plain, "box", {0, 0, 0}, {2, 1, 1}, Fronts::kOutside, false);
  for (const double x : {0.0, 1.0}) {
    plain.add_ring(plain.patch("box"), {{x, 0, 0}, {x, 1, 0}, {x + 1, 1, 0}, {x + 1, 0, 0}});
  }
  const std::vector<Contact> found = buried_parts(generate::build(plain));
  ASSERT_EQ(found.size(), 2U);
  for (const Contact& one : found) EXPECT_NEAR(one.area, 5.0, 1e-12);
}

}  // namespace
}  // namespace exactff::slips
