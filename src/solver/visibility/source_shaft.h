// The shaft of the edge engine: the pyramid from x to one outline of the source, for step 4 of the exact method. The
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

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/shaft_tree.h"
#include "visibility/outlines.h"
#include "visibility/plane_visibility.h"

namespace exactff::visibility {

// --- Run marks ---

// Marks on items, all of which are forgotten at once.

class RunMarks {
 public:
  // Forgets all marks, in the existing memory. From now on, item i is below `count`.
  void clear(std::size_t count) {
    marked_in_.resize(count, 0);
    if (++run_ != 0) return;
    std::fill(marked_in_.begin(), marked_in_.end(), 0U);
    run_ = 1;
  }
  void set(std::uint32_t i) { marked_in_[i] = run_; }
  [[nodiscard]] bool is_set(std::uint32_t i) const { return marked_in_[i] == run_; }

 private:
  std::uint32_t run_ = 0;
  std::vector<std::uint32_t> marked_in_;  // by item: the last run that marked it
};

// --- Side planes ---

// Decides on which sides of a few planes a piece of up to four corners lies, by the filter alone and for all corners at
// once.

// A corner t, a direction from x, lies above the plane if normal . t > offset. This is certain if the two sides differ
// by more than error_per_size |t| + error, where |t| is the largest component.
struct SidePlane {
  Vec3 normal;
  double offset = 0.0;
  double error_per_size = 0.0;
  double error = 0.0;
};

using FourCorners = std::array<const Outlines::Corner*, 4>;  // a triangle's last corner repeated

struct Sides {
  bool certain = false;                 // if false, the other members mean nothing
  bool some_above_each = false;         // every plane has a corner above it
  bool all_above_each = false;          // every corner lies above every plane
  bool some_below_first = false;        // a corner lies below the first plane
  Outlines::LineBits wholly_above = 0;  // a bit for each of the first planes: all corners lie above it
  bool beside = false;                  // every corner lies below one plane; false if that took no filter
};

inline constexpr Sides kInsideShaft{.certain = true, .some_above_each = true, .all_above_each = true};

Sides sides_of(std::span<const SidePlane> planes, const FourCorners& corners);

// --- Search memory ---

// Memory of the parts of a search, reused from one plane to the next.

struct ClipMemory {
  std::vector<CornerId> corners, ring;
  std::vector<int> depths;  // of the corners: on which side of the plane that may cut them
};

struct ShaftMemory {
  std::vector<HalfSpace> half_spaces;
  HalfSpaceGroups groups;  // the same
  std::vector<SidePlane> side_planes;
};

// By closed surface.
struct BacksMemory {
  RunMarks has_own_piece;  // by surface, as `decided`
  RunMarks decided;
  std::vector<std::uint8_t> left_out;  // where it is decided
};

// --- Piece clip ---

// Steps 2 and 4 of the exact method for one piece of the scene: its part above the receiver's horizon, or its part on
// x's side of the source's plane. Becomes an outline of the edge engine.

// The part of the source above the horizon: the first outlines.
struct ClippedSource {
  std::size_t count = 0;  // outlines, each of one panel
  bool is_cut = false;    // by the horizon
};

class PieceClip {
 public:
  PieceClip(const PlaneQuery& query, Outlines& outlines, ClipMemory& memory)
      : view_(query.view),
        plane_(query.plane),
        by_pieces_(query.request.by_pieces),
        outlines_(outlines),
        memory_(memory) {}

  // Discards all outlines and starts with those of the source.
  [[nodiscard]] ClippedSource add_source();

  // The following functions refer to the piece with these vertices.
  void take(std::span<const std::uint32_t> vertices) {
    vertices_ = vertices;
    outlines_.corners_of(vertices, memory_.corners);
  }
  [[nodiscard]] std::span<const CornerId> corners() const { return memory_.corners; }
  // For every corner +1: on x's side of the source's plane.
  std::span<const int> find_depths();
  // +1: ahead of the plane through x that is parallel to the source's.
  [[nodiscard]] int toward_sign(CornerId corner) const;
  // Adds the part on x's side of the source's plane. `is_cut`: that is not all of it. `facing`: see below.
  OutlineId add_occluder(bool is_cut, int facing);
  // For every vertex: the sign of its height above the source's plane.
  [[nodiscard]] int depth_sign(std::uint32_t vertex) const;

 private:
  bool add_above_horizon(std::span<const std::uint32_t> corners, ClippedSource& source);
  [[nodiscard]] int horizon_side(CornerId corner) const;
  OutlineId add_part_above(Outlines::Plane plane, bool mirrored);

  const View& view_;
  const SourcePlane& plane_;
  bool by_pieces_;
  Outlines& outlines_;
  ClipMemory& memory_;
  std::span<const std::uint32_t> vertices_;
};

// --- Source shaft ---

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
