// Proves that F has no kink around one plane of the source, without gathering everything that touches the shaft.
//
// A kink needs (kinks.h) a piece that x sees edge-on or, in a plane through x, two lines at different depths, each an
// edge of the source or an edge with pieces on one side alone, all of it in the closed shaft, and not on the horizon.
// So there is none if no such piece is seen edge-on, and if such edges that lie in one plane through x always lie on
// one line in space, or on the horizon. That is checked
//   - for the silhouettes of meshes. The jump of an edge with pieces on one side is not 0, so it is one
//     (visibility/silhouettes.h). And the search looks at all edges of a piece seen edge-on, since no bound of normals
//     leaves them out.
#pragma once

#include "gradient/sight_groups.h"
#include "visibility/silhouettes.h"

namespace exactff::gradient {

// A workspace.
class KinkProof {
 public:
  // False: not proved, or not tried, since what is known is not enough or shall not be shared (by the Booleans).
  // Requires that x lies in front of the source's plane.
  [[nodiscard]] bool excludes_kinks(const visibility::PlaneQuery& query);

 private:
  [[nodiscard]] bool by_silhouettes(const visibility::PlaneQuery& query);
  [[nodiscard]] bool lie_apart_or_on_one_line(const visibility::View& view, visibility::Outlines& outlines);

  visibility::Outlines outlines_;
  visibility::SilhouetteMemory memory_;
  SightGroups groups_;
};

}  // namespace exactff::gradient
