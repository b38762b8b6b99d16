// Edges grouped by the planes through x in which they lie. Planes are compared by a number that depends on the plane
// alone, with its error bound, and then by exact signs.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "kernel/poll.h"
#include "visibility/outlines.h"

namespace exactff::gradient {

// Whether all edges, which lie in one plane through x, lie on one line in space. Those of pieces cut by the source's
// plane are not compared.
[[nodiscard]] bool are_on_one_line(const visibility::Outlines& outlines, std::span<const visibility::EdgeId> group);

// A workspace.
class SightGroups {
 public:
  void clear() { entries_.clear(); }
  void add(const visibility::Outlines& outlines, visibility::EdgeId id);
  // Calls visit(group) for every plane with at least `least` edges, until one call returns false, which is returned.
  template <class Visit>
  bool for_each(visibility::Outlines& outlines, const Visit& visit, std::size_t least = 2);

 private:
  struct Entry {
    double low = 0.0, high = 0.0;  // bounds of the number of the edge's plane
    visibility::EdgeId edge = 0;
    bool done = false;
  };
  std::vector<Entry> entries_;
  std::vector<visibility::EdgeId> group_;
};

template <class Visit>
bool SightGroups::for_each(visibility::Outlines& outlines, const Visit& visit, std::size_t least) {
  std::ranges::sort(entries_,
                    [](const Entry& p, const Entry& q) { return p.low != q.low ? p.low < q.low : p.edge < q.edge; });
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const bool is_alone = i + 1 == entries_.size() || entries_[i + 1].low > entries_[i].high;
    if (entries_[i].done || (is_alone && least > 1)) continue;
    const visibility::Outlines::Edge edge = outlines.edge(entries_[i].edge);
    group_.assign(1, entries_[i].edge);
    for (std::size_t j = i + 1; j < entries_.size() && entries_[j].low <= entries_[i].high; ++j) {
      Entry& other = entries_[j];
      if (other.done) continue;
      const visibility::Outlines::Edge& line = outlines.edge(other.edge);
      if (outlines.side(edge, line.a) != 0 || outlines.side(edge, line.b) != 0) continue;
      other.done = true;
      group_.push_back(other.edge);
    }
    if (group_.size() < least) continue;
    kernel::poll();
    if (!visit(std::span<const visibility::EdgeId>(group_))) return false;
  }
  return true;
}

}  // namespace exactff::gradient
