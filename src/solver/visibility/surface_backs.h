// Which pieces of closed surfaces are left out because they show x their backs.
//
// Let x lie outside the box of a closed surface (closed_surfaces.h) all of whose pieces may occlude or are seen
// edge-on, and let the box lie on x's side of the source's plane, off it. Along almost every segment from x to a point
// y of that plane the winding number goes up by one at each piece that is crossed from the front, down by one at each
// that is crossed from the back, and is 0 at both ends, which lie outside the box. So as many pieces are crossed from
// the front as from the back. The pieces that show x their backs cover the same region as the pieces that show x their
// fronts, up to a set of area zero, and either set may be left out. All pieces remain candidates, and each may still
// hide all.
#pragma once

#include "scene/closed_surfaces.h"
#include "scene/panels.h"
#include "visibility/search_memory.h"
#include "visibility/source_shaft.h"

namespace exactff::visibility {

class SurfaceBacks {
 public:
  SurfaceBacks(const PlaneQuery& query, const SourceShaft& shaft, BacksMemory& memory)
      : query_(query),
        shaft_(shaft),
        surfaces_(closed_surfaces(query.view.scene)),
        panels_(*query.plane.scene_panels),
        memory_(memory) {}

  void start();
  // `facing`: facing_of the panel. Requires the shaft of an outline.
  [[nodiscard]] bool is_left_out(PanelId panel, int facing) {
    if (surfaces_.empty()) return false;
    const std::uint32_t surface = surface_of(panel);
    if (surface == ClosedSurfaces::kNone) return false;
    return backs_left_out(surface) && (facing > 0) != surfaces_.surfaces()[surface].turned_inside_out;
  }

 private:
  [[nodiscard]] std::uint32_t surface_of(PanelId panel) const {
    return panels_.is_joined(panel) ? panels_.sheet_of(panel).surface : surfaces_.of_piece(panel);
  }
  [[nodiscard]] bool backs_left_out(std::uint32_t surface);
  [[nodiscard]] bool may_leave_out_backs(std::uint32_t surface) const;

  const PlaneQuery& query_;
  const SourceShaft& shaft_;
  const ClosedSurfaces& surfaces_;
  const Panels& panels_;
  BacksMemory& memory_;
};

}  // namespace exactff::visibility
