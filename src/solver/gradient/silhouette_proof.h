// Proves that F has no kink around one plane of the source from the silhouettes alone, which are few in a mesh, instead
// of from everything in the shaft.
//
// A kink needs (kinks.h) a piece that x sees edge-on or, in a plane through x, two lines at different depths, each an
// edge of the source or an edge with pieces on one side alone. The jump of such an edge is not 0, so it is a silhouette
// (visibility/silhouettes.h). And the search for silhouettes looks at all edges of a piece seen edge-on, since no bound
// of normals leaves them out. So without a piece seen edge-on, and if silhouettes and edges of the source that lie in
// one plane through x always lie on one line in space, there is no kink.
#pragma once

#include "gradient/sight_groups.h"
#include "visibility/silhouettes.h"

namespace exactff::gradient {

// A workspace.
class SilhouetteProof {
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
