#include "view_factors/pair_memory.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "view_factors/cell.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kMostEntries = std::size_t{1} << 18;  // 6 MB
constexpr std::size_t kMostPlanes = std::size_t{1} << 14;   // some 5 MB

}  // namespace

void PairMemory::take(std::size_t pair, std::size_t line_count, std::size_t point_count) {
  pair_ = pair;
  point_count_ = point_count;
  const std::size_t wanted = std::min(std::bit_ceil(line_count * point_count), kMostEntries);
  if (wanted > entries_.size()) entries_.assign(wanted, {});
}

void PairMemory::start(std::size_t pair, std::size_t line_count, std::size_t point_count) {
  take(pair, line_count, point_count);
  enter(0);
}

// Cells have numbers of their own, so what other pairs have left behind is about none on the way.
void PairMemory::resume(std::size_t pair, std::size_t line_count, std::size_t point_count, Way way) {
  EXACTFF_EXPECT(!way.empty());
  take(pair, line_count, point_count);
  depth_ = way.size() - 1;
  way_ = std::move(way);
}

void PairMemory::enter(std::size_t depth) {
  EXACTFF_EXPECT(depth <= way_.size() && depth < std::size_t{1} << kDepthBits);
  depth_ = depth;
  way_.resize(depth);
  way_.push_back(++cells_ << kDepthBits | depth);
}

int PairMemory::sign(LineId line, PointId point) const {
  const Entry& entry = entries_[slot(line, point)];
  if (entry.key != key(line, point)) return kUnasked;
  const std::size_t depth = entry.cell & ((std::size_t{1} << kDepthBits) - 1);
  if (depth > depth_ || way_[depth] != entry.cell) return kUnasked;
  return entry.sign >= kMixed && depth != depth_ ? kUnasked : entry.sign;
}

void PairMemory::keep_sign(LineId line, PointId point, int sign) {
  entries_[slot(line, point)] = {key(line, point), way_.back(), static_cast<std::int8_t>(sign)};
}

const std::shared_ptr<const Plane>& PairMemory::plane(const Points& points, LineId line, PointId point) {
  const std::tuple place(pair_, line, point);
  if (const auto known = planes_.find(place); known != planes_.end()) return known->second;
  if (planes_.size() >= kMostPlanes) planes_.clear();
  const Line& ends = points.line(line);
  Plane made = make_plane(join(points[ends.a], points[ends.b], points[point]), points.units());
  return planes_.emplace(place, std::make_shared<const Plane>(std::move(made))).first->second;
}

}  // namespace exactff::view_factors
