// Where F has no derivative by the receiver's point, by exact signs.
//
// A kink needs an arc of positive length, above the horizon and on the source, along which nothing covers both sides,
// and on which x sees a face edge-on or lines at different depths as one. So for one plane of the
// source:
//   0. of a mesh, try to prove from its silhouettes that there is none;
//   1. gather what touches the closed shaft (sight_lines.h); stop if one piece hides more than the source;
//   2. drop edges with a piece on both sides: they are covered;
//   3. group the edges that are left by the planes through x in which they lie. Planes are compared by a number that
//      depends on the plane alone, with its error bound, and then by exact signs;
//   4. judge the plane of each group with lines at different depths, and the plane of each piece seen edge-on.
// Along the horizon w . n = 0: nothing there counts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gradient/sight_lines.h"
#include "gradient/sight_plane.h"
#include "kernel/numbers.h"
#include "visibility/silhouettes.h"
#include "visibility/visible_edges.h"

namespace exactff::gradient {

// --- Kink proof ---

// Proves that F has no kink around one plane of the source from the silhouettes of meshes, which are few, instead of
// from everything that touches the shaft.
//
// A kink needs a piece that x sees edge-on or, in a plane through x, two lines at different depths, each an
// edge of the source or an edge with pieces on one side alone, all of it in the closed shaft, and not on the horizon.
// The jump of an edge with pieces on one side is not 0, so it is a silhouette (visibility/silhouettes.h). And the
// search for silhouettes looks at all edges of a piece seen edge-on, since no bound of normals leaves them out. So
// there is no kink if no piece is seen edge-on, and if silhouettes and edges of the source that lie in one plane
// through x always lie on one line in space, or on the horizon.

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

// --- Kinks ---

// What is found in one plane through x.
struct SightResult {
  kernel::ExactVec3 normal;
  std::vector<SightArc> arcs;
};

// A workspace.
class KinkSearch {
 public:
  enum class Extent { kFirst, kAll };
  // Looks for kinks of one plane of the source; kFirst: stops at the first one. `is_visible`: something of the plane
  // is.
  void find(const visibility::PlaneQuery& query, bool is_visible, Extent extent);

  [[nodiscard]] const std::optional<Kink>& kink() const { return kink_; }
  // The planes through x with kinks; all their arcs.
  [[nodiscard]] const std::vector<SightResult>& planes() const { return planes_; }

 private:
  void find_around_source(const visibility::PlaneQuery& query, bool is_visible, Extent extent);
  void find_edge_on(const visibility::PlaneQuery& query);
  void find_open_edges();
  [[nodiscard]] bool judge_groups(const visibility::PlaneQuery& query, Extent extent);
  [[nodiscard]] bool judge_sheets(const visibility::PlaneQuery& query, Extent extent);
  void judge(const visibility::PlaneQuery& query, const visibility::Outlines::Edge& edge, Extent extent);
  [[nodiscard]] bool is_judged(const kernel::ExactVec3& normal) const;
  void note(KinkReason reason, const Scene& scene, std::span<const std::uint32_t> pieces);

  KinkProof proof_;
  Profile profile_;
  visibility::EdgeTable table_;
  std::vector<std::uint8_t> sides_;  // by edge: 1 if a piece lies on its left, 2 if on its right
  SightGroups groups_;
  std::vector<kernel::ExactVec3> judged_;  // normals
  std::optional<Kink> kink_;
  std::vector<SightResult> planes_;
};

}  // namespace exactff::gradient
