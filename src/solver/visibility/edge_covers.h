// What convex outlines cover of an edge, decided exactly, and where lines cross it. Both the edges of one source's view
// (visible_edges.h) and those of the whole view (whole_view/view_edges.h) are compared with outlines in this way.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "visibility/edge_lanes.h"
#include "visibility/edge_parameters.h"
#include "visibility/outlines.h"

namespace exactff::visibility {

class EdgeCovers {
 public:
  // A part of an edge.
  struct Part {
    EdgeId edge = 0;
    Parameter begin, end;
  };

  Outlines& outlines() { return outlines_; }
  [[nodiscard]] const Outlines& outlines() const { return outlines_; }
  [[nodiscard]] BoundaryPiece exact(const Part& part);
  // What a search found.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  // Pairs of an edge and an outline, or another edge: those examined, and those for which the filter was not certain.
  [[nodiscard]] std::uint64_t pairs() const { return pairs_; }
  [[nodiscard]] std::uint64_t undecided_pairs() const { return undecided_pairs_; }

 protected:
  static constexpr Parameter kBegin{0.0, 0.0F, Parameter::kAtBegin};
  static constexpr Parameter kEnd{1.0, 0.0F, Parameter::kAtEnd};

  struct Interval {
    Parameter begin, end;
  };
  // What an outline covers along an edge, on each side of it.
  struct Cover {
    bool left = false, right = false;
    bool coincides = false;  // it has an edge on the line
    Interval interval;
  };

  // Of edge k of a run.
  [[nodiscard]] Parameter parameter(const LaneParameters& of, unsigned k) const {
    const auto line = static_cast<EdgeId>(of.line[k]);
    return {of.value[k], rounded_up(of.error[k]), line < Parameter::kAtBegin ? line_[line] : line};
  }
  [[nodiscard]] Interval interval(const LaneIntervals& of, unsigned k) const {
    return {parameter(of.begin, k), parameter(of.end, k)};
  }
  // The part of an edge that is covered; false if none.
  [[nodiscard]] bool cover_exactly(EdgeId edge, OutlineId outline, Cover& result);

  [[nodiscard]] int compare(EdgeId edge, const Parameter& p, const Parameter& q) {
    const double difference = p.value - q.value, error = p.error + q.error;
    if (std::abs(difference) > error) return difference > 0.0 ? 1 : -1;
    return p.line == q.line ? 0 : exact_.compare(outlines_, edge, p, q);
  }
  // By their beginnings.
  EXACTFF_INLINE void sort(EdgeId edge, std::vector<Interval>& intervals) {
    constexpr std::size_t kMostToInsert = 16;
    const auto comes_first = [&](const Interval& a, const Interval& b) { return compare(edge, a.begin, b.begin) < 0; };
    if (intervals.size() > kMostToInsert) {
      std::sort(intervals.begin(), intervals.end(), comes_first);
      return;
    }
    for (std::size_t i = 1; i < intervals.size(); ++i) {
      const Interval inserted = intervals[i];
      std::size_t at = i;
      for (; at > 0 && comes_first(inserted, intervals[at - 1]); --at) intervals[at] = intervals[at - 1];
      intervals[at] = inserted;
    }
  }

  Outlines outlines_;
  std::vector<EdgeId> line_;  // by edge: the first edge between the same two corners
  ExactParameters exact_;
  std::vector<Part> parts_;
  std::uint64_t pairs_ = 0, undecided_pairs_ = 0;

 private:
  void cut_exactly(EdgeId edge, EdgeId line, int& sign_a, int& sign_b, Parameter& crossing);

 protected:
  // Where the line crosses the edge. Requires ends strictly on different sides: callers
  // know the exact signs.
  [[nodiscard]] Parameter crossing_of(EdgeId edge, EdgeId line);
  [[nodiscard]] bool lies_left(const Outlines::Edge& edge, OutlineId outline);
};

}  // namespace exactff::visibility
