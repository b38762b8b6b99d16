#include "visibility/plane_visibility.h"

#include <algorithm>

#include "visibility/polygon_sets.h"

namespace exactff::visibility {

View::View(const Scene& scene_in, const Receiver& receiver)
    : scene(scene_in),
      x(receiver.point),
      n(receiver.normal),
      own(scene_in, receiver),
      is_buried(buried_under(scene_in, receiver).has_value()) {}

Direction View::normal() const { return kernel::make_direction(kernel::exact_vector(n).v); }

bool may_occlude(const View& view, const SourcePlane& plane, const BoundaryRequest& request, PanelId panel) {
  const Panels& panels = *plane.scene_panels;
  const Piece& piece = panels.piece(panel);
  if (piece.transparent) return false;
  // A joined panel lies in one plane.
  if (view.is_own(panels.is_joined(panel) ? panels.sheet_of(panel).pieces.front() : panel)) return false;
  if (panels.is_joined(panel)) {
    return request.joins_pieces() && !std::ranges::binary_search(plane.panels, panel);
  }
  if (std::ranges::binary_search(plane.pieces, panel)) return false;
  const std::vector<FaceId>* only = request.only_occluders;
  return only == nullptr || std::binary_search(only->begin(), only->end(), piece.face);
}

Ring ring_of(const View& view, std::uint32_t piece) {
  Ring ring;
  for (const std::uint32_t corner : view.scene.corners(view.scene.pieces()[piece])) {
    ring.push_back(kernel::make_direction(kernel::exact_difference(view.scene.vertices()[corner], view.x).v));
  }
  return ring;
}

// The frame's (p, q) are the projected coordinates divided by h, so areas must be multiplied by h^2 before they are
// compared.
Rational share_of_source(const View& view, const SourcePlane& plane, const PlaneFrame& frame, const Rational& doubled) {
  const ScaledVec3 s = kernel::exact_difference(plane.point, view.x);
  const Rational h = kernel::times_power_of_two(dot(plane.normal.exact, s.v), s.exponent);
  return doubled / 2 * frame.unit_area() * h * h / union_area(view.scene, plane).area;
}

}  // namespace exactff::visibility
