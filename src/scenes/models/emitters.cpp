// A hall with many small bright lamps below its ceiling and boxes on its floor. Seen from the floor, each lamp is
// smaller than a pixel of a usual hemicube, and its shadows have hardly any penumbra. Metres; y up. Each lamp and each
// box stands in its own cell of a square grid, off the middle of the cell.
#include <algorithm>

#include "models/model_files.h"
#include "models/random.h"
#include "models/room_parts.h"
#include "models/square_grid.h"

namespace exactff::models {

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
