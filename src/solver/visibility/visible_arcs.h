// What is seen, as a value: the exact arcs of a visible boundary, and of each the line in space on which it lies. It
// does not depend on the memory of the search that found it, so whatever is computed from it may read it again.
//
// A line runs through two corners: vertices of the scene, or points where a plane crosses the segment between two
// vertices. An arc is the part of a line between two points: its corners, or where the plane through x and another
// line crosses it. Seen from x, what is visible is on its left.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/plane_visibility.h"

namespace exactff::visibility {

// --- Dense index ---

// Numbers items from 0 in the order in which they are first requested.

class DenseIndex {
 public:
  // Forgets all items. From now on, item i is below `count`.
  void clear(std::size_t count) {
    first_ = next_ = 0;
    number_.assign(count, kNone);
  }
  // The number of item i, and whether it is new.
  struct Found {
    std::uint32_t number;
    bool is_new;
  };
  Found find(std::uint32_t i) {
    const bool is_new = number_[i] == kNone || number_[i] < first_;
    if (is_new) number_[i] = next_++;
    return {number_[i] - first_, is_new};
  }
  // Starts again from 0, without clearing the table.
  void restart() { first_ = next_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::uint32_t first_ = 0, next_ = 0;
  std::vector<std::uint32_t> number_;
};

// --- Visible arcs ---

struct Arc {
  static constexpr std::uint32_t kAtA = Parameter::kAtBegin, kAtB = Parameter::kAtEnd;
  std::uint32_t line = 0;
  std::uint32_t begin = kAtA, end = kAtB;  // or the line that crosses
};
struct ArcLine {
  std::uint32_t a = 0, b = 0;  // corners
  OutlineId outline = 0;       // of the search: those of the source come first
  bool whole = false;          // the outline is a piece that is not clipped, or there is none
};
struct ArcCorner {
  std::uint32_t p = 0, q = 0;  // the vertices between which a plane crosses a segment; the same one twice: that vertex
  bool is_fine = false;
  std::uint32_t constructed = 0;  // if it is no vertex: into ArcSection::fine, or else into ArcSection::exactly
  std::uint32_t plane = 0;        // Outlines::Plane
  std::uint32_t id = 0;           // in the search
  [[nodiscard]] bool is_vertex() const { return p == q; }
};

// The arcs of one plane of the source, or of a whole view. Lines and corners are numbered in the order in which the
// arcs first refer to them. Refers to VisibleArcs, and is valid until something is added there.
struct ArcSection {
  std::span<const Vec3> vertices;      // of the scene
  Vec3 x, n;                           // of the receiver
  const SourcePlane* plane = nullptr;  // null: of a whole view
  Outlines* outlines = nullptr;        // of a whole view, for the corners in further planes
  int scale_exponent = 0;              // as Outlines::scale_exponent
  std::span<const Arc> arcs;
  std::span<const ArcLine> lines;
  std::span<const ArcCorner> corners;
  std::span<const FineDirection> fine;
  std::span<const ExactVec3> exactly;
  std::span<const BoundaryPiece> pieces;  // instead of all these, if the Booleans found it

  [[nodiscard]] bool empty() const { return arcs.empty() && pieces.empty(); }
  // By the edge engine, so that there is a form for arithmetic in doubles.
  [[nodiscard]] bool is_by_edges() const { return pieces.empty(); }
  // A direction from x.
  [[nodiscard]] ExactVec3 exact(const ArcCorner& corner) const;
  // Calls visit(piece) for every piece of the boundary.
  template <class Visit>
  void for_each_piece(const Visit& visit) const;
};

// The arcs of a section in exact numbers.
class ExactArcs {
 public:
  explicit ExactArcs(const ArcSection& seen);
  [[nodiscard]] BoundaryPiece operator()(const Arc& arc) const;
  // The nearness g of the arc's line: g . y = 1 for its points y, relative to x. Requires a plane of the source.
  [[nodiscard]] kernel::RationalVec3 nearness(const Arc& arc) const;

 private:
  [[nodiscard]] kernel::RationalVec3 point_at(std::uint32_t corner) const;

  const ArcSection& seen_;
  std::vector<ExactVec3> corners_;
  kernel::RationalVec3 x_;
};

// The point of the line with this nearness in direction t from x, rounded once.
[[nodiscard]] Vec3 point_on_line(const kernel::RationalVec3& x, const ExactVec3& t,
                                 const kernel::RationalVec3& nearness);

template <class Visit>
void ArcSection::for_each_piece(const Visit& visit) const {
  for (const BoundaryPiece& piece : pieces) visit(piece);
  if (arcs.empty()) return;
  const ExactArcs exact(*this);
  for (const Arc& arc : arcs) visit(exact(arc));
}

class VisibleArcs {
 public:
  // Forgets everything, in the existing memory.
  void clear();
  // Adds what is seen of a plane of the source, perhaps nothing.
  void add(const View& view, const SourcePlane& plane, VisibleBoundary&& boundary);
  // Adds a whole view. Keeps a reference to what was found.
  void add(const View& view, EdgeCovers& found);

  [[nodiscard]] std::size_t size() const { return sections_.size(); }
  // One for each call of add(), in that order.
  [[nodiscard]] ArcSection operator[](std::size_t section) const;
  [[nodiscard]] bool empty() const { return arcs_.empty() && pieces_.empty(); }

 private:
  // Where a section begins.
  struct Section {
    std::span<const Vec3> vertices;
    Vec3 x, n;
    const SourcePlane* plane = nullptr;
    Outlines* outlines = nullptr;
    int scale_exponent = 0;
    std::size_t arc = 0, line = 0, corner = 0, fine = 0, exact = 0, piece = 0;
  };
  void start(const View& view, const SourcePlane* plane);
  void take(EdgeCovers& found);
  [[nodiscard]] std::uint32_t number_of_line(Outlines& outlines, EdgeId id);
  [[nodiscard]] std::uint32_t number_of_corner(Outlines& outlines, CornerId id);

  std::vector<Section> sections_;
  std::vector<Arc> arcs_;
  std::vector<ArcLine> lines_;
  std::vector<ArcCorner> corners_;
  std::vector<FineDirection> fine_;
  std::vector<ExactVec3> exact_;  // the first exact_count_; the rest is spare memory
  std::size_t exact_count_ = 0;
  std::vector<BoundaryPiece> pieces_;
  DenseIndex line_index_, corner_index_;  // of the last section
};

}  // namespace exactff::visibility
