// What changes in one plane through x when x, or a vertex of the scene, moves a little, by exact arithmetic.
//
// Let N be the plane's normal, and let w be a direction in the plane. Beside w, directions are given by the coordinate
// s along N / |N|. If something moves by d, each line that bounds the view moves there to s = f . d, with a vector f
// for each line (sight_lines.h). To first order, near w,
//   - a face with an edge in the plane, on the side of N, covers all s above the line of the edge;
//     a face on the other side covers all s below it;
//   - a face that x sees edge-on covers what is between the lines of its near and its far side;
//   - a face that the plane cuts covers all s;
//   - where the source lies on one side of the plane alone, its edge ends the view as a face on the other side would.
// What is visible is what nothing covers. Its change is M . d, with a sum M of some f, each with a sign. M depends on
// the order of all f . d alone. If M is the same vector for every order, F is differentiable: this is a *kink*
// otherwise.
//   - If all f are multiples of N, there are two orders. So it is where x moves: f = -N u, u = 1 / r, by the distance r
//     of the line. Without faces with an edge on either side, a face seen edge-on is then a kink. With faces on one
//     side alone, so is another depth, or a face seen edge-on; with both, so is a gap between the two.
//   - Else all orders of the different f are tried, even if no movement leads to some: a kink may be reported
//     where there is none, but no derivative where there is none.
// An edge of an occluder that lies in the source's plane hides what is beside it, or not, as it rises or sinks. Where
// a vertex moves it, or the source's plane, M must be the same with all such edges and without any.
//
// f is linear in w. Arcs along which the order of all lines that one movement moves is the same, and all faces are
// present or not, are judged at one direction inside of them.
#pragma once

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

using contour::ArcSum;
using contour::MovingArc;

// An arc along which something changes if x moves.
struct SightArc {
  ExactVec3 begin, end;  // N . (begin x end) > 0
  // -M / N, as a nearness: if x moves towards N, and away from it.
  RationalVec3 gain_ahead, gain_back;
  bool is_kink = false;
  bool edge_on = false;               // of a kink: a face that x sees edge-on is part of it
  std::vector<std::uint32_t> pieces;  // of a kink: what meets there, without the source
};

// What an arc adds to the derivative by one vertex: weight / |C| 2 I / (2 pi |n|), where the arc's nearness is a share.
struct VertexArc {
  std::uint32_t place = 0;
  MovingArc arc;
  RationalVec3 turn;  // divided by the component of C of largest magnitude
};

class SightPlane : public SightDirections {
 public:
  // The plane through x and the edge. The profile is that of the query; if vertices move, it is gathered with what
  // meets the source's plane. `motions`: of the vertices; null: x moves.
  SightPlane(const PlaneQuery& query, Profile& profile, const Outlines::Edge& edge,
             const VertexMotions* motions = nullptr);

  // --- If x moves ---

  enum class Extent { kAll, kUpToKink };
  // All arcs in order, or those up to the first kink.
  [[nodiscard]] std::vector<SightArc> arcs(Extent extent = Extent::kAll);
  // The same if the plane is that of the source, and N its front.
  [[nodiscard]] std::vector<SightArc> arcs_of_source_edge_on();

  // --- If vertices move ---

  struct OfVertices {
    std::vector<std::uint32_t> kinks;  // places of vertices by which there is no derivative, in any order
    std::vector<VertexArc> arcs;       // of the other vertices
  };
  [[nodiscard]] OfVertices of_vertices();
  // Only the kinks.
  [[nodiscard]] std::vector<std::uint32_t> kinks_of_vertices();

 private:
  using Motions = std::vector<Motion>;
  // A line, or what crosses the plane.
  struct Element {
    ExactVec3 from, to;  // N . (from x to) > 0
    int side = 0;        // on which its outline lies; 0: on both
    bool is_source = false;
    bool touches = false;  // it lies in the source's plane
    bool present = true;   // it hides something now
    std::uint32_t piece = 0;
    std::optional<VertexMotions::VertexPair> line;  // if vertices move
    Motions motions;                                // set where they count; none on the horizon
  };
  // A piece that lies in the plane.
  struct Sheet {
    struct Side {
      ExactVec3 from, to;
      RationalVec3 nearness;
      Motions motions;
    };
    std::uint32_t piece = 0;
    std::vector<Side> sides;
    std::vector<ExactVec3> corners;
    std::vector<std::uint32_t> places;  // of the corners
  };
  // Where a sheet is met in one direction.
  struct Chord {
    const Sheet* sheet = nullptr;
    const Sheet::Side *near = nullptr, *far = nullptr;
    Rational u_near, u_far;
    bool is_cut = false;  // by the source's plane
  };
  struct Change;
  struct Verdict;

  [[nodiscard]] RationalVec3 nearness_of(const Vec3& a, const Vec3& b, const Vec3& c) const;
  [[nodiscard]] RationalVec3 nearness_of(std::uint32_t piece) const;
  void add_outline(OutlineId id);
  void add_meeting(std::uint32_t piece);
  [[nodiscard]] Sheet sheet_of(std::uint32_t piece) const;
  void set_motions(Element& element) const;
  [[nodiscard]] bool find_range();
  [[nodiscard]] bool clamp(ExactVec3& from, ExactVec3& to) const;
  [[nodiscard]] bool gather();
  void add_meetings(const std::vector<const RationalVec3*>& lines, std::vector<ExactVec3>& breaks) const;
  void sort(std::vector<ExactVec3>& directions) const;
  [[nodiscard]] std::vector<ExactVec3> breaks() const;
  // Calls visit(begin, end) for each arc between neighbours, until one call returns false.
  template <class Visit>
  void for_each_arc(const std::vector<ExactVec3>& breaks, const Visit& visit) const;

  [[nodiscard]] std::optional<Chord> chord_of(const Sheet& sheet, const ExactVec3& t) const;
  [[nodiscard]] bool look_at(const ExactVec3& t);
  [[nodiscard]] Verdict judge(std::uint32_t place, const ExactVec3& begin, const ExactVec3& end) const;
  [[nodiscard]] std::optional<SightArc> arc_between(const ExactVec3& begin, const ExactVec3& end);
  [[nodiscard]] std::optional<SightArc> arc_of_source(const ExactVec3& begin, const ExactVec3& end) const;
  [[nodiscard]] bool may_have_kinks() const;
  [[nodiscard]] bool is_concerned(std::uint32_t place, const ExactVec3& begin, const ExactVec3& end) const;
  [[nodiscard]] std::vector<std::uint32_t> movers() const;
  [[nodiscard]] OfVertices judge_vertices();

  const PlaneQuery& query_;
  Profile& profile_;
  const VertexMotions* motions_;
  RationalVec3 source_nearness_;
  Motions source_motions_;  // if x moves
  std::vector<Element> elements_;
  std::vector<Sheet> sheets_;
  ExactVec3 first_, last_;  // the directions that matter
  // At one direction:
  std::vector<const Element*> active_;
  std::vector<Chord> chords_;
};

}  // namespace exactff::gradient
