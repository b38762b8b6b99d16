// Finds the boundary of the region of one source plane that is visible from a receiving point, with memory that is
// reused from one plane to the next.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/panels.h"
#include "visibility/plane_visibility.h"
#include "visibility/silhouettes.h"
#include "visibility/source_shaft.h"
#include "visibility/visible_edges.h"

namespace exactff::visibility {

// --- Cover memory ---

// Remembers which panels hid a source plane from the receiver before, since they mostly hide it from a neighbour as
// well. What it returns is only tried first: the panels may be those of another scene.

class CoverMemory {
 public:
  static constexpr std::size_t kMost = 128;  // panels of a cover; more are not remembered

  // Those that hid the plane with this first piece last; empty if that is not known.
  [[nodiscard]] std::span<const PanelId> of(std::uint32_t first_piece) const {
    const Cover& cover = covers_[first_piece % kPlanes];
    return {cover.panels.data(), cover.first_piece == first_piece ? cover.count : 0};
  }
  void forget(std::uint32_t first_piece) { covers_[first_piece % kPlanes].count = 0; }
  // Remembers the panel of each of these, or of the first kMost of them.
  template <class Item, class PanelOf>
  void set(std::uint32_t first_piece, std::span<const Item> items, const PanelOf& panel_of) {
    Cover& cover = covers_[first_piece % kPlanes];
    cover.first_piece = first_piece;
    cover.count = 0;
    for (const Item& item : items.first(std::min(items.size(), kMost))) cover.panels[cover.count++] = panel_of(item);
  }

 private:
  static constexpr std::size_t kPlanes = 16;
  struct Cover {
    std::uint32_t first_piece = 0;
    std::size_t count = 0;
    std::array<PanelId, kMost> panels{};
  };
  std::array<Cover, kPlanes> covers_{};
};

// --- Edge workspace ---

// What a search for the visible parts of one plane works on. It depends on nothing that an earlier search left here.
struct EdgeSearch {
  VisibleEdges edges;
  ClipMemory clip;
  ShaftMemory shaft;
  BacksMemory backs;
  RunMarks seen;                        // panels
  std::vector<PanelId> outline_panels;  // of the occluders' outlines
};

struct EdgeWorkspace {
  EdgeSearch search;   // what it found remains valid until the next one
  EdgeSearch attempt;  // to hide the plane as before
  CoverMemory covers;
  SilhouetteWalk silhouettes;
};

// Exact. Requires a receiver normal that is not zero. The edge engine, unless the Booleans are requested or are the
// better method (visible_edges.h).
PlaneVisibility find_visible_boundary(const View& view, const SourcePlane& plane, const BoundaryRequest& request,
                                      EdgeWorkspace& workspace);

}  // namespace exactff::visibility
