#include "gradient/quick_arcs.h"

namespace exactff::gradient {

using contour::QuickCorner;
using contour::QuickPiece;
using visibility::CornerId;
using visibility::EdgeCovers;
using visibility::EdgeId;
using visibility::Outlines;
using visibility::Parameter;

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;

}  // namespace

void QuickArcs::add(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary) {
  if (boundary.empty()) return;
  if (boundary.edges() == nullptr) {
    sum_.decline();
    return;
  }
  translate(query, *boundary.edges());
  const std::span lines = std::span(lines_).first(edges_.size());
  sum_.add(pieces_, lines, boundary.edges()->outlines().scale_exponent());
}

// Sets pieces_ and lines_.
void QuickArcs::translate(const visibility::PlaneQuery& query, EdgeCovers& found) {
  using kernel::double_double::Bounded;
  static_assert(Parameter::kAtBegin == QuickPiece::kAtA && Parameter::kAtEnd == QuickPiece::kAtB);
  Outlines& outlines = found.outlines();
  plane_ = &query.plane;
  const QuickCorner s = contour::quick_corner(plane_->point, outlines.x(), outlines.scale_exponent());
  offset_ = {};
  for (int i = 0; i < 3; ++i) offset_ = offset_ + plane_->fine_normal[i] * Bounded{s.hi[i], s.lo[i], s.error};
  number_.assign(outlines.edges().size(), kNone);
  corner_number_.assign(outlines.corner_count(), kNone);
  edges_.clear();
  corners_.clear();
  pieces_.clear();
  const auto end = [&](EdgeId line) { return line < Parameter::kAtBegin ? number_of_line(outlines, line) : line; };
  for (const EdgeCovers::Part& part : found.parts()) {
    pieces_.push_back({number_of_line(outlines, part.edge), end(part.begin.line), end(part.end.line)});
  }
  if (lines_.size() < edges_.size()) lines_.resize(edges_.size());
  sum_.make_lines(corners_, edges_, std::span(lines_).first(edges_.size()));
}

std::uint32_t QuickArcs::number_of_line(Outlines& outlines, EdgeId id) {
  if (number_[id] != kNone) return number_[id];
  const Outlines::Edge edge = outlines.edge(id);
  number_[id] = static_cast<std::uint32_t>(edges_.size());
  edges_.push_back({number_of_corner(outlines, edge.a), number_of_corner(outlines, edge.b)});
  return number_[id];
}

std::uint32_t QuickArcs::number_of_corner(Outlines& outlines, CornerId id) {
  if (corner_number_[id] == kNone) {
    corner_number_[id] = static_cast<std::uint32_t>(corners_.size());
    corners_.push_back(point_at(outlines, id));
  }
  return corner_number_[id];
}

// Relative to x. A corner that is not a vertex lies in the source's plane.
QuickCorner QuickArcs::point_at(Outlines& outlines, CornerId corner) const {
  if (const auto vertex = outlines.vertex(corner)) {
    return contour::quick_corner(outlines.position(*vertex), outlines.x(), outlines.scale_exponent());
  }
  const QuickCorner* fine = outlines.fine(corner);
  return contour::lifted(fine != nullptr ? *fine : contour::quick_corner(outlines.exact(corner)), plane_->fine_normal,
                         offset_);
}

}  // namespace exactff::gradient
