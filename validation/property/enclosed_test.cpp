// Closed surfaces around what a patch sees: rooms, and scenes of every family, judged by whole views of points.
#include "property/closed_rooms.h"
#include "support/test.h"
#include "view_factors/pairs.h"

namespace exactff::validation::enclosed_patches {
namespace {

std::vector<Selection> all_of(const Scene& scene) {
  std::vector<Selection> all;
  for (const Patch& patch : scene.patches()) all.push_back(scene.select(patch.name));
  return all;
}

// The patches that are enclosed, by name.
std::vector<std::string> enclosed(const Scene& scene) {
  const std::vector<Selection> all = all_of(scene);
  const view_factors::Pairs pairs(scene, all, all, {});
  std::vector<std::string> names;
  for (std::size_t row = 0; row < all.size(); ++row) {
    if (pairs.is_enclosed(row)) names.push_back(scene.name_of(all[row]));
  }
  return names;
}
std::vector<std::string> enclosed(const PlainScene& plain) { return enclosed(generate::build(plain)); }

const std::vector<std::string> kWalls{"wall0", "wall1", "wall2", "wall3", "wall4", "wall5"};

PlainScene room() {
  PlainScene scene;
  add_room(scene, box({0, 0, 0}, {4, 3, 2}));
  return scene;
}

void turn_round(PlainScene& scene) {
  for (generate::PlainPatch& patch : scene.patches) {
    for (generate::PlainFace& face : patch.faces) {
      for (auto& ring : face.rings) std::ranges::reverse(ring);
    }
  }
}

TEST(Enclosed, AreTheWallsOfARoom) {
  EXPECT_EQ(enclosed(room()), kWalls);
  PlainScene turned = room();
  turn_round(turned);
  EXPECT_EQ(enclosed(turned), std::vector<std::string>{});
}

TEST(Enclosed, IsNobodyWhereAWallIsMissingOrTransparent) {
  PlainScene plain = room();
  const Scene scene = generate::build(plain);
  EXPECT_EQ(enclosed(scene.with_transparent(std::vector{scene.select("wall2")})), std::vector<std::string>{});
  plain.patches.pop_back();
  EXPECT_EQ(enclosed(plain), std::vector<std::string>{});
}

TEST(Enclosed, IsAThingInARoomAndNotOneOutside) {
  PlainScene plain = room();
  add_thing(plain, box({1, 1, 0.5}, {2, 2, 1.5}));
  std::vector<std::string> all = kWalls;
  all.emplace_back("things");
  EXPECT_EQ(enclosed(plain), all);
  PlainScene apart = room();
  add_thing(apart, box({10, 1, 0.5}, {12, 2, 1.5}));
  EXPECT_EQ(enclosed(apart), kWalls);
}

// Its centre is inside, its tip outside.
TEST(Enclosed, IsNoPatchThatPiercesAWall) {
  PlainScene plain = room();
  plain.add_ring(plain.patch("blade"), {{1, 1, 1}, {5, 1.5, 1}, {1, 2, 1}});
  EXPECT_EQ(enclosed(plain), kWalls);
}

// The upper half of one wall is two faces, the lower half is one: corners of others lie in the middle of its edges.
TEST(Enclosed, AreTheWallsOfARoomWithTJunctions) {
  PlainScene plain;
  plain.add_ring(plain.patch("floor"), {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
  plain.add_ring(plain.patch("ceiling"), {{0, 0, 2}, {0, 3, 2}, {4, 3, 2}, {4, 0, 2}});
  plain.add_ring(plain.patch("left"), {{0, 0, 0}, {0, 3, 0}, {0, 3, 2}, {0, 0, 2}});
  plain.add_ring(plain.patch("right"), {{4, 0, 0}, {4, 0, 2}, {4, 3, 2}, {4, 3, 0}});
  plain.add_ring(plain.patch("front"), {{0, 0, 0}, {0, 0, 2}, {4, 0, 2}, {4, 0, 0}});
  plain.add_ring(plain.patch("low"), {{0, 3, 0}, {4, 3, 0}, {4, 3, 1}, {0, 3, 1}});
  plain.add_ring(plain.patch("west"), {{0, 3, 1}, {1, 3, 1}, {1, 3, 2}, {0, 3, 2}});
  plain.add_ring(plain.patch("east"), {{1, 3, 1}, {4, 3, 1}, {4, 3, 2}, {1, 3, 2}});
  EXPECT_EQ(enclosed(plain).size(), 8U);
  PlainScene moved = plain;
  for (Vec3& vertex : moved.vertices) {
    if (vertex == Vec3{1, 3, 2}) vertex.z = 1.9375;
  }
  EXPECT_EQ(enclosed(moved), std::vector<std::string>{});
}

// A corner in the middle of the ceiling's edge touches the neighbour's part at one point.
TEST(Enclosed, IsEveryPatchOfView3DsClosedRooms) {
  for (const char* name : {"facet", "test4", "box345", "gunter1"}) {
    const Scene scene = read_scene(std::string(EXACTFF_DATA_DIR) + "/scenes/formats/" + name + ".vs3");
    EXPECT_EQ(enclosed(scene).size(), scene.patches().size()) << name;
  }
}

struct Counts {
  std::size_t enclosed = 0, open = 0;
};

// False where the area is no double.
bool is_enclosed_and_has_area(const Scene& scene, const Selection& patch) {
  try {
    return view_factors::Pairs(scene, {&patch, 1}, {&patch, 1}, {}).is_enclosed(0);
  } catch (const InputError&) {
    return false;
  }
}

// Points are rounded, and may see past an edge by as little.
void judge(const Scene& scene, const std::string& where, Counts& counts) {
  constexpr double kRounding = 1e-9;
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection patch{static_cast<PatchId>(p), {}, scene.id()};
    if (scene.faces_of(patch).empty()) continue;
    const bool is_enclosed = is_enclosed_and_has_area(scene, patch);
    counts.enclosed += is_enclosed ? 1 : 0;
    bool is_open = false;
    for (const Receiver& receiver : sample_receivers(scene, scene.faces_of(patch), 6, p + 1)) {
      const double open = view(scene, receiver).open.value;
      is_open = is_open || open > kRounding;
      EXPECT_TRUE(!is_enclosed || open <= kRounding) << where << ' ' << scene.name_of(patch) << ' ' << open;
    }
    counts.open += is_open ? 1 : 0;
  }
}

TEST(Enclosed, SeesNothingOpenInRooms) {
  Counts counts;
  for (std::uint64_t s = 0; s < scaled_count(20); ++s) {
    Random random(seed_of(s));
    generate::PlainScene plain = s % 2 == 0 ? random_building(random).scene : random_hull_room(random);
    if (s % 4 >= 2) plain.patches.erase(plain.patches.begin() + random.integer(0, 5));
    judge(generate::build(plain), std::to_string(s), counts);
  }
  EXPECT_GE(counts.enclosed, 20U);
  EXPECT_GE(counts.open, 20U);
}

TEST(Enclosed, SeesNothingOpenInEveryFamily) {
  Counts counts;
  for (const RandomFamily& family : random_families()) {
    for (std::uint64_t s = 0; s < scaled_count(3); ++s) {
      Random random(seed_of(s));
      judge(generate::build(family.make(random)), std::string(family.name) + ' ' + std::to_string(s), counts);
    }
  }
  EXPECT_GE(counts.open, 20U);
}

// --- Backs that closed surfaces hide ---

// Some faces of a thing are taken away, and so are walls: what is left has holes in one plane, or in several.
PlainScene room_with_holes(Random& random) {
  PlainScene plain = random.below(2) == 0 ? random_building(random).scene : random_hull_room(random);
  if (random.below(2) == 0) plain.patches.erase(plain.patches.begin() + random.integer(0, 3));
  for (generate::PlainPatch& patch : plain.patches) {
    if (patch.name != "things" || random.below(3) == 0) continue;
    patch.faces.erase(patch.faces.begin() + static_cast<std::ptrdiff_t>(random.below(patch.faces.size())));
  }
  return plain;
}

struct BackCounts {
  std::size_t proved = 0, seen = 0;
};

// Where a row is proved to see no back, no point does.
void judge_backs(const Scene& scene, const std::string& where, BackCounts& counts) {
  constexpr double kRounding = 1e-9;
  std::vector<Selection> rows;
  for (const Selection& patch : all_of(scene)) {
    if (!scene.faces_of(patch).empty()) rows.push_back(patch);
  }
  std::vector<ViewFactor> backs;
  try {
    backs = matrix::compute(scene, rows, {}, {.factors = {.accuracy = 1.0, .budget = 20}, .backs = true}).back;
  } catch (const InputError&) {
    return;  // an area is no double
  }
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const bool is_proved = backs[row].claim == Claim::kZero;
    counts.proved += is_proved ? 1 : 0;
    bool is_seen = false;
    for (const Receiver& receiver : sample_receivers(scene, scene.faces_of(rows[row]), 6, row + 1)) {
      const double back = view(scene, receiver).back.value;
      is_seen = is_seen || back > kRounding;
      EXPECT_TRUE(!is_proved || back <= kRounding) << where << ' ' << scene.name_of(rows[row]) << ' ' << back;
    }
    counts.seen += is_seen ? 1 : 0;
  }
}

TEST(HiddenBacks, AreSeenFromNoPointOfRoomsWithHoles) {
  BackCounts counts;
  for (std::uint64_t s = 0; s < scaled_count(30); ++s) {
    Random random(seed_of(s));
    judge_backs(generate::build(room_with_holes(random)), std::to_string(s), counts);
  }
  EXPECT_GE(counts.proved, 50U);
  EXPECT_GE(counts.seen, 10U);
}

TEST(HiddenBacks, AreSeenFromNoPointInEveryFamily) {
  BackCounts counts;
  for (const RandomFamily& family : random_families()) {
    Random random(seed_of(1));
    judge_backs(generate::build(family.make(random)), family.name, counts);
  }
  EXPECT_GE(counts.seen, 3U);
}

// --- How much is open ---

struct Mean {
  double value = 0.0, standard_error = 0.0;
};

// Of whole views from random points.
Mean mean_of_views(const Scene& scene, const Selection& patch, std::uint64_t count, std::uint64_t seed) {
  double sum = 0.0, squares = 0.0;
  for (const Receiver& receiver : sample_receivers(scene, scene.faces_of(patch), count, seed)) {
    const double open = view(scene, receiver).open.value;
    sum += open;
    squares += open * open;
  }
  const auto n = static_cast<double>(count);
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0))};
}

// Nothing where a patch's area is no double beside the rest of the scene, or the scene is too large for a sky.
std::optional<ViewFactor> open_to(const Scene& scene, const Selection& patch, const ViewFactorOptions& options) {
  try {
    return matrix::compute(scene, {&patch, 1}, {}, {.factors = options, .open = true, .threads = 1}).open.front();
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// Each row with cells alone, certified, and with points where they cost less.
struct Judged {
  std::size_t open = 0, certified = 0, in_part = 0;
};
void judge_open(const Scene& scene, const Selection& patch, const std::string& where, std::uint64_t points,
                Judged& judged) {
  const Mean mean = mean_of_views(scene, patch, points, 7);
  for (const bool certify : {false, true}) {
    for (const bool points_too : {false, true}) {
      if (certify && points_too) continue;
      const std::optional<ViewFactor> f = open_to(scene, patch,
                                                  {.accuracy = 1e-3,
                                                   .budget = 1000,
                                                   .sample_crowds = points_too,
                                                   .both_directions = false,
                                                   .certify = certify});
      if (!f) return;
      EXPECT_LE(f->lower, f->value) << where;
      EXPECT_LE(f->value, f->upper) << where;
      EXPECT_LE(f->lower - 5.0 * mean.standard_error - 1e-6, mean.value) << where << ' ' << certify << points_too;
      EXPECT_GE(f->upper + 5.0 * mean.standard_error + 1e-6, mean.value) << where << ' ' << certify << points_too;
      judged.open += f->accurate && f->value > 0.0 ? 1 : 0;
      judged.certified += f->accurate && f->claim == Claim::kCertified ? 1 : 0;
      judged.in_part += f->accurate && f->lower > 0.01 && f->upper < 0.99 ? 1 : 0;
    }
  }
}

TEST(Open, IsTheMeanOfViewsInRoomsWithoutAWall) {
  Judged judged;
  for (std::uint64_t s = 0; s < scaled_count(6); ++s) {
    Random random(seed_of(s));
    generate::PlainScene plain = s % 3 == 0 ? random_hull_room(random) : random_building(random).scene;
    plain.patches.erase(plain.patches.begin() + random.integer(0, 3));
    const Scene scene = generate::build(plain);
    for (int i = 0; i < 2; ++i) {
      const Selection patch{static_cast<PatchId>(random.below(scene.patches().size())), {}, scene.id()};
      if (scene.faces_of(patch).size() != 1) continue;
      judge_open(scene, patch, std::to_string(s) + ' ' + scene.name_of(patch), 256, judged);
    }
  }
  EXPECT_GE(judged.open, 10U);
  EXPECT_GE(judged.certified, 3U);
  EXPECT_GE(judged.in_part, 5U);
}

TEST(Open, IsTheMeanOfViewsInRandomScenes) {
  Judged judged;
  for (std::uint64_t s = 0; s < scaled_count(15); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(s % 2 == 0 ? degenerate_scene(random) : generic_scene(random));
    const Selection patch{static_cast<PatchId>(random.below(scene.patches().size())), {}, scene.id()};
    if (scene.faces_of(patch).size() != 1) continue;
    judge_open(scene, patch, std::to_string(s) + ' ' + scene.name_of(patch), 256, judged);
  }
  EXPECT_GE(judged.open, 10U);
  EXPECT_GE(judged.in_part, 5U);
}

// In a room that is open at its front.
TEST(Open, IsTheRestOfARow) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  const std::vector<Selection> all = all_of(scene);
  const matrix::Matrix m =
      matrix::compute(scene, all, all, {.factors = {.accuracy = 1e-2}, .backs = true, .open = true});
  for (std::size_t row = 0; row < all.size(); ++row) {
    double lower = m.back[row].lower, upper = m.back[row].upper;
    for (std::size_t column = 0; column < all.size(); ++column) {
      lower += m.factors.at(row, column).lower;
      upper += m.factors.at(row, column).upper;
    }
    EXPECT_TRUE(m.open[row].accurate);
    EXPECT_LE(m.open[row].lower, 1.0 - lower + 1e-9) << scene.name_of(all[row]);
    EXPECT_GE(m.open[row].upper, 1.0 - upper - 1e-9) << scene.name_of(all[row]);
    EXPECT_LE(m.open[row].cells, 20000U) << "edges of the sky must make no cells";
  }
}

}  // namespace
}  // namespace exactff::validation::enclosed_patches
