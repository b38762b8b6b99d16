// Steps 2 and 3 of the exact method for one piece of the scene: its part above the receiver's horizon, or its part on
// x's side of the source's plane. Becomes an outline of the edge engine.
#pragma once

#include <span>

#include "visibility/plane_visibility.h"
#include "visibility/search_memory.h"

namespace exactff::visibility {

// The part of the source above the horizon: the first outlines.
struct ClippedSource {
  std::size_t count = 0;  // outlines, each of one panel
  bool is_cut = false;    // by the horizon
};

class PieceClip {
 public:
  PieceClip(const PlaneQuery& query, Outlines& outlines, ClipMemory& memory)
      : view_(query.view),
        plane_(query.plane),
        by_pieces_(query.request.by_pieces),
        outlines_(outlines),
        memory_(memory) {}

  // Discards all outlines and starts with those of the source.
  [[nodiscard]] ClippedSource add_source();

  // The following functions refer to the piece with these vertices.
  void take(std::span<const std::uint32_t> vertices) {
    vertices_ = vertices;
    outlines_.corners_of(vertices, memory_.corners);
  }
  [[nodiscard]] std::span<const CornerId> corners() const { return memory_.corners; }
  // For every corner +1: on x's side of the source's plane.
  std::span<const int> find_depths();
  // +1: ahead of the plane through x that is parallel to the source's.
  [[nodiscard]] int toward_sign(CornerId corner) const;
  // Adds the part on x's side of the source's plane. `is_cut`: that is not all of it. `facing`: see below.
  OutlineId add_occluder(bool is_cut, int facing);
  // For every vertex: the sign of its height above the source's plane.
  [[nodiscard]] int depth_sign(std::uint32_t vertex) const;

 private:
  bool add_above_horizon(std::span<const std::uint32_t> corners, ClippedSource& source);
  [[nodiscard]] int horizon_side(CornerId corner) const;
  OutlineId add_part_above(Outlines::Plane plane, bool mirrored);

  const View& view_;
  const SourcePlane& plane_;
  bool by_pieces_;
  Outlines& outlines_;
  ClipMemory& memory_;
  std::span<const std::uint32_t> vertices_;
};

}  // namespace exactff::visibility
