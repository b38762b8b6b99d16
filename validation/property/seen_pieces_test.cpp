// Views from points of a box among the pieces that the box may see (whole_view/seen_pieces.h): the same as among all.
#include "whole_view/seen_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "generate/random.h"
#include "property/closed_rooms.h"
#include "support/random_scenes.h"

namespace exactff::validation {
namespace {

using generate::PlainScene;
using generate::Random;
using whole_view::pieces_seen_from;
using whole_view::view_among;

void expect_same(const ViewShare& a, const ViewShare& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.status, b.status);
}

void expect_same(const WholeView& a, const WholeView& b) {
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t i = 0; i < a.patches.size(); ++i) {
    EXPECT_EQ(a.patches[i].patch, b.patches[i].patch);
    EXPECT_EQ(a.patches[i].face, b.patches[i].face);
    expect_same(a.patches[i].share, b.patches[i].share);
    expect_same(a.patches[i].form_factor, b.patches[i].form_factor);
  }
  expect_same(a.back, b.back);
  expect_same(a.open, b.open);
}

// A box beside the receiver: flat, a point, or as large as the distance to what is seen. Returns how many pieces its
// points do not see.
std::size_t expect_the_same_views(const PlainScene& plain, Random& random) {
  const Scene scene = generate::build(plain);
  const Receiver receiver = generate::receiver_of(plain);
  const Vec3 low = receiver.point;
  const double size = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), 1.0});
  const auto wide = [&] { return random.one_in(3) ? 0.0 : std::ldexp(size, -random.integer(0, 6)); };
  const Vec3 high{low.x + wide(), low.y + wide(), low.z + wide()};
  const std::vector<std::uint32_t> pieces = pieces_seen_from(scene, {low, high});
  for (int i = 0; i < 4; ++i) {
    const auto between = [&](double a, double b) { return i < 2 ? (random.one_in(2) ? a : b) : random.between(a, b); };
    Receiver moved = receiver;
    moved.point = {between(low.x, high.x), between(low.y, high.y), between(low.z, high.z)};
    moved.on.clear();
    const ViewOptions options{.faces = random.one_in(2)};
    Workspace workspace;
    WholeView found;
    view_among(scene, pieces, moved, options, found, workspace);
    expect_same(found, view(scene, moved, options));
  }
  return scene.pieces().size() - pieces.size();
}

TEST(SeenPieces, GiveTheSameViewsInAllFamilies) {
  std::size_t hidden = 0;
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t s = 0; s < scaled_count(4); ++s) {
      SCOPED_TRACE(std::string(family.name) + ", seed " + std::to_string(seed_of(s)));
      Random random(seed_of(s));
      const PlainScene scene = family.make(random);
      hidden += expect_the_same_views(scene, random);
    }
  }
  EXPECT_GE(hidden, 20U);
}

TEST(SeenPieces, GiveTheSameViewsInBuildings) {
  std::size_t hidden = 0;
  for (std::uint64_t s = 0; s < scaled_count(40); ++s) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(s)));
    Random random(seed_of(s));
    const ClosedRoom room = random_building(random);
    hidden += expect_the_same_views(room.scene, random);
  }
  EXPECT_GE(hidden, 20U);
}

}  // namespace
}  // namespace exactff::validation
