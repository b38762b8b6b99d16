// The faces of a source that lie in one oriented plane. They are treated together, as their union.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"
#include "kernel/plane_crossing.h"
#include "scene/panels.h"

namespace exactff::visibility {

using kernel::Approx3;
using kernel::Direction;
using kernel::ExactVec3;
using kernel::fine_normal;
using kernel::FineDirection;
using kernel::FineNormal;
using kernel::Integer;
using kernel::kUncertain;
using kernel::PlaneCrossings;
using kernel::Rational;
using kernel::Ring;
using kernel::ScaledVec3;
using kernel::sign;

struct SourcePlane {
  const Panels* scene_panels = nullptr;
  std::vector<FaceId> faces;          // ascending
  std::vector<std::uint32_t> pieces;  // their pieces that lie in it, ascending; into Scene::pieces()
  std::vector<PanelId> panels;        // the same region, ascending: sheets of these pieces as they are joined
  // Pieces in the same plane that hide parts of it: those that bury them (scene/contacts.h), and `elsewhere`.
  std::vector<std::uint32_t> covers;
  std::vector<std::uint32_t> elsewhere;  // pieces of the source in another SourcePlane, where what they cover counts
  Direction normal;                      // front, primitive integers
  FineNormal fine_normal;                // the same, for PlaneCrossings
  Vec3 point;                            // a vertex in the plane
  Vec3 second, third;                    // with `point`, three vertices that run counter-clockwise seen from the front
};

// Groups faces by exact equality of their oriented planes, in order of first appearance. Where a piece buries some of a
// plane's pieces and also overlaps others, which it does not bury, each buried piece is by itself, less the others.
std::vector<SourcePlane> group_by_plane(const Scene& scene, const std::vector<FaceId>& faces);

// The plane of each face by itself, with three vertices of that face; the plane as it is if faces overlap in it.
std::vector<SourcePlane> split_by_face(const Scene& scene, const SourcePlane& plane);

// -1, 0, +1: x behind, in, in front of the plane.
int side_of(const SourcePlane& plane, const Vec3& x);

// Area of the union of the faces, projected along the axis of the normal's largest component; exact.
struct ProjectedArea {
  Rational area;
  int axis = 0;
};
ProjectedArea union_area(const Scene& scene, const SourcePlane& plane);

// Whether the union of other pieces covers all of the piece, exactly. Requires that all lie in one plane; they may face
// either way.
[[nodiscard]] bool is_covered(const Scene& scene, std::uint32_t piece, std::span<const std::uint32_t> by);

}  // namespace exactff::visibility
