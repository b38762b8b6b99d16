// What changes in one plane through x when one vertex moves a little, by exact arithmetic. Requires that F has a
// derivative by x (kinks.h).
//
// As in kinks.h, what is visible beside a direction w of the plane is what nothing covers, and its change M is a
// sum of some coordinates s, each with a sign: those to which the lines in the plane move. But here each line moves as
// its own vertices do: s = f . d, with a vector f for each line, a sum of turn (share . w). M is the
// same sum of some f . d as long as the order of all f . d is. F has a derivative by the vertex if M is the same vector
// for every order.
//   - If all f are multiples of N, there are two orders.
//   - Else all orders of the different f are tried, even if no movement leads to some: a kink may be reported
//     where there is none, but no derivative where there is none.
// An edge of an occluder that lies in the source's plane hides what is beside it, or not, as it rises or sinks. Where
// it moves, or the source's plane does, M must be the same with all such edges and without any.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contour/contour.h"
#include "gradient/sight_lines.h"
#include "kernel/numbers.h"
#include "visibility/plane_visibility.h"

namespace exactff::gradient {

// --- Vertex motion ---

// How a line that bounds the view moves if a vertex moves.
//
// Notation: as in contour/contour.h; a, b, ... are points relative to x. The plane through x and the line has the
// normal N. Beside a direction w in it, directions are given by the coordinate s along N / |N|. If a vertex moves by d,
// the line moves at w by
//   s = (turn . d) (share . w) / |N|,
// with two vectors that depend on the line and the vertex:
//   - The line is that through the vertices a and b. A point y = r w of it follows a by the share that a has in
//     it: with y = l a + m b, this is l, and l / r is linear in w: share . a = 1, share . b = 0. turn = N. The
//     shares of a and b add up to the nearness of the line, since l + m = 1. So a movement of both is one of x
//     the other way.
//   - The line is where the plane of a face meets the source's plane. Let h and g be the nearnesses of the planes:
//     h . y = 1 for their points y. They meet where (h - g) . w = 0, so that N = k (h - g). The plane of a face
//     follows three of its vertices. If a, one of them, moves by d, h changes by -(h . d) a*, where a* . a = 1, and
//     a* . b = a* . c = 0 for the others; a* + b* + c* = h. Then w . (h - g) = 0 gives turn = k h, share = a*. For
//     a vertex of the source's frame, turn = -k g, and the share is by that frame.

struct VertexMotion {
  std::uint32_t place = 0;  // of the vertex (scene/scene.h)
  kernel::RationalVec3 share;
  kernel::RationalVec3 turn;  // divided by the component of N of largest magnitude
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
  [[nodiscard]] std::vector<VertexMotion> of_line(const kernel::ExactVec3& N, const VertexPair& line) const;
  [[nodiscard]] std::vector<VertexMotion> of_cut(const kernel::ExactVec3& N, std::uint32_t piece) const;

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

// --- Vertex sight ---

// What an arc adds to the derivative by one vertex: weight / |C| 2 I / (2 pi |n|), where the arc's nearness is a share.
struct VertexArc {
  std::uint32_t place = 0;
  contour::MovingArc arc;
  kernel::RationalVec3 turn;  // divided by the component of C of largest magnitude
};

class VertexSight : public SightDirections {
 public:
  // The plane through x and the edge. The profile is that of the query, gathered with what meets the source's plane.
  VertexSight(const visibility::PlaneQuery& query, Profile& profile, const VertexMotions& motions,
              const visibility::Outlines::Edge& edge);

  enum class Extent { kAll, kKinks };
  void judge(Extent extent);
  // Places of vertices by which there is no derivative, in any order.
  [[nodiscard]] const std::vector<std::uint32_t>& kinks() const { return kinks_; }
  // Of the other vertices.
  [[nodiscard]] std::vector<VertexArc>& arcs() { return arcs_; }

 private:
  using Motion = std::vector<VertexMotion>;
  // A line, or what crosses the plane.
  struct Element {
    enum class Kind { kSource, kOccluder };
    Kind kind = Kind::kSource;
    kernel::ExactVec3 from, to;  // N . (from x to) > 0
    int side = 0;                // on which it lies; 0: on both
    bool touches = false;        // it lies in the source's plane
    bool present = true;         // it hides something now
    Motion motion;
  };
  struct SheetSide {
    kernel::ExactVec3 from, to;
    kernel::RationalVec3 nearness;
    Motion motion;
  };
  struct Sheet {
    std::vector<SheetSide> sides;
    std::vector<std::uint32_t> places;
    std::vector<kernel::ExactVec3> corners;
  };
  struct Strip {
    const SheetSide *near = nullptr, *far = nullptr;
    const Sheet* sheet = nullptr;
    bool is_cut = false;  // by the source's plane
  };
  struct Change {
    std::vector<int> counts;  // of each of the different f
    bool below = false, above = false;
    friend bool operator==(const Change&, const Change&) = default;
  };

  void add_outline(visibility::OutlineId id);
  void add_meeting(std::uint32_t piece);
  void add_sheet(std::uint32_t piece);
  [[nodiscard]] bool find_range();
  [[nodiscard]] bool may_have_kinks() const;
  [[nodiscard]] std::vector<kernel::ExactVec3> breaks() const;
  void judge_at(const kernel::ExactVec3& begin, const kernel::ExactVec3& end);
  void judge_vertex(std::uint32_t place, const kernel::ExactVec3& begin, const kernel::ExactVec3& end);
  [[nodiscard]] std::optional<Strip> strip_of(const Sheet& sheet, const kernel::ExactVec3& t) const;
  [[nodiscard]] bool is_concerned(std::uint32_t place, const kernel::ExactVec3& begin,
                                  const kernel::ExactVec3& end) const;

  const visibility::PlaneQuery& query_;
  Profile& profile_;
  const VertexMotions& motions_;
  kernel::RationalVec3 source_nearness_;
  std::vector<Element> elements_;
  std::vector<Sheet> sheets_;
  kernel::ExactVec3 first_, last_;
  // At one direction:
  std::vector<const Element*> active_;
  std::vector<Strip> strips_;

  std::vector<std::uint32_t> kinks_;
  std::vector<VertexArc> arcs_;
};

}  // namespace exactff::gradient
