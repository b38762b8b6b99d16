// The advice of `info` to turn patches round is silent in random rooms with windows, carpets, furniture and stray faces
// whose fronts are right (room_advice_test.cpp follows advice), and the fronts that lie on each other are named.
#include "kernel/vec.h"
#include "property/flip_judge.h"
#include "support/test.h"

namespace exactff::slips {
namespace {

using validation::advised_flips;
using validation::scaled_count;
using validation::seed_of;
using Corners = std::vector<Vec3>;

enum class Frame { kUpright, kExactlyTurned, kTurned };

// A room with fronts that look inward, and what stands in it.
class RoomMaker {
 public:
  explicit RoomMaker(Random& random)
      : random_(random), size_{random.between(2, 6), random.between(2, 6), random.between(2, 4)} {
    for (int k = 0; k < 3; ++k) (&size_.x)[k] = std::round(8 * (&size_.x)[k]) / 8;
  }

  PlainScene make() {
    add_walls();
    if (random_.one_in(2)) add_window();
    if (random_.one_in(2)) add_carpet();
    for (int count = random_.integer(0, 2); count > 0; --count) add_furniture(count);
    if (random_.one_in(3)) add_stray();
    if (random_.one_in(4)) add_neighbour();
    return std::move(scene_);
  }

  std::map<std::pair<std::string, std::string>, double> overlaps;  // smaller, larger, area

 private:
  void add(const std::string& name, const Corners& corners) { scene_.add_ring(scene_.patch(name), corners); }

  // Counter-clockwise seen from outside, or in the reverse direction.
  void add_box(const std::array<std::string, 6>& names, const Vec3& a, const Vec3& b, bool inward, bool bottom) {
    const std::array<Corners, 6> faces = {Corners{{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}},
                                          Corners{{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}},
                                          Corners{{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}},
                                          Corners{{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}},
                                          Corners{{b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}},
                                          Corners{{a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}}};
    for (std::size_t i = bottom ? 0 : 1; i < 6; ++i) {
      add(names[i], inward ? Corners(faces[i].rbegin(), faces[i].rend()) : faces[i]);
    }
  }

  void add_walls() {
    if (random_.one_in(4)) {
      add_box({"room", "room", "room", "room", "room", "room"}, {}, size_, true, true);
      floor_ = east_ = "room";
    } else {
      add_box({"floor", "ceiling", "south", "east", "north", "west"}, {}, size_, true, true);
    }
  }

  void add_window() {
    const double x = size_.x, y = size_.y / 4, z = size_.z / 4;
    add("window", {{x, y, 2 * z}, {x, 2 * y, 2 * z}, {x, 2 * y, z}, {x, y, z}});
    overlaps[{"window", east_}] = y * z;
  }

  void add_carpet() {
    const double x = size_.x / 2, y = size_.y / 2;
    add("carpet", {{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}});
    overlaps[{"carpet", floor_}] = x * y;
  }

  // Stands beyond the carpet, or hangs in the air.
  void add_furniture(int number) {
    const double x = size_.x / 2 + size_.x / 8 * number, y = size_.y / 2, z = random_.one_in(3) ? 0.25 : 0.0;
    const std::string name = "thing" + std::to_string(number);
    std::array<std::string, 6> names;
    const bool apart = random_.one_in(2);
    for (std::size_t i = 0; i < 6; ++i) names[i] = name + (apart ? "_" + std::to_string(i) : "");
    add_box(names, {x, y, z}, {x + size_.x / 16, y + size_.y / 4, z + 0.5}, false, random_.one_in(2));
  }

  // Another room, behind the north wall.
  void add_neighbour() {
    std::array<std::string, 6> names;
    const bool apart = random_.one_in(2);
    for (std::size_t i = 0; i < 6; ++i) names[i] = "neighbour" + (apart ? std::to_string(i) : "");
    const double y = size_.y + (random_.one_in(2) ? 0.25 : 0.0);
    add_box(names, {0, y, 0}, {size_.x, y + 2, 2}, true, true);
  }

  void add_stray() {
    const double x = size_.x + random_.between(0.5, 2);
    Corners corners{{x, 0.5, 0.5}, {x, 1, 0.5}, {x, 1, 1}};
    if (random_.one_in(2)) std::ranges::reverse(corners);
    add("stray", corners);
  }

  Random& random_;
  Vec3 size_;
  PlainScene scene_;
  std::string floor_ = "floor", east_ = "east";
};

// Lengths are 5 times as large in the exact frame.
void turn(PlainScene& scene, Frame frame, Random& random) {
  if (frame == Frame::kUpright) return;
  Vec3 u{3, 4, 0}, v{-4, 3, 0}, w{0, 0, 5};
  if (frame == Frame::kTurned) {
    u = kernel::unit({random.between(-1, 1), random.between(-1, 1), 1.5});
    v = kernel::unit(kernel::cross({0.3, 1, random.between(-1, 1)}, u));
    w = kernel::cross(u, v);
  }
  for (Vec3& p : scene.vertices) {
    p = kernel::along(kernel::along(kernel::scaled(u, p.x), v, p.y), w, p.z);
  }
}

constexpr std::array kFrames = {Frame::kUpright, Frame::kExactlyTurned, Frame::kTurned};

TEST(FlipAdvice, IsNotGivenForRoomsThatAreRight) {
  std::size_t named = 0;
  for (std::uint64_t s = 0; s < scaled_count(60); ++s) {
    Random random(seed_of(s));
    RoomMaker maker(random);
    PlainScene plain = maker.make();
    const Frame frame = kFrames[s % 3];
    turn(plain, frame, random);
    const Scene scene = generate::build(plain);
    EXPECT_TRUE(advised_flips(scene).empty()) << s << '\n' << generate::to_obj(plain);
    std::vector<Selection> patches;
    for (const Patch& patch : scene.patches()) patches.push_back(scene.select(patch.name));
    const std::vector<Overlap> overlaps = overlapping_fronts(scene, patches);
    EXPECT_EQ(overlaps.size(), maker.overlaps.size()) << s << '\n' << generate::to_obj(plain);
    for (const Overlap& one : overlaps) {
      const std::pair names(scene.name_of(one.smaller), scene.name_of(one.larger));
      ASSERT_TRUE(maker.overlaps.contains(names)) << s << ' ' << names.first << ' ' << names.second;
      const double area = maker.overlaps.at(names) * (frame == Frame::kExactlyTurned ? 25.0 : 1.0);
      EXPECT_NEAR(one.area, area, 1e-9 * area) << s;
      EXPECT_TRUE(frame == Frame::kTurned || one.apart == 0.0) << s;
      ++named;
    }
  }
  EXPECT_GT(named, scaled_count(30));
}

}  // namespace
}  // namespace exactff::slips
