// Solids that touch: boxes of whole unit cubes, in a room or not, in sheared coordinates. Which unit squares are buried
// is known from the cubes alone. The judge is the same scene made of the other unit squares, in which nothing touches.
#include "support/test.h"

namespace exactff::validation::contacts {
namespace {

using Cell = std::array<int, 3>;

// Maps whole coordinates to whole ones and keeps the orientation.
Vec3 sheared(double x, double y, double z) { return {x + 2.0 * y, y + 3.0 * z, z + x}; }

struct Cuboid {
  Cell low{}, high{};
  std::string name;
  bool is_room = false;  // its fronts are inside

  [[nodiscard]] bool holds(const Cell& cell) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell[k] < low[k] || cell[k] >= high[k]) return false;
    }
    return true;
  }
};

// A unit square on a side of a cuboid.
struct Square {
  std::size_t of = 0, axis = 0;
  bool is_high = false;
  Cell cell{};  // of the cube that it bounds, inside the cuboid
};

class Scenery {
 public:
  Scenery(Random& random, bool has_room) {
    if (has_room) cuboids_.push_back({{0, 0, 0}, {5, 4, 4}, "room", true});
    if (!has_room) cuboids_.push_back({{0, 0, -1}, {5, 4, 0}, "ground", false});
    const int boxes = random.integer(2, 5);
    for (int i = 0; i < boxes; ++i) add_box(random);
  }

  [[nodiscard]] const std::vector<Cuboid>& cuboids() const { return cuboids_; }

  [[nodiscard]] std::vector<Square> squares() const {
    std::vector<Square> result;
    for (std::size_t of = 0; of < cuboids_.size(); ++of) {
      const auto& [low, high, name, is_room] = cuboids_[of];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool is_high : {false, true}) {
          Cell from = low, to = high;
          (is_high ? from : to)[axis] = is_high ? high[axis] - 1 : low[axis] + 1;
          for (Cell c = from; c[0] < to[0]; ++c[0]) {
            for (c[1] = from[1]; c[1] < to[1]; ++c[1]) {
              for (c[2] = from[2]; c[2] < to[2]; ++c[2]) result.push_back({of, axis, is_high, c});
            }
          }
        }
      }
    }
    return result;
  }

  // A box is buried where the cube beyond the square is solid: in another box, or outside of the room. A room is, where
  // the cube before it is.
  [[nodiscard]] bool is_buried(const Square& square) const {
    Cell before = square.cell;
    if (!cuboids_[square.of].is_room) before[square.axis] += square.is_high ? 1 : -1;
    for (std::size_t of = 0; of < cuboids_.size(); ++of) {
      if (of != square.of && cuboids_[of].holds(before) != cuboids_[of].is_room) return true;
    }
    return false;
  }

  // Counter-clockwise as seen from the front.
  [[nodiscard]] std::vector<Vec3> corners(const Square& square) const {
    return rectangle(square, square.cell, {square.cell[0] + 1, square.cell[1] + 1, square.cell[2] + 1});
  }
  [[nodiscard]] std::vector<Vec3> side(std::size_t of, std::size_t axis, bool is_high) const {
    return rectangle({of, axis, is_high, {}}, cuboids_[of].low, cuboids_[of].high);
  }
  [[nodiscard]] static Vec3 middle(const std::vector<Vec3>& c) {
    return {0.5 * (c[0].x + c[2].x), 0.5 * (c[0].y + c[2].y), 0.5 * (c[0].z + c[2].z)};
  }

  // Whole sides, a patch for each cuboid.
  [[nodiscard]] Scene whole() const {
    SceneBuilder builder;
    const MaterialId material = builder.add_material({});
    add_sides(builder, material, "");
    return builder.build();
  }
  // The squares that are not buried. Among them, faces keep their order.
  [[nodiscard]] Scene exposed() const {
    SceneBuilder builder;
    const MaterialId material = builder.add_material({});
    add_exposed(builder, material);
    return builder.build();
  }
  // For receivers anywhere: whole sides as occluders, and transparent squares.
  [[nodiscard]] Scene exposed_and_whole() const {
    SceneBuilder builder;
    const MaterialId material = builder.add_material({});
    add_sides(builder, material, "whole ");
    add_exposed(builder, material);
    const Scene scene = builder.build();
    std::vector<Selection> squares;
    for (const Cuboid& cuboid : cuboids_) squares.push_back(scene.select(cuboid.name));
    return scene.with_transparent(squares);
  }

 private:
  void add_box(Random& random) {
    for (int tries = 0; tries < 50; ++tries) {
      Cuboid box{{}, {}, "box" + std::to_string(cuboids_.size()), false};
      for (std::size_t k = 0; k < 3; ++k) {
        const int end = k == 0 ? 5 : 4;
        box.low[k] = k == 2 && random.one_in(2) ? 0 : random.integer(0, end - 2);
        box.high[k] = box.low[k] + random.integer(1, std::min(2, end - 1 - box.low[k]));
      }
      const bool overlaps = std::ranges::any_of(cuboids_, [&](const Cuboid& other) {
        if (other.is_room) return false;
        for (std::size_t k = 0; k < 3; ++k) {
          if (box.high[k] <= other.low[k] || other.high[k] <= box.low[k]) return false;
        }
        return true;
      });
      if (overlaps) continue;
      cuboids_.push_back(box);
      return;
    }
  }

  [[nodiscard]] std::vector<Vec3> rectangle(const Square& square, const Cell& low, const Cell& high) const {
    const std::size_t k = square.axis, u = (k + 1) % 3, v = (k + 2) % 3;
    std::array<double, 3> at{};
    at[k] = square.is_high ? high[k] : low[k];
    std::vector<Vec3> corners;
    for (const auto& [on_u, on_v] :
         {std::pair(low[u], low[v]), {high[u], low[v]}, {high[u], high[v]}, {low[u], high[v]}}) {
      at[u] = on_u;
      at[v] = on_v;
      corners.push_back(sheared(at[0], at[1], at[2]));
    }
    if (square.is_high == cuboids_[square.of].is_room) std::ranges::reverse(corners);
    return corners;
  }
  static void add_face(SceneBuilder& builder, PatchId patch, MaterialId material, const std::vector<Vec3>& corners) {
    std::vector<std::uint32_t> ring;
    for (const Vec3& corner : corners) ring.push_back(builder.add_vertex(corner));
    builder.add_face(patch, material, {ring});
  }
  void add_sides(SceneBuilder& builder, MaterialId material, const std::string& prefix) const {
    for (std::size_t of = 0; of < cuboids_.size(); ++of) {
      const PatchId patch = builder.patch(prefix + cuboids_[of].name);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool is_high : {false, true}) add_face(builder, patch, material, side(of, axis, is_high));
      }
    }
  }
  void add_exposed(SceneBuilder& builder, MaterialId material) const {
    for (const Cuboid& cuboid : cuboids_) (void)builder.patch(cuboid.name);
    for (const Square& square : squares()) {
      if (!is_buried(square)) add_face(builder, builder.patch(cuboids_[square.of].name), material, corners(square));
    }
  }

  std::vector<Cuboid> cuboids_;
};

// The number of a square's side among the faces of whole().
FaceId side_of(const Square& square) {
  return static_cast<FaceId>(6 * square.of + 2 * square.axis + (square.is_high ? 1 : 0));
}

std::map<std::string, double> shares(const Scene& scene, const WholeView& seen) {
  std::map<std::string, double> result{{"(back)", seen.back.value}, {"(open)", seen.open.value}};
  for (const SeenPatch& patch : seen.patches) result[scene.patch(patch.patch).name] = patch.share.value;
  return result;
}

double value_of(const Scene& scene, const Receiver& receiver, const std::string& source) {
  const ExactSource of(scene, scene.select(source));
  return exact_form_factor(scene, receiver, of, {.engine = Engine::kBoth}).value;
}

class Contacts : public testing::TestWithParam<bool> {};

TEST_P(Contacts, AreBuriedAndChangeNothingElse) {
  for (std::uint64_t i = 0; i < scaled_count(5); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const Scenery scenery(random, GetParam());
    const Scene whole = scenery.whole(), exposed = scenery.exposed();
    std::size_t buried = 0, open = 0;
    std::uint32_t square_of_exposed = 0;
    for (const Square& square : scenery.squares()) {
      const std::vector<Vec3> corners = scenery.corners(square);
      Receiver receiver{Scenery::middle(corners), whole.face(side_of(square)).newell, {side_of(square)}, {}};
      const bool is_buried = scenery.is_buried(square);
      ASSERT_EQ(buried_under(whole, receiver).has_value(), is_buried);
      const std::uint32_t number = is_buried ? 0 : square_of_exposed++;
      if ((is_buried ? buried++ : open++) % 9 != 0) continue;
      const WholeView seen = view(whole, receiver);
      if (is_buried) {
        EXPECT_EQ(seen.buried.value, 1.0);
        EXPECT_TRUE(seen.patches.empty());
        EXPECT_EQ(seen.back.value + seen.open.value, 0.0);
        for (const Cuboid& cuboid : scenery.cuboids()) EXPECT_EQ(value_of(whole, receiver, cuboid.name), 0.0);
        continue;
      }
      Receiver there = receiver;
      there.on = {static_cast<FaceId>(number)};
      EXPECT_EQ(shares(whole, seen), shares(exposed, view(exposed, there)));
      for (const Cuboid& cuboid : scenery.cuboids()) {
        if (exposed.faces_of(exposed.select(cuboid.name)).empty()) continue;
        EXPECT_EQ(value_of(whole, receiver, cuboid.name), value_of(exposed, there, cuboid.name));
      }
    }
  }
}

TEST_P(Contacts, SendNothingEvenToWhoeverIsInside) {
  for (std::uint64_t i = 0; i < scaled_count(5); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const Scenery scenery(random, GetParam());
    const Scene whole = scenery.whole(), judge = scenery.exposed_and_whole();
    for (int k = 0; k < 4; ++k) {
      const auto at = [&](int end) { return random.integer(0, 8 * end - 1) / 8.0 + 0.0625; };
      const double x = at(5), y = at(4), z = at(4);
      const Vec3 normal{1.0 * random.integer(-3, 3), 1.0 * random.integer(-3, 3), 1.0};
      const Receiver receiver{sheared(x, y, z), normal, {}, {}};
      for (const Cuboid& cuboid : scenery.cuboids()) {
        EXPECT_EQ(value_of(whole, receiver, cuboid.name), value_of(judge, receiver, cuboid.name));
      }
      const WholeView seen = view(whole, receiver);
      for (const SeenPatch& patch : seen.patches) {
        EXPECT_EQ(patch.share.value, value_of(judge, receiver, whole.patch(patch.patch).name));
      }
    }
  }
}

TEST_P(Contacts, MatricesAreMeansOverWhatIsExposed) {
  constexpr double kAccuracy = 1e-2;
  for (std::uint64_t i = 0; i < scaled_count(1); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const Scenery scenery(random, GetParam());
    const auto matrix_of = [&](const Scene& scene) {
      std::vector<Selection> all;
      for (const Cuboid& cuboid : scenery.cuboids()) all.push_back(scene.select(cuboid.name));
      return matrix::compute(scene, all, all, {.factors = {.accuracy = kAccuracy}, .backs = true, .open = true});
    };
    const Scene whole = scenery.whole(), exposed = scenery.exposed();
    const auto is_all_buried = [&](const Cuboid& c) { return exposed.faces_of(exposed.select(c.name)).empty(); };
    if (std::ranges::any_of(scenery.cuboids(), is_all_buried)) continue;
    const matrix::Matrix made = matrix_of(whole), judge = matrix_of(exposed);
    ASSERT_FALSE(made.buried.empty());
    EXPECT_TRUE(reasons_against_one(whole, made).empty());
    for (const matrix::Sum& sum : row_sums(made)) {
      EXPECT_LE(sum.lower, 1.0);
      EXPECT_GE(sum.upper, 1.0);
    }
    const std::size_t size = scenery.cuboids().size();
    for (std::size_t row = 0; row < size; ++row) {
      const double share = 1.0 - made.buried[row].value, area = made.factors.at(row, 0).area_from;
      EXPECT_NEAR(judge.factors.at(row, 0).area_from, share * area, 1e-12 * area);
      EXPECT_LE(made.buried[row].upper - made.buried[row].lower, 1e-12);
      const auto expect_same = [&](const ViewFactor& f, const ViewFactor& of_exposed) {
        EXPECT_LE(f.lower, of_exposed.upper * share + 1e-12);
        EXPECT_GE(f.upper, of_exposed.lower * share - 1e-12);
        EXPECT_LE(f.upper - f.lower, kAccuracy);
      };
      for (std::size_t column = 0; column < size; ++column) {
        expect_same(made.factors.at(row, column), judge.factors.at(row, column));
      }
      expect_same(made.back[row], judge.back[row]);
      expect_same(made.open[row], judge.open[row]);
    }
  }
}

// --- Single cases ---

enum class Fronts { kOutside, kInside };

// Six faces of a patch. Vertices at one position are shared if `shared`.
struct Builder {
  explicit Builder(bool shares_vertices = false) : shares(shares_vertices) {}

  SceneBuilder builder;
  MaterialId material = builder.add_material({});
  bool shares;
  std::map<std::array<double, 3>, std::uint32_t> known;

  std::uint32_t vertex(const Vec3& v) {
    if (!shares) return builder.add_vertex(v);
    const auto [place, is_new] = known.try_emplace({v.x, v.y, v.z});
    if (is_new) place->second = builder.add_vertex(v);
    return place->second;
  }
  void add_face(const std::string& patch, std::vector<Vec3> corners) {
    std::vector<std::uint32_t> ring;
    for (const Vec3& corner : corners) ring.push_back(vertex(corner));
    builder.add_face(builder.patch(patch), material, {ring});
  }
  void add_box(const std::string& patch, const Vec3& a, const Vec3& b, Fronts fronts = Fronts::kOutside) {
    const Vec3 c[] = {a, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z},
                      b, {a.x, b.y, b.z}};
    for (const auto& side :
         {std::array{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {3, 0, 4, 7}}) {
      std::vector<Vec3> corners;
      for (const int i : side) corners.push_back(c[i]);
      if (fronts == Fronts::kInside) std::ranges::reverse(corners);
      add_face(patch, corners);
    }
  }
};
constexpr int kBottom = 1, kTop = 2;  // faces of add_box, from 1

// Whether the middle of the face is buried.
bool is_buried(const Scene& scene, const std::string& name) {
  const FaceId face = *scene.select(name).face;
  return buried_under(scene, centre_receivers(scene, std::vector{face}).front()).has_value();
}
std::string face_of(const std::string& patch, int number) { return patch + ':' + std::to_string(number); }

TEST(BuriedFaces, AreThreeSidesOfABoxInTheCornerOfARoom) {
  for (const bool shares : {false, true}) {
    Builder made(shares);
    made.add_box("room", {0, 0, 0}, {4, 4, 4}, Fronts::kInside);
    made.add_box("box", {0, 0, 0}, {1, 1, 1});
    const Scene scene = made.builder.build();
    int buried = 0;
    for (int face = 1; face <= 6; ++face) buried += is_buried(scene, face_of("box", face)) ? 1 : 0;
    EXPECT_EQ(buried, 3);
    EXPECT_TRUE(buried_under(scene, {{0.5, 0.5, 0}, {0, 0, 1}, {scene.faces_of(scene.select("room"))[0]}, {}}));
    EXPECT_FALSE(buried_under(scene, {{1.5, 0.5, 0}, {0, 0, 1}, {scene.faces_of(scene.select("room"))[0]}, {}}));
  }
}

TEST(BuriedFaces, AreNotThePartyWallsOfRooms) {
  for (const double height : {3.0, 2.0}) {
    Builder made;
    made.add_box("one", {0, 0, 0}, {4, 4, 3}, Fronts::kInside);
    made.add_box("other", {4, 0, 0}, {8, 4, height}, Fronts::kInside);
    EXPECT_FALSE(some_is_buried(made.builder.build()));
  }
}

TEST(BuriedFaces, AreNotTheSidesOfASheetOrOfATwoSidedRoom) {
  Builder lamp;
  lamp.add_face("up", {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  lamp.add_face("down", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  EXPECT_FALSE(some_is_buried(lamp.builder.build()));
  Builder made;
  made.add_box("room", {0, 0, 0}, {4, 4, 3}, Fronts::kInside);
  const Scene room = made.builder.build();
  EXPECT_FALSE(some_is_buried(matrix::with_two_sided(room, std::vector{room.select("room")})));
  for (int face = 1; face <= 6; ++face) {
    EXPECT_FALSE(some_is_buried(matrix::with_two_sided(room, std::vector{room.select(face_of("room", face))})));
  }
}

// The cover is made of two triangles; what is buried is open.
TEST(BuriedFaces, HoldTheCommonSideOfTwoCoversAndNotTheirBoundary) {
  Builder made;
  made.add_face("floor", {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0}, top{0.5, 0.5, 1};
  made.add_face("pyramid", {a, c, b});
  made.add_face("pyramid", {a, d, c});
  for (const auto& [p, q] : {std::pair(a, b), {b, c}, {c, d}, {d, a}}) made.add_face("pyramid", {p, q, top});
  const Scene scene = made.builder.build();
  const std::vector<FaceId> floor = scene.faces_of(scene.select("floor"));
  const auto is_buried_at = [&](double x, double y) {
    return buried_under(scene, {{x, y, 0}, {0, 0, 1}, floor, {}}).has_value();
  };
  EXPECT_TRUE(is_buried_at(0.5, 0.5));
  EXPECT_TRUE(is_buried_at(0.25, 0.25));
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {0.5, 0.0}, {1.0, 0.5}, {1.0, 1.0}, {0.0, 0.5}, {-0.5, 0.5}}) {
    EXPECT_FALSE(is_buried_at(x, y)) << x << ' ' << y;
  }
  EXPECT_FALSE(buried_under(scene, {{0.5, 0.5, 0}, {0, 0, -1}, floor, {}})) << "it looks from the back";
  EXPECT_FALSE(buried_under(scene, {{0.5, 0.5, 0}, {0, 0, 1}, {}, {}})) << "it lies on no face";
}

INSTANTIATE_TEST_SUITE_P(InARoom, Contacts, testing::Values(true));
INSTANTIATE_TEST_SUITE_P(OnTheGround, Contacts, testing::Values(false));

}  // namespace
}  // namespace exactff::validation::contacts
