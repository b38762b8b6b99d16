// What every point of a cell sees of the source: the edge engine's question, asked for a whole cell at once.
//
// As seen from x, the visible region is the source without the union of the occluders' shadows. All of them are convex,
// so its boundary consists of the parts of edges of the source that no shadow covers, and of the parts of occluders'
// edges that lie inside the source and that no other shadow covers. Which parts these are depends on two kinds of
// signs:
//
// - on which side of an edge a vertex is seen. For an edge (a, b) and a vertex v this is the side of the plane (a, b,
// v)
//   on which x lies, an affine function of x: its sign at the corners of a convex cell decides it for the whole cell;
// - in which order an edge e meets two others, g and h: the sign of f(x) = det(N_e, N_g, N_h), where
//   N = (a - x) x (b - x). The terms of third order cancel, so f is quadratic in x. With its polar form,
//   b(y, z) = 2 f((y + z) / 2) - (f(y) + f(z)) / 2, a point x = sum of l_i c_i of the cell has f(x) = sum of
//   l_i l_j b(c_i, c_j): the signs of b at pairs of corners decide it. If two of the three lines share a point v, f is
//   a product of two signs of the first kind.
//
// Coincident edges. A function that vanishes at all corners vanishes everywhere on the receiver, so edges are seen
// along one another from all of it or from none of a cell. The rules for these: an edge of the source is covered if the
// occluder lies on the source's side of it; an occluder's edge along an edge of the source bounds nothing, since that
// edge counts; of two occluders on the same side of their common edge the first one counts, and on opposite sides
// neither does.
//
// Arcs. An edge is seen under less than 180 degrees, and all lies in the closed half-space in front of the receiver.
// Edges in the receiver's plane are all seen along the horizon, where two edges may face each other from opposite
// sides. So an arc (a, b) is intersected with an arc (p, q) of the same great circle by asking which ends lie in the
// other arc.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "view_factors/event_bound.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// An end of a boundary piece: a vertex, or where the edge of `line` crosses the piece's own edge.
struct End {
  PointId vertex = 0;
  std::optional<LineId> line;

  friend bool operator==(const End&, const End&) = default;
};

// A part of an edge, constant on the cell. The visible region is on its left if `sign` is +1, else on its right.
struct BoundaryPart {
  Edge edge;
  End from, to;
  int sign = 1;
};

// Signs that are known for a cell are known for its parts: copies of this go from a cell to its parts. A sign that is
// mixed on the cell is not kept.
struct KnownSigns {
  std::vector<std::int8_t> of_points;  // for every line and point
  std::vector<std::int8_t> facing;     // for every occluder: the side of its plane on which the cell lies
  std::vector<bool> beside;            // for every occluder: it covers nothing
};

class CellView {
 public:
  explicit CellView(const Sight& sight);

  enum class Outcome {
    kKnown,      // parts() is the boundary of the visible region from every point inside the cell
    kCut,        // one of cuts() decides more
    kCrossings,  // only orders of crossings are undecided
  };
  [[nodiscard]] Outcome look(const Cell& cell, KnownSigns& known);
  [[nodiscard]] KnownSigns nothing_known() const;

  [[nodiscard]] const std::vector<BoundaryPart>& parts() const { return parts_; }
  [[nodiscard]] const std::vector<std::shared_ptr<const Plane>>& cuts() const { return cuts_; }
  // Of kCrossings: all lines whose order is undecided.
  [[nodiscard]] const std::vector<CrossingTriple>& triples() const { return triples_; }

 private:
  enum class Overlap { kNone, kPart, kAll, kUnknown };
  struct Interval {
    End from, to;
  };
  struct Covered {
    Overlap kind = Overlap::kNone;
    Interval interval{};
  };
  enum class Along { kNo, kSameSide, kOppositeSide };

  const std::shared_ptr<const Plane>& plane(LineId line, PointId point);
  int raw_side(LineId line, PointId point);
  int side(const Edge& edge, PointId point);
  bool is_beside(const Ring& ring, const Ring& other);
  bool holds(const Ring& ring, const Ring& other);
  bool sort_out(std::size_t occluder);
  Covered overlap(const Edge& edge, const Ring& ring, Along& along);
  Covered between(const Edge& edge, const Edge& in, const Edge& out);
  const Ring& ring_of(std::size_t occluder) const;
  void look_at_edge(const Edge& edge, std::size_t owner);
  bool covers(Along along, std::size_t owner, std::size_t other) const;
  int order(const Edge& edge, const End& p, const End& q);
  int order_of_lines(LineId e, LineId g, LineId h);
  [[nodiscard]] bool emit_uncovered(const Edge& edge, const Interval& base, int sign);
  void find_all_undecided(const Edge& edge, const Interval& base);
  void commit_doubts();

  const Sight& sight_;
  std::size_t point_count_;
  std::vector<std::shared_ptr<const Plane>> planes_;  // for every line and point, made when asked for
  std::vector<Ring> reversed_;                        // of every occluder
  std::vector<std::shared_ptr<const Plane>> occluder_planes_;

  const Cell* cell_ = nullptr;
  KnownSigns* known_ = nullptr;
  std::vector<std::shared_ptr<const Plane>> doubts_;  // undecided signs since the last question
  std::vector<std::shared_ptr<const Plane>> cuts_;
  std::vector<Interval> covers_;
  std::vector<BoundaryPart> parts_;
  std::vector<CrossingTriple> triples_;
};

}  // namespace exactff::view_factors
