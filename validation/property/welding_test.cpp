// Rooms whose corners were moved by a slip of an export, welded to the rooms that were meant.
#include "property/closed_rooms.h"
#include "support/test.h"
#include "support/transform.h"

namespace exactff::validation {
namespace {

using Place = std::tuple<double, double, double>;

Place place_of(const Vec3& v) { return {v.x, v.y, v.z}; }

// Faces as cycles of positions, from the lowest, with the names of their patches; sorted.
std::vector<std::pair<std::string, std::vector<Place>>> shape_of(const Scene& scene) {
  std::vector<std::pair<std::string, std::vector<Place>>> faces;
  for (const Face& face : scene.faces()) {
    std::vector<Place> all;
    for (const auto& ring : face.rings) {
      std::vector<Place> places;
      for (const std::uint32_t v : ring) places.push_back(place_of(scene.vertices()[v]));
      std::rotate(places.begin(), std::ranges::min_element(places), places.end());
      all.insert(all.end(), places.begin(), places.end());
    }
    faces.emplace_back(scene.patch(face.patch).name, all);
  }
  std::ranges::sort(faces);
  return faces;
}

std::size_t bent_faces(const Scene& scene) {
  return static_cast<std::size_t>(
      std::ranges::count(scene.faces(), FaceShape::kTriangulated, [](const Face& face) { return face.shape; }));
}

TEST(Welding, ClosesRoomsWhoseCornersMoved) {
  std::size_t cells = 0, meant_cells = 0;
  for (std::uint64_t s = 0; s < scaled_count(60); ++s) {
    Random random(seed_of(s));
    const PlainScene room = random_plain_room(random);
    const double moved = std::pow(10.0, -12.0 + 9.0 * random.unit());
    SCOPED_TRACE("seed " + std::to_string(seed_of(s)) + ", moved " + std::to_string(moved));
    const Scene meant = generate::build(room), scene = generate::build(with_moved_corners(room, moved, seed_of(s)));
    const std::optional<Gap> gap = exactff::gap(scene);
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->open_edges, 0U);
    EXPECT_EQ(gap->open_edges_before, scene.open_edge_count());
    EXPECT_LE(gap->length, 7.0 * moved);
    const WeldedScene welded = exactff::welded(scene, 4.0 * moved);
    EXPECT_EQ(welded.scene.open_edge_count(), 0U);
    EXPECT_EQ(exactff::welded(scene, gap->length).scene.open_edge_count(), 0U);
    EXPECT_EQ(bent_faces(welded.scene), 0U);
    EXPECT_EQ(welded.corners, meant.vertices().size());
    EXPECT_TRUE(welded.vanished.empty() && welded.sheets.empty());
    EXPECT_LE(welded.largest_move, 2.0 * std::sqrt(3.0) * moved);
    EXPECT_EQ(exactff::gap(welded.scene).has_value(), false);
    for (std::size_t f = 0; f < meant.faces().size(); ++f) {
      EXPECT_NEAR(welded.scene.faces()[f].area, meant.faces()[f].area, 30.0 * moved);
    }
    const auto factor = [](const Scene& of) {
      return view_factor(of, of.select("wall0"), of.select("wall1"), {.accuracy = 1e-3});
    };
    const ViewFactor f = factor(welded.scene), g = factor(meant);
    EXPECT_NEAR(f.value, g.value, 1e-3 + 20.0 * moved);
    cells += f.cells;
    meant_cells += g.cells;
  }
  EXPECT_LE(cells, 2 * meant_cells) << meant_cells;
}

// Rooms, also with things in them, of which lengths up to a quarter of a side remove details.
TEST(Welding, DependsOnNoOrderAndChangesNothingTwice) {
  std::size_t made = 0, refused = 0;
  for (std::uint64_t s = 0; s < scaled_count(300); ++s) {
    Random random(seed_of(s));
    PlainScene room = random.one_in(2) ? random_plain_room(random) : random_hull_room(random);
    if (random.one_in(3)) add_thing(room, box({0.25, 0.25, 0.0}, {0.75, 0.5, 0.5}));
    const double moved = std::pow(10.0, -12.0 + 11.0 * random.unit());
    const PlainScene plain = with_moved_corners(room, moved, seed_of(s));
    const double length = moved * std::pow(10.0, random.between(-0.5, 0.7));
    SCOPED_TRACE("seed " + std::to_string(seed_of(s)) + ", length " + std::to_string(length));
    const auto weld = [&](const Scene& scene) { return welded(scene, length); };
    const std::string complaint = validation::complaint([&] { (void)weld(generate::build(plain)); });
    const Scene other = generate::build(shuffled(plain, random));
    const std::string also = validation::complaint([&] { (void)weld(other); });
    // Whether a bent face can be cut depends on the order of its vertices.
    const bool is_uncut = holds(complaint + also, "crosses itself") || holds(complaint + also, "no triangulation");
    EXPECT_TRUE(also.empty() == complaint.empty() || is_uncut) << complaint << also;
    if (!(complaint + also).empty()) {
      ++refused;
      continue;
    }
    ++made;
    const WeldedScene once = weld(generate::build(plain)), shuffled = weld(other);
    EXPECT_EQ(shape_of(once.scene), shape_of(shuffled.scene));
    EXPECT_EQ(once.largest_move, shuffled.largest_move);
    if (bent_faces(once.scene) == 0) {
      EXPECT_EQ(once.sheets.size(), shuffled.sheets.size());
    }
    EXPECT_LE(once.largest_move, 8.0 * length);
    const WeldedScene twice = weld(once.scene);
    EXPECT_EQ(shape_of(twice.scene), shape_of(once.scene));
    EXPECT_EQ(twice.largest_move, 0.0);
    EXPECT_EQ(twice.junctions, 0U);
    EXPECT_EQ(twice.corners_before, twice.corners);
    EXPECT_TRUE(twice.vanished.empty());
  }
  EXPECT_GT(made, 4 * refused);
}

Scene scene_of_rings(const std::vector<std::pair<std::string, std::vector<Vec3>>>& faces) {
  PlainScene scene;
  for (const auto& [name, ring] : faces) scene.add_ring(scene.patch(name), ring);
  return generate::build(scene);
}

TEST(Welding, LinksCornersAtExactlyTheLength) {
  const Scene scene =
      scene_of_rings({{"a", {{-9, -9, 0}, {3, -9, 0}, {0, 0, 0}}}, {"b", {{3, 4, 0}, {9, 9, 0}, {0, 9, 0}}}});
  EXPECT_EQ(welded(scene, 5.0).corners, 5U);
  EXPECT_EQ(welded(scene, std::nextafter(5.0, 0.0)).corners, 6U);
}

TEST(Welding, PutsCornersIntoOpenEdgesThatTheyTouch) {
  const auto scene = [](double off) {
    return scene_of_rings({{"whole", {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}}},
                           {"left", {{0, off, 0}, {0, -2, 0}, {1.5, -2, 0}, {1.5, -off, 0}}},
                           {"right", {{1.5, off, 0}, {1.5, -2, 0}, {4, -2, 0}, {4, 0, 0}}}});
  };
  for (const double off : {0.0, 1e-9}) {
    const WeldedScene made = welded(scene(off), 3e-9);
    EXPECT_EQ(made.junctions, 1U);
    EXPECT_EQ(made.scene.faces()[0].rings[0].size(), 5U);
    EXPECT_EQ(made.scene.open_edge_count(), 7U);
    EXPECT_EQ(bent_faces(made.scene), 0U);
  }
  EXPECT_FALSE(gap(scene(0.0)));
  ASSERT_TRUE(gap(scene(1e-9)));
  EXPECT_GT(gap(scene(1e-9))->length, 0.99e-9);
  EXPECT_LT(gap(scene(1e-9))->length, 2.1e-9);
}

TEST(Welding, IsNotAdvisedForSheetsThatLieNearEachOther) {
  const auto sheet = [](double x, double z) {
    return std::vector<Vec3>{{x, 0, z}, {x + 1, 0, z}, {x + 1, 1, z}, {x, 1, z}};
  };
  const double d = 0x1p-9;
  EXPECT_FALSE(gap(scene_of_rings({{"a", sheet(0, 0)}, {"b", sheet(1 + d, 0)}, {"c", sheet(2 + 2 * d, 0)}})));
  EXPECT_FALSE(gap(scene_of_rings({{"a", sheet(0, 0)}, {"b", sheet(0, d)}, {"c", sheet(0, 2 * d)}})));
  const std::vector<Vec3> upright{{-d, 0, 0}, {-d, 1, 0}, {-d, 1, 1}, {-d, 0, 1}};
  EXPECT_FALSE(gap(scene_of_rings({{"a", sheet(0, 0)}, {"b", upright}})));
  // A room closes beside them, within its own distance.
  Random random(seed_of(0));
  PlainScene room = with_moved_corners(random_plain_room(random), 1e-5, 7);
  room.add_ring(room.patch("tile"), sheet(50, 0));
  room.add_ring(room.patch("tile"), sheet(51 + d, 0));
  const std::optional<Gap> found = gap(generate::build(room));
  ASSERT_TRUE(found);
  EXPECT_LT(found->length, 1e-4);
  EXPECT_EQ(found->open_edges, 8U);
}

TEST(Welding, TellsSheetsAndMergesNone) {
  const auto plates = [](double size, double z) {
    return scene_of_rings({{"floor", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}},
                           {"mat", {{1, 1, z}, {1 + size, 1, z}, {1 + size, 2, z}, {1, 2, z}}},
                           {"lid", {{0, 0, 1}, {0, 4, 1}, {4, 4, 1}, {4, 0, 1}}},
                           {"cover", {{0, 0, 1 + z}, {4, 0, 1 + z}, {4, 4, 1 + z}, {0, 4, 1 + z}}}});
  };
  const WeldedScene made = welded(plates(2.0, 0x1p-10), 0x1p-9);
  ASSERT_EQ(made.scene.faces().size(), 4U);
  ASSERT_EQ(made.sheets.size(), 2U);
  EXPECT_EQ(made.sheets[0].apart, 0x1p-10);
  EXPECT_EQ(made.scene.name_of(made.sheets[0].one), "floor:1");
  EXPECT_EQ(made.scene.name_of(made.sheets[0].other), "mat:1");
  EXPECT_EQ(made.sheets[1].apart, 0.0);
  EXPECT_EQ(made.scene.name_of(made.sheets[1].other), "cover:1");
  EXPECT_TRUE(welded(plates(2.0, 0x1p-10), 0x1p-11).sheets.empty());
}

TEST(Welding, NamesFacesThatVanishAndRefusesToMeltAScene) {
  const Scene strip = scene_of_rings({{"wall", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}},
                                      {"strip", {{4, 0, 0}, {4.0001, 0, 0}, {4.0001, 4, 0}, {4, 4, 0}}},
                                      {"more", {{4.0001, 0, 0}, {8, 0, 0}, {8, 4, 0}, {4.0001, 4, 0}}}});
  const WeldedScene made = welded(strip, 0.001);
  ASSERT_EQ(made.vanished.size(), 1U);
  EXPECT_EQ(strip.name_of(made.vanished[0]), "strip");
  EXPECT_EQ(made.scene.open_edge_count(), 6U);
  PlainScene stairs;
  for (int k = 0; k < 40; ++k)
    stairs.add_ring(stairs.patch("row"), {{k * 1.0, 0, 0}, {k + 1.0, 0, 0}, {k + 1.0, 9, 0}, {k * 1.0, 9, 0}});
  const Scene row = generate::build(stairs);
  EXPECT_TRUE(holds(complaint([&] { (void)welded(row, 1.0); }), "a chain of corners within this length"));
  EXPECT_EQ(welded(row, 0.99).corners, row.vertices().size() / 4 * 2 + 2);
  for (const double bad : {0.0, -1.0, HUGE_VAL, 1e-60}) EXPECT_NE(complaint([&] { (void)welded(row, bad); }), "");
  EXPECT_TRUE(holds(complaint([&] { (void)welded(strip, 100.0); }), "nothing is left of the scene"));
  // Two that would close by becoming nothing.
  const Scene slivers = scene_of_rings(
      {{"one", {{0, 0, 0}, {10, 0, 0}, {10, 0.125, 0}}}, {"other", {{0, 0, 0}, {10, 0.125, 0}, {10, 0.25, 0}}}});
  const std::optional<Gap> found = gap(slivers);
  EXPECT_TRUE(!found || welded(slivers, found->length).vanished.empty());
}

}  // namespace
}  // namespace exactff::validation
