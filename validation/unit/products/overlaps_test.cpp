// Fronts of different patches that lie on each other: what is found, what is said of it, and what is no overlap.
#include "support/test.h"

namespace exactff::slips {
namespace {

using Kinds = std::vector<Kind>;

Scene regression_scene(const std::string& name) {
  return read_obj(std::string(EXACTFF_DATA_DIR "/regression/") + name + ".obj");
}

std::vector<std::string> kinds_in(const Scene& scene) {
  std::vector<std::string> kinds;
  for (const Finding& finding : diagnose(scene)) kinds.emplace_back(to_string(finding.kind));
  return kinds;
}

std::string words_in(const Scene& scene, Kind kind) {
  for (const Finding& finding : diagnose(scene)) {
    if (finding.kind == kind) return finding.words.message();
  }
  return "nothing";
}

std::vector<Overlap> all_overlaps(const Scene& scene) { return overlapping_fronts(scene, all_patches(scene)); }

// Looks up; its corners are those of a box in the plane z.
void add_tile(PlainScene& scene, const std::string& name, double x, double y, double width, double depth,
              double z = 0) {
  scene.add_ring(scene.patch(name), {{x, y, z}, {x + width, y, z}, {x + width, y + depth, z}, {x, y + depth, z}});
}

using Names = std::vector<std::string>;

TEST(Overlaps, OfAWindowOnAWallIsNamedAndNoWallIsTurned) {
  for (const char* name : {"window_on_a_wall", "window_beside_furniture"}) {
    const Scene scene = regression_scene(name);
    EXPECT_EQ(kinds_in(scene).front(), "overlapping-fronts") << name;
    EXPECT_EQ(std::ranges::count(kinds_in(scene), "no-bottom"), std::string(name) == "window_beside_furniture");
    EXPECT_EQ(
        words_in(scene, Kind::kOverlappingFronts),
        "'window' lies in the plane of 'east' and overlaps it by 1 (area): there both count in full, and rows of a "
        "matrix exceed 1; cut it out of 'east', or make it a subsurface");
  }
}

TEST(Overlaps, AreaIsThatOfAllPartsTogether) {
  PlainScene plain;
  add_tile(plain, "floor", 0, 0, 2, 4);
  add_tile(plain, "floor", 2, 0, 2, 4);
  for (const double y : {0.5, 2.5}) {  // each cut in two by a diagonal, and over both halves of the floor
    plain.add_ring(plain.patch("carpet"), {{1, y, 0}, {3, y, 0}, {3, y + 1, 0}});
    plain.add_ring(plain.patch("carpet"), {{1, y, 0}, {3, y + 1, 0}, {1, y + 1, 0}});
  }
  const Scene scene = generate::build(plain);
  const std::vector<Overlap> overlaps = all_overlaps(scene);
  ASSERT_EQ(overlaps.size(), 1U);
  EXPECT_EQ(scene.name_of(overlaps[0].smaller), "carpet");
  EXPECT_EQ(scene.name_of(overlaps[0].larger), "floor");
  EXPECT_NEAR(overlaps[0].area, 4.0, 1e-12);
  EXPECT_EQ(overlaps[0].apart, 0.0);
}

TEST(Overlaps, AreNotBetweenNeighboursThatTouch) {
  PlainScene plain;
  for (int i = 0; i < 9; ++i) {  // corners in the middle of edges, and coordinates that are rounded
    add_tile(plain, "tile" + std::to_string(i), i / 3.0, 0, (i + 1) / 3.0 - i / 3.0, 0.7);
    add_tile(plain, "row" + std::to_string(i), 0.4 * i, 0.7, 0.4 * (i + 1) - 0.4 * i, 0.1);
  }
  EXPECT_TRUE(all_overlaps(generate::build(plain)).empty());
  EXPECT_TRUE(all_overlaps(models::make_scene("teapot:segments=4")).empty());
  EXPECT_TRUE(
      all_overlaps(read_scene(EXACTFF_DATA_DIR "/scenes/cornell_box.obj", {.patches = PatchMode::kFaces})).empty());
}

TEST(Overlaps, ARoundingApartAreToldApart) {
  for (const double apart : {1e-12, -1e-9, 1e-5, 1e-2}) {
    PlainScene plain;
    add_tile(plain, "floor", 0, 0, 4, 4);
    add_tile(plain, "carpet", 1, 1, 2, 1, apart);
    const Scene scene = generate::build(plain);
    const std::string words = words_in(scene, Kind::kNearlyCoplanar);
    if (std::abs(apart) > 1e-6) {
      EXPECT_EQ(words, "nothing") << apart;
      continue;
    }
    EXPECT_EQ(words.find(std::string("'carpet' lies within 1e-") + (apart > 0 ? "12" : "09") +
                         " of the plane of 'floor' and overlaps it by 2 (area): there a rounding decides which"),
              0U)
        << words;
    EXPECT_EQ(words_in(scene, Kind::kOverlappingFronts), "nothing");
  }
}

// A room with a stray face outside: it is not turned round, and neither is the stray face, which sees nothing either
// way.
TEST(Overlaps, AStrayFaceOutsideTurnsNoRoom) {
  const std::string walls =
      "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2.5\nv 4 0 2.5\nv 4 3 2.5\nv 0 3 2.5\nv 9 1 1\nv 9 2 1\nv 9 2 2\n";
  const std::string faces[] = {"f 1 2 3 4\n", "f 8 7 6 5\n", "f 5 6 2 1\n",
                               "f 6 7 3 2\n", "f 7 8 4 3\n", "f 8 5 1 4\n"};
  for (const bool one_patch : {true, false}) {
    std::string text = walls;
    for (int i = 0; i < 6; ++i) text += "g room" + (one_patch ? "" : std::to_string(i)) + '\n' + faces[i];
    for (const char* stray : {"f 9 10 11\n", "f 11 10 9\n"}) {  // it looks away from the room, and at it
      std::istringstream in(text + "g stray\n" + stray);
      const Scene scene = read_obj(in, "s.obj");
      EXPECT_EQ(kinds_in(scene), Names{"unseen-front"});
      EXPECT_EQ(
          words_in(scene, Kind::kUnseenFront),
          "no other patch sees the front of 'stray', as far as rays can tell (receivers there see nothing, and it "
          "lights nothing); turning it round does not help; check the place");
      EXPECT_EQ(diagnose(scene)[0].flag, "");
    }
  }
}

// --- What closed solids bury, and what touches without being buried ---

void add_floor(PlainScene& scene) {
  scene.add_ring(scene.patch("floor"), {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
}

// Of those that are about contacts.
Kinds kinds_of_touch(const PlainScene& plain) {
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
  EXPECT_EQ(kinds_of_touch(plain), Kinds{});
}

TEST(TouchFindings, TellBottomsOnOpenFloors) {
  PlainScene plain;
  add_floor(plain);
  add_box(plain, "box", {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(kinds_of_touch(plain), Kinds{Kind::kOpenFloor});
}

TEST(TouchFindings, TellBlocksWithoutBottoms) {
  PlainScene plain;
  add_floor(plain);
  add_box(plain, "block", {0, 0, 0}, {1, 1, 1}, Fronts::kOutside, false);
  EXPECT_EQ(kinds_of_touch(plain), Kinds{Kind::kNoBottom});
  PlainScene above;
  add_floor(above);
  add_box(above, "block", {0, 0, 1}, {1, 1, 2}, Fronts::kOutside, false);
  EXPECT_EQ(kinds_of_touch(above), Kinds{});
}

TEST(TouchFindings, TellContactsThatMissByLittle) {
  for (const double gap : {1e-13, 1e-7, -1e-13, -1e-7}) {
    PlainScene plain;
    add_box(plain, "lower", {0, 0, 0}, {2, 2, 1});
    add_box(plain, "upper", {0.5, 0.5, 1 + gap}, {1, 1, 2});
    EXPECT_EQ(kinds_of_touch(plain), Kinds{Kind::kNearContact}) << gap;
    EXPECT_TRUE(buried_parts(generate::build(plain)).empty());
  }
  PlainScene apart;
  add_box(apart, "lower", {0, 0, 0}, {2, 2, 1});
  add_box(apart, "upper", {0.5, 0.5, 1.001}, {1, 1, 2});
  EXPECT_EQ(kinds_of_touch(apart), Kinds{});
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
    EXPECT_EQ(kinds_of_touch(plain), Kinds{Kind::kOverlappingSolids}) << low.x << ' ' << high.x;
  }
}

TEST(TouchFindings, LeaveAloneWhatStandsInAHollow) {
  PlainScene plain;
  add_box(plain, "shell", {-1, -1, -1}, {5, 5, 5});
  add_box(plain, "room", {0, 0, 0}, {4, 4, 4}, Fronts::kInside);
  add_box(plain, "box", {1, 1, 1}, {2, 2, 2});
  EXPECT_EQ(kinds_of_touch(plain), Kinds{});
}

}  // namespace
}  // namespace exactff::slips
