// The geometry of the edge engine: convex outlines as x sees them, their edges as planes through x, and the crossings
// of these planes.
//
// Notation: an edge runs from a to b, two directions from x less than a half turn apart, with the inside of its outline
// on its left as x sees it. The plane through x and the edge has the inward normal N = b x a, so that a direction t
// lies inside, on or outside the edge's line as N . t is positive, zero or negative. A point of the edge has the
// parameter (l : m), l, m >= 0, and lies in direction l a + m b. Where the line of another edge f crosses it,
//   l : m = |F . b| : |F . a|,   F the inward normal of f.
//
// Filters. A corner is represented by a triple of doubles, each within relative error 2u, u = 2^-53, and by the largest
// magnitude |t| among them. The components of N then err by less than kCrossError |a||b|, and N . t by less than
// kTripleError |a||b||t| (kernel/filter.h). Corners are scaled so that those of the source are of order 1; a corner
// whose |t| is not moderate, or whose components do not survive the scaling, makes every filter decline, so that
// underflow does not matter.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactff/scene.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"
#include "visibility/source_plane.h"

namespace exactff::visibility {

// --- Boundary piece ---

// The boundary of the visible region, in the form that the contour integral takes.
//
// A piece lies on a supporting edge from a to b (exact directions from x, each known up to its own positive factor);
// the point with the homogeneous parameter (l : m) lies in direction l a + m b. A piece runs from `begin` to `end`. The
// pieces of one plane form closed loops. Seen from x, the visible region is on their left.
// Eq. (4) depends on nothing else, so any method that finds the pieces can supply them.

struct EdgeParameter {
  Integer l;
  Integer m;
};

struct BoundaryPiece {
  ExactVec3 a;
  ExactVec3 b;
  EdgeParameter begin{1, 0};
  EdgeParameter end{0, 1};

  // The directions in which it begins and ends.
  [[nodiscard]] ExactVec3 from() const { return at(begin); }
  [[nodiscard]] ExactVec3 to() const { return at(end); }

  // Of a parameter of the edge.
  [[nodiscard]] ExactVec3 at(const EdgeParameter& t) const {
    if (sign(t.m) == 0 && t.l == 1) return a;
    if (sign(t.l) == 0 && t.m == 1) return b;
    return a * t.l + b * t.m;
  }
};

// --- Outlines ---

using CornerId = std::uint32_t;
using EdgeId = std::uint32_t;
using OutlineId = std::uint32_t;

// The value of N . t with an error bound. The sign is certain where |value| > error, or where both are 0.
struct Height {
  double value = 0.0;
  double error = 0.0;
};

class Outlines {
 public:
  struct Corner {
    Approx3 t;
    double size = 0.0;  // largest magnitude; NaN where filters must decline
  };
  struct Edge {
    CornerId a = 0, b = 0;
    OutlineId outline = 0;
    Vec3 normal;         // N: no component's sign is certain
    double error = 0.0;  // kTripleError |a||b|
  };
  using LineBits = std::uint32_t;  // a bit for each of an outline's first edges
  static constexpr std::size_t kLineBits = 32;
  static constexpr OutlineId kNone = 0xFFFFFFFFU;
  struct Outline {
    EdgeId first = 0;
    std::uint32_t count = 0;
    bool whole = false;          // a piece of the scene, not clipped: its corners are vertices
    bool inside_source = false;  // known to lie inside a piece of the source, off its edges
    LineBits within_lines = 0;   // of the source, if that is one outline: known to have all of this on the inner side
  };

  // Discards all corners, edges and outlines. Directions are relative to x, a point of `scene`'s space. Vertices at one
  // position are one corner. `unit`: a length of the order of the distances that matter.
  void start(const Scene& scene, const Vec3& x, double unit);
  // The planes that add_crossing refers to. The exact normal of the source's plane must outlive their use.
  enum class Plane : std::uint32_t { kSource, kHorizon };
  void set_source_plane(const ExactVec3& normal, const FineNormal& fine_normal, const Vec3& point);
  void set_horizon(const Vec3& normal);
  // A further plane, through a point.
  [[nodiscard]] Plane add_plane(const ExactVec3& normal, const Vec3& point);

  // Replaces the contents of `corners` by the corners at these vertices.
  void corners_of(std::span<const std::uint32_t> vertices, std::vector<CornerId>& corners);
  // Where the segment between two vertices on different sides of the plane crosses it.
  [[nodiscard]] CornerId add_crossing(Plane plane, std::uint32_t p, std::uint32_t q);
  // Counter-clockwise as x sees it. `whole`: all of a piece of the scene.
  OutlineId add(std::span<const CornerId> corners, bool whole);

  // An edge of no outline.
  EdgeId add_edge(CornerId a, CornerId b);
  // The same, but it is not added.
  [[nodiscard]] Edge line_through(CornerId a, CornerId b) const;
  // The corner at a vertex.
  [[nodiscard]] CornerId corner_at(std::uint32_t vertex);

  void remove_last();
  void set_inside_source(OutlineId id) { outlines_[id].inside_source = true; }
  void set_within_lines(OutlineId id, LineBits lines) { outlines_[id].within_lines = lines; }
  // Starts the check for shared corners: outlines of vertices added from now on have no corner in common unless
  // has_shared_corners() is true.
  void watch_for_shared_corners() { shared_corners_ = false; }
  [[nodiscard]] bool has_shared_corners() const { return shared_corners_; }

  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  [[nodiscard]] std::span<const Outline> outlines() const { return outlines_; }
  [[nodiscard]] const Edge& edge(EdgeId id) const { return edges_[id]; }
  [[nodiscard]] std::span<const Edge> edges_of(const Outline& outline) const {
    return edges().subspan(outline.first, outline.count);
  }
  [[nodiscard]] const Outline& outline(OutlineId id) const { return outlines_[id]; }
  [[nodiscard]] const Corner& corner(CornerId id) const { return corners_[id]; }
  [[nodiscard]] std::size_t corner_count() const { return corners_.size(); }
  // The scene's vertex at this corner, if the corner is a vertex. Its doubles are those of its position less x, times
  // 2^scale_exponent.
  [[nodiscard]] std::optional<std::uint32_t> vertex(CornerId id) const {
    return origins_[id].is_vertex() ? std::optional(origins_[id].p) : std::nullopt;
  }
  // The vertices between which a plane crosses a segment at this corner; the same one twice if it is a vertex.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> segment(CornerId id) const {
    const Origin& origin = origins_[id];
    return {origin.p, origin.is_vertex() ? origin.p : origin.q};
  }
  // The plane, if the corner is not a vertex.
  [[nodiscard]] Plane plane(CornerId id) const { return origins_[id].plane; }
  // Not null if the corner was constructed in double-double arithmetic: its doubles are those of `hi`.
  [[nodiscard]] const FineDirection* fine(CornerId id) const {
    return origins_[id].fine == kNone ? nullptr : &fine_[origins_[id].fine];
  }
  [[nodiscard]] const Vec3& position(std::uint32_t vertex) const { return vertices_[vertex]; }
  [[nodiscard]] const Vec3& x() const { return x_; }
  [[nodiscard]] int scale_exponent() const { return scale_exponent_; }

  // N . t, exactly zero where t is an end of the edge.
  [[nodiscard]] Height height(const Edge& edge, CornerId t) const {
    if (t == edge.a || t == edge.b) return {};
    const Corner& c = corners_[t];
    return {edge.normal.x * c.t.x + edge.normal.y * c.t.y + edge.normal.z * c.t.z, edge.error * c.size};
  }
  // Whether all corners are certainly outside one line of the outline.
  [[nodiscard]] bool are_beside(OutlineId id, std::span<const CornerId> corners) const;
  // Whether each corner of the first `count` outlines lies on this side of each line, or further inside.
  [[nodiscard]] bool cover(OutlineId by, std::size_t count, int least_side);
  // -1, 0, +1: outside, on, inside the line of the edge.
  [[nodiscard]] int side(const Edge& edge, CornerId t);
  // Sign of normal . t, or kUncertain.
  [[nodiscard]] int side_by_filter(const Approx3& normal, CornerId t) const;

  [[nodiscard]] const ExactVec3& exact(CornerId id) { return scaled(id).v; }
  // exact(id) * 2^exponent(id) is what the doubles of the corner approximate.
  [[nodiscard]] long exponent(CornerId id) { return scaled(id).exponent; }
  // The exact height of a corner above an edge's line. Reuses the memory of `result`.
  void set_exact_height(Integer& result, const Edge& edge, CornerId t);

 private:
  // Where a corner comes from: the vertex p, or where the segment from p to q crosses a plane.
  struct Origin {
    std::uint32_t p, q = kNone;
    std::uint32_t exact = kNone;  // into exact_
    std::uint32_t fine = kNone;   // into fine_
    Plane plane = Plane::kSource;
    int fine_exponent = 0;
    [[nodiscard]] bool is_vertex() const { return q == kNone; }
  };
  CornerId corner_of_vertex(std::uint32_t any_vertex);
  CornerId add_corner(const Approx3& t, double size, const Origin& origin);
  static constexpr std::size_t kNamedPlanes = 2;
  struct FurtherPlane {
    PlaneCrossings crossings;
    ExactVec3 normal;
  };
  [[nodiscard]] PlaneCrossings& crossings(Plane plane) {
    const auto index = static_cast<std::size_t>(plane);
    return index < kNamedPlanes ? crossings_[index] : further_planes_[index - kNamedPlanes].crossings;
  }
  [[nodiscard]] const ExactVec3& exact_normal(Plane plane) const {
    const auto index = static_cast<std::size_t>(plane);
    return index >= kNamedPlanes     ? further_planes_[index - kNamedPlanes].normal
           : plane == Plane::kSource ? *normal_
                                     : horizon_.v;
  }
  [[nodiscard]] Edge edge_between(CornerId a, CornerId b, OutlineId outline) const;
  [[nodiscard]] bool are_on_axis_line(const Edge& edge, CornerId t) const;
  // Computed at first use and kept in exact_.
  [[nodiscard]] const ScaledVec3& scaled(CornerId id);

  const Scene* scene_ = nullptr;
  std::span<const Vec3> vertices_;
  std::span<const std::uint32_t> places_;
  Vec3 x_;
  int scale_exponent_ = 0;
  double scale_ = 1.0;
  std::vector<Corner> corners_;
  std::vector<Origin> origins_;   // by corner
  std::deque<ScaledVec3> exact_;  // the first exact_count_; the rest is spare memory
  std::size_t exact_count_ = 0;
  ExactVec3 edge_normal_;                         // of the edge last queried exactly,
  CornerId normal_a_ = kNone, normal_b_ = kNone;  // from a to b
  std::vector<FineDirection> fine_;
  std::array<PlaneCrossings, kNamedPlanes> crossings_;  // by plane
  std::deque<FurtherPlane> further_planes_;             // the first further_count_; the rest is spare memory
  std::size_t further_count_ = 0;
  const ExactVec3* normal_ = nullptr;  // of the source's plane
  ScaledVec3 horizon_;                 // its normal
  std::vector<Edge> edges_;
  std::vector<Outline> outlines_;
  std::vector<std::pair<std::uint32_t, CornerId>> corner_of_vertex_;  // (run, corner) for every vertex of the scene
  std::uint32_t run_ = 0;
  bool shared_corners_ = false;
  Integer height_;  // scratch
};

}  // namespace exactff::visibility
