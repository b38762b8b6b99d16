// The exact geometry rounded to doubles. No value depends on anything here.
#include <algorithm>

#include "exact/source_planes.h"
#include "exactff/exact.h"
#include "kernel/float_environment.h"
#include "visibility/boolean_walk.h"

namespace exactff {

namespace {

using kernel::ExactVec3;
using kernel::Rational;

// Maps directions from x to points: where they meet the plane of the source.
class Lift {
 public:
  Lift(const visibility::SourcePlane& plane, const Vec3& x)
      : normal_(plane.normal.exact), x_{kernel::to_rational(x.x), kernel::to_rational(x.y), kernel::to_rational(x.z)} {
    const kernel::ScaledVec3 s = kernel::exact_difference(plane.point, x);
    distance_ = kernel::times_power_of_two(dot(normal_, s.v), s.exponent);
  }

  [[nodiscard]] Vec3 operator()(const ExactVec3& t) const {
    const Rational factor = distance_ / Rational(dot(normal_, t));
    return {kernel::nearest_double(x_[0] + factor * t.x), kernel::nearest_double(x_[1] + factor * t.y),
            kernel::nearest_double(x_[2] + factor * t.z)};
  }

  [[nodiscard]] Loop operator()(const kernel::Ring& ring) const {
    Loop loop;
    for (const kernel::Direction& corner : ring) loop.corners.push_back((*this)(corner.exact));
    return loop;
  }

 private:
  ExactVec3 normal_;
  Rational x_[3];
  Rational distance_;
};

// Scaled so that the largest component is about 1. The filters' form of a direction (Approx3) is not used because it
// has no value for small components.
Vec3 rounded(const ExactVec3& direction) {
  const long bits = bit_length(direction);
  const auto scaled = [bits](const kernel::Integer& component) { return kernel::nearest_double(component, -bits); };
  return {scaled(direction.x), scaled(direction.y), scaled(direction.z)};
}

PlaneDrawing draw(const visibility::View& view, const visibility::SourcePlane& plane) {
  const visibility::PlaneGeometry seen = find_geometry(view, plane);
  const Lift lift(plane, view.x);
  PlaneDrawing drawing;
  drawing.normal = rounded(plane.normal.exact);
  if (side_of(plane, view.x) <= 0) return drawing;
  for (const kernel::Ring& ring : seen.source) drawing.source.push_back(lift(ring));
  for (const kernel::Ring& ring : seen.clipped) drawing.clipped_source.push_back(lift(ring));
  for (const visibility::Occluder& occluder : seen.occluders) {
    drawing.shadows.push_back({occluder.face, lift(occluder.ring)});
  }
  for (const visibility::RegionLoop& loop : seen.visible) {
    Loop drawn{{}, loop.hole};
    for (const visibility::Point2& corner : loop.corners) {
      drawn.corners.push_back(lift(seen.frame->to_direction(corner)));
    }
    if (!seen.frame->keeps_orientation()) std::reverse(drawn.corners.begin(), drawn.corners.end());
    drawing.visible.push_back(std::move(drawn));
  }
  return drawing;
}

}  // namespace

std::vector<PlaneDrawing> draw_visibility(const Scene& scene, const Receiver& receiver, const ExactSource& source) {
  const kernel::StandardArithmetic arithmetic;
  exact::check_arguments(scene, receiver, source);
  const visibility::View view(scene, receiver);
  std::vector<PlaneDrawing> drawings;
  for (const visibility::SourcePlane& plane : source.planes().planes) drawings.push_back(draw(view, plane));
  return drawings;
}

}  // namespace exactff
