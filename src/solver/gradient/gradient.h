// The gradient of one form factor, plane by plane of the source: whether it exists (kinks.h), and its values, first in
// double-double, then in balls of rising precision (contour/contour.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contour/contour.h"
#include "contour/quick_contour.h"
#include "exactff/exact.h"
#include "gradient/kinks.h"
#include "kernel/ball.h"
#include "visibility/plane_visibility.h"

namespace exactff::gradient {

// --- Moving arcs ---

// The arcs of the visible boundary, each with the line in space that moves it, for sums in double-double and in balls
// (contour/), and the certified derivative that such a sum gives.

// Calls visit(pole) once for every plane through x in which the boundary has pieces, but for the receiver's horizon;
// the pole is its primitive normal.
template <class Visit>
void for_each_plane(const visibility::VisibleBoundary& boundary, const kernel::ExactVec3& horizon, const Visit& visit) {
  std::vector<kernel::ExactVec3> done;
  boundary.for_each_piece([&](const visibility::BoundaryPiece& piece) {
    kernel::ExactVec3 pole = cross(piece.a, piece.b);
    make_primitive(pole);
    const auto is_parallel = [&](const kernel::ExactVec3& other) { return is_zero(cross(pole, other)); };
    if (is_parallel(horizon) || std::ranges::any_of(done, is_parallel)) return;
    done.push_back(pole);
    visit(pole);
  });
}

// --- Derivative ---

// One derivative: from a ball, or from sums of arcs in balls of rising precision.

inline constexpr int kQuickBits = 106;  // of double-double

// Takes the double from a ball, unless it contains 0. False if the ball does not determine it.
[[nodiscard]] bool is_determined(const Ball& ball, Derivative& result);
// Of a number within `error` of hi + lo.
[[nodiscard]] bool is_determined(double hi, double lo, double error, Derivative& result);
void set_zero(Derivative& result);
void set_none(Derivative& result);

// The sum of the terms times `factor`, which has as many bits as it is asked for.
template <class Factor>
void certify(const contour::ArcSum& sum, const Factor& factor, int cap, Derivative& result) {
  if (sum.cancels()) {
    set_zero(result);
    return;
  }
  constexpr int kFirstBits = 128;
  constexpr long kBitsForZero = 256;  // a ball that still contains 0 at this precision is the result
  for (int bits = std::min(kFirstBits, cap);; bits = std::min(2 * bits, cap)) {
    const Ball ball = sum.evaluate(bits) * factor(bits);
    if (is_determined(ball, result)) return;
    const bool holds_zero = result.enclosure.contains(0.0);
    if (bits < cap && !(holds_zero && bits >= kBitsForZero)) {
      const std::optional<double> nearest = result.enclosure.nearest();
      if (!nearest || std::isfinite(*nearest)) continue;  // a larger precision does not help beyond the doubles
    }
    result.status = DerivativeStatus::kEnclosed;
    constexpr double kLargest = std::numeric_limits<double>::max();
    result.value = holds_zero ? 0.0 : std::clamp(kernel::nearest_to_midpoint(ball), -kLargest, kLargest);
    return;
  }
}

// 1 / (2 pi |n|).
[[nodiscard]] Ball over_turn_and_length(const kernel::ExactVec3& n, long bits);

// --- Quick arcs ---

// The first attempt at a certified gradient: translates the boundary that the edge engine found into corners of space,
// lines and pieces, and adds these in double-double arithmetic (contour/quick_contour.h).

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

// --- Gradient ---

// A workspace.
class PointGradient {
 public:
  struct Request {
    std::optional<Vec3> along;  // not zero
    bool list_arcs = false;
  };
  // Starts a new one.
  void start(const visibility::View& view, const Request& request);
  // Takes one plane with its visible boundary.
  void add(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary);

  // Encloses F, by the sums for V. Requires that something is visible.
  [[nodiscard]] Ball form_factor() const;
  // Takes the values that double-double determines. False if others are left: then call add_exactly for all planes in
  // the same order, and certify.
  [[nodiscard]] bool finish(int cap, Gradient& result);
  void add_exactly(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary);
  void certify(int cap, Gradient& result);

 private:
  [[nodiscard]] bool exists_along() const;
  void list_arcs(const kernel::ExactVec3& n, Gradient& result) const;

  KinkSearch search_;
  QuickArcs quick_;
  std::optional<kernel::ExactVec3> along_;
  Vec3 x_, normal_;
  bool list_arcs_ = false;
  bool something_visible_ = false;
  std::optional<Kink> kink_;
  std::vector<std::vector<SightResult>> kinks_;  // by plane of the source, if `along` is asked for
  std::size_t exact_planes_ = 0;
  std::vector<contour::MovingArc> arcs_, contour_arcs_;
};

}  // namespace exactff::gradient
