#include "generate/patched_rooms.h"

#include <array>
#include <string>

#include "generate/vectors.h"

namespace exactff::models {
namespace {

void add_parallelogram(PlainScene& scene, const std::string& name, const Vec3& corner, const Vec3& u, const Vec3& v) {
  scene.add_ring(scene.patch(name), {corner, corner + u, corner + u + v, corner + v});
}

// A wall in rows x columns patches.
void add_wall(PlainScene& scene, const std::string& name, const Vec3& corner, const Vec3& u, int columns, const Vec3& v,
              int rows) {
  const Vec3 du = (1.0 / columns) * u, dv = (1.0 / rows) * v;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      add_parallelogram(scene, name + '_' + std::to_string(i) + '_' + std::to_string(j),
                        corner + static_cast<double>(i) * du + static_cast<double>(j) * dv, du, dv);
    }
  }
}

// A box of whole sides, fronts inward, in patches of 1 / n.
void add_shell(PlainScene& scene, int width, int depth, int height, int n) {
  const Vec3 x{static_cast<double>(width), 0, 0}, y{0, static_cast<double>(depth), 0},
      z{0, 0, static_cast<double>(height)};
  add_wall(scene, "floor", {}, x, width * n, y, depth * n);
  add_wall(scene, "ceiling", z, y, depth * n, x, width * n);
  add_wall(scene, "left", {}, y, depth * n, z, height * n);
  add_wall(scene, "right", x, z, height * n, y, depth * n);
  add_wall(scene, "front", {}, z, height * n, x, width * n);
  add_wall(scene, "back", y, x, width * n, z, height * n);
}

// The parallelepiped of a right-handed triple of sides, fronts outward.
void add_block(PlainScene& scene, const std::string& name, const Vec3& o, const Vec3& a, const Vec3& b, const Vec3& c) {
  int side = 0;
  const auto add = [&](const Vec3& corner, const Vec3& u, const Vec3& v) {
    add_parallelogram(scene, name + '_' + std::to_string(side++), corner, u, v);
  };
  add(o, b, a);
  add(o + c, a, b);
  add(o, a, c);
  add(o + b, c, a);
  add(o, c, b);
  add(o + a, b, c);
}

void add_box(PlainScene& scene, const std::string& name, const Vec3& low, const Vec3& high) {
  add_block(scene, name, low, {high.x - low.x, 0, 0}, {0, high.y - low.y, 0}, {0, 0, high.z - low.z});
}

// With sides of 9 s, whose coordinates are whole multiples of s.
void add_tilted_cube(PlainScene& scene, const std::string& name, const Vec3& centre, double s) {
  const Vec3 a = s * Vec3{8, -4, 1}, b = s * Vec3{1, 4, 8}, c = s * Vec3{-4, -7, 4};
  add_block(scene, name, centre + -0.5 * (a + b + c), a, b, c);
}

// With sides of 5 s.
void add_standing_cube(PlainScene& scene, const std::string& name, const Vec3& corner, double s) {
  add_block(scene, name, corner, s * Vec3{3, 4, 0}, s * Vec3{-4, 3, 0}, s * Vec3{0, 0, 5});
}

// Between two rooms: parts beside and over a doorway of 1 x 2. `along` and `across` are its directions.
void add_partition(PlainScene& scene, const std::string& name, const Vec3& start, const Vec3& along,
                   const Vec3& across) {
  const auto part = [&](const char* which, double from, double to, double bottom, double top) {
    const Vec3 low = start + from * along + -0.0625 * across + Vec3{0, 0, bottom};
    const Vec3 high = start + to * along + 0.0625 * across + Vec3{0, 0, top};
    add_box(scene, name + which, low, high);
  };
  part("_before", 0.0, 1.0, 0.0, 3.0);
  part("_after", 2.0, 3.0, 0.0, 3.0);
  part("_over", 1.0, 2.0, 2.0, 3.0);
}

void furnish(PlainScene& scene, const std::string& name, const Vec3& corner) {
  constexpr std::array<std::array<double, 5>, 4> kThings{{{0.25, 0.25, 0.75, 0.5, 1.75},
                                                          {1.875, 0.25, 0.875, 0.875, 0.5},
                                                          {0.25, 2.0, 0.5, 0.5, 0.75},
                                                          {2.0, 2.0, 0.625, 0.5, 1.0}}};  // x, y, width, depth, height
  for (std::size_t i = 0; i < kThings.size(); ++i) {
    const auto& [x, y, width, depth, height] = kThings[i];
    const Vec3 low = corner + Vec3{x, y, 0};
    add_box(scene, name + "_thing" + std::to_string(i), low, low + Vec3{width, depth, height});
  }
}

}  // namespace

PlainScene cube_room(const FamilyOptions& options) {
  PlainScene scene;
  add_shell(scene, 1, 1, 1, options.n);
  add_tilted_cube(scene, "cube", {0.5, 0.5, 0.5}, 0x1p-5);
  return scene;
}

PlainScene three_cube_room(const FamilyOptions& options) {
  PlainScene scene;
  add_shell(scene, 1, 1, 1, options.n);
  add_tilted_cube(scene, "hanging", {0.5, 0.5, 0.75}, 0x1p-6);
  add_standing_cube(scene, "small", {0.75, 0.125, 0}, 0x1p-5);
  add_standing_cube(scene, "large", {0.25, 0.5, 0}, 0x1p-4);
  return scene;
}

PlainScene building(const FamilyOptions& options) {
  constexpr int kColumns = 8, kRows = 4, kSide = 3;
  PlainScene scene;
  add_shell(scene, kColumns * kSide, kRows * kSide, kSide, options.n);
  for (int i = 0; i < kColumns; ++i) {
    for (int j = 0; j < kRows; ++j) {
      const std::string room = "room" + std::to_string(i) + std::to_string(j);
      const Vec3 corner{static_cast<double>(kSide * i), static_cast<double>(kSide * j), 0};
      furnish(scene, room, corner);
      if (i > 0) add_partition(scene, room + "_x", corner, {0, 1, 0}, {1, 0, 0});
      if (j > 0) add_partition(scene, room + "_y", corner, {1, 0, 0}, {0, 1, 0});
    }
  }
  return scene;
}

std::span<const Family> patched_rooms() {
  static constexpr std::array<Family, 3> kRooms{{
      {"cube-room", "a closed room of 6 n x n patches and a tilted cube, every face a patch", &cube_room},
      {"three-cube-room", "the same with three cubes, two of which stand on the floor", &three_cube_room},
      {"building", "32 furnished rooms with doorways, in patches of 1 / n; about 5,000 for n = 2", &building},
  }};
  return kRooms;
}

}  // namespace exactff::models
