#include "visibility/plane_visibility.h"

#include <algorithm>

#include "scene/contacts.h"
#include "visibility/plane_frame.h"

namespace exactff::visibility {

using kernel::Rational;

View::View(const Scene& scene_in, const Receiver& receiver)
    : scene(scene_in),
      x(receiver.point),
      n(receiver.normal),
      on(receiver.on),
      is_buried(buried_under(scene_in, receiver.on, receiver.point, receiver.normal).has_value()) {}

kernel::Direction View::normal() const { return kernel::make_direction(kernel::exact_vector(n).v); }

namespace {

// Calls visit(piece, sheet) for the pieces of own faces that belong to sheets, until one call returns true.
template <class Visit>
bool any_own_piece(const View& view, const Panels& panels, const Visit& visit) {
  return std::ranges::any_of(view.on, [&](FaceId own) {
    const Face& face = view.scene.face(own);
    for (std::uint32_t piece = face.first_piece; piece < face.first_piece + face.piece_count; ++piece) {
      const std::uint32_t sheet = panels.sheet_of_piece(piece);
      if (sheet != Panels::kNoSheet && visit(piece, sheet)) return true;
    }
    return false;
  });
}

}  // namespace

bool is_own_sheet(const View& view, const Panels& panels, std::uint32_t sheet) {
  return any_own_piece(view, panels, [&](std::uint32_t, std::uint32_t own) { return own == sheet; });
}

bool is_beside_own_sheet(const View& view, const Panels& panels) {
  return any_own_piece(view, panels, [&](std::uint32_t piece, std::uint32_t) {
    return facing_of(view, view.scene.pieces()[piece]) != 0;
  });
}

bool may_occlude(const View& view, const SourcePlane& plane, const BoundaryRequest& request, PanelId panel) {
  const Panels& panels = *plane.scene_panels;
  const Piece& piece = panels.piece(panel);
  if (piece.transparent) return false;
  if (panels.is_joined(panel)) {
    return request.joins_pieces() && !std::ranges::binary_search(plane.panels, panel) &&
           !is_own_sheet(view, panels, panels.sheet_of_joined(panel));
  }
  const FaceId face = piece.face;
  if (view.is_own(face)) return false;
  if (std::ranges::binary_search(plane.pieces, panel)) return false;
  const std::vector<FaceId>* only = request.only_occluders;
  return only == nullptr || std::binary_search(only->begin(), only->end(), face);
}

// The frame's (p, q) are the projected coordinates divided by h, so areas must be multiplied by h^2 before they are
// compared.
Rational share_of_source(const View& view, const SourcePlane& plane, const PlaneFrame& frame, const Rational& doubled) {
  const kernel::ScaledVec3 s = kernel::exact_difference(plane.point, view.x);
  const Rational h = kernel::times_power_of_two(dot(plane.normal.exact, s.v), s.exponent);
  return doubled / 2 * frame.unit_area() * h * h / union_area(view.scene, plane).area;
}

}  // namespace exactff::visibility
