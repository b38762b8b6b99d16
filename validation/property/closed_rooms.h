// Closed polyhedra, as rooms whose faces look inward and as things that stand in them.
#pragma once

#include <array>
#include <vector>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// Closed; faces run counter-clockwise seen from outside.
struct Solid {
  std::vector<Vec3> corners;
  std::vector<generate::PlainFace> faces;
};

using FloorPlan = std::vector<std::vector<std::array<double, 2>>>;  // counter-clockwise, then holes clockwise

[[nodiscard]] Solid box(const Vec3& low, const Vec3& high);
[[nodiscard]] Solid prism(const FloorPlan& plan, double bottom, double top);
// Requires points of which no four lie in one plane and not all in one.
[[nodiscard]] Solid hull(const std::vector<Vec3>& points);
// True if no four of the points lie in one plane.
[[nodiscard]] bool in_general_position(const std::vector<Vec3>& points);

// For convex solids with planar faces; on the surface is neither.
[[nodiscard]] bool strictly_outside(const Solid& convex, const Vec3& x);
[[nodiscard]] bool strictly_inside(const Solid& convex, const Vec3& x);

// Every face turned inward, as a patch of its own: wall0, wall1, ...
void add_room(generate::PlainScene& scene, const Solid& solid);
// To the patch `things`: coplanar faces of one patch count once where they overlap.
void add_thing(generate::PlainScene& scene, const Solid& solid);
// A polygon and the same turned round, also to `things`.
void add_sheet(generate::PlainScene& scene, const std::vector<Vec3>& corners);

// A room in a building of whole coordinates, things in it, and a receiver inside the one and outside the others.
struct ClosedRoom {
  generate::PlainScene scene;
  bool receiver_is_eighths = false;  // its coordinates are multiples of 1/8, and it keeps its distance from all faces
  bool holes = false;                // some face has holes, which forbids to round its corners
};
[[nodiscard]] ClosedRoom random_building(generate::Random& random);

// A room, and things, that are hulls of random points.
[[nodiscard]] generate::PlainScene random_hull_room(generate::Random& random);

// A room of whole coordinates with walls along the axes.
[[nodiscard]] generate::PlainScene random_plain_room(generate::Random& random);
// Every face with corners of its own, all within `moved` of where they were in each coordinate.
[[nodiscard]] generate::PlainScene with_moved_corners(const generate::PlainScene& room, double moved,
                                                      std::uint64_t seed);

}  // namespace exactff::validation
