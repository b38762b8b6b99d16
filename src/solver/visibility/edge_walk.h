// The visible boundary by the edge engine, by predicates alone. A corner is constructed only where an edge crosses the
// horizon or the source's plane (plane_crossings.h).
//
// Steps, stopping as soon as nothing is left:
//   1. cull: x behind or in the plane, or nothing above the horizon;
//   2. clip the pieces that the receiver's horizon cuts;
//   3. shaft: candidates from the bounding-volume tree; then signs of their corners' heights above the source's edges;
//      a face that the source's plane cuts is clipped, no face is clipped to the shaft, and pieces of closed surfaces
//      that face away from x are left out (see below);
//   4. and 5. no candidates, or one that hides all;
//   6. and 7. a few that hide all together, or the visible parts of every edge (visible_edges.h).
// If the caller allows it, step 3 begins with the pieces that hid the plane from the receiver before. If these hide it
// again, a narrow query of the tree decides whether a single piece hides all, and no candidates are gathered.
//
// Which pieces may hide all alone: let one do so, and let a be the start of an edge of the source. The piece covers a:
// its directions from x, as non-negative multiples, add up to a. The plane through x and the edge holds a, so not all
// corners of the piece lie strictly on one side of it. Its box, therefore, meets both closed half-spaces of each such
// plane.
//
// Backs of closed surfaces. Let x lie outside the box of a closed surface (closed_surfaces.h) all of whose pieces may
// occlude, and let the box lie on x's side of the source's plane, off it. Along almost every segment from x to a point
// y of that plane the winding number goes up by one at each piece that is crossed from the front, down by one at each
// that is crossed from the back, and is 0 at both ends, which lie outside the box. So as many pieces are crossed from
// the front as from the back. The pieces that show x their backs cover the same region as the pieces that show x their
// fronts, up to a set of area zero, and either set may be left out. All pieces remain candidates, and each may still
// hide all.
#pragma once

#include "visibility/cover_memory.h"
#include "visibility/plane_visibility.h"
#include "visibility/side_planes.h"

namespace exactff::visibility {

// What the engine found last, and memory that it reuses from one plane to the next. The memory has no effect on any
// result.
struct EdgeWorkspace {
  VisibleEdges edges;
  std::vector<HalfSpace> half_spaces;
  HalfSpaceGroups shaft;  // the same
  std::vector<SidePlane> side_planes;
  std::vector<CornerId> corners, ring;
  std::vector<int> depths;             // of the current corners: on which side of the plane that may cut them
  std::vector<std::uint32_t> seen_in;  // by piece: the last run that looked at it
  // By closed surface: the last run that looked at it, and whether its pieces that face away from x were left out.
  struct Surface {
    std::uint32_t run = 0;
    bool backs_left_out = false;
  };
  std::vector<Surface> surfaces;
  std::vector<std::uint32_t> outline_pieces;  // of the occluders' outlines
  CoverMemory covers;
  std::uint32_t run = 0;
};

// Lists a cutter only where one occluder hides all.
// Returns nullopt where the Booleans are the better method (visible_edges.h).
std::optional<PlaneVisibility> find_by_edges(const View& view, const SourcePlane& plane, const Request& request,
                                             EdgeWorkspace& workspace);

}  // namespace exactff::visibility
