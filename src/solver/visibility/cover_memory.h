// Remembers which panels hid a source plane from the receiver before, since they mostly hide it from a neighbour as
// well. What it returns is only tried first: the panels may be those of another scene.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "scene/panels.h"

namespace exactff::visibility {

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

}  // namespace exactff::visibility
