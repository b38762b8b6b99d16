// All that is seen from x, as arcs: parts of edges, each with what is seen beside it on its left and on its right.
//
// What is seen in a direction is the nearest face whose plane does not hold x and that is not one of x's own; of faces
// in one plane the one that comes first (scene/contacts.h): a front before a back, and of several fronts, or backs, the
// one with the lowest index. A receiver that is buried sees nothing. An outline is the part above the horizon of a
// convex piece of a face, as x sees it. Its edges have its inside on their left. An edge of outline O is an arc
// wherever O is seen just to the left of it. What is seen just to the right is then
//   - the nearest of the outlines that cover the right side of the edge there, or
//   - nothing.
// Where two edges lie in one plane through x, and each is an arc with the other's outline on its right, only that of
// the lower outline is kept. Where two faces pierce each other, the part of their planes' common line that lies in both
// is an edge as well, with the nearer face of each side beside it. Nothing else separates what is seen.
//
// Depths along an edge are linear (windows.h), so two signs say whether an outline is nearer than another one along all
// of an edge, or from where on. Where both signs are 0, the two planes and the edge have a line in common, and the sign
// beside the edge decides, separately for the left and the right.
//
// Steps:
//   1. gather the pieces above the horizon, clipped by it, and find the edges that two of them share;
//   2. windows (windows.h): which outlines may be seen near an edge, and which are hidden;
//   3. edges, in runs of up to four corners, each with the outlines of its windows: the intervals that nearer outlines
//      cover on the left are hidden; the others are possible backgrounds on the right;
//   4. for each edge, one sweep over the hidden intervals, and the nearest backgrounds of the rest;
//   5. the same for the lines along which faces pierce each other.
//
// Shared edges. An edge e of O that runs the other way in exactly one other outline P has P on its right wherever O is
// seen on its left, unless a third outline has an edge in the same plane through x or a plane that holds e. So such an
// edge is looked at once, and not at all where both are parts of the same whole; where such a third outline is found,
// it is looked at like any other.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernel/expect.h"
#include "scene/contacts.h"
#include "visibility/edge_covers.h"
#include "visibility/plane_visibility.h"
#include "visibility/visible_edges.h"
#include "whole_view/windows.h"

namespace exactff::whole_view {

// --- Pair table ---

// Numbers for unordered pairs of numbers: a hash table with open addressing.

class PairTable {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  // Forgets all pairs, in the existing memory.
  void clear() {
    count_ = 0;
    slots_.assign(std::max<std::size_t>(slots_.size(), 64), Slot{});
  }

  // The number of the pair; kNone if it is new. The reference is valid until the next call. Requires p != q.
  std::uint32_t& operator()(std::uint32_t p, std::uint32_t q) {
    EXACTFF_EXPECT(p != q);
    if (2 * ++count_ > slots_.size()) grow();  // counts requests, so grows a little early
    return find(std::min(p, q), std::max(p, q)).number;
  }

 private:
  struct Slot {
    std::uint32_t low = 0, high = 0;  // equal: free
    std::uint32_t number = kNone;
  };
  Slot& find(std::uint32_t low, std::uint32_t high) {
    const std::uint64_t key = (std::uint64_t{high} << 32U | low) * 0x9E3779B97F4A7C15U;
    for (std::size_t at = key >> 32U & (slots_.size() - 1);; at = (at + 1) & (slots_.size() - 1)) {
      Slot& slot = slots_[at];
      if (slot.low == slot.high) slot = {low, high, kNone};
      if (slot.low == low && slot.high == high) return slot;
    }
  }
  void grow() {
    old_.swap(slots_);
    slots_.assign(2 * old_.size(), Slot{});
    count_ = 1;
    for (const Slot& slot : old_) {
      if (slot.low == slot.high) continue;
      ++count_;
      find(slot.low, slot.high) = slot;
    }
  }

  std::vector<Slot> slots_, old_;
  std::size_t count_ = 0;
};

// --- View edges ---

using visibility::Four;
using visibility::FourMask;
using visibility::kRunCorners;
using visibility::Parameter;

inline constexpr OutlineId kNothing = 0xFFFFFFFFU;

class ViewEdges : public visibility::EdgeCovers {
 public:
  // What is seen on both sides of parts()[i].
  struct Sides {
    OutlineId left = kNothing, right = kNothing;
    bool on_horizon = false;  // below it there is nothing
  };
  // An outline belongs to a whole: arcs between outlines of the same whole are left out.
  enum class Wholes {
    kPatches,  // the fronts of each patch; all backs
    kFronts,   // the front of each face; all backs
    kFaces,    // each face
    kPlanes,   // each face, and each triangle of a face that is not planar
  };

  void find(const visibility::View& view, Wholes wholes);

  [[nodiscard]] std::span<const Sides> sides() const { return sides_; }
  [[nodiscard]] std::size_t outline_count() const { return whole_.size(); }
  [[nodiscard]] const Piece& piece(OutlineId outline) const { return depths_.piece(outline); }
  [[nodiscard]] FaceId face(OutlineId outline) const { return piece(outline).face; }
  [[nodiscard]] std::uint32_t whole(OutlineId outline) const { return whole_[outline]; }
  [[nodiscard]] bool shows_front(OutlineId outline) const { return front_[outline] != 0; }
  // Fronts of different wholes that overlap in one plane: where both could be seen, the first is.
  struct Stack {
    OutlineId first = kNothing, other = kNothing;
  };
  [[nodiscard]] std::span<const Stack> stacks() const { return stacks_; }

  struct Work {
    std::uint64_t outlines = 0, windows = 0, pairs = 0, undecided = 0, pierced = 0;
  };
  [[nodiscard]] const Work& work() const { return work_; }

 private:
  static constexpr EdgeId kNoEdge = 0xFFFFFFFFU;
  using Lines = Windows::Lines;

  enum class Side { kLeft, kRight };
  // Which of two outlines is nearer along an edge: +1 the first, -1 the second. Never 0.
  struct Order {
    int at_a = 0, at_b = 0;
  };
  struct Background {
    OutlineId outline = kNothing;
    bool coincides = false;  // it begins at the edge
    Interval interval;
  };
  // Edges of one outline (edge_covers.h), or one line of two piercing faces.
  struct Run {
    OutlineId owner = kNothing;  // seen on the left
    OutlineId other = kNothing;  // of piercing faces: the one on the right
    EdgeId first = 0;
    unsigned edges = 0;
    unsigned wanted = 0, skipped = 0, forced = 0;
    visibility::RunCorners corners{};
    Four w{}, w_error{};  // inverse depths of the owner
  };
  // What an outline covers of a run, by the filter and by shared corners.
  struct Cuts : visibility::LaneCuts {
    unsigned reversed = 0;                       // of the coincident edges: it runs the other way
    unsigned nearer = 0, further = 0, same = 0;  // of the outline, by corner; same: they share the corner
  };
  struct Piercing {
    OutlineId p = 0, q = 0;
    EdgeId edge = 0;
  };

  // 1.
  void start(const visibility::View& view);
  void gather(const visibility::View& view, Wholes wholes);
  void add(const visibility::View& view, const Piece& piece, std::uint32_t whole, int facing);
  void classify_new_corners(const visibility::View& view);
  void clip();
  void find_partners();
  // 3.
  void trace_all();
  void trace_outline(OutlineId outline);
  void find_near(OutlineId outline, Lines lines);
  void add_near(OutlineId outline);
  void set_run(Run& run) const;
  void trace(Run& run);
  void look_at_near(Run& run);
  void look_at(Run& run, OutlineId by);
  void resolve(Run& run, unsigned k, const Cuts& cuts);
  [[nodiscard]] static bool may_hold(unsigned k, const Cuts& cuts);
  [[nodiscard]] bool holds(const Run& run, unsigned k, const Cuts& cuts);
  [[nodiscard]] bool cover(const Run& run, unsigned k, const Cuts& cuts, Cover& result);
  void hide(Run& run, unsigned k, const Interval& interval);
  void hide_where_nearer(Run& run, unsigned k, OutlineId by, const Interval& interval);
  void note_rivals(OutlineId outline);
  // Depths.
  // Of outlines in one plane.
  [[nodiscard]] bool comes_first(OutlineId p, OutlineId q) const {
    const auto side = [&](OutlineId o) {
      return Contacts::Side{static_cast<std::uint32_t>(&piece(o) - scene_->pieces().data()), shows_front(o)};
    };
    return contacts_->comes_first(side(p), side(q));
  }
  [[nodiscard]] Order order(OutlineId p, OutlineId q, EdgeId edge, OutlineId owner, Side side);
  [[nodiscard]] int order_beside(OutlineId p, OutlineId q, EdgeId edge, OutlineId owner);
  [[nodiscard]] int order_everywhere(OutlineId p, OutlineId q);
  [[nodiscard]] EdgeId line_between(OutlineId p, OutlineId q);
  [[nodiscard]] bool overlap(OutlineId p, OutlineId q);
  [[nodiscard]] bool has_outside(OutlineId p, OutlineId q);
  // 4.
  void finish(const Run& run, unsigned k, const Interval& allowed);
  void find_right(const Run& run, unsigned k, const Interval& visible);
  void keep_around(const Run& run, EdgeId edge, const Interval& visible, const Background& only);
  void put_in(const Run& run, EdgeId edge, const Background& background);
  void keep(const Run& run, EdgeId edge, const Background& right);
  // 5.
  void examine_rivals();
  void examine(OutlineId p, OutlineId q);
  void note_stack(OutlineId p, OutlineId q);
  void trace_piercing(const Piercing& piercing);

  const Scene* scene_ = nullptr;
  const Contacts* contacts_ = nullptr;
  Windows windows_;
  Depths depths_;
  std::vector<std::uint32_t> whole_;       // by outline
  std::vector<std::uint8_t> front_;        // by outline
  std::vector<std::int8_t> horizon_side_;  // by corner
  std::vector<EdgeId> partner_;            // by edge
  std::vector<CornerId> corners_, ring_;   // scratch of gather
  PairTable crossings_;                    // of the horizon with segments between two corners
  visibility::EdgeTable table_;            // of find_partners
  std::vector<std::uint8_t> shared_;       // by edge, of find_partners
  std::vector<OutlineId> near_;            // of the current run
  std::vector<std::uint32_t> seen_in_;     // by outline: the last run that listed it
  std::uint32_t run_ = 0;
  std::vector<std::uint8_t> traced_;  // by outline
  std::array<std::vector<Interval>, kRunCorners> hidden_;
  std::array<std::vector<Background>, kRunCorners> backgrounds_;
  std::vector<Background> envelope_, next_envelope_;
  std::vector<std::pair<OutlineId, OutlineId>> rivals_;
  std::vector<Stack> stacks_;
  PairTable lines_;  // of pairs of outlines
  std::vector<Piercing> piercings_;
  std::vector<Sides> sides_;
  Work work_;
};

}  // namespace exactff::whole_view
