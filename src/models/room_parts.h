// What rooms are made of. y is up; every quadrilateral lies in a coordinate plane and is exactly planar.
#pragma once

#include <array>
#include <string>

#include "models/plain_scene.h"

namespace exactff::models {

struct Box {
  Vec3 low;
  Vec3 high;
};

using Quad = std::array<Vec3, 4>;

// A patch without faces yet.
void add_patch(PlainScene& scene, std::string name, std::string material);

// The six faces of a box, fronts outward: low x, high x, low y, high y, low z, high z.
void add_box(PlainScene& scene, std::string_view name, const Box& box);

// Patch `table_top`, a box, and under its corners four legs down to y = 0, patch `table_legs`.
void add_table(PlainScene& scene, const Box& top);

// What is between two quadrilaterals in one plane, as four trapezoids that share every corner with them.
void add_frame(PlainScene& scene, std::string_view name, const Quad& outer, const Quad& inner);

// The room between the origin and `size`, fronts inward: patches `floor` and `wall_left`, `wall_right`, `wall_back` (at
// high z), `wall_front`. The ceiling is the caller's, with the corners of ceiling_of(), as the front sees them.
void add_floor_and_walls(PlainScene& scene, const Vec3& size);
[[nodiscard]] Quad ceiling_of(const Vec3& size);
// A rectangle at a height, its front down.
[[nodiscard]] Quad facing_down(double left, double right, double y, double near, double far);

void add_quad(PlainScene& scene, std::string_view name, const Quad& quad);

}  // namespace exactff::models
