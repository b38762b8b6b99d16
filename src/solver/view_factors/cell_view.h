// What every point of a cell sees of the source: the edge engine's question, asked for a whole cell at once.
//
// As seen from x, the visible region is the source without the union of the occluders' shadows. All of them are convex,
// so its boundary consists of the parts of edges of the source that no shadow covers, and of the parts of occluders'
// edges that lie inside the source and that no other shadow covers. Which parts these are depends on two kinds of
// signs:
//
// - on which side of an edge a vertex is seen. For an edge (a, b) and a vertex v this is the side of the plane
//   (a, b, v) on which x lies, an affine function of x: its sign at the corners of a convex cell decides it for the
//   whole cell;
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
// What is open. Without a source, the region is all directions above the horizon without the shadows. Its boundary
// consists of such parts of the occluders' edges and of the horizon. Where a shadow reaches the horizon, its occluder
// has an edge in the receiver's plane. If these parts follow one another once around, no horizon bounds the region, and
// they are left out.
//
// Meshes. Two occluders that meet in an edge, and that show the cell fronts, or backs, of one surface, lie on opposite
// sides of it. So it bounds nothing, and needs no further look: of a finely cut wall, silhouettes are left.
//
// Arcs. An edge is seen under less than 180 degrees, and all lies in the closed half-space in front of the receiver.
// Edges in the receiver's plane are all seen along the horizon, where two edges may face each other from opposite
// sides. So an arc (a, b) is intersected with an arc (p, q) of the same great circle by asking which ends lie in the
// other arc.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "view_factors/cell.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// An end of a boundary piece: where the edge of `line` crosses the piece's own edge, or else a vertex.
struct End {
  PointId vertex = 0;
  std::optional<LineId> line;

  friend bool operator==(const End& a, const End& b) { return a.line == b.line && (a.line || a.vertex == b.vertex); }
};

// A part of an edge, constant on the cell. The visible region is on its left if `sign` is +1, else on its right.
struct BoundaryPart {
  Edge edge;
  End from, to;
  int sign = 1;
};

// An occluder that may cover something of the source, and the side of its plane on which the cell lies. What covers
// nothing for a cell covers nothing for its parts, so these inherit the list.
struct Candidate {
  std::uint32_t occluder = 0;
  std::int8_t facing = kUnasked;
};
using Candidates = std::vector<Candidate>;  // by ascending index

class CellView {
 public:
  // Keeps references. `id` tells the pairs apart that share the memory.
  CellView(const Sight& sight, PairMemory& memory, std::size_t id);

  enum class Outcome {
    kKnown,      // parts() is the boundary of the visible region from every point inside the cell
    kCut,        // best_cut() decides more
    kCrossings,  // only orders of crossings are undecided
  };
  // To be called before the first look at the parts of a cell that is not the last one looked at.
  void start();
  // The same, but parts of a cell that was looked at before follow, at the depth way.size(). What has been found out
  // for it still holds.
  void resume(PairMemory::Way way);
  // To the last cell that was looked at, at this depth.
  [[nodiscard]] PairMemory::Way way(std::size_t depth) const;
  // `depth`: of the cell below the root; each cell is a part of the last one at the depth before. Takes out candidates
  // that turn out to cover nothing.
  [[nodiscard]] Outcome look(const Cell& cell, std::size_t depth, Candidates& candidates);
  [[nodiscard]] Candidates all_candidates() const;
  // Of an occluder that has been taken out: whether it is known to hide nothing of the source from the present cell,
  // not only what others hide.
  [[nodiscard]] bool hides_nothing(std::uint32_t occluder) const { return !was_covered_[occluder]; }
  // The occluders that share a side with this one, and the side, by its place in the ring.
  [[nodiscard]] std::vector<std::pair<std::uint32_t, std::size_t>> neighbours_of(std::uint32_t occluder) const;

  [[nodiscard]] const std::vector<BoundaryPart>& parts() const { return parts_; }
  // Whether all of the horizon bounds the region, too; parts() then has the edges on it that take off some.
  [[nodiscard]] bool has_horizon() const { return has_horizon_; }
  // Of all planes that decide more, the one that halves the cell best; the first of equal ones. Where very many signs
  // have been asked for, of those that were found by then.
  [[nodiscard]] const std::shared_ptr<const Plane>& best_cut() const { return best_cut_; }
  // Of kCrossings: all lines whose order is undecided.
  [[nodiscard]] const std::vector<CrossingTriple>& triples() const { return triples_; }
  // How often a sign has been asked for so far.
  [[nodiscard]] std::uint64_t work() const { return work_; }
  // How many planes of an edge and a vertex cut the cell, one of which is the source's and the other one an occluder's;
  // 0 if there are many candidates.
  [[nodiscard]] std::size_t count_events(const Cell& cell, const Candidates& candidates);

 private:
  enum class Overlap { kNone, kPart, kAll, kUnknown };
  struct Interval {
    End from, to;
  };
  struct Covered {
    Overlap kind = Overlap::kNone;
    Interval interval{};
  };
  // From a place of an edge: the end of a cover that holds it, or else the nearest start of one beyond, if any.
  struct Ahead {
    std::optional<End> covered_to, next_cover;
  };
  enum class Along { kNo, kSameSide, kOppositeSide };

  // All edges of occluders with the same ends, as ranges of same_edges_. They are written in either direction.
  struct SameEdge {
    std::uint32_t occluder;
    bool from_lower;  // from the point of the lower number
  };
  struct EdgeRange {
    std::uint32_t begin, end;
  };

  // An edge's line and a point, whose plane cuts the cell.
  struct Doubt {
    LineId line;
    PointId point;
  };

  int sign_on_cell(LineId line, PointId point);
  int raw_side(LineId line, PointId point);
  int side(const Edge& edge, PointId point);
  bool is_beside(const Ring& ring, const Ring& other);
  bool holds(const Ring& ring, const Ring& other);
  bool is_outside(const Solid& solid);
  [[nodiscard]] bool is_back(const Candidate& candidate) const;
  bool is_spare_back(const Candidate& candidate);
  bool holds_with_neighbour(const Candidate& outer, std::uint32_t inner);
  bool sort_out(Candidate& candidate);
  void drop_covered(Candidates& candidates);
  Covered overlap(const Edge& edge, const Ring& ring, Along& along);
  Covered between(const Edge& edge, const Edge& in, const Edge& out);
  const Ring& ring_of(const Candidate& candidate) const;
  void look_at_edge(const Edge& edge, std::size_t owner);
  void find_same_edges();
  void note_facing();
  [[nodiscard]] std::optional<std::uint32_t> neighbour_at(std::uint32_t owner, std::size_t edge) const;
  [[nodiscard]] bool look_at_edges();
  bool covers(Along along, std::size_t owner, std::size_t other) const;
  int order(const Edge& edge, const End& p, const End& q);
  int order_of_lines(LineId e, LineId g, LineId h);
  int order_of_apart(CrossingTriple lines);
  std::span<const Interval> covers() const { return std::span(intervals_).subspan(1); }
  bool is_known_before(const End& p, const End& q) const;
  std::optional<Ahead> look_ahead(const Edge& edge, const End& at);
  [[nodiscard]] bool emit_uncovered(const Edge& edge, int sign);
  void find_all_undecided(const Edge& edge);
  [[nodiscard]] bool is_on_horizon(const Edge& edge) const;
  [[nodiscard]] std::pair<PointId, LineId> place_on_horizon(const End& end) const;
  void look_at_horizon();
  void consider_cut(const std::shared_ptr<const Plane>& plane);
  void consider_doubts();

  const Sight& sight_;
  PairMemory& memory_;
  std::size_t id_;
  std::size_t top_ = 0;         // depth of the first cells that are looked at
  std::vector<Ring> reversed_;  // of every occluder
  std::vector<bool> in_plane_;  // of the receiver, by point; only if there is no source
  std::vector<SameEdge> same_edges_;
  std::vector<std::vector<EdgeRange>> edges_;  // of every occluder, in the order of its ring
  std::vector<std::int8_t> facing_;            // of every occluder; 0: it is no candidate
  std::vector<bool> was_covered_;              // of every occluder: others hid from some cell what it does

  const Cell* cell_ = nullptr;
  const Candidates* candidates_ = nullptr;
  std::uint64_t work_ = 0;
  std::vector<Doubt> doubts_;  // undecided signs since the last question
  std::shared_ptr<const Plane> best_cut_;
  double best_balance_ = -1.0;
  std::vector<Interval> intervals_;  // of the edge that is looked at: the one inside the source, then covered ones
  std::vector<BoundaryPart> parts_;
  bool has_horizon_ = false;
  std::vector<CrossingTriple> triples_;
  std::map<CrossingTriple, int> orders_;  // of ascending lines, that have been asked for
};

}  // namespace exactff::view_factors
