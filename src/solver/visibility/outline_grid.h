// Finds the occluders that an edge may meet, by a grid over the source as x sees it.
//
// The grid lies in the image of a projection (u, v) = (e . t, f . t) / w . t. The doubles of its vectors are exact by
// definition: any projection with w . t > 0 serves, since it only has to map lines to lines. |w| = 1, |e|, |f| <= 1. A
// corner is ahead if w . t >= 2^-8 |t|; then |u|, |v| <= 2^8, numerator and denominator err by less than 8u |t|
// (u = 2^-53), the quotient by less than 2^-42 (1 + 2^8) < 2^-33, and rotating the image adds a negligible error: the
// slack of 2^-32 bounds the total. Ranges are widened by multiples of the slack, so that outlines and edges that meet
// inside the source share a cell; others may share one too. An outline that is not ahead is treated as near everything.
//
// If only few edges are needed, only the cells that these edges run through are filled.
//
// A cell that one occluder covers with a margin lists only that occluder: it hides every part of an edge within the
// cell, so no other occluder matters there.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "kernel/lanes.h"
#include "visibility/outlines.h"

namespace exactff::visibility {

class OutlineGrid {
 public:
  // The first `source_count` outlines are the source's, the others go into the grid. Requires that edges marked in
  // `dropped` are never queried: VisibleEdges leaves them out of `wanted`.
  void build(const Outlines& outlines, std::size_t source_count, std::span<const std::uint8_t> dropped);

  // Estimates how many pairs of an edge and an occluder find_near would return for all edges because cells cannot
  // separate them; where they are many, the grid is of little use. Pairs too close together for any cells are also too
  // close for the filter: each is counted as the number of filtered pairs that take as long as one exact comparison.
  [[nodiscard]] std::uint64_t unsorted_pairs(const Outlines& outlines) const;

  // All outlines. If there are more than the caches hold, they are ordered so that outlines near one another mostly
  // follow one another. Valid until build is called again.
  [[nodiscard]] std::span<const OutlineId> in_order(std::size_t count);

  // Every occluder needed to find the visible parts of the edges inside the source, each once, and possibly others. The
  // edges are those of the set bits of `wanted`, counted from `first`. Valid until the next call.
  [[nodiscard]] std::span<const OutlineId> find_near(const Outlines& outlines, EdgeId first, unsigned wanted);

 private:
  struct Image {
    double u = 0.0, v = 0.0;
    bool ahead = false;
  };
  static constexpr OutlineId kNone = 0xFFFFFFFFU;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Range {
    double low, high;
    void widen(double by) {
      low -= by;
      high += by;
    }
    void include(double x) {
      low = x < low ? x : low;
      high = x > high ? x : high;
    }
    void include(const Range& r) {
      include(r.low);
      include(r.high);
    }
    [[nodiscard]] bool empty() const { return !(low <= high); }
  };
  struct Cells {  // first > last: none
    int first, last;
  };
  // One axis of the grid.
  struct Axis {
    Range range{0, 0};  // of the source, widened
    int count = 1;
    double per_unit = 0.0;
    [[nodiscard]] Cells cells(const Range& r) const {
      if (!(r.high >= range.low && r.low <= range.high)) return {1, 0};
      return {cell(r.low), cell(r.high)};
    }
    // The nearest of the grid's cells. Truncation rounds down because the number is not negative.
    [[nodiscard]] int cell(double x) const {
      const double at = (x - range.low) * per_unit;
      return at <= 0.0 ? 0 : at >= count - 1 ? count - 1 : static_cast<int>(at);
    }
    [[nodiscard]] Range extent(int cell) const;
    // The cells that lie within the range.
    [[nodiscard]] Cells cells_inside(const Range& r) const;
  };

  // The bounds of an outline's image, widened; empty if it is not ahead.
  struct ImageBounds {
    Range u{kInfinity, -kInfinity}, v{kInfinity, -kInfinity};
  };
  // ImageBounds of an outline's image along the axes and both diagonals, in fine steps, rounded outwards: the four
  // lower bounds, then the four upper ones with their signs changed, so that a smaller number is further out in all of
  // them.
  using Octagon = kernel::lanes::EightShorts;

  [[nodiscard]] bool choose_projection(const Outlines& outlines, std::size_t source_count);
  void project(const Outlines& outlines);
  void align(const Outlines& outlines, std::size_t source_count);
  void find_bounds(const Outlines& outlines);
  void choose_cells(std::size_t source_count);
  [[nodiscard]] Octagon octagon(const Outlines& outlines, OutlineId id) const;
  // Another outline can meet this one only if its bounds nowhere exceed these.
  [[nodiscard]] static Octagon reach(const Octagon& bounds);
  void find_needed_cells(const Outlines& outlines, std::span<const std::uint8_t> dropped);
  [[nodiscard]] bool is_needed(const Cells& columns, const Cells& rows) const;
  void find_covered_cells(const Outlines& outlines);
  [[nodiscard]] bool covers(const Outlines& outlines, const Outlines::Outline& outline, const Range& u,
                            const Range& v) const;
  void find_cells(const Outlines& outlines);
  void fill();
  [[nodiscard]] bool belongs(OutlineId o, std::size_t cell) const {
    return coverer_[cell] == kNone || coverer_[cell] == o;
  }
  [[nodiscard]] bool is_ahead(const Outlines& outlines, const Outlines::Outline& outline) const;
  [[nodiscard]] static Range part_within(const Image& a, const Image& b, const Range& v);
  [[nodiscard]] std::span<const OutlineId> all_occluders();
  template <class Visit>
  void for_each_cell_of_edge(const Image& a, const Image& b, const Visit& visit) const;
  template <class Visit>
  void for_each_cell_of(const Outlines& outlines, OutlineId id, const Visit& visit);
  // Where the outline's bounds span few cells, they are as good as the outline itself.
  template <class Visit>
  bool for_few_cells(const Cells& columns, const Cells& rows, const Visit& visit) const;

  Vec3 e_, f_, w_;
  OutlineId first_ = 0;  // of the occluders
  Axis u_, v_;
  bool single_ = true;               // too few outlines for a grid, or no projection: all are near all
  bool too_fine_ = false;            // the accuracy of the images limits the cell size: many may share a cell
  bool all_ahead_ = true;            // every corner is
  std::vector<Image> images_;        // by corner
  std::vector<ImageBounds> bounds_;  // by outline
  // By outline. The entries of outlines without cells are unspecified: such outlines have no part inside the source, or
  // none near an edge that may be queried, so it does not matter which outlines they find or which find them.
  std::vector<Octagon> octagons_;
  bool all_needed_ = true;
  std::vector<std::uint32_t> needed_;         // cells that edges run through, before this one: sums over both axes
  std::vector<std::uint32_t> outline_begin_;  // into cells_, by outline, one more at the end
  std::vector<std::uint32_t> cells_;          // where occluders are
  std::vector<std::uint32_t> cell_begin_;     // into members_, by cell, one more at the end
  std::vector<OutlineId> members_;
  std::vector<OutlineId> coverer_;  // by cell: an occluder that certainly covers it; then it is the only member
  std::vector<OutlineId> everywhere_;
  std::vector<OutlineId> all_;  // every occluder; filled at the first request for all
  std::vector<OutlineId> order_;
  std::vector<std::uint32_t> next_;  // scratch: by cell
  std::vector<EdgeId> last_found_;   // by outline: the first of the edges that found it last
  std::vector<EdgeId> last_seen_;    // by cell: the first of the edges that looked into it last
  std::vector<Range> spans_;         // scratch: by row
  std::vector<OutlineId> near_;      // first everywhere_, then scratch: room for every occluder and one more
};

}  // namespace exactff::visibility
