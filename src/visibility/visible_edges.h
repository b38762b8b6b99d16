// The boundary of the visible region without its faces: the parts of every edge that no outline hides.
//
// V is the union of the source's outlines S_k less the union of the occluders' O_i, all convex and open. A point of an
// edge lies on the boundary of V where V is on one side of it and not on the other. What lies on a side of an edge, at
// its very line, is told by intervals of its parameter: an outline whose interior the edge's line crosses covers both
// sides along an interval; an outline with an edge of its own on that line covers, along that edge, the side it lies
// on; any other outline covers nothing. Hence, with "left" and "right" sides as x sees the edge,
//   an edge of S_k (S_k left) bounds V where no O covers its left and no S_l its right; of S-edges that coincide with
//     the same side, the one with the lowest index keeps it;
//   an edge of O_i (O_i left) bounds V where S covers both its sides, no O_j covers its right; of O-edges that coincide
//     with the same side, the one with the lowest index keeps it.
// Where an O-edge falls upon the outer boundary of S, it has S on one side only and the S-edge speaks for both.
//
// Steps:
//   1. silhouettes: an edge that two occluders share, one on either side, cannot bound V; nor can its doubles;
//   2. a grid over the source (outline_grid.h) tells which outlines an edge may meet;
//   3. for each edge the intervals, from which what is left of it follows by one sweep.
#pragma once

#include <cmath>
#include <vector>

#include "visibility/boundary_piece.h"
#include "visibility/outline_grid.h"
#include "visibility/outlines.h"

namespace exactff::visibility {

// A workspace: what it holds is reused from one call to the next.
class VisibleEdges {
 public:
  static constexpr std::uint32_t kNowhere = 0xFFFFFFFFU;

  // A parameter of an edge: one of its ends, or where the line of another edge crosses it.
  struct Parameter {
    enum class Kind : std::uint8_t { kBegin, kCrossing, kEnd } kind = Kind::kBegin;
    EdgeId line = 0;                  // that crosses
    std::uint32_t stored = kNowhere;  // where the exact parameter is, if it had to be computed
    double value = 0.0;               // m / (l + m)
    double error = 0.0;
  };
  // A part of the boundary of V, V to its left.
  struct Part {
    EdgeId edge = 0;
    Parameter begin, end;
  };

  Outlines& outlines() { return outlines_; }

  // True if the occluder covers every corner of the source, and so all of it.
  [[nodiscard]] bool hides_all(OutlineId occluder, std::size_t source_count);

  // Requires that the first `source_count` outlines are the source's and the others the occluders', all of positive
  // area.
  // False, with nothing found, where so many occluders and edges cannot be told apart by the grid that the Booleans are
  // the better way.
  [[nodiscard]] bool find(std::size_t source_count);
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] BoundaryPiece exact(const Part& part);

 private:
  struct Interval {
    Parameter begin, end;
  };
  // What an outline covers along the edge, on either side of it.
  struct Cover {
    bool left = false, right = false;
    bool coincides = false;  // it has an edge on the line
    Interval interval;
  };

  void drop_inner_edges(std::size_t source_count);
  void trace(EdgeId id, std::size_t source_count);
  // What the outline covers; false if nothing.
  [[nodiscard]] bool cover(const Outlines::Edge& edge, OutlineId outline, Cover& result);
  void cut_exactly(const Outlines::Edge& edge, EdgeId line, int& sign_a, int& sign_b, Parameter& crossing);
  [[nodiscard]] static Parameter crossing_at(EdgeId line, double height_a, double height_b, double error);
  [[nodiscard]] bool lies_left(const Outlines::Edge& edge, OutlineId outline);
  void find_allowed(const Outlines::Edge& edge, std::size_t source_count);
  // False where what is removed is all.
  [[nodiscard]] bool find_removed(const Outlines::Edge& edge, std::size_t source_count);
  void keep_rest(EdgeId id, bool reversed, const Interval& allowed);
  void keep(EdgeId id, bool reversed, const Parameter& begin, const Parameter& end);

  [[nodiscard]] int compare(const Outlines::Edge& edge, const Parameter& p, const Parameter& q) {
    const double difference = p.value - q.value;
    if (std::abs(difference) > p.error + q.error) return difference > 0.0 ? 1 : -1;
    return compare_exactly(edge, p, q);
  }
  [[nodiscard]] int compare_exactly(const Outlines::Edge& edge, const Parameter& p, const Parameter& q);
  [[nodiscard]] EdgeParameter exact(const Outlines::Edge& edge, const Parameter& p);
  [[nodiscard]] bool covers(const Outlines::Edge& edge, const Interval& a, const Interval& b);
  void sort(const Outlines::Edge& edge, std::vector<Interval>& intervals);
  void merge(const Outlines::Edge& edge, std::vector<Interval>& intervals);

  Outlines outlines_;
  OutlineGrid grid_;
  std::vector<std::uint8_t> dropped_;  // by edge
  std::vector<OutlineId> near_;        // occluders that the edge at hand may meet
  std::vector<Part> parts_;
  std::vector<EdgeParameter> stored_;
  std::vector<Interval> allowed_, left_, right_, removed_;
  std::vector<EdgeId> slots_;  // of drop_inner_edges: a hash table
};

}  // namespace exactff::visibility
