// Two convex polygons of a plane have no inner point in common if and only if a line along an edge of one of them
// separates them (the separating axis theorem). The signs are those of a projection along an axis that does not lie in
// the plane, which is one-to-one and keeps lines. They are exact.
#include "scene/coplanar.h"

#include <algorithm>
#include <array>
#include <vector>

#include "kernel/exact_vec.h"
#include "kernel/expect.h"
#include "scene/places.h"

namespace exactff {
namespace {

// The point without the coordinate of the axis.
Vec3 projected(const Vec3& v, int axis) {
  return axis == 0 ? Vec3{v.y, v.z, 0.0} : axis == 1 ? Vec3{v.z, v.x, 0.0} : Vec3{v.x, v.y, 0.0};
}

// Positive if c lies left of the line from a to b.
int side(const Vec3& a, const Vec3& b, const Vec3& c) { return kernel::orientation(a, b, c, {a.x, a.y, 1.0}); }

struct Outline {
  std::vector<Vec3> corners;
  int turn = 0;  // +1: counter-clockwise
};

int turn_of(const Scene& scene, const Piece& piece, int axis) {
  const auto at = [&](int i) { return projected(scene.vertices()[piece.frame[i]], axis); };
  return side(at(0), at(1), at(2));
}

// An axis that does not lie in the piece's plane.
int axis_off(const Scene& scene, const Piece& piece) {
  int axis = 0;
  while (axis < 2 && turn_of(scene, piece, axis) == 0) ++axis;
  return axis;
}

Outline outline_of(const Scene& scene, const Piece& piece, int axis) {
  Outline outline{{}, turn_of(scene, piece, axis)};
  for (const std::uint32_t v : scene.corners(piece)) outline.corners.push_back(projected(scene.vertices()[v], axis));
  return outline;
}

// No corner of `other` lies inside some edge of the outline.
bool has_separating_edge(const Outline& outline, const Outline& other) {
  for (std::size_t i = 0; i < outline.corners.size(); ++i) {
    const Vec3 &a = outline.corners[i], &b = outline.corners[(i + 1) % outline.corners.size()];
    const auto is_inside = [&](const Vec3& c) { return side(a, b, c) * outline.turn > 0; };
    if (std::ranges::none_of(other.corners, is_inside)) return true;
  }
  return false;
}

std::vector<std::uint32_t> sorted_places(const Scene& scene, const Piece& piece) {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t v : scene.corners(piece)) result.push_back(places(scene)[v]);
  std::ranges::sort(result);
  return result;
}

// The boxes of their corners are apart, or only touch.
bool are_boxes_apart(const Scene& scene, const Piece& a, const Piece& b) {
  const auto range = [&](const Piece& piece, double Vec3::*c) {
    const auto [low, high] =
        std::ranges::minmax(scene.corners(piece), {}, [&](std::uint32_t v) { return scene.vertices()[v].*c; });
    return std::pair(scene.vertices()[low].*c, scene.vertices()[high].*c);
  };
  for (double Vec3::*c : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const auto [low_a, high_a] = range(a, c);
    const auto [low_b, high_b] = range(b, c);
    if (high_a < low_b || high_b < low_a) return true;
  }
  return false;
}

// For a requirement.
[[maybe_unused]] bool are_coplanar(const Scene& scene, const Piece& a, const Piece& b) {
  const auto at = [&](std::uint32_t v) { return scene.vertices()[v]; };
  return std::ranges::all_of(b.frame, [&](std::uint32_t v) {
    return kernel::orientation(at(a.frame[0]), at(a.frame[1]), at(a.frame[2]), at(v)) == 0;
  });
}

}  // namespace

bool overlap(const Scene& scene, const Piece& a, const Piece& b) {
  EXACTFF_EXPECT(are_coplanar(scene, a, b));
  if (are_boxes_apart(scene, a, b)) return false;
  const int axis = axis_off(scene, a);
  const Outline of_a = outline_of(scene, a, axis), of_b = outline_of(scene, b, axis);
  return !has_separating_edge(of_a, of_b) && !has_separating_edge(of_b, of_a);
}

bool have_same_front(const Scene& scene, const Piece& a, const Piece& b) {
  EXACTFF_EXPECT(are_coplanar(scene, a, b));
  const int axis = axis_off(scene, a);
  return turn_of(scene, a, axis) == turn_of(scene, b, axis);
}

bool have_same_corners(const Scene& scene, const Piece& a, const Piece& b) {
  return a.corner_count == b.corner_count && sorted_places(scene, a) == sorted_places(scene, b);
}

}  // namespace exactff
