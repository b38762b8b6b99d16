// The first attempt at a certified gradient: translates the boundary that the edge engine found into corners of space,
// lines and pieces, and adds these in double-double arithmetic (contour/quick_gradient.h).
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contour/quick_gradient.h"
#include "visibility/plane_visibility.h"

namespace exactff::gradient {

// A workspace.
class QuickArcs {
 public:
  // Starts new sums in the existing memory.
  void start(const Vec3& normal) { sum_ = contour::QuickGradient(normal); }
  // Adds the boundary of one plane's visible region. Declines what the Booleans found.
  void add(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary);
  [[nodiscard]] const contour::QuickGradient& sum() const { return sum_; }
  // Calls visit(part, line, shares, ends) for each part of a boundary that the edge engine found, without adding it.
  // `ends`: the corners that are the points a and b of the line.
  template <class Visit>
  void for_each_share(const visibility::PlaneQuery& query, visibility::EdgeCovers& found, const Visit& visit) {
    translate(query, found);
    shares_.resize(pieces_.size());
    const std::span lines = std::span(lines_).first(edges_.size());
    sum_.find_shares(pieces_, lines, shares_);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const visibility::EdgeCovers::Part& part = found.parts()[i];
      const visibility::Outlines::Edge& edge = found.outlines().edge(part.edge);
      const contour::QuickGradient::Line& line = lines_[pieces_[i].edge];
      const std::pair ends = line.reversed ? std::pair(edge.b, edge.a) : std::pair(edge.a, edge.b);
      visit(part, line, shares_[i], ends);
    }
  }

 private:
  void translate(const visibility::PlaneQuery& query, visibility::EdgeCovers& found);
  [[nodiscard]] std::uint32_t number_of_line(visibility::Outlines& outlines, visibility::EdgeId id);
  [[nodiscard]] std::uint32_t number_of_corner(visibility::Outlines& outlines, visibility::CornerId id);
  [[nodiscard]] contour::QuickCorner point_at(visibility::Outlines& outlines, visibility::CornerId corner) const;

  contour::QuickGradient sum_;
  const visibility::SourcePlane* plane_ = nullptr;
  kernel::double_double::Bounded offset_;  // of the source's plane, in the scale of its normal and of the corners
  std::vector<std::uint32_t> number_, corner_number_;  // by edge, by corner
  std::vector<contour::QuickCorner> corners_;
  std::vector<contour::QuickEdge> edges_;
  std::vector<contour::QuickGradient::Line> lines_;
  std::vector<contour::QuickPiece> pieces_;
  std::vector<contour::QuickGradient::Shares> shares_;
};

}  // namespace exactff::gradient
