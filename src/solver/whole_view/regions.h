// From the arcs of a view (view_edges.h) to closed regions with exact corners.
//
// Each outline belongs to a thing, which the caller names by a number; what meets nothing above the horizon is the
// thing kOpen. Run with the thing on its left, the arcs beside a thing are the boundary of the part of the directions
// in which it is seen: at every corner as many of them end as begin. (What is seen is a set of directions bounded by
// arcs, and every part of its boundary is an arc once.) So they form closed loops. The boundary of kOpen also has the
// parts of the horizon that no arc covers.
//
// Corners are exact: primitive integer directions, so that equal directions are one corner. Where several sides of a
// thing meet in a corner, a loop goes on along the first one clockwise from the side that it came by, and so stays
// beside one part of the region; a loop may touch itself in a corner. It may also touch the inside of a side: no arc
// ends there, and that changes neither areas nor what lies inside. Corners between two sides of one plane through x are
// left out, except on the horizon, where sides would grow beyond a half turn.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "kernel/filter.h"
#include "whole_view/view_edges.h"

namespace exactff::whole_view {

// A part of a plane through x, of at most a half turn. It ends where the next side of its loop begins. Seen from x,
// the region is on its left.
struct Side {
  std::uint32_t from = 0, to = 0;  // corners
  Vec3 inward;  // the plane's normal on the side of the region; components rounded, the largest in [1/2, 1]
  bool on_horizon = false;
};
using SideLoop = std::vector<Side>;

struct Region {
  std::uint32_t thing = 0;
  std::vector<SideLoop> loops;
};

class Regions {
 public:
  static constexpr std::uint32_t kOpen = kNothing;
  using ThingOf = std::function<std::uint32_t(OutlineId)>;

  // `up`: the receiver's normal.
  Regions(ViewEdges& edges, const kernel::ExactVec3& up, const ThingOf& thing_of);

  [[nodiscard]] std::span<const Region> regions() const { return regions_; }  // of all things seen, ascending
  [[nodiscard]] std::uint32_t corner_count() const { return static_cast<std::uint32_t>(corners_.size()); }
  [[nodiscard]] const kernel::Direction& corner(std::uint32_t index) const { return corners_[index]; }

 private:
  struct Hash {
    std::size_t operator()(const kernel::ExactVec3& v) const;
  };
  struct Equal {
    bool operator()(const kernel::ExactVec3& a, const kernel::ExactVec3& b) const {
      return a.x == b.x && a.y == b.y && a.z == b.z;
    }
  };
  struct OfThing {
    std::uint32_t thing = 0;
    Side side;
    bool used = false;
  };

  std::uint32_t corner_at(kernel::ExactVec3 direction);
  void add_arc(ViewEdges& edges, std::size_t arc, const ThingOf& thing_of);
  void close_horizon(const kernel::ExactVec3& up);
  void trace(std::span<OfThing> sides);
  OfThing* next_side(std::span<OfThing> sides, const Side& side, const OfThing& start) const;
  [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  [[nodiscard]] SideLoop merged(const SideLoop& loop) const;

  std::vector<kernel::Direction> corners_;
  std::unordered_map<kernel::ExactVec3, std::uint32_t, Hash, Equal> corner_at_;
  std::vector<OfThing> sides_;
  std::vector<Side> horizon_;  // covered parts
  std::vector<Region> regions_;
};

}  // namespace exactff::whole_view
