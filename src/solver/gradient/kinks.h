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

// --- Sight plane ---

// What changes in one plane through x when x moves a little, by exact arithmetic.
//
// Let N be the plane's normal, m = N / |N|, and let w be a direction in the plane. Beside w, directions are given by
// the coordinate s along m. If x moves by d, a point at the distance r in direction w moves to
//   s = -(d . m) / r = -(d . m) u,   u = 1 / r.
// To first order, near w,
//   - a face with an edge in the plane, on the side of N, covers all s above the u of the edge, times -(d . m);
//     a face on the other side covers all s below it;
//   - a face that x sees edge-on covers what is between the u of its near and its far side;
//   - a face that the plane cuts covers all s;
//   - where the source lies on one side of the plane alone, its edge ends the view as a face on the other side would.
// What is visible is what nothing covers. Its change is |d . m| M, where M depends on the side to which x moves alone,
// and is a sum of some u, each with a sign. F then changes by 1/pi times the integral of |d . m| M (w . n) along w.
//
// Only if M has opposite values for the two sides everywhere, F is differentiable: this is a *kink* otherwise. Let L
// and R be the faces on the side of N and on the other. Without L and R, a face seen edge-on is a kink; with L alone,
// so is another depth, or a face seen edge-on; with both, so is a gap between the two on one side.
//
// u is linear in w: u = g . w with the nearness g of the line or, for a line in a plane that does not hold x, of that
// plane. Arcs along which the order of all u is the same, and all faces are present or not, are judged at one direction
// inside of them.

// An arc along which something changes.
struct SightArc {
  kernel::ExactVec3 begin, end;  // N . (begin x end) > 0
  // M, as a nearness: if x moves towards N, and away from it.
  kernel::RationalVec3 gain_ahead, gain_back;
  bool is_kink = false;
  bool edge_on = false;               // of a kink: a face that x sees edge-on is part of it
  std::vector<std::uint32_t> pieces;  // of a kink: what meets there, without the source
};

class SightPlane : public SightDirections {
 public:
  // The plane through x and the edge. The profile is that of the query.
  SightPlane(const visibility::PlaneQuery& query, Profile& profile, const visibility::Outlines::Edge& edge);

  enum class Extent { kAll, kUpToKink };
  // All arcs in order, or those up to the first kink.
  [[nodiscard]] std::vector<SightArc> arcs(Extent extent = Extent::kAll);
  // The same if the plane is that of the source, and N its front.
  [[nodiscard]] std::vector<SightArc> arcs_of_source_edge_on();

 private:
  // Where a piece meets the plane.
  struct Stripe {
    kernel::ExactVec3 from, to;  // N . (from x to) > 0
    int side = 0;                // on which the piece lies; 0: on both
    bool is_source = false;
    kernel::RationalVec3 nearness;  // set where it counts
    std::uint32_t piece = 0;
  };
  // A piece that lies in the plane.
  struct Sheet {
    struct Side {
      kernel::ExactVec3 from, to;
      kernel::RationalVec3 nearness;
    };
    std::uint32_t piece = 0;
    std::vector<Side> sides;
    std::vector<kernel::ExactVec3> corners;
  };
  struct Chord {
    const kernel::RationalVec3* near = nullptr;
    const kernel::RationalVec3* far = nullptr;
    std::uint32_t piece = 0;
  };

  [[nodiscard]] std::optional<Stripe> stripe_of(visibility::OutlineId outline);
  void find_nearness(Stripe& stripe) const;
  [[nodiscard]] Sheet sheet_of(std::uint32_t piece) const;
  [[nodiscard]] bool lies_in_plane(std::uint32_t piece);
  [[nodiscard]] kernel::RationalVec3 nearness_of(const Vec3& a, const Vec3& b, const Vec3& c) const;
  [[nodiscard]] bool find_range();
  [[nodiscard]] bool clamp(kernel::ExactVec3& from, kernel::ExactVec3& to) const;
  void add_meetings(std::vector<const kernel::RationalVec3*> lines, std::vector<kernel::ExactVec3>& breaks) const;
  [[nodiscard]] std::optional<Chord> chord_of(const Sheet& sheet, const kernel::ExactVec3& t) const;
  [[nodiscard]] std::optional<SightArc> judge(const kernel::ExactVec3& t) const;
  [[nodiscard]] std::optional<SightArc> judge_source(const kernel::ExactVec3& t) const;
  template <class Judge>
  [[nodiscard]] std::vector<SightArc> judge_all(std::vector<kernel::ExactVec3> breaks, const Judge& judge,
                                                Extent extent = Extent::kAll) const;

  const visibility::PlaneQuery& query_;
  Profile& profile_;
  std::vector<Stripe> stripes_;
  std::vector<Sheet> sheets_, source_sheets_;
  kernel::RationalVec3 source_nearness_;
  kernel::ExactVec3 first_, last_;  // the directions that matter
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
