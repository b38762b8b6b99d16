// Where F has no derivative by the receiver's point, by exact signs.
//
// A kink needs an arc of positive length, above the horizon and on the source, along which nothing covers both sides,
// and on which x sees a face edge-on or lines at different depths as one (sight_plane.h). So for one plane of the
// source:
//   0. of a mesh, try to prove from its silhouettes that there is none (kink_proof.h);
//   1. gather what touches the closed shaft (profile.h); stop if one piece hides more than the source;
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

#include "gradient/kink_proof.h"
#include "gradient/profile.h"
#include "gradient/sight_groups.h"
#include "gradient/sight_plane.h"
#include "visibility/visible_edges.h"

namespace exactff::gradient {

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
