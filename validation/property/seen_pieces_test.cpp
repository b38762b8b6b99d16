// Without the faces of which a box sees no piece (visibility/walls.h), views from its points are the same.
#include "property/closed_rooms.h"
#include "support/test.h"
#include "visibility/walls.h"

namespace exactff::validation {
namespace {

using visibility::pieces_seen_from;

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

// The scene without the other faces; all keep their numbers.
Scene with_only(const Scene& scene, const std::vector<std::uint32_t>& pieces) {
  std::vector<bool> seen(scene.faces().size());
  for (const std::uint32_t piece : pieces) seen[index_of(scene.pieces()[piece].face)] = true;
  std::vector<Selection> others;
  for (std::uint32_t f = 0; f < seen.size(); ++f) {
    if (!seen[f]) others.push_back({scene.faces()[f].patch, FaceId{f}, scene.id()});
  }
  return scene.with_transparent(others);
}

// A box beside the receiver: flat, a point, or as large as the distance to what is seen. Returns how many pieces its
// points do not see.
std::size_t expect_the_same_views(const Scene& scene, const Receiver& receiver, Random& random) {
  if (some_is_buried(scene)) return 0;  // a solid without some faces buries nothing
  const Vec3 low = receiver.point;
  const double size = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), 1.0});
  const auto wide = [&] { return random.one_in(3) ? 0.0 : std::ldexp(size, -random.integer(0, 6)); };
  const Vec3 high{low.x + wide(), low.y + wide(), low.z + wide()};
  const std::vector<std::uint32_t> pieces = pieces_seen_from(scene, visibility::walls_of(scene), {low, high});
  const Scene others_left_out = with_only(scene, pieces);
  for (int i = 0; i < 4; ++i) {
    const auto between = [&](double a, double b) { return i < 2 ? (random.one_in(2) ? a : b) : random.between(a, b); };
    Receiver moved = receiver;
    moved.point = {between(low.x, high.x), between(low.y, high.y), between(low.z, high.z)};
    moved.on.clear();
    const ViewOptions options{.faces = random.one_in(2)};
    expect_same(view(others_left_out, moved, options), view(scene, moved, options));
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
      hidden += expect_the_same_views(generate::build(scene), generate::receiver_of(scene), random);
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
    hidden += expect_the_same_views(generate::build(room.scene), generate::receiver_of(room.scene), random);
  }
  EXPECT_GE(hidden, 20U);
}

// The square of whole coordinates with this lowest corner, across an axis; it may face either way.
void add_square(PlainScene& scene, const std::string& name, int across, const Vec3& low, Random& random) {
  const Vec3 u{across == 0 ? 0.0 : 1.0, across == 0 ? 1.0 : 0.0, 0.0},
      v{0.0, across == 2 ? 1.0 : 0.0, across == 2 ? 0.0 : 1.0};
  const auto at = [&](double s, double t) {
    return Vec3{low.x + s * u.x + t * v.x, low.y + s * u.y + t * v.y, low.z + s * u.z + t * v.z};
  };
  std::vector<Vec3> ring{at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
  if (random.one_in(2)) std::ranges::reverse(ring);
  scene.add_ring(scene.patch(name), ring);
}

constexpr int kHouse = 6;

// Walls of squares, some of which are left out, and squares anywhere, also in the planes of the walls and at their
// edges.
PlainScene house_of_squares(Random& random) {
  PlainScene scene;
  int count = 0;
  const auto place = [&](int most) { return static_cast<double>(random.integer(0, most)); };
  for (int wall = 0; wall < 3; ++wall) {
    const int across = static_cast<int>(random.below(3));
    const double depth = static_cast<double>(random.integer(1, kHouse - 1));
    const auto missing = static_cast<unsigned>(random.integer(4, 20));
    for (int i = 0; i < kHouse; ++i) {
      for (int j = 0; j < kHouse; ++j) {
        if (random.one_in(missing)) continue;
        const double s = i, t = j;
        const Vec3 low = across == 0 ? Vec3{depth, s, t} : across == 1 ? Vec3{s, depth, t} : Vec3{s, t, depth};
        add_square(scene, "wall" + std::to_string(count++), across, low, random);
      }
    }
  }
  for (int i = 0; i < 40; ++i) {
    add_square(scene, "thing" + std::to_string(i), static_cast<int>(random.below(3)),
               {place(kHouse), place(kHouse), place(kHouse)}, random);
  }
  return scene;
}

// Pieces in a wall's plane are not hidden by it, even where a part of the tree lies behind the wall.
TEST(SeenPieces, GiveTheSameViewsBetweenWallsWithHoles) {
  std::size_t hidden = 0;
  for (std::uint64_t s = 0; s < scaled_count(40); ++s) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(s)));
    Random random(seed_of(s));
    const Scene scene = generate::build(house_of_squares(random));
    const auto coordinate = [&] { return random.between(0.0, kHouse); };
    const auto component = [&] { return static_cast<double>(random.integer(-1, 1)); };
    const Receiver receiver{.point = {coordinate(), coordinate(), coordinate()},
                            .normal = {component(), 0.5, component()},
                            .on = {},
                            .id = {}};
    hidden += expect_the_same_views(scene, receiver, random);
  }
  EXPECT_GE(hidden, 400U);
}

std::size_t pieces_hidden_behind(const Scene& scene, const Box& region) {
  return scene.pieces().size() - pieces_seen_from(scene, visibility::walls_of(scene), region).size();
}

// Four squares with a hole in the middle of a wall of three by three, or without it, and what lies behind.
PlainScene wall_with_window(bool open, Random& random) {
  PlainScene scene;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (open && i == 1 && j == 1) continue;
      add_square(scene, "wall" + std::to_string(3 * i + j), 0, {0.0, static_cast<double>(i), static_cast<double>(j)},
                 random);
    }
  }
  add_square(scene, "opposite", 0, {1, 1, 1}, random);
  add_square(scene, "beside", 0, {1, 0, 1}, random);
  add_square(scene, "above", 0, {1, 1, 2}, random);
  add_square(scene, "before", 0, {-2, 1, 1}, random);
  return scene;
}

TEST(SeenPieces, AWallOfSeveralPiecesHidesWhatNoneOfThemHides) {
  Random random(1);
  const Box small{{-0.25, 1.25, 1.25}, {-0.25, 1.75, 1.75}}, large{{-1, 0.5, 1}, {-1, 2, 2}};
  EXPECT_EQ(pieces_hidden_behind(generate::build(wall_with_window(false, random)), small), 3U);
  EXPECT_EQ(pieces_hidden_behind(generate::build(wall_with_window(false, random)), large), 3U);
}

TEST(SeenPieces, AWindowShowsWhatIsBehindIt) {
  Random random(1);
  const Scene scene = generate::build(wall_with_window(true, random));
  EXPECT_EQ(pieces_hidden_behind(scene, {{-0.25, 1.25, 1.25}, {-0.25, 1.75, 1.75}}), 0U);
  // From above the window, only what is lower is seen through it.
  EXPECT_EQ(pieces_hidden_behind(scene, {{-1, 2.25, 2.25}, {-1, 2.75, 2.75}}), 1U);
  EXPECT_EQ(pieces_hidden_behind(scene, {{-1, 1, 1}, {-1, 2, 2}}), 0U);
}

}  // namespace
}  // namespace exactff::validation
