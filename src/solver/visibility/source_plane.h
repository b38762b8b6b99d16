// The faces of a source that lie in one oriented plane. They are treated together, as their union.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"
#include "kernel/double_double.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"
#include "scene/panels.h"

namespace exactff::visibility {

// --- Plane crossings ---

// The point where the segment between two vertices crosses a plane (the source's plane or the horizon), as a
// direction from x.
//
// With g(y) = N . (y - s), s a point of the plane, N its normal, and g(p), g(q) of different signs, the point lies in
// direction
//   (p - x) |g(q)| + (q - x) |g(p)|.
// It is computed in double-double arithmetic with an error bound first, and exactly where that declines or on request.

using kernel::FineDirection;

// A plane's normal N divided by 2^bit_length(N), so that its largest component is in [1/2, 1).
using FineNormal = std::array<kernel::double_double::Bounded, 3>;
[[nodiscard]] FineNormal fine_normal(const kernel::ExactVec3& normal);
// The same for the integers of exact_vector(normal).
[[nodiscard]] FineNormal fine_normal(const Vec3& normal);

class PlaneCrossings {
 public:
  // Lengths are multiplied by 2^scale_exponent, which should bring them to the order of 1.
  void start(const Vec3& x, const FineNormal& normal, const Vec3& point, int scale_exponent);

  // Times 2^-bit_length(N) 2^exponent, so that the largest component is in [1/2, 1]. Each hi is within relative error
  // 2u, u = 2^-53, of the true component and zero only where that component is zero.
  struct Fine {
    FineDirection direction;
    int exponent = 0;
  };
  [[nodiscard]] std::optional<Fine> fine(const Vec3& p, const Vec3& q) const;

  // The exact crossing. Reuses the memory of `result`. v 2^exponent is the value that a Fine with `fine_exponent`
  // approximates.
  void set_exact(kernel::ScaledVec3& result, const Vec3& p, const Vec3& q, const kernel::ExactVec3& normal,
                 long fine_exponent);

 private:
  Vec3 x_, point_;
  FineNormal normal_{};
  int zero_axis_ = -1;  // along which all crossings are 0; -1: none
  int scale_exponent_ = 0;
  double scale_ = 1.0;
  // Scratch of set_exact.
  kernel::ScaledVec3 t_p_, t_q_, d_p_, d_q_;
  kernel::Integer g_p_, g_q_;
};

// --- Source plane ---

struct SourcePlane {
  const Panels* scene_panels = nullptr;
  std::vector<FaceId> faces;          // ascending
  std::vector<std::uint32_t> pieces;  // their pieces that lie in it, ascending; into Scene::pieces()
  std::vector<PanelId> panels;        // the same region, ascending: sheets of these pieces as they are joined
  // Pieces in the same plane that hide parts of it: those that bury them (scene/contacts.h), and `elsewhere`.
  std::vector<std::uint32_t> covers;
  std::vector<std::uint32_t> elsewhere;  // pieces of the source in another SourcePlane, where what they cover counts
  kernel::Direction normal;              // front, primitive integers
  FineNormal fine_normal;                // the same, for PlaneCrossings
  Vec3 point;                            // a vertex in the plane
  Vec3 second, third;                    // with `point`, three vertices that run counter-clockwise seen from the front
};

// Groups faces by exact equality of their oriented planes, in order of first appearance. Where a piece buries some of a
// plane's pieces and also overlaps others, which it does not bury, each buried piece is by itself, less the others.
std::vector<SourcePlane> group_by_plane(const Scene& scene, const std::vector<FaceId>& faces);

// The plane of each face by itself, with three vertices of that face; the plane as it is if faces overlap in it.
std::vector<SourcePlane> split_by_face(const Scene& scene, const SourcePlane& plane);

// -1, 0, +1: x behind, in, in front of the plane.
int side_of(const SourcePlane& plane, const Vec3& x);

// Area of the union of the faces, projected along the axis of the normal's largest component; exact.
struct ProjectedArea {
  kernel::Rational area;
  int axis = 0;
};
ProjectedArea union_area(const Scene& scene, const SourcePlane& plane);

// Whether the union of other pieces covers all of the piece, exactly. Requires that all lie in one plane; they may face
// either way.
[[nodiscard]] bool is_covered(const Scene& scene, std::uint32_t piece, std::span<const std::uint32_t> by);

}  // namespace exactff::visibility
