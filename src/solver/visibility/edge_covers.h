// What convex outlines cover of an edge, decided exactly, and where lines cross it. Both the edges of one source's view
// (visible_edges.h) and those of the whole view (whole_view/view_edges.h) are compared with outlines in this way.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <vector>

#include "kernel/lanes.h"
#include "visibility/outlines.h"

namespace exactff::visibility {

// --- Edge parameters ---

// Points of an edge as the edge engine knows them: by a double with an error bound, and exactly where that is not
// enough.

// A parameter (l : m) of an edge (outlines.h), with a and b scaled like their doubles: one of the edge's ends, or the
// crossing with the line of another edge. m / (l + m) lies within `error` of `value`.
struct Parameter {
  static constexpr EdgeId kAtBegin = 0xFFFFFFFEU, kAtEnd = 0xFFFFFFFFU;
  double value = 0.0;
  float error = 0.0F;
  EdgeId line = kAtBegin;  // the line that crosses
};

// The error of a crossing's parameter as a float. It exceeds the double by enough that the sum of two, rounded as
// floats, is no less than the sum of the doubles. It is at least 2^-50 and so a normal float; an infinite error decides
// nothing in either case.
inline float rounded_up(double error) { return static_cast<float>(error * (1.0 + 0x1p-20)); }

// Exact parameters, each computed at first use. Equal lines must have equal ids.
class ExactParameters {
 public:
  // Forgets all parameters, in the existing memory.
  void clear(std::size_t edges) {
    count_ = 0;
    grow(edges);
  }
  // Makes room for edges that were added since.
  void grow(std::size_t edges) { stored_at_.resize(4 * edges); }

  [[nodiscard]] const EdgeParameter& of(Outlines& outlines, EdgeId edge, const Parameter& p);
  // Where the line crosses the edge.
  [[nodiscard]] const EdgeParameter& crossing(Outlines& outlines, EdgeId edge, EdgeId line);
  // -1, 0, +1: p before, at, after q.
  [[nodiscard]] int compare(Outlines& outlines, EdgeId edge, const Parameter& p, const Parameter& q);

 private:
  struct Stored {
    EdgeId edge = 0, line = 0;
    EdgeParameter parameter;
  };

  std::deque<Stored> stored_;  // the first count_; the rest is spare memory
  std::size_t count_ = 0;
  std::vector<std::uint32_t> stored_at_;  // into stored_, for every line and four edges; may be stale or another edge's
  Integer product_p_, product_q_;         // scratch
};

// --- Edge lanes ---

// Compares a run of edges with all lines of an outline at once, by the filter alone: four edges to a vector register.
// Both the edges of one source's view (visible_edges.h) and those of the whole view (whole_view/view_edges.h) are
// compared with outlines in this way.
//
// An edge enters or leaves a line's inner side where it crosses the line: if its ends have heights m and l above the
// line, of different signs, the crossing is at the parameter |m| / (|l| + |m|) = m / (m - l).
//
// Its error. Let D be |l| + |m| and e the larger error of the two heights, all as computed, and u = 2^-53. The quotient
// of the true heights differs by at most e / (D - 2e) <= 2e / D where D >= 4e. Difference, inverse and product err by u
// each, relatively, so that the quotient, at most 1, has an additional error of at most 4u; 4e / D is computed within a
// relative error of 4u. 4e / D + 2^-50 covers all of this, with 4u and half of 4e / D to spare for the rounding of
// differences of parameters and of sums of errors: computed values may be compared directly. Where D < 4e the error is
// more than 1, which is more than the distance of any two parameters: it then decides nothing; nor does NaN.
//
// Every comparison that does not hold for all numbers within the errors makes the edge unsure, whatever is computed
// from it afterwards, except that one line with both ends certainly below it is enough for the outline to cover
// nothing. The side that an end lies on, and which of two parameters is larger, can therefore be read from the signs,
// as masks whose other bits do not matter. A line whose inner side the edge enters can only move the beginning of the
// covered interval; a line whose inner side it leaves can only move the end. So one comparison serves for both. A line
// that has the whole run on its inner side moves neither and may be skipped.
//
// Shared corners. A corner that is known to be an end of a line has height 0 above it, exactly: it lies neither below
// nor above. An edge with both ends on a line coincides with it; one with one end on a line and the other below it is
// not covered at all.

using kernel::lanes::Four;
using kernel::lanes::FourMask;

// One parameter for each edge of a run. Equal lines are not yet replaced by their representative.
struct LaneParameters {
  Four value{}, error{};
  FourMask line{};
};
struct LaneIntervals {
  LaneParameters begin, end;
};

// A run: consecutive edges of an outline with up to four corners between them.
inline constexpr unsigned kRunCorners = 4;
// All edges of a triangle or a quadrilateral, otherwise three.
constexpr unsigned edges_of_run(unsigned all) { return all <= kRunCorners ? all : kRunCorners - 1; }

// Edge k runs from the corner in lane k to that in the next lane, lane 0 after the last; unused lanes repeat a corner.
struct RunCorners {
  FourMask id{};
  Four x{}, y{}, z{}, size{};

  EXACTFF_INLINE void set(const Outlines& outlines, EdgeId first, unsigned edges) {
    const auto corner = [&](unsigned k) {
      const Outlines::Edge& edge = outlines.edge(first + std::min(k, edges - 1));
      return k < edges ? edge.a : edge.b;
    };
    const CornerId i = corner(0), j = corner(1), k = corner(2), l = corner(3);
    const Outlines::Corner &a = outlines.corner(i), &b = outlines.corner(j), &c = outlines.corner(k),
                           &d = outlines.corner(l);
    id = FourMask{i, j, k, l};
    x = Four{a.t.x, b.t.x, c.t.x, d.t.x};
    y = Four{a.t.y, b.t.y, c.t.y, d.t.y};
    z = Four{a.t.z, b.t.z, c.t.z, d.t.z};
    size = Four{a.size, b.size, c.size, d.size};
  }

  [[nodiscard]] EXACTFF_INLINE Four dot(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

// What an outline covers of a run, by the filter alone. A bit for every edge.
struct LaneCuts {
  OutlineId by = 0;
  unsigned covered = 0;     // it certainly crosses the outline's interior, in the interval
  unsigned coincident = 0;  // it runs between the same two corners as one of the outline's edges
  unsigned unsure = 0;      // nothing is certain
  LaneIntervals intervals;
};

// For cut_run(): no corner is known to be an end of a line, so that edges which touch one are unsure.
struct UnknownCorners {
  EXACTFF_INLINE static FourMask at(CornerId /*end*/) { return kernel::lanes::four_whole(0); }
  EXACTFF_INLINE static bool take_line(const FourMask& /*starts*/, const FourMask& /*reversed*/, const Four& /*height*/,
                                       const FourMask& /*certain*/) {
    return true;
  }
};

EXACTFF_INLINE LaneIntervals whole_edges() {
  using kernel::lanes::four, kernel::lanes::four_whole;
  return {{four(0.0), four(0.0), four_whole(Parameter::kAtBegin)},
          {four(1.0), four(0.0), four_whole(Parameter::kAtEnd)}};
}

EXACTFF_INLINE void replace(LaneParameters& parameters, const FourMask& where, const LaneParameters& by) {
  using kernel::lanes::pick;
  parameters.value = pick(where, by.value, parameters.value);
  parameters.error = pick(where, by.error, parameters.error);
  parameters.line = pick(where, by.line, parameters.line);
}

// `shared.at(end)`: the corners of the run that are this end of a line. `shared.take_line` sees, for every line, the
// corners where it starts, the edges that coincide with it and run the other way, and the corners' heights above it
// with those whose sign is certain. If it returns false, nothing is covered: then so does this, with nothing in `cuts`.
template <class Shared>
EXACTFF_INLINE bool cut_run(const RunCorners& run, const Outlines& outlines, OutlineId by, Outlines::LineBits skipped,
                            Shared& shared, LaneCuts& cuts) {
  using namespace kernel::lanes;
  const EdgeId first = outlines.outline(by).first;
  const std::span<const Outlines::Edge> lines = outlines.edges().subspan(first, outlines.outline(by).count);
  const Four size_of_both = run.size + next_lane(run.size);  // at least the larger one; NaN if either is
  auto [begin, end] = whole_edges();
  LaneParameters crossing;
  FourMask outside = four_whole(0), coincident = four_whole(0), sure = four_whole(-1);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i < Outlines::kLineBits && (skipped >> i & 1U) != 0) continue;
    const Outlines::Edge& line = lines[i];
    const FourMask starts = shared.at(line.a), stops = shared.at(line.b);
    const FourMask on_a = starts | stops, on_b = next_lane(on_a), on_both = on_a & on_b;
    const Four a = pick(on_a, four(0.0), run.dot(line.normal)), b = next_lane(a);
    const Four error = line.error * size_of_both;
    const FourMask certain_a = on_a | (absolute(a) > error), known = certain_a & (on_b | (absolute(b) > error));
    if (!shared.take_line(starts, on_both & stops, a, certain_a)) return false;
    const FourMask below_a = FourMask(a), below_b = FourMask(b);  // by their signs
    const FourMask crosses = (below_a ^ below_b) & ~(on_a | on_b);
    const Four inverse = 1.0 / (a - b);
    crossing.value = a * inverse;
    crossing.error = error * absolute(inverse) * 4.0 + 0x1p-50;
    crossing.line = four_whole(static_cast<std::int64_t>(first + i));
    // From the end of the interval that the crossing may replace.
    const Four beyond = crossing.value - pick(below_b, end.value, begin.value);
    const Four beyond_error = crossing.error + pick(below_b, end.error, begin.error);
    const FourMask before = FourMask(beyond);
    outside |= known & (below_a | on_a) & (below_b | on_b) & ~on_both;
    coincident |= on_both;
    sure &= known & ~(crosses & ~(absolute(beyond) > beyond_error));
    replace(begin, crosses & below_a & ~before, crossing);
    replace(end, crosses & below_b & before, crossing);
  }
  sure = sure < 0;
  const FourMask inside = ~(outside < 0), open = inside & ~coincident;
  const Four length = end.value - begin.value, length_error = end.error + begin.error;
  cuts.by = by;
  cuts.covered = lane_bits(open & sure & (length > length_error));
  cuts.coincident = lane_bits(inside & coincident);
  cuts.unsure = lane_bits(open & ~(sure & (absolute(length) > length_error)));
  cuts.intervals = {begin, end};
  return true;
}

// --- Edge covers ---

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
  // What both hold: empty unless it ends after its beginning. Of equal ends, those of the first.
  [[nodiscard]] Interval common(EdgeId edge, const Interval& a, const Interval& b) {
    return {compare(edge, a.begin, b.begin) >= 0 ? a.begin : b.begin, compare(edge, a.end, b.end) <= 0 ? a.end : b.end};
  }
  [[nodiscard]] bool is_empty(EdgeId edge, const Interval& a) { return compare(edge, a.begin, a.end) >= 0; }
  // Calls visit(interval) for what is left of an interval without others, which are in order of their beginnings.
  template <class Visit>
  EXACTFF_INLINE void for_each_rest(EdgeId edge, const Interval& whole, std::span<const Interval> others,
                                    const Visit& visit) {
    const Parameter* reached = &whole.begin;
    for (const Interval& other : others) {
      if (compare(edge, other.begin, whole.end) >= 0) break;
      if (compare(edge, other.begin, *reached) > 0) visit(Interval{*reached, other.begin});
      if (compare(edge, other.end, *reached) > 0) reached = &other.end;
    }
    if (compare(edge, *reached, whole.end) < 0) visit(Interval{*reached, whole.end});
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
