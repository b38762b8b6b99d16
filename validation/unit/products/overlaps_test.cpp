// Fronts of different patches that lie on each other: what is found, what is said of it, and what is no overlap.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "exactff/slips.h"
#include "generate/plain_scene.h"

namespace exactff::slips {
namespace {

using generate::PlainScene;

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

std::vector<Overlap> all_overlaps(const Scene& scene) {
  std::vector<Selection> patches;
  for (std::size_t p = 0; p < scene.patches().size(); ++p) patches.push_back({static_cast<PatchId>(p), {}, scene.id()});
  return overlapping_fronts(scene, patches);
}

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

// Opposite fronts are twin faces, or a thing that stands on the floor.
TEST(Overlaps, AreNotBetweenOppositeFronts) {
  PlainScene plain;
  add_tile(plain, "floor", 0, 0, 4, 4);
  plain.add_ring(plain.patch("foot"), {{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}});
  EXPECT_TRUE(all_overlaps(generate::build(plain)).empty());
}

TEST(Overlaps, OfTheSameCornersAreDoubledFaces) {
  PlainScene plain;
  add_tile(plain, "floor", 0, 0, 4, 4);
  plain.add_ring(plain.patch("carpet"), {{4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {4, 0, 0}});
  const Scene scene = generate::build(plain);
  EXPECT_EQ(words_in(scene, Kind::kOverlappingFronts), "nothing");
  EXPECT_NE(words_in(scene, Kind::kDoubledFaces), "nothing");
  ASSERT_EQ(all_overlaps(scene).size(), 1U);
  EXPECT_TRUE(all_overlaps(scene)[0].doubled);
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

// The ground outside would see five walls, but fifteen pairs of them would no longer see each other.
TEST(Overlaps, ARoomAboveTheGroundIsNotTurned) {
  std::istringstream in(
      "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2.5\nv 4 0 2.5\nv 4 3 2.5\nv 0 3 2.5\n"
      "v -50 -50 -1\nv 50 -50 -1\nv 50 50 -1\nv -50 50 -1\n"
      "g floor\nf 1 2 3 4\ng ceiling\nf 8 7 6 5\ng south\nf 5 6 2 1\ng east\nf 6 7 3 2\ng north\nf 7 8 4 3\n"
      "g west\nf 8 5 1 4\ng ground\nf 9 10 11 12\n");
  const Scene scene = read_obj(in, "s.obj");
  EXPECT_EQ(kinds_in(scene), Names{"unseen-front"});
  EXPECT_EQ(diagnose(scene)[0].flag, "");
}

// Turned round, a carpet that looks down would lie on the floor as a second front.
TEST(Overlaps, NoFrontIsTurnedOntoAnother) {
  PlainScene plain;
  add_tile(plain, "floor", 0, 0, 4, 4);
  plain.add_ring(plain.patch("carpet"), {{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}});
  plain.add_ring(plain.patch("wall"), {{0, 0, 0}, {0, 4, 0}, {0, 4, 4}, {0, 0, 4}});
  const Scene scene = generate::build(plain);
  EXPECT_EQ(words_in(scene, Kind::kUnseenFront),
            "no other patch sees the front of 'carpet', as far as rays can tell (receivers there see nothing, and it "
            "lights nothing); turning it round does not help; check the place");
}

// Walls whose vn all contradict a winding under which they see each other.
TEST(Overlaps, NormalsThatWouldDarkenARoomAreDoubted) {
  std::istringstream in(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 -1\nvn 0 0 1\n"
      "g floor\nf 1//1 2//1 3//1 4//1\ng lid\nf 8//2 7//2 6//2 5//2\n");
  const Scene scene = read_obj(in, "s.obj");
  const std::string words = words_in(scene, Kind::kNormals);
  EXPECT_NE(words.find("; turning them round may hide patches from each other: look first which is right"),
            std::string::npos)
      << words;
  EXPECT_EQ(diagnose(scene)[0].flag, "");
}

// A window on a wall, asked from another point of the wall: nothing is gained by a window that looks out.
TEST(Overlaps, NoSourceIsTurnedAwayFromItsRoom) {
  const Scene scene = regression_scene("window_on_a_wall");
  const std::vector<Receiver> receivers = grid_receivers(scene, scene.select("east"), {2, 2});
  const Selection window = scene.select("window");
  const std::vector<Problem> warnings = warnings_of_dark_sources(scene, receivers, std::span(&window, 1));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].message().find("--flip"), std::string::npos) << warnings[0].message();
  EXPECT_EQ(advice_to_flip(scene, std::span(&window, 1)), "");
}

TEST(Overlaps, BetweenSelectionsAloneAreFound) {
  PlainScene plain;
  add_tile(plain, "floor", 0, 0, 4, 4);
  add_tile(plain, "carpet", 1, 1, 1, 1);
  add_tile(plain, "carpet", 3, 3, 2, 1);
  const Scene scene = generate::build(plain);
  const std::vector<Selection> first{scene.select("floor"), scene.select("carpet:1")};
  ASSERT_EQ(overlapping_fronts(scene, first).size(), 1U);
  EXPECT_NEAR(overlapping_fronts(scene, first)[0].area, 1.0, 1e-12);
  const std::vector<Selection> alone{scene.select("carpet:1"), scene.select("carpet:2")};
  EXPECT_TRUE(overlapping_fronts(scene, alone).empty());
}

}  // namespace
}  // namespace exactff::slips
