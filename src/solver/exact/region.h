// What one receiver sees of one source, found once (steps 1 to 7 of src/README.md) and read as often as needed (step
// 8): the values of all measures, the gradient, and the derivatives by vertices, each from the same arcs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contour/contour.h"
#include "exact/quick_tier.h"
#include "exactff/exact.h"
#include "gradient/gradient.h"
#include "gradient/vertex_gradient.h"
#include "kernel/numbers.h"
#include "visibility/visible_arcs.h"
#include "visibility/visible_boundary.h"

namespace exactff::exact {

// One plane: its area is projected_area * |normal| / |normal[axis]|, irrational in general.
struct PlaneShare {
  kernel::Rational fraction;        // visible over whole, in [0, 1]
  kernel::Rational projected_area;  // > 0
  kernel::ExactVec3 normal;
  int axis = 0;
};

// A workspace: its memory is reused from one receiver to the next. Keeps references to the scene and to the planes.
class Region {
 public:
  // Finds what is seen, with the engine, the occluders and the requests for fractions and cutters of the options. It is
  // that of a sphere if the options' measure is. Sets everything in `result` but the value, which is set to zero.
  void find(const Scene& scene, const Receiver& receiver, std::span<const visibility::SourcePlane> planes,
            const ExactOptions& options, visibility::EdgeWorkspace& edges, FormFactor& result);

  [[nodiscard]] const visibility::VisibleArcs& arcs() const { return arcs_; }
  [[nodiscard]] bool is_sphere() const { return is_sphere_; }

  // Step 8: sets value, bounds, status, enclosure and precision. Requires a measure of a sphere if and only if the
  // region is one.
  void measure(const Measure& measure, int digits, int precision_cap, FormFactor& result);

  // The derivatives of F by the receiver. Requires a region that is not a sphere's.
  void differentiate(const gradient::PointGradient::Request& request, int precision_cap, Gradient& result);
  // Those by the vertices, beside these. Each face of the source moves with its own vertices, and a panel may lack
  // vertices that move it. So where some faces are joined, the boundary of each face is found, from pieces.
  void differentiate_by_vertices(int precision_cap, visibility::EdgeWorkspace& edges, Gradient& result);

 private:
  [[nodiscard]] visibility::PlaneVisibility find(const visibility::View& view, const visibility::SourcePlane& plane,
                                                 visibility::EdgeWorkspace& edges);
  [[nodiscard]] visibility::PlaneVisibility find_around_sphere(const Receiver& receiver,
                                                               const visibility::SourcePlane& plane,
                                                               visibility::EdgeWorkspace& edges);
  void note(const visibility::SourcePlane& plane, visibility::PlaneVisibility&& seen, const ExactOptions& options,
            PlaneRecord& record, FormFactor& result);
  [[nodiscard]] bool sum_is_certain(const Measure& measure, int digits, int precision_cap, FormFactor& result);
  void integrate_in_balls(const Measure& measure, int digits, int precision_cap, FormFactor& result) const;
  void find_by_pieces(const visibility::BoundaryRequest& request, visibility::EdgeWorkspace& edges);

  std::optional<visibility::View> view_;
  std::span<const visibility::SourcePlane> planes_;
  visibility::BoundaryRequest request_;
  visibility::VisibleArcs arcs_;  // a section for each plane; of a sphere two, one for each half of its view
  bool is_sphere_ = false;
  bool has_gradient_ = false;  // of these arcs
  std::vector<PlaneShare> shares_;
  // Sources differ in their number of planes: records that one source does not need are kept for the next one.
  std::vector<PlaneRecord> spare_records_;
  // For sums over the arcs.
  QuickTier quick_;
  gradient::PointGradient gradient_;
  gradient::VertexGradient vertices_;
  // For derivatives by vertices.
  std::vector<visibility::SourcePlane> planes_by_face_;
  visibility::VisibleArcs arcs_by_face_;
};

}  // namespace exactff::exact

namespace exactff {

// The memory behind a Workspace.
struct Workspace::Memory {
  visibility::EdgeWorkspace edges;
  exact::Region region;  // the last one
};

struct WorkspaceInside {
  using Memory = Workspace::Memory;
  [[nodiscard]] static Memory& memory(Workspace& workspace) { return workspace.memory(); }
};

}  // namespace exactff
