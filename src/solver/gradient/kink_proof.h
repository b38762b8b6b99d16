// Proves that F has no kink around one plane of the source from the silhouettes of meshes, which are few, instead of
// from everything that touches the shaft.
//
// A kink needs (kinks.h) a piece that x sees edge-on or, in a plane through x, two lines at different depths, each an
// edge of the source or an edge with pieces on one side alone, all of it in the closed shaft, and not on the horizon.
// The jump of an edge with pieces on one side is not 0, so it is a silhouette (visibility/silhouettes.h). And the
// search for silhouettes looks at all edges of a piece seen edge-on, since no bound of normals leaves them out. So
// there is no kink if no piece is seen edge-on, and if silhouettes and edges of the source that lie in one plane
// through x always lie on one line in space, or on the horizon.
#pragma once

#include "gradient/sight_groups.h"
#include "visibility/silhouettes.h"

namespace exactff::gradient {

// A workspace.
class KinkProof {
 public:
  // False: not proved, or not tried, since another way is shorter or shall share nothing with this one (the Booleans').
  // Requires that x lies in front of the source's plane.
  [[nodiscard]] bool excludes_kinks(const visibility::PlaneQuery& query);

 private:
  visibility::Outlines outlines_;
  visibility::SilhouetteMemory memory_;
  SightGroups groups_;
};

}  // namespace exactff::gradient
