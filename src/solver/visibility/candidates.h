// Steps 3 and 4 of the exact method, for the edge engine: finds the panels that enter the shaft and adds their
// outlines, unless one of them hides all.
//
// Candidates come from the bounding-volume tree; then signs decide (source_shaft.h). A face that the source's plane
// cuts is clipped, no face is clipped to the shaft, and pieces of closed surfaces that face away from x are left out
// (surface_backs.h).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "visibility/edge_workspace.h"
#include "visibility/piece_clip.h"
#include "visibility/source_shaft.h"
#include "visibility/surface_backs.h"

namespace exactff::visibility {

class Candidates {
 public:
  static constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();

  // Requires that the first `source_count` outlines of the search are the source's. Counts its work in the record.
  Candidates(const PlaneQuery& query, std::size_t source_count, EdgeSearch& search, PlaneRecord& record)
      : query_(query),
        panels_(*query.plane.scene_panels),
        source_count_(source_count),
        search_(search),
        outlines_(search.edges.outlines()),
        record_(record),
        clip_(query, outlines_, search.clip),
        shaft_(query, clip_, outlines_, search.shaft),
        backs_(query, shaft_, search.backs) {}

  // Adds the outlines of all candidates. If one hides all, returns it; the others are then not needed. Stops
  // after more than `most` candidates: see too_many().
  [[nodiscard]] std::optional<PanelId> gather(std::uint64_t most = kAny);
  [[nodiscard]] bool too_many() const { return too_many_; }
  // Adds the outlines of what buries parts of the source. They lie in its plane, and are no candidates.
  void add_covers();
  // A panel that hides all, if there is one. Looks only at those that may. Adds outlines. Requires culling.
  [[nodiscard]] std::optional<PanelId> one_that_hides_all();

 private:
  void start();
  [[nodiscard]] bool visit(PanelId panel, bool inside);

  const PlaneQuery& query_;
  const Panels& panels_;
  const std::size_t source_count_;
  EdgeSearch& search_;
  Outlines& outlines_;
  PlaneRecord& record_;
  PieceClip clip_;
  SourceShaft shaft_;
  SurfaceBacks backs_;
  bool too_many_ = false;
};

}  // namespace exactff::visibility
