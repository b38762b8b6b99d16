// Finds the boundary of the visible region without constructing the region: the parts of every edge that no outline
// hides.
//
// V is the union of the source's outlines S_k less the union of the occluders' O_i, all convex and open. A point of an
// edge lies on the boundary of V where V is on one side of it and not on the other. Intervals of the edge's parameter
// describe what covers each side of the edge, next to its line. An outline whose interior the edge's line crosses
// covers both sides along an interval. An outline with an edge on that line covers, along that edge, the side that it
// lies on. Any other outline covers nothing. Hence, with "left" and "right" sides as x sees the edge,
//   an edge of S_k (S_k left) bounds V where no O covers its left and no S_l its right; of S-edges that coincide with
//     the same side, the one with the lowest index keeps it;
//   an edge of O_i (O_i left) bounds V where S covers both its sides, no O_j covers its right; of O-edges that coincide
//     with the same side, the one with the lowest index keeps it.
// Where an O-edge lies on the outer boundary of S, it has S on one side only, and the S-edge represents both.
//
// Step 7 of the exact method (src/README.md) in four parts:
//   a. silhouettes: an edge that two occluders share, one on each side, cannot bound V; nor can its duplicates;
//   b. a grid over the source (outline_grid.h) finds the outlines that an edge may meet;
//   c. edges are processed in runs of up to four corners, outline by outline; where there are many outlines, neighbours
//      follow one another. The heights of a run's corners above the lines of an outline give, for each edge of the run,
//      the interval that the outline covers: by the filter for all edges of the run at once (edge_covers.h), and
//      exactly where the filter is not certain;
//   d. for each edge, one sweep over its intervals gives its visible parts.
//
// Few occluders may prove that nothing is visible: if no part of any edge of the source or of these occluders bounds
// what they leave visible, they leave nothing, and so do all. find_cover chooses them by estimates,
// and traces only their edges and the source's, against them alone. Where it finds a visible part, it adds an occluder
// that seems to hide it, and traces the edge again. What was hidden before stays hidden.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "visibility/edge_covers.h"
#include "visibility/outline_grid.h"
#include "visibility/outlines.h"

namespace exactff::visibility {

// --- Cover choice ---

// Chooses a few occluders that may together hide all of the source. By estimates in doubles, which prove nothing:
// that what is chosen hides all, VisibleEdges proves.
//
// An occluder seems to hide a direction if the direction lies on the inner side of all its edges. The size of a shadow
// is its area in a plane across the view.

// A workspace: its memory is reused from one call to the next.
class CoverChoice {
 public:
  // How many occluders may be chosen, of that many: so few that a search in vain takes little of the time that a search
  // for all visible edges takes, which is nearly proportional to `occluders`.
  [[nodiscard]] static std::size_t most_of(std::size_t occluders);

  // Chooses, for some points of the source, the largest of the occluders that seem to hide each. False if none does, or
  // if most_of() occluders are not enough for the area of the source. The first `source_count` outlines are the
  // source's.
  [[nodiscard]] bool start(const Outlines& outlines, std::size_t source_count);
  // Chooses the largest occluder that seems to hide the direction. False if none does, if the direction seems hidden by
  // those already chosen, or if they are too many.
  [[nodiscard]] bool add_for(const Outlines& outlines, const Approx3& direction);

  // Chooses all occluders; no more can be added.
  void take_all(const Outlines& outlines, std::size_t source_count);

  // Those chosen, in order. Valid until the next call.
  [[nodiscard]] std::span<const OutlineId> chosen() const { return chosen_; }

 private:
  using Shadow = std::pair<float, OutlineId>;  // its size, as a share of the source's, at most 1

  void find_points(const Outlines& outlines, std::size_t source_count);
  [[nodiscard]] bool corners_seem_hidden(const Outlines& outlines, std::size_t source_count);
  [[nodiscard]] bool find_largest(const Outlines& outlines, std::size_t source_count);
  void find_depths(const Outlines& outlines);
  [[nodiscard]] double size(const Outlines& outlines, OutlineId id) const;
  [[nodiscard]] static bool seems_hidden(const Outlines& outlines, OutlineId by, const Approx3& direction);

  Approx3 across_view_;
  std::vector<Approx3> corners_, points_;  // of the source: near its corners, and elsewhere
  std::vector<OutlineId> across_;          // occluders that reach beyond the source's edges
  std::vector<double> inverse_depths_;     // by corner, along the view; infinite where it is not ahead
  std::vector<Shadow> largest_;            // in descending order
  std::vector<OutlineId> chosen_;
  std::size_t most_ = 0;
};

// --- Visible edges ---

// Finds edges between the same two corners: a hash table with open addressing.
class EdgeTable {
 public:
  // Forgets all edges, in the existing memory. Makes room for `most` edges.
  void clear(std::size_t most) {
    mask_ = std::bit_ceil(2 * most) - 1;
    slots_.assign(mask_ + 1, kFree);
  }

  // Adds an edge, unless one between the same two corners, in either direction, was added before. Returns the edge in
  // the table.
  EdgeId add(EdgeId id, std::span<const Outlines::Edge> edges) {
    const CornerId a = edges[id].a, b = edges[id].b;
    const std::uint64_t key = (std::uint64_t{std::max(a, b)} << 32U | std::min(a, b)) * 0x9E3779B97F4A7C15U;
    for (std::size_t slot = key >> 32U & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot] == kFree) return slots_[slot] = id;
      const Outlines::Edge& known = edges[slots_[slot]];
      if ((known.a == a && known.b == b) || (known.a == b && known.b == a)) return slots_[slot];
    }
  }

 private:
  static constexpr EdgeId kFree = 0xFFFFFFFFU;
  std::size_t mask_ = 0;
  std::vector<EdgeId> slots_;
};

// A workspace: its memory is reused from one call to the next. Each of its parts has V to its left.
class VisibleEdges : public EdgeCovers {
 public:
  // Requires that the first `source_count` outlines are the source's and the others are the occluders', all of positive
  // area: who adds them has clipped them, and left out what has none. Returns false, with nothing found, if the grid
  // fails to separate so many occluders and edges that the Booleans are the better method.
  [[nodiscard]] bool find(std::size_t source_count);
  // True if a few of the occluders hide all of the source; `cover` lists these. False proves nothing. Requires the same
  // as find. Nothing is visible, or nothing is found: parts() is empty.
  [[nodiscard]] bool find_cover(std::size_t source_count);
  // The same for all occluders, which should be few: false if they leave a part of the source visible.
  [[nodiscard]] bool all_cover(std::size_t source_count);
  [[nodiscard]] std::span<const OutlineId> cover() const { return choice_.chosen(); }

 private:
  static constexpr std::size_t kBatch = 4;

  // Edges of an outline (edge_covers.h).
  struct Run {
    OutlineId outline = 0;
    bool of_source = false;
    EdgeId first = 0;
    unsigned edges = 0;
    unsigned wanted = 0;   // a bit for every edge of which something may be left
    LaneIntervals left{};  // where it may be, except for the intervals in removed_
    RunCorners corners{};
  };
  void start();
  void drop_inner_edges(std::size_t source_count);
  void poll();
  [[nodiscard]] bool cover_hides_all(std::size_t source_count);
  [[nodiscard]] bool hide(OutlineId id, std::size_t source_count);
  [[nodiscard]] Approx3 direction_in_view(const Part& part, bool of_source) const;
  void trace_outline(OutlineId id, std::size_t source_count);
  void trace(Run& run, std::size_t source_count);
  void find_allowed(Run& run, std::size_t source_count);
  void find_allowed_in_union(Run& run, std::size_t source_count);
  void allow_common(Run& run, unsigned k);
  void find_removed(Run& run, std::size_t source_count);
  void remove(Run& run, const LaneCuts& cuts, bool same_kind);
  static void set(LaneParameters& parameters, unsigned k, const Parameter& parameter);
  void take_off(Run& run, unsigned k, const Interval& interval);
  [[nodiscard]] unsigned take_off_by_filter(Run& run, const LaneCuts& cuts);

  void cut(const Run& run, OutlineId outline, LaneCuts& cuts, Outlines::LineBits skipped = 0);
  // The part of an edge that is covered; false if none.
  [[nodiscard]] bool cover(const Run& run, unsigned k, const LaneCuts& cuts, Cover& result);
  void merge(EdgeId edge, std::vector<Interval>& intervals);

  OutlineGrid grid_;
  CoverChoice choice_;
  bool by_cover_ = false;               // only the chosen occluders count
  std::vector<std::uint8_t> dropped_;   // by edge
  std::span<const OutlineId> near_;     // occluders that the current run may meet
  std::array<LaneCuts, kBatch> batch_;  // by some of these
  std::uint64_t next_poll_ = 0;         // in pairs
  // By edge of the run: the intervals removed, and the intervals with the source on the left and on the right.
  std::array<std::vector<Interval>, kRunCorners> removed_, left_, right_;
  EdgeTable table_;  // of drop_inner_edges
};

}  // namespace exactff::visibility
