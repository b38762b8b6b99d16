#include "visibility/visible_arcs.h"

#include <algorithm>
#include <iterator>

#include "kernel/vec.h"

namespace exactff::visibility {

void VisibleArcs::clear() {
  sections_.clear();
  arcs_.clear();
  lines_.clear();
  corners_.clear();
  fine_.clear();
  exact_count_ = 0;
  pieces_.clear();
}

void VisibleArcs::start(const View& view, const SourcePlane* plane) {
  sections_.push_back({.vertices = view.scene.vertices(),
                       .x = view.x,
                       .n = view.n,
                       .plane = plane,
                       .arc = arcs_.size(),
                       .line = lines_.size(),
                       .corner = corners_.size(),
                       .fine = fine_.size(),
                       .exact = exact_count_,
                       .piece = pieces_.size()});
}

void VisibleArcs::add(const View& view, const SourcePlane& plane, VisibleBoundary&& boundary) {
  start(view, &plane);
  if (boundary.edges() != nullptr) take(*boundary.edges());
  std::ranges::move(boundary.pieces(), std::back_inserter(pieces_));
}

void VisibleArcs::add(const View& view, EdgeCovers& found) {
  start(view, nullptr);
  sections_.back().outlines = &found.outlines();
  take(found);
}

void VisibleArcs::take(EdgeCovers& found) {
  Outlines& outlines = found.outlines();
  sections_.back().scale_exponent = outlines.scale_exponent();
  line_index_.clear(outlines.edges().size());
  corner_index_.clear(outlines.corner_count());
  const auto end = [&](EdgeId line) { return line < Parameter::kAtBegin ? number_of_line(outlines, line) : line; };
  for (const EdgeCovers::Part& part : found.parts()) {
    const std::uint32_t line = number_of_line(outlines, part.edge), begin = end(part.begin.line);
    arcs_.push_back({line, begin, end(part.end.line)});
  }
}

std::uint32_t VisibleArcs::number_of_line(Outlines& outlines, EdgeId id) {
  const auto [number, is_new] = line_index_.find(id);
  if (is_new) {
    const Outlines::Edge edge = outlines.edge(id);
    const std::uint32_t a = number_of_corner(outlines, edge.a), b = number_of_corner(outlines, edge.b);
    lines_.push_back({a, b, edge.outline, edge.outline == Outlines::kNone || outlines.outline(edge.outline).whole});
  }
  return number;
}

std::uint32_t VisibleArcs::number_of_corner(Outlines& outlines, CornerId id) {
  const auto [number, is_new] = corner_index_.find(id);
  if (!is_new) return number;
  const auto [p, q] = outlines.segment(id);
  ArcCorner& corner = corners_.emplace_back(ArcCorner{.p = p, .q = q, .id = id});
  if (corner.is_vertex()) return number;
  corner.plane = static_cast<std::uint32_t>(outlines.plane(id));
  if (const FineDirection* fine = outlines.fine(id)) {
    corner.is_fine = true;
    corner.constructed = static_cast<std::uint32_t>(fine_.size() - sections_.back().fine);
    fine_.push_back(*fine);
  } else {
    corner.constructed = static_cast<std::uint32_t>(exact_count_ - sections_.back().exact);
    if (exact_.size() == exact_count_) exact_.emplace_back();
    exact_[exact_count_++] = outlines.exact(id);
  }
  return number;
}

ArcSection VisibleArcs::operator[](std::size_t index) const {
  const Section& from = sections_[index];
  const Section* to = index + 1 < sections_.size() ? &sections_[index + 1] : nullptr;
  const auto part = [&](const auto& all, std::size_t Section::*at) {
    return std::span(all).subspan(from.*at, (to != nullptr ? to->*at : all.size()) - from.*at);
  };
  return {.vertices = from.vertices,
          .x = from.x,
          .n = from.n,
          .plane = from.plane,
          .outlines = from.outlines,
          .scale_exponent = from.scale_exponent,
          .arcs = part(arcs_, &Section::arc),
          .lines = part(lines_, &Section::line),
          .corners = part(corners_, &Section::corner),
          .fine = part(fine_, &Section::fine),
          .exactly = part(std::span(exact_).first(exact_count_), &Section::exact),
          .pieces = part(pieces_, &Section::piece)};
}

ExactVec3 ArcSection::exact(const ArcCorner& corner) const {
  if (corner.is_vertex()) return kernel::exact_difference(vertices[corner.p], x).v;
  if (!corner.is_fine) return exactly[corner.constructed];
  if (outlines != nullptr) return outlines->exact(corner.id);
  const bool on_horizon = corner.plane == static_cast<std::uint32_t>(Outlines::Plane::kHorizon);
  PlaneCrossings crossings;
  crossings.start(x, plane->fine_normal, on_horizon ? x : plane->point, 0);
  ScaledVec3 result;
  crossings.set_exact(result, vertices[corner.p], vertices[corner.q],
                      on_horizon ? kernel::exact_vector(n).v : plane->normal.exact, 0);
  return std::move(result.v);
}

ExactArcs::ExactArcs(const ArcSection& seen) : seen_(seen), x_(kernel::to_rational(seen.x)) {
  corners_.reserve(seen.corners.size());
  for (const ArcCorner& corner : seen.corners) corners_.push_back(seen.exact(corner));
}

BoundaryPiece ExactArcs::operator()(const Arc& arc) const {
  const ArcLine& line = seen_.lines[arc.line];
  const ExactVec3 &a = corners_[line.a], &b = corners_[line.b];
  const auto parameter = [&](std::uint32_t at) -> EdgeParameter {
    if (at == Arc::kAtA) return {1, 0};
    if (at == Arc::kAtB) return {0, 1};
    const ExactVec3 normal = cross(corners_[seen_.lines[at].b], corners_[seen_.lines[at].a]);
    return {abs(dot(normal, b)), abs(dot(normal, a))};
  };
  return {a, b, parameter(arc.begin), parameter(arc.end)};
}

// Relative to x. A corner that is not a vertex lies in the source's plane.
kernel::RationalVec3 ExactArcs::point_at(std::uint32_t index) const {
  using kernel::to_rational;
  const ArcCorner& corner = seen_.corners[index];
  if (corner.is_vertex()) return to_rational(seen_.vertices[corner.p]) - x_;
  const kernel::RationalVec3 normal = to_rational(seen_.plane->normal.exact), direction = to_rational(corners_[index]);
  return direction * kernel::Rational(dot(normal, to_rational(seen_.plane->point) - x_) / dot(normal, direction));
}

Vec3 point_on_line(const kernel::RationalVec3& x, const ExactVec3& t, const kernel::RationalVec3& nearness) {
  const kernel::RationalVec3 w = kernel::to_rational(t);
  return kernel::nearest_double(x + w * kernel::Rational(1 / dot(nearness, w)));
}

kernel::RationalVec3 ExactArcs::nearness(const Arc& arc) const {
  const ArcLine& line = seen_.lines[arc.line];
  const kernel::RationalVec3 a = point_at(line.a), along = point_at(line.b) - a, moment = cross(a, along);
  return cross(along, moment) * kernel::Rational(1 / dot(moment, moment));
}

}  // namespace exactff::visibility
