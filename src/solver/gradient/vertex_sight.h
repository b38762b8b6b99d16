// What changes in one plane through x when one vertex moves a little, by exact arithmetic. Requires that F has a
// derivative by x (kinks.h).
//
// As in sight_plane.h, what is visible beside a direction w of the plane is what nothing covers, and its change M is a
// sum of some coordinates s, each with a sign: those to which the lines in the plane move. But here each line moves as
// its own vertices do (vertex_motion.h): s = f . d, with a vector f for each line, a sum of turn (share . w). M is the
// same sum of some f . d as long as the order of all f . d is. F has a derivative by the vertex if M is the same vector
// for every order.
//   - If all f are multiples of N, there are two orders.
//   - Else all orders of the different f are tried, even if no movement leads to some: a kink may be reported
//     where there is none, but no derivative where there is none.
// An edge of an occluder that lies in the source's plane hides what is beside it, or not, as it rises or sinks. Where
// it moves, or the source's plane does, M must be the same with all such edges and without any.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "contour/arc_sum.h"
#include "gradient/profile.h"
#include "gradient/sight_directions.h"
#include "gradient/vertex_motion.h"

namespace exactff::gradient {

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
