// Numbers for unordered pairs of numbers: a hash table with open addressing.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernel/expect.h"

namespace exactff::whole_view {

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

}  // namespace exactff::whole_view
