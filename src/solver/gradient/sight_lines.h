// The lines that a movement of x, or of a vertex, may bring into or out of sight: what may bound the view, which of its
// edges lie in one plane through x, and how they move.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kernel/numbers.h"
#include "kernel/poll.h"
#include "visibility/outlines.h"
#include "visibility/source_shaft.h"
#include "visibility/visible_edges.h"

namespace exactff::gradient {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::RationalVec3;
using kernel::sign;
using kernel::to_rational;
using visibility::CornerId;
using visibility::EdgeId;
using visibility::OutlineId;
using visibility::Outlines;
using visibility::PieceClip;
using visibility::PlaneQuery;
using visibility::View;

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
  void gather(const PlaneQuery& query, Extent extent = Extent::kBefore);
  // For a plane that holds x: the pieces that meet the plane, whole, as outlines. No source.
  void gather_around_plane(const PlaneQuery& query);

  [[nodiscard]] Outlines& outlines() { return outlines_; }
  [[nodiscard]] const Outlines& outlines() const { return outlines_; }
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
  [[nodiscard]] Outlines::Edge edge_in_plane(const ExactVec3& normal);
  // One piece hides all of the source and more: the view does not change when x moves.
  [[nodiscard]] bool stays_hidden() const { return stays_hidden_; }

 private:
  void start();
  struct Shaft;
  void visit(Shaft& shaft, std::uint32_t index, bool inside);

  Outlines outlines_;
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
[[nodiscard]] bool holds_x(const View& view, const Piece& piece);

// --- Sight directions ---

// A plane through x, and the directions in it.

class SightDirections {
 public:
  [[nodiscard]] const ExactVec3& normal() const { return normal_; }

 protected:
  // The plane through x and the edge; N is its inward normal.
  SightDirections(Outlines& outlines, const Outlines::Edge& edge);

  // The sign of N . (p x q).
  [[nodiscard]] int turn(const ExactVec3& p, const ExactVec3& q) const;
  // Requires that `from` and `to` are less than a half turn apart.
  [[nodiscard]] bool is_between(const ExactVec3& from, const ExactVec3& to, const ExactVec3& t) const;

  // On which side of the plane each corner of the outline lies, edge by edge.
  [[nodiscard]] std::vector<int> sides_of(Outlines& outlines, OutlineId id) const;
  // On which side the outline with these corners lies; 0: on both.
  [[nodiscard]] static int side_of(std::span<const int> sides);
  // The arc along which the outline with these corners meets the plane, from its end of the smallest angle on.
  [[nodiscard]] std::optional<std::pair<ExactVec3, ExactVec3>> arc_of(Outlines& outlines, OutlineId id,
                                                                      std::span<const int> sides) const;

  Outlines::Edge edge_;
  ExactVec3 normal_;
};

// --- Sight groups ---

// Edges grouped by the planes through x in which they lie. Planes are compared by a number that depends on the plane
// alone, with its error bound, and then by exact signs.

// Whether all edges, which lie in one plane through x, lie on one line in space. Those of pieces cut by the source's
// plane are not compared.
[[nodiscard]] bool are_on_one_line(const Outlines& outlines, std::span<const EdgeId> group);

// A workspace.
class SightGroups {
 public:
  void clear() { entries_.clear(); }
  void add(const Outlines& outlines, EdgeId id);
  // Clears the groups; adds the edges of the source and, of all others, those without a piece on both sides. Of those
  // with two, also_counts(edge) adds some.
  template <class Also>
  void add_open(const Outlines& outlines, std::size_t source_count, const Also& also_counts);
  // Calls visit(group) for every plane with at least `least` edges, until one call returns false, which is returned.
  template <class Visit>
  bool for_each(Outlines& outlines, const Visit& visit, std::size_t least = 2);

 private:
  struct Entry {
    double low = 0.0, high = 0.0;  // bounds of the number of the edge's plane
    EdgeId edge = 0;
    bool done = false;
  };
  std::vector<Entry> entries_;
  std::vector<EdgeId> group_;
  visibility::EdgeTable table_;
  std::vector<std::uint8_t> sides_;  // by edge: 1 if a piece lies on its left, 2 if on its right
};

template <class Also>
void SightGroups::add_open(const Outlines& outlines, std::size_t source_count, const Also& also_counts) {
  const auto edges = outlines.edges();
  const auto is_source = [&](EdgeId id) { return edges[id].outline < source_count; };
  sides_.assign(edges.size(), 0);
  table_.clear(std::max<std::size_t>(edges.size(), 1));
  clear();
  for (EdgeId id = 0; id < edges.size(); ++id) {
    if (is_source(id)) continue;
    const EdgeId first = table_.add(id, edges);
    sides_[first] = static_cast<std::uint8_t>(sides_[first] | (edges[first].a == edges[id].a ? 1U : 2U));
  }
  for (EdgeId id = 0; id < edges.size(); ++id) {
    if (is_source(id) || sides_[id] == 1 || (sides_[id] == 3 && also_counts(id))) add(outlines, id);
  }
}

template <class Visit>
bool SightGroups::for_each(Outlines& outlines, const Visit& visit, std::size_t least) {
  std::ranges::sort(entries_,
                    [](const Entry& p, const Entry& q) { return p.low != q.low ? p.low < q.low : p.edge < q.edge; });
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const bool is_alone = i + 1 == entries_.size() || entries_[i + 1].low > entries_[i].high;
    if (entries_[i].done || (is_alone && least > 1)) continue;
    const Outlines::Edge edge = outlines.edge(entries_[i].edge);
    group_.assign(1, entries_[i].edge);
    for (std::size_t j = i + 1; j < entries_.size() && entries_[j].low <= entries_[i].high; ++j) {
      Entry& other = entries_[j];
      if (other.done) continue;
      const Outlines::Edge& line = outlines.edge(other.edge);
      if (outlines.side(edge, line.a) != 0 || outlines.side(edge, line.b) != 0) continue;
      other.done = true;
      group_.push_back(other.edge);
    }
    if (group_.size() < least) continue;
    kernel::poll();
    if (!visit(std::span<const EdgeId>(group_))) return false;
  }
  return true;
}

// --- Vertex motions ---

// How the lines that bound the view move if a vertex of the scene moves, or x.
//
// Notation: as in contour/contour.h; a, b, ... are points relative to x. The plane through x and the line has the
// normal N. Beside a direction w in it, directions are given by the coordinate s along N / |N|. If a vertex moves by d,
// the line moves at w by
//   s = (turn . d) (share . w) / |N|,
// with two vectors that depend on the line and the vertex:
//   - The line is that through the vertices a and b. A point y = r w of it follows a by the share that a has in
//     it: with y = l a + m b, this is l, and l / r is linear in w: share . a = 1, share . b = 0. turn = N. The
//     shares of a and b add up to the nearness of the line, since l + m = 1.
//   - The line is where the plane of a face meets the source's plane. Let h and g be the nearnesses of the planes:
//     h . y = 1 for their points y. They meet where (h - g) . w = 0, so that N = k (h - g). The plane of a face
//     follows three of its vertices. If a, one of them, moves by d, h changes by -(h . d) a*, where a* . a = 1, and
//     a* . b = a* . c = 0 for the others; a* + b* + c* = h. Then w . (h - g) = 0 gives turn = k h, share = a*. For
//     a vertex of the source's frame, turn = -k g, and the share is by that frame.
//   - If x moves, all vertices move the other way. Their shares add up to the nearness u = share . w of the line, and
//     turn = N, also for a line in which two planes meet.

struct Motion {
  static constexpr std::uint32_t kAll = static_cast<std::uint32_t>(-1);
  std::uint32_t place = kAll;  // of the vertex (scene/scene.h), or of all of them
  RationalVec3 share;
  RationalVec3 turn;  // divided by the component of N of largest magnitude; of all, not set
};

// Of all lines of one plane of the source.
class VertexMotions {
 public:
  explicit VertexMotions(const PlaneQuery& query);

  using VertexPair = std::pair<std::uint32_t, std::uint32_t>;  // places, ascending
  [[nodiscard]] VertexPair pair_of(std::uint32_t p, std::uint32_t q) const;
  // The vertices through which the edge of an occluder's outline runs. Nullopt: it is a cut by the source's plane.
  [[nodiscard]] std::optional<VertexPair> line_of_occluder(const Outlines& outlines, const Outlines::Edge& edge) const {
    const bool whole = edge.outline == Outlines::kNone || outlines.outline(edge.outline).whole;
    return line_of_occluder(outlines.segment(edge.a), outlines.segment(edge.b), whole);
  }
  // The same for the source. Nullopt: it lies on the horizon.
  [[nodiscard]] std::optional<VertexPair> line_of_source(const Outlines& outlines, const Outlines::Edge& edge) const {
    return line_of_source(outlines.segment(edge.a), outlines.segment(edge.b));
  }
  // The same between the corners on two segments (Outlines::segment). `whole`: of an outline that is not clipped.
  using Segment = std::pair<std::uint32_t, std::uint32_t>;
  [[nodiscard]] std::optional<VertexPair> line_of_occluder(const Segment& a, const Segment& b, bool whole) const;
  [[nodiscard]] std::optional<VertexPair> line_of_source(const Segment& a, const Segment& b) const;
  [[nodiscard]] bool is_in_source_plane(std::uint32_t vertex) const;

  // N is any normal of the line's plane.
  [[nodiscard]] std::vector<Motion> of_line(const ExactVec3& N, const VertexPair& line) const;
  [[nodiscard]] std::vector<Motion> of_cut(const ExactVec3& N, std::uint32_t piece) const;

  // Places of the vertices that the plane of a piece, and that of the source, follows.
  [[nodiscard]] std::array<std::uint32_t, 3> frame_of_piece(std::uint32_t piece) const;
  [[nodiscard]] const std::array<std::uint32_t, 3>& source_frame() const { return source_.places; }
  // Of those, each one's share in directions w, as in a cut.
  [[nodiscard]] const RationalVec3& source_share(int corner) const { return source_.shares[corner]; }

 private:
  struct Frame {
    std::array<std::uint32_t, 3> places{};
    std::array<RationalVec3, 3> shares;
    RationalVec3 nearness;
  };
  [[nodiscard]] RationalVec3 point(std::uint32_t vertex) const;
  [[nodiscard]] Frame make_frame(const std::array<std::uint32_t, 3>& corners) const;

  const Scene& scene_;
  const visibility::SourcePlane& plane_;
  std::span<const std::uint32_t> places_;
  RationalVec3 x_;
  Frame source_;
};

// The places that a piece's plane follows: the lowest that are not on a line, of the corners of its face if that is
// planar, else of its own.
[[nodiscard]] std::array<std::uint32_t, 3> frame_of(const Scene& scene, std::uint32_t piece);

}  // namespace exactff::gradient
