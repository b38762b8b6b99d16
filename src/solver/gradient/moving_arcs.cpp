#include "gradient/moving_arcs.h"

#include <algorithm>
#include <utility>

#include "kernel/poll.h"

namespace exactff::gradient {

using contour::MovingArc;
using kernel::ExactVec3;
using kernel::Rational;
using kernel::RationalVec3;
using kernel::to_rational;
using visibility::BoundaryPiece;
using visibility::CornerId;
using visibility::EdgeCovers;
using visibility::Outlines;
using visibility::PlaneQuery;

namespace {

bool is_in_one_of(std::span<const SightResult> planes, const ExactVec3& normal) {
  return std::ranges::any_of(planes, [&](const SightResult& plane) { return is_zero(cross(plane.normal, normal)); });
}

class EdgeArcs {
 public:
  EdgeArcs(const PlaneQuery& query, EdgeCovers& found) : x_(to_rational(query.view.x)), found_(found) {
    const visibility::SourcePlane& plane = query.plane;
    normal_ = to_rational(plane.normal.exact);
    offset_ = dot(normal_, to_rational(plane.point) - x_);
  }

  void add(std::span<const SightResult> except, std::vector<MovingArc>& arcs) {
    for (const EdgeCovers::Part& part : found_.parts()) {
      kernel::poll();
      const BoundaryPiece piece = found_.exact(part);
      MovingArc arc{
          piece.a * piece.begin.l + piece.b * piece.begin.m, piece.a * piece.end.l + piece.b * piece.end.m, {}};
      const ExactVec3 pole = cross(arc.begin, arc.end);
      if (is_zero(pole) || is_in_one_of(except, pole)) continue;
      const Outlines::Edge& edge = found_.outlines().edge(part.edge);
      const RationalVec3 a = point_at(edge.a), along = point_at(edge.b) - a, moment = cross(a, along);
      arc.nearness = cross(along, moment) * Rational(1 / dot(moment, moment));
      arcs.push_back(std::move(arc));
    }
  }

 private:
  // Relative to x. A corner that is not a vertex lies in the source's plane.
  [[nodiscard]] RationalVec3 point_at(CornerId corner) {
    Outlines& outlines = found_.outlines();
    if (const auto vertex = outlines.vertex(corner)) return to_rational(outlines.position(*vertex)) - x_;
    const RationalVec3 direction = to_rational(outlines.exact(corner));
    return direction * Rational(offset_ / dot(normal_, direction));
  }

  RationalVec3 x_, normal_;
  Rational offset_;
  EdgeCovers& found_;
};

// The arcs of the boundary in one plane through x, from one of its pieces. The profile is that of the query.
void add_arcs_of_plane(const PlaneQuery& query, Profile& profile, const Outlines::Edge& edge,
                       std::vector<MovingArc>& arcs) {
  for (const SightArc& found : SightPlane(query, profile, edge).arcs()) {
    // If x moves away from N, what is seen grows by the gain: it lies on the other side of the arc.
    if (!is_zero(found.gain_back)) arcs.push_back({found.begin, found.end, found.gain_back});
  }
}

}  // namespace

void add_contour_arcs(const visibility::VisibleBoundary& boundary, std::vector<MovingArc>& arcs) {
  boundary.for_each_piece([&](const BoundaryPiece& piece) {
    MovingArc arc{piece.a * piece.begin.l + piece.b * piece.begin.m, piece.a * piece.end.l + piece.b * piece.end.m, {}};
    if (!is_zero(cross(arc.begin, arc.end))) arcs.push_back(std::move(arc));
  });
}

void add_moving_arcs(const PlaneQuery& query, const visibility::VisibleBoundary& boundary,
                     std::span<const SightResult> except, std::vector<MovingArc>& arcs) {
  if (boundary.empty()) return;
  if (boundary.edges() != nullptr) {
    EdgeArcs(query, *boundary.edges()).add(except, arcs);
    return;
  }
  visibility::BoundaryRequest request = query.request;
  request.culling = ShaftCulling::kTree;
  const PlaneQuery closed{query.view, query.plane, request};
  Profile profile;
  profile.gather(closed);
  for_each_plane(boundary, query.view.normal().exact, [&](const ExactVec3& pole) {
    if (!is_in_one_of(except, pole)) add_arcs_of_plane(closed, profile, profile.edge_in_plane(pole), arcs);
  });
}

}  // namespace exactff::gradient
