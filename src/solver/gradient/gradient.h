// The gradient of one form factor, plane by plane of the source: whether it exists, and its values, first in
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
#include "gradient/sight_plane.h"
#include "kernel/ball.h"
#include "visibility/silhouettes.h"
#include "visibility/visible_arcs.h"
#include "visibility/visible_edges.h"

namespace exactff::gradient {

using visibility::Arc;
using visibility::ArcCorner;
using visibility::ArcLine;
using visibility::ArcSection;
using visibility::BoundaryPiece;

// --- Kinks ---

// Where F has no derivative by the receiver's point, by exact signs.
//
// A kink needs an arc of positive length, above the horizon and on the source, along which nothing covers both sides,
// and on which x sees a face edge-on or lines at different depths as one. So for one plane of the
// source:
//   0. of a mesh, try to prove from its silhouettes that there is none;
//   1. gather what touches the closed shaft (sight_lines.h); stop if one piece hides more than the source;
//   2. drop edges with a piece on both sides: they are covered;
//   3. group the edges that are left by the planes through x in which they lie. Planes are compared by a number that
//      depends on the plane alone, with its error bound, and then by exact signs;
//   4. judge the plane of each group with lines at different depths, and the plane of each piece seen edge-on.
// Along the horizon w . n = 0: nothing there counts.

// Proves that F has no kink around one plane of the source from the silhouettes of meshes, which are few, instead of
// from everything that touches the shaft.
//
// A kink needs a piece that x sees edge-on or, in a plane through x, two lines at different depths, each an
// edge of the source or an edge with pieces on one side alone, all of it in the closed shaft, and not on the horizon.
// The jump of an edge with pieces on one side is not 0, so it is a silhouette (visibility/silhouettes.h). And the
// search for silhouettes looks at all edges of a piece seen edge-on, since no bound of normals leaves them out. So
// there is no kink if no piece is seen edge-on, and if silhouettes and edges of the source that lie in one plane
// through x always lie on one line in space, or on the horizon.

// A workspace.
class KinkProof {
 public:
  // False: not proved, or not tried, since another way is shorter or shall share nothing with this one (the Booleans').
  // Requires that x lies in front of the source's plane.
  [[nodiscard]] bool excludes_kinks(const PlaneQuery& query);

 private:
  Outlines outlines_;
  visibility::SilhouetteMemory memory_;
  SightGroups groups_;
};

// What is found in one plane through x.
struct SightResult {
  ExactVec3 normal;
  std::vector<SightArc> arcs;
};

// A workspace.
class KinkSearch {
 public:
  enum class Extent { kFirst, kAll };
  // Looks for kinks of one plane of the source; kFirst: stops at the first one. `is_visible`: something of the plane
  // is.
  void find(const PlaneQuery& query, bool is_visible, Extent extent);

  [[nodiscard]] const std::optional<Kink>& kink() const { return kink_; }
  // The planes through x with kinks; all their arcs.
  [[nodiscard]] const std::vector<SightResult>& planes() const { return planes_; }

 private:
  void find_around_source(const PlaneQuery& query, bool is_visible, Extent extent);
  void find_edge_on(const PlaneQuery& query);
  [[nodiscard]] bool judge_groups(const PlaneQuery& query, Extent extent);
  [[nodiscard]] bool judge_sheets(const PlaneQuery& query, Extent extent);
  void judge(const PlaneQuery& query, const Outlines::Edge& edge, Extent extent);
  [[nodiscard]] bool is_judged(const ExactVec3& normal) const;
  void note(KinkReason reason, const Scene& scene, std::span<const std::uint32_t> pieces);

  KinkProof proof_;
  Profile profile_;
  SightGroups groups_;
  std::vector<ExactVec3> judged_;  // normals
  std::optional<Kink> kink_;
  std::vector<SightResult> planes_;
};

// --- Moving arcs ---

// The arcs of the visible boundary, each with the line in space that moves it, for sums in double-double and in balls
// (contour/), and the certified derivative that such a sum gives.

// Calls visit(pole) once for every plane through x in which the boundary has pieces, but for the receiver's horizon;
// the pole is its primitive normal.
template <class Visit>
void for_each_plane(const ArcSection& seen, const ExactVec3& horizon, const Visit& visit) {
  std::vector<ExactVec3> done;
  seen.for_each_piece([&](const BoundaryPiece& piece) {
    ExactVec3 pole = cross(piece.a, piece.b);
    make_primitive(pole);
    const auto is_parallel = [&](const ExactVec3& other) { return is_zero(cross(pole, other)); };
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
void certify(const ArcSum& sum, const Factor& factor, int cap, Derivative& result) {
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
[[nodiscard]] Ball over_turn_and_length(const ExactVec3& n, long bits);

// --- Quick arcs ---

// The first attempt at a certified gradient: adds the arcs that the edge engine found (visibility/visible_arcs.h), with
// their lines in space, in double-double arithmetic (contour/quick_contour.h).

// A workspace.
class QuickArcs {
 public:
  // Starts new sums in the existing memory.
  void start(const Vec3& normal) { sum_ = contour::QuickGradient(normal); }
  // Adds what is seen of one plane. Declines what the Booleans found.
  void add(const ArcSection& seen);
  [[nodiscard]] const contour::QuickGradient& sum() const { return sum_; }
  // Calls visit(arc, line, shares, ends) for each arc that the edge engine found, without adding it. `ends`: the
  // corners that are the points a and b of the line.
  template <class Visit>
  void for_each_share(const ArcSection& seen, const Visit& visit) {
    make_lines(seen);
    shares_.resize(pieces_.size());
    sum_.find_shares(pieces_, lines_, shares_);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Arc& arc = seen.arcs[i];
      const auto& [a, b, outline, whole] = seen.lines[arc.line];
      visit(arc, lines_[arc.line], shares_[i], lines_[arc.line].reversed ? std::pair(b, a) : std::pair(a, b));
    }
  }

 private:
  void make_lines(const ArcSection& seen);

  contour::QuickGradient sum_;
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
  void start(const View& view, const Request& request);
  // Takes what is seen of one plane.
  void add(const PlaneQuery& query, const ArcSection& seen);

  // Encloses F, by the sums for V. Requires that something is visible.
  [[nodiscard]] Ball form_factor() const;
  // Takes the values that double-double determines. False if others are left: then call add_exactly for all planes in
  // the same order, and certify.
  [[nodiscard]] bool finish(int cap, Gradient& result);
  void add_exactly(const PlaneQuery& query, const ArcSection& seen);
  void certify(int cap, Gradient& result);

 private:
  [[nodiscard]] bool exists_along() const;
  void list_arcs(const ExactVec3& n, Gradient& result) const;

  KinkSearch search_;
  QuickArcs quick_;
  std::optional<ExactVec3> along_;
  Vec3 x_, normal_;
  bool list_arcs_ = false;
  bool something_visible_ = false;
  std::optional<Kink> kink_;
  std::vector<std::vector<SightResult>> kinks_;      // by plane of the source, if `along` is asked for
  bool opens_normal_ = false, opens_lines_ = false;  // sums in balls are needed: of V, of the lines in space
  std::size_t exact_planes_ = 0;
  std::vector<MovingArc> arcs_, contour_arcs_;
};

}  // namespace exactff::gradient
