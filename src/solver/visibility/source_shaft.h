// The shaft of the edge engine: the pyramid from x to one outline of the source, for step 3 of the exact method. The
// tree gets it as half-spaces. Then signs of the heights of a piece's corners above a few planes decide whether the
// piece enters it.
//
// An occluder must have some part above each of these planes: the source's plane (above is its front), the parallel
// plane through x (above is towards the source), and the planes through x and the edges of the outline. Without
// culling, only the first two are used, because outlines rely on them; pieces outside the shaft are then found edge by
// edge.
//
// Which pieces may hide the outline alone: let one do so, and let a be the start of an edge of the outline. The piece
// covers a: its directions from x, as non-negative multiples, add up to a. The plane through x and the edge holds a, so
// not all corners of the piece lie strictly on one side of it. Its box, therefore, meets both closed half-spaces of
// each such plane.
#pragma once

#include "visibility/piece_clip.h"

namespace exactff::visibility {

class SourceShaft {
 public:
  static constexpr unsigned kSidePlanesBeforeEdges = 2;

  SourceShaft(const PlaneQuery& query, PieceClip& clip, Outlines& outlines, ShaftMemory& memory)
      : query_(query), clip_(clip), outlines_(outlines), memory_(memory) {}

  // Selects an outline of the source.
  void set(OutlineId source);
  // From now on, the half-spaces rule out pieces that cannot hide the outline alone. Requires culling.
  void narrow();

  [[nodiscard]] const HalfSpaceGroups& half_spaces() const { return memory_.groups; }
  // The same as a list: those of the edges, then two for the sides of the source's plane.
  [[nodiscard]] std::span<const HalfSpace> half_space_list() const { return memory_.half_spaces; }
  // x's side of the source's plane. Requires culling.
  [[nodiscard]] const HalfSpace& front() const { return memory_.half_spaces.back(); }
  // Of the piece that the clip has taken.
  [[nodiscard]] Sides sides() {
    const Sides sides = sides_by_filter();
    return sides.certain ? sides : sides_exactly();
  }
  // The same if doubles tell, and if it has at most four corners.
  [[nodiscard]] Sides sides_by_filter() const;

 private:
  void make_half_spaces();
  void make_side_planes();
  [[nodiscard]] std::span<const Outlines::Edge> edges() const;
  [[nodiscard]] Sides sides_exactly();

  const PlaneQuery& query_;
  PieceClip& clip_;
  Outlines& outlines_;
  ShaftMemory& memory_;
  OutlineId source_ = 0;
};

}  // namespace exactff::visibility
