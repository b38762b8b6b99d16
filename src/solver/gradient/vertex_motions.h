// How the lines that bound the view move if a vertex of the scene moves, or x.
//
// Notation: as in contour/contour.h; a, b, ... are points relative to x. The plane through x and the line has the
// normal N. Beside a direction w in it, directions are given by the coordinate s along N / |N|. If a vertex moves by d,
// the line moves at w by
//   s = (turn . d) (share . w) / |N|,
// with two vectors that depend on the line and the vertex:
//   - The line is that through the vertices a and b. A point y = r w of it follows a by the share that a has in
//     it: with y = l a + m b, this is l, and l / r is linear in w: share . a = 1, share . b = 0. turn = N. The
//     shares of a and b add up to the nearness of the line, since l + m = 1.
//   - The line is where the plane of a face meets the source's plane. Let h and g be the nearnesses of the planes:
//     h . y = 1 for their points y. They meet where (h - g) . w = 0, so that N = k (h - g). The plane of a face
//     follows three of its vertices. If a, one of them, moves by d, h changes by -(h . d) a*, where a* . a = 1, and
//     a* . b = a* . c = 0 for the others; a* + b* + c* = h. Then w . (h - g) = 0 gives turn = k h, share = a*. For
//     a vertex of the source's frame, turn = -k g, and the share is by that frame.
//   - If x moves, all vertices move the other way. Their shares add up to the nearness u = share . w of the line, and
//     turn = N, also for a line in which two planes meet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kernel/numbers.h"
#include "visibility/plane_visibility.h"

namespace exactff::gradient {

struct Motion {
  static constexpr std::uint32_t kAll = static_cast<std::uint32_t>(-1);
  std::uint32_t place = kAll;  // of the vertex (scene/scene.h), or of all of them
  kernel::RationalVec3 share;
  kernel::RationalVec3 turn;  // divided by the component of N of largest magnitude; of all, not set
};

// Of all lines of one plane of the source.
class VertexMotions {
 public:
  explicit VertexMotions(const visibility::PlaneQuery& query);

  using VertexPair = std::pair<std::uint32_t, std::uint32_t>;  // places, ascending
  [[nodiscard]] VertexPair pair_of(std::uint32_t p, std::uint32_t q) const;
  // The vertices through which the edge of an occluder's outline runs. Nullopt: it is a cut by the source's plane.
  [[nodiscard]] std::optional<VertexPair> line_of_occluder(const visibility::Outlines& outlines,
                                                           const visibility::Outlines::Edge& edge) const {
    const bool whole = edge.outline == visibility::Outlines::kNone || outlines.outline(edge.outline).whole;
    return line_of_occluder(outlines.segment(edge.a), outlines.segment(edge.b), whole);
  }
  // The same for the source. Nullopt: it lies on the horizon.
  [[nodiscard]] std::optional<VertexPair> line_of_source(const visibility::Outlines& outlines,
                                                         const visibility::Outlines::Edge& edge) const {
    return line_of_source(outlines.segment(edge.a), outlines.segment(edge.b));
  }
  // The same between the corners on two segments (Outlines::segment). `whole`: of an outline that is not clipped.
  using Segment = std::pair<std::uint32_t, std::uint32_t>;
  [[nodiscard]] std::optional<VertexPair> line_of_occluder(const Segment& a, const Segment& b, bool whole) const;
  [[nodiscard]] std::optional<VertexPair> line_of_source(const Segment& a, const Segment& b) const;
  [[nodiscard]] bool is_in_source_plane(std::uint32_t vertex) const;

  // N is any normal of the line's plane.
  [[nodiscard]] std::vector<Motion> of_line(const kernel::ExactVec3& N, const VertexPair& line) const;
  [[nodiscard]] std::vector<Motion> of_cut(const kernel::ExactVec3& N, std::uint32_t piece) const;

  // Places of the vertices that the plane of a piece, and that of the source, follows.
  [[nodiscard]] std::array<std::uint32_t, 3> frame_of_piece(std::uint32_t piece) const;
  [[nodiscard]] const std::array<std::uint32_t, 3>& source_frame() const { return source_.places; }
  // Of those, each one's share in directions w, as in a cut.
  [[nodiscard]] const kernel::RationalVec3& source_share(int corner) const { return source_.shares[corner]; }

 private:
  struct Frame {
    std::array<std::uint32_t, 3> places{};
    std::array<kernel::RationalVec3, 3> shares;
    kernel::RationalVec3 nearness;
  };
  [[nodiscard]] kernel::RationalVec3 point(std::uint32_t vertex) const;
  [[nodiscard]] Frame make_frame(const std::array<std::uint32_t, 3>& corners) const;

  const Scene& scene_;
  const visibility::SourcePlane& plane_;
  std::span<const std::uint32_t> places_;
  kernel::RationalVec3 x_;
  Frame source_;
};

// The places that a piece's plane follows: the lowest that are not on a line, of the corners of its face if that is
// planar, else of its own.
[[nodiscard]] std::array<std::uint32_t, 3> frame_of(const Scene& scene, std::uint32_t piece);

}  // namespace exactff::gradient
