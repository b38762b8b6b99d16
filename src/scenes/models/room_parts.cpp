#include "models/room_parts.h"

#include <utility>

namespace exactff::models {

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

Quad facing_down(double left, double right, double y, double near, double far) {
  return {{{left, y, near}, {right, y, near}, {right, y, far}, {left, y, far}}};
}

Quad ceiling_of(const Vec3& size) { return facing_down(0, size.x, size.y, 0, size.z); }

}  // namespace exactff::models
