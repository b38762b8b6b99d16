// The lines that a movement of x may bring into or out of sight: what may bound the view, and which of its edges lie in
// one plane through x.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kernel/poll.h"
#include "visibility/outlines.h"
#include "visibility/source_shaft.h"

namespace exactff::gradient {

// --- Profile ---

// What may bound the view of one plane of the source, now or after a small movement of x: the source, and every piece
// that touches the closed shaft, as outlines, and the pieces that x sees edge-on. The search of the edge engine is not
// enough here, since it leaves out pieces that hide nothing now. A workspace.
class Profile {
 public:
  enum class Extent {
    kBefore,   // of the source's plane
    kMeeting,  // also pieces in or behind it that have two corners in it
  };
  // Finds everything below. Keeps references to what the query refers to.
  void gather(const visibility::PlaneQuery& query, Extent extent = Extent::kBefore);
  // For a plane that holds x: the pieces that meet the plane, whole, as outlines. No source.
  void gather_around_plane(const visibility::PlaneQuery& query);

  [[nodiscard]] visibility::Outlines& outlines() { return outlines_; }
  [[nodiscard]] const visibility::Outlines& outlines() const { return outlines_; }
  // Outlines: first those of the source above the horizon, then those of the occluders before the source's plane.
  [[nodiscard]] std::size_t source_count() const { return source_count_; }
  // A piece of the scene for each outline.
  [[nodiscard]] std::span<const std::uint32_t> pieces() const { return pieces_; }
  // Pieces that x sees edge-on, with a part before the source's plane.
  [[nodiscard]] std::span<const std::uint32_t> sheets() const { return sheets_; }
  // Pieces in the source's plane or behind it, with at least two corners in it.
  [[nodiscard]] std::span<const std::uint32_t> meeting() const { return meeting_; }
  // One of the sheets that holds x.
  [[nodiscard]] const std::optional<std::uint32_t>& touching() const { return touching_; }
  // An edge in the plane through x with this normal. Requires that there is one.
  [[nodiscard]] visibility::Outlines::Edge edge_in_plane(const kernel::ExactVec3& normal);
  // One piece hides all of the source and more: the view does not change when x moves.
  [[nodiscard]] bool stays_hidden() const { return stays_hidden_; }

 private:
  void start();
  struct Shaft;
  void visit(Shaft& shaft, std::uint32_t index, bool inside);
  [[nodiscard]] bool is_beside(visibility::OutlineId source, std::span<const visibility::CornerId> corners) const;
  [[nodiscard]] bool hides_more(visibility::OutlineId occluder);

  visibility::Outlines outlines_;
  visibility::ClipMemory clip_;
  visibility::ShaftMemory shaft_;
  visibility::RunMarks seen_;
  std::vector<std::uint32_t> pieces_, sheets_, meeting_;
  std::optional<std::uint32_t> touching_;
  std::size_t source_count_ = 0;
  bool with_meeting_ = false;
  bool stays_hidden_ = false;
};

// Whether the piece, in whose plane x lies, holds x.
[[nodiscard]] bool holds_x(const visibility::View& view, const Piece& piece);

// --- Sight directions ---

// A plane through x, and the directions in it.

class SightDirections {
 public:
  [[nodiscard]] const kernel::ExactVec3& normal() const { return normal_; }

 protected:
  // The plane through x and the edge; N is its inward normal.
  SightDirections(visibility::Outlines& outlines, const visibility::Outlines::Edge& edge);

  // The sign of N . (p x q).
  [[nodiscard]] int turn(const kernel::ExactVec3& p, const kernel::ExactVec3& q) const;
  // Requires that `from` and `to` are less than a half turn apart.
  [[nodiscard]] bool is_between(const kernel::ExactVec3& from, const kernel::ExactVec3& to,
                                const kernel::ExactVec3& t) const;

  // On which side of the plane each corner of the outline lies, edge by edge.
  [[nodiscard]] std::vector<int> sides_of(visibility::Outlines& outlines, visibility::OutlineId id) const;
  // On which side the outline with these corners lies; 0: on both.
  [[nodiscard]] static int side_of(std::span<const int> sides);
  // The arc along which the outline with these corners meets the plane, from its end of the smallest angle on.
  [[nodiscard]] std::optional<std::pair<kernel::ExactVec3, kernel::ExactVec3>> arc_of(visibility::Outlines& outlines,
                                                                                      visibility::OutlineId id,
                                                                                      std::span<const int> sides) const;

  visibility::Outlines::Edge edge_;
  kernel::ExactVec3 normal_;
};

// --- Sight groups ---

// Edges grouped by the planes through x in which they lie. Planes are compared by a number that depends on the plane
// alone, with its error bound, and then by exact signs.

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
