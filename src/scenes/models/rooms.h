// Parts of rooms. y is up; every quadrilateral lies in a coordinate plane and is exactly planar.
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

// Adds a patch that has no faces yet.
void add_patch(PlainScene& scene, std::string name, std::string material);

// The six faces of a box, fronts outward: low x, high x, low y, high y, low z, high z.
void add_box(PlainScene& scene, std::string_view name, const Box& box);

// The patch `table_top`, a box, and the patch `table_legs`: four legs under its corners, down to y = 0.
void add_table(PlainScene& scene, const Box& top);

// The region between two quadrilaterals in one plane, as four trapezoids that share all corners with them.
void add_frame(PlainScene& scene, std::string_view name, const Quad& outer, const Quad& inner);

[[nodiscard]] Quad ceiling_of(const Vec3& size);

void add_quad(PlainScene& scene, std::string_view name, const Quad& quad);

}  // namespace exactff::models
