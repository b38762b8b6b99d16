// Vertices of files that repeat them for every triangle.
#pragma once

#include <bit>
#include <chrono>
#include <cstdint>
#include <vector>

#include "exactff/geometry.h"

namespace exactff::formats {

// Numbers positions in the order of their first appearance. Positions are one if their doubles are equal, so 0 and -0
// are. A hash table with open addressing.
class PositionTable {
 public:
  PositionTable() : slots_(1024) {}

  // The number of the position; `is_new` tells if it was not there before.
  std::uint32_t number(const Vec3& position, bool& is_new) {
    if (2 * positions_.size() >= slots_.size()) grow();
    std::uint32_t& slot = slots_[slot_of(position)];
    is_new = slot == 0;
    if (is_new) {
      positions_.push_back(position);
      slot = static_cast<std::uint32_t>(positions_.size());
    }
    return slot - 1;
  }

 private:
  // Where the position is, or the empty slot where it belongs.
  [[nodiscard]] std::size_t slot_of(const Vec3& position) const {
    std::size_t at = hash(position) & (slots_.size() - 1);
    while (slots_[at] != 0 && positions_[slots_[at] - 1] != position) at = (at + 1) & (slots_.size() - 1);
    return at;
  }

  [[nodiscard]] std::uint64_t hash(const Vec3& position) const {
    std::uint64_t state = seed_;
    for (const double coordinate : {position.x, position.y, position.z}) {
      state = (state ^ std::bit_cast<std::uint64_t>(coordinate + 0.0)) * 0x9E3779B97F4A7C15U;
      state ^= state >> 32U;
    }
    return state;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), 0);
    for (std::size_t i = 0; i < positions_.size(); ++i)
      slots_[slot_of(positions_[i])] = static_cast<std::uint32_t>(i + 1);
  }

  std::vector<std::uint32_t> slots_;  // a number plus 1, or 0 if empty
  std::vector<Vec3> positions_;
  // Differs from run to run, so that no file can be made of positions that fall into one slot. The numbers do not
  // depend on it.
  std::uint64_t seed_ = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
};

}  // namespace exactff::formats
