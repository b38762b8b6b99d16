// The room with the venetian blind. Metres; x to the right, y up, z into the room. Every quadrilateral is exactly
// planar in doubles: it either lies in a coordinate plane or is swept along an axis.
#include "models/families.h"
#include "models/room_parts.h"

namespace exactff::models {

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

}  // namespace exactff::models
