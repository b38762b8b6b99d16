// Two rooms, and the parts of which rooms are made.
//
// The room with the venetian blind. Metres; x to the right, y up, z into the room. Every quadrilateral is exactly
// planar in doubles: it either lies in a coordinate plane or is swept along an axis.
#include "models/rooms.h"

#include <algorithm>
#include <utility>

#include "models/families.h"
#include "models/random.h"
#include "models/registry.h"

namespace exactff::models {

// --- Room parts ---

namespace {

constexpr double kLegSide = 0.0625;

}  // namespace

void add_patch(PlainScene& scene, std::string name, std::string material) {
  scene.patches.push_back({std::move(name), std::move(material), {}});
}

void add_box(PlainScene& scene, std::string_view name, const Box& box) {
  const auto& [a, b] = box;
  PlainPatch& patch = scene.patch(name);
  scene.add_ring(patch, {{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}});
  scene.add_ring(patch, {{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}});
  scene.add_ring(patch, {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}});
  scene.add_ring(patch, {{a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}});
  scene.add_ring(patch, {{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}});
  scene.add_ring(patch, {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}});
}

void add_table(PlainScene& scene, const Box& top) {
  add_box(scene, "table_top", top);
  for (const double x : {top.low.x, top.high.x - kLegSide}) {
    for (const double z : {top.low.z, top.high.z - kLegSide}) {
      add_box(scene, "table_legs", {{x, 0, z}, {x + kLegSide, top.low.y, z + kLegSide}});
    }
  }
}

void add_frame(PlainScene& scene, std::string_view name, const Quad& outer, const Quad& inner) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    scene.add_ring(scene.patch(name), {outer[i], outer[j], inner[j], inner[i]});
  }
}

void add_quad(PlainScene& scene, std::string_view name, const Quad& quad) {
  scene.add_ring(scene.patch(name), {quad.begin(), quad.end()});
}

namespace {

// The room between the origin and `size`, with fronts inward: patches `floor`, of the material of that name, and
// `wall_left`, `wall_right`, `wall_back` (at high z), `wall_front` and `ceiling`, of the material `wall`. The caller
// fills the ceiling, with the corners of ceiling_of(), in the order seen from its front.
void add_floor_and_walls(PlainScene& scene, const Vec3& size) {
  const auto& [w, h, d] = size;
  add_patch(scene, "floor", "floor");
  for (const char* name : {"wall_left", "wall_right", "wall_back", "wall_front", "ceiling"}) {
    add_patch(scene, name, "wall");
  }
  add_quad(scene, "floor", {{{0, 0, 0}, {0, 0, d}, {w, 0, d}, {w, 0, 0}}});
  add_quad(scene, "wall_left", {{{0, 0, 0}, {0, h, 0}, {0, h, d}, {0, 0, d}}});
  add_quad(scene, "wall_right", {{{w, 0, 0}, {w, 0, d}, {w, h, d}, {w, h, 0}}});
  add_quad(scene, "wall_back", {{{0, 0, d}, {0, h, d}, {w, h, d}, {w, 0, d}}});
  add_quad(scene, "wall_front", {{{0, 0, 0}, {w, 0, 0}, {w, h, 0}, {0, h, 0}}});
}

// A level rectangle whose front faces down.
Quad facing_down(double left, double right, double y, double near, double far) {
  return {{{left, y, near}, {right, y, near}, {right, y, far}, {left, y, far}}};
}

}  // namespace

Quad ceiling_of(const Vec3& size) { return facing_down(0, size.x, size.y, 0, size.z); }

// --- The room with the venetian blind ---

namespace {

constexpr double kWidth = 4.0;    // x
constexpr double kHeight = 2.75;  // y
constexpr double kDepth = 5.0;    // z

constexpr double kWindowLeft = 1.0;
constexpr double kWindowRight = 3.0;
constexpr double kSill = 0.875;
constexpr double kLintel = 2.25;

constexpr double kBlindGap = 0.125;    // from the window to the middle of the blind
constexpr double kBlindMargin = 0.05;  // overlap of the blind over the window at left and right
constexpr double kSlatDepth = 1.0;     // depth of a slat / pitch
constexpr double kSlatHeight = 0.75;   // height of a slat / pitch: it slopes down towards the room, 3 in 4

constexpr double kTableHeight = 0.75;
constexpr double kTopThickness = 0.03125;

// Floor, ceiling and three walls. Their fronts face the room.
void add_shell(PlainScene& scene) {
  const double w = kWidth;
  const double h = kHeight;
  const double d = kDepth;
  scene.add_ring(scene.patch("floor"), {{0, 0, 0}, {0, 0, d}, {w, 0, d}, {w, 0, 0}});
  scene.add_ring(scene.patch("ceiling"), {{0, h, 0}, {w, h, 0}, {w, h, d}, {0, h, d}});
  scene.add_ring(scene.patch("wall_left"), {{0, 0, 0}, {0, h, 0}, {0, h, d}, {0, 0, d}});
  scene.add_ring(scene.patch("wall_right"), {{w, 0, 0}, {w, 0, d}, {w, h, d}, {w, h, 0}});
  scene.add_ring(scene.patch("wall_back"), {{0, 0, d}, {0, h, d}, {w, h, d}, {w, 0, d}});
}

// The window and the wall around it.
void add_window_wall(PlainScene& scene) {
  const Quad outer{{{0, 0, 0}, {kWidth, 0, 0}, {kWidth, kHeight, 0}, {0, kHeight, 0}}};
  const Quad inner{
      {{kWindowLeft, kSill, 0}, {kWindowRight, kSill, 0}, {kWindowRight, kLintel, 0}, {kWindowLeft, kLintel, 0}}};
  add_frame(scene, "wall_window", outer, inner);
  add_quad(scene, "window", inner);
}

void add_blind(PlainScene& scene, int slats) {
  const double left = kWindowLeft - kBlindMargin;
  const double right = kWindowRight + kBlindMargin;
  const double pitch = (kLintel - kSill) / slats;
  for (int i = 0; i < slats; ++i) {
    const double middle = kSill + pitch * (i + 0.5);
    const double top = middle + kSlatHeight * pitch / 2;
    const double bottom = middle - kSlatHeight * pitch / 2;
    const double near = kBlindGap - kSlatDepth * pitch / 2;
    const double far = kBlindGap + kSlatDepth * pitch / 2;
    scene.add_ring(scene.patch("blind"),
                   {{left, bottom, far}, {right, bottom, far}, {right, top, near}, {left, top, near}});
  }
}

}  // namespace

PlainScene room(const FamilyOptions& options) {
  PlainScene scene;
  scene.materials = {{"wall", {0.75, 0.75, 0.7}, {}},
                     {"floor", {0.4, 0.3, 0.2}, {}},
                     {"sky", {}, {6, 8, 10}},
                     {"slat", {0.8, 0.8, 0.8}, {}},
                     {"wood", {0.5, 0.35, 0.2}, {}}};
  scene.materials[2].reflectance = {0, 0, 0};
  for (const char* name : {"wall_window", "wall_left", "wall_right", "wall_back", "ceiling"})
    add_patch(scene, name, "wall");
  add_patch(scene, "floor", "floor");
  add_patch(scene, "window", "sky");
  add_patch(scene, "blind", "slat");
  add_patch(scene, "table_top", "wood");
  add_patch(scene, "table_legs", "wood");
  add_shell(scene);
  add_window_wall(scene);
  add_blind(scene, options.n);
  add_table(scene, {{1.25, kTableHeight - kTopThickness, 1.5}, {2.75, kTableHeight, 2.5}});
  scene.source = "window";
  scene.point = {1.875, kTableHeight, 2.0};
  scene.normal = {0, 1, 0};
  return scene;
}

// --- Closed room ---

// A closed room with objects in it. Metres; x to the right, y up, z into the room. The table stands in the middle, the
// boxes in two rows along the walls at low and at high z, one in each of equal slots.

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

// --- Emitters ---

// A hall with many small bright lamps below its ceiling and boxes on its floor. Seen from the floor, each lamp is
// smaller than a pixel of a usual hemicube, and its shadows have hardly any penumbra. Metres; y up. Each lamp and each
// box stands in its own cell of a square grid, off the middle of the cell.

namespace {

constexpr Vec3 kHall{10.0, 3.0, 10.0};
constexpr double kEmitterHeight = 2.875;
constexpr double kTallestBox = 2.25;
constexpr double kCellMargin = 0.25;

void add_lamps(PlainScene& scene, Random& random, int count, double size) {
  int number = 0;
  for_each_cell(random, count, kHall.x, kCellMargin, [&](double x, double z, double) {
    const std::string name = "lamp" + std::to_string(++number);
    const double half = size / 2;
    add_patch(scene, name, "lamp");
    add_quad(scene, name, facing_down(x - half, x + half, kEmitterHeight, z - half, z + half));
  });
}

void add_hiding_boxes(PlainScene& scene, Random& random, int count) {
  int number = 0;
  for_each_cell(random, count, kHall.x, kCellMargin, [&](double x, double z, double cell) {
    const std::string name = "box" + std::to_string(++number);
    const double largest = std::min(0.75, 0.25 * cell);
    const double half_width = largest * random.between(0.3, 1.0);
    const double half_depth = largest * random.between(0.3, 1.0);
    const double height = random.between(0.3, kTallestBox);
    add_patch(scene, name, "board");
    add_box(scene, name, {{x - half_width, 0.0, z - half_depth}, {x + half_width, height, z + half_depth}});
  });
}

// The radiosity of a lamp at which all lamps together give the floor about 1.
double radiosity(int count, double size) { return kHall.x * kHall.z / (count * size * size); }

PlainScene make_emitters(const Settings& settings) {
  const int count = static_cast<int>(settings.whole("n"));
  const double size = settings.number("size");
  const double bright = radiosity(count, size);
  PlainScene scene;
  scene.materials = {{"floor", {0.4, 0.4, 0.4}, {}},
                     {"wall", {0.75, 0.75, 0.7}, {}},
                     {"lamp", {0, 0, 0}, {bright, bright, bright}},
                     {"board", {0.6, 0.6, 0.55}, {}}};
  add_floor_and_walls(scene, kHall);
  add_quad(scene, "ceiling", ceiling_of(kHall));
  Random random(static_cast<std::uint64_t>(settings.whole("seed")));
  add_hiding_boxes(scene, random, static_cast<int>(settings.whole("boxes")));
  add_lamps(scene, random, count, size);
  scene.source = "lamp1";
  scene.point = {0.125, 0.0, 0.125};  // no box stands here
  scene.normal = {0, 1, 0};
  return scene;
}

}  // namespace

Recipe emitters_model() {
  return {
      {.name = "emitters",
       .summary =
           "a hall of 10 x 10 x 3 m with n small bright lamps, each a separate source, and boxes on the floor (floor, "
           "ceiling, wall_*, box1 ..., lamp1 ...)",
       .settings = {whole_setting("n", 64, 1, 2500, "number of lamps"),
                    number_setting("size", 0.03, 1e-6, 0.1, "side of a lamp; it does not change the total light", "m"),
                    whole_setting("boxes", 12, 0, 1000, "boxes on the floor"), seed_setting()}},
      &make_emitters};
}

}  // namespace exactff::models
