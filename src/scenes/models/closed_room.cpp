// A closed room with objects in it. Metres; x to the right, y up, z into the room. The table stands in the middle, the
// boxes in two rows along the walls at low and at high z, one in each of equal slots.
#include <algorithm>

#include "models/model_files.h"
#include "models/random.h"
#include "models/room_parts.h"

namespace exactff::models {

namespace {

constexpr Vec3 kRoom{6.0, 3.0, 4.0};
constexpr double kMargin = 0.25;    // from the walls to the slots
constexpr double kSlotDepth = 1.0;  // along z
constexpr double kWidestBox = 1.25;

constexpr double kLampLeft = 2.25, kLampRight = 3.75, kLampNear = 1.625, kLampFar = 2.375;
constexpr double kLampHeight = 2.5, kHousingTop = 2.625;  // of a hanging lamp

constexpr Box kTableTop{{2.25, 0.71875, 1.5}, {3.75, 0.75, 2.5}};

void add_flush_lamp(PlainScene& scene) {
  const Quad lamp = facing_down(kLampLeft, kLampRight, kRoom.y, kLampNear, kLampFar);
  add_frame(scene, "ceiling", ceiling_of(kRoom), lamp);
  add_quad(scene, "lamp", lamp);
}

// A closed box whose underside alone emits.
void add_hanging_lamp(PlainScene& scene) {
  add_quad(scene, "ceiling", ceiling_of(kRoom));
  add_quad(scene, "lamp", facing_down(kLampLeft, kLampRight, kLampHeight, kLampNear, kLampFar));
  add_patch(scene, "lamp_housing", "metal");
  add_box(scene, "lamp_housing", {{kLampLeft, kLampHeight, kLampNear}, {kLampRight, kHousingTop, kLampFar}});
  auto& sides = scene.patch("lamp_housing").faces;
  sides.erase(sides.begin() + 2);  // the underside
}

Box box_in_slot(Random& random, double left, double width, double near) {
  const double box_width = std::min(kWidestBox, width * random.between(0.4, 0.9));
  const double depth = random.between(0.3, 0.9) * kSlotDepth;
  const double height = random.between(0.25, 1.75);
  const double x = left + (width - box_width) * random.unit();
  const double z = near + (kSlotDepth - depth) * random.unit();
  return {{x, 0.0, z}, {x + box_width, height, z + depth}};
}

void add_boxes(PlainScene& scene, Random& random, int count) {
  const int slots = (count + 1) / 2;
  const double width = (kRoom.x - 2 * kMargin) / std::max(1, slots);
  for (int i = 0; i < count; ++i) {
    const std::string name = "box" + std::to_string(i + 1);
    const double near = i % 2 == 0 ? kRoom.z - kMargin - kSlotDepth : kMargin;
    add_patch(scene, name, "board");
    add_box(scene, name, box_in_slot(random, kMargin + width * (i / 2), width, near));
  }
}

PlainScene make_closed_room(const Settings& settings) {
  PlainScene scene;
  scene.materials = {{"floor", {0.4, 0.3, 0.2}, {}}, {"wall", {0.75, 0.75, 0.7}, {}}, {"lamp", {0, 0, 0}, {10, 10, 9}},
                     {"metal", {0.5, 0.5, 0.5}, {}}, {"wood", {0.5, 0.35, 0.2}, {}},  {"board", {0.6, 0.6, 0.55}, {}}};
  add_floor_and_walls(scene, kRoom);
  add_patch(scene, "lamp", "lamp");
  add_patch(scene, "table_top", "wood");
  add_patch(scene, "table_legs", "wood");
  settings.word("lamp") == "flush" ? add_flush_lamp(scene) : add_hanging_lamp(scene);
  add_table(scene, kTableTop);
  Random random(static_cast<std::uint64_t>(settings.whole("seed")));
  add_boxes(scene, random, static_cast<int>(settings.whole("boxes")));
  scene.source = "lamp";
  scene.point = {3.0, 0.0, 1.375};
  scene.normal = {0, 1, 0};
  return scene;
}

}  // namespace

Recipe closed_room_model() {
  return {
      {.name = "closed-room",
       .summary =
           "a closed room of 6 x 4 x 3 m with a lamp, a table and boxes; the form factors from a point in it to all "
           "patches sum to 1 (floor, ceiling, wall_*, lamp, table_*, box1 ...)",
       .settings = {word_setting("lamp", {"flush", "hanging"},
                                 "flush: in the ceiling; hanging: a box half a metre below it"),
                    whole_setting("boxes", 6, 0, 1000, "number of boxes along the walls"), seed_setting()}},
      &make_closed_room};
}

}  // namespace exactff::models
