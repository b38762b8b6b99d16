// The exact geometry rounded to doubles. No value depends on anything here.
#include <algorithm>

#include "exact/lift.h"
#include "exact/source_planes.h"
#include "exactff/exact.h"
#include "kernel/float_environment.h"
#include "visibility/boolean_walk.h"

namespace exactff {

namespace {

Loop lift_ring(const exact::Lift& lift, const kernel::Ring& ring) {
  Loop loop;
  for (const kernel::Direction& corner : ring) loop.corners.push_back(lift(corner.exact));
  return loop;
}

PlaneDrawing draw(const visibility::View& view, const visibility::SourcePlane& plane) {
  const visibility::PlaneGeometry seen = find_geometry(view, plane);
  const exact::Lift lift(plane.normal.exact, plane.point, view.x);
  PlaneDrawing drawing;
  drawing.normal = exact::rounded(plane.normal.exact);
  if (side_of(plane, view.x) <= 0) return drawing;
  for (const kernel::Ring& ring : seen.source) drawing.source.push_back(lift_ring(lift, ring));
  for (const kernel::Ring& ring : seen.clipped) drawing.clipped_source.push_back(lift_ring(lift, ring));
  for (const visibility::Occluder& occluder : seen.occluders) {
    drawing.shadows.push_back({occluder.face, lift_ring(lift, occluder.ring)});
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
  for (const visibility::SourcePlane& plane : ExactSourceInside::planes(source).planes)
    drawings.push_back(draw(view, plane));
  return drawings;
}

}  // namespace exactff
