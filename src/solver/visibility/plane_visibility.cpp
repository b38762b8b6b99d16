#include "visibility/plane_visibility.h"

#include <algorithm>

#include "visibility/plane_frame.h"

namespace exactff::visibility {

using kernel::Rational;

View::View(const Scene& scene_in, const Receiver& receiver)
    : scene(scene_in), x(receiver.point), n(receiver.normal), on(receiver.on) {}

kernel::Direction View::normal() const { return kernel::make_direction(kernel::exact_vector(n).v); }

bool may_occlude(const View& view, const SourcePlane& plane, const BoundaryRequest& request, std::uint32_t piece) {
  const FaceId face = view.scene.pieces()[piece].face;
  if (view.is_own(face) || view.scene.pieces()[piece].transparent) return false;
  if (std::binary_search(plane.pieces.begin(), plane.pieces.end(), piece)) return false;
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
