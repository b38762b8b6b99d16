// Finds edges between the same two corners: a hash table with open addressing.
#pragma once

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

#include "visibility/outlines.h"

namespace exactff::visibility {

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

}  // namespace exactff::visibility
