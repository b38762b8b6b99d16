// What has been found out about cells and would cost time to find again: signs, and exact planes. Its size is limited;
// what no longer fits is found again, so the results do not depend on it.
//
// It serves pair after pair, so that its memory is allocated once.
//
// Cells form a tree, and a sign that is known for a cell is known for its parts. So a sign is kept with the cell that
// it was found for, and holds as long as this cell is on the way from the root to the present one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "view_factors/polygons.h"

namespace exactff::view_factors {

// More than the signs of cell.h.
inline constexpr int kMixedAndSeen = 3;  // mixed on the cell, and considered as a cut
inline constexpr int kUnasked = 4;

class PairMemory {
 public:
  // The pairs so far are done with: their numbers may be given to others.
  void forget_pairs() { planes_.clear(); }
  // To be called first: what is asked from here on is about the cells of another pair, or of this one from a new root.
  void start(std::size_t pair, std::size_t line_count, std::size_t point_count);
  // The cells from the root to one, by depth.
  using Way = std::vector<std::uint64_t>;
  // The same, but what follows are parts of a cell that was the present one before.
  void resume(std::size_t pair, std::size_t line_count, std::size_t point_count, Way way);
  [[nodiscard]] const Way& way() const { return way_; }
  // The present cell becomes one at this depth, a part of the last one at the depth before.
  void enter(std::size_t depth);

  // The sign of a line and a point, or kUnasked. Mixed signs are known for the cell itself alone.
  [[nodiscard]] int sign(LineId line, PointId point) const;
  void keep_sign(LineId line, PointId point, int sign);

  // The plane through a line and a point of the points.
  const std::shared_ptr<const Plane>& plane(const Points& points, LineId line, PointId point);

 private:
  static constexpr int kDepthBits = 24;

  struct Entry {
    std::uint64_t key = ~std::uint64_t{0};
    std::uint64_t cell = 0;  // its number, then its depth
    std::int8_t sign = 0;
  };
  [[nodiscard]] static std::uint64_t key(LineId line, PointId point) { return std::uint64_t{line} << 32 | point; }
  void take(std::size_t pair, std::size_t line_count, std::size_t point_count);
  [[nodiscard]] std::size_t slot(LineId line, PointId point) const {
    return (line * point_count_ + point) & (entries_.size() - 1);
  }

  std::size_t pair_ = 0, point_count_ = 0, depth_ = 0;
  std::uint64_t cells_ = 0;
  std::vector<Entry> entries_;  // a power of two of them; each place is taken by the last sign that falls on it
  Way way_;                     // to the present cell
  std::map<std::tuple<std::size_t, LineId, PointId>, std::shared_ptr<const Plane>> planes_;
};

// Memories for as many jobs as run at the same time.
class PairMemories {
 public:
  [[nodiscard]] std::unique_ptr<PairMemory> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<PairMemory>();
    std::unique_ptr<PairMemory> memory = std::move(idle_.back());
    idle_.pop_back();
    return memory;
  }
  void give_back(std::unique_ptr<PairMemory> memory) {
    memory->forget_pairs();
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(memory));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<PairMemory>> idle_;
};

}  // namespace exactff::view_factors
