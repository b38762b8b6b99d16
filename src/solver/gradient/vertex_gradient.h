// The derivatives of one form factor by the vertices of the scene, plane by plane of the source. Requires that F has a
// derivative by x.
//
// For one plane of the source:
// 1. Gather what touches the closed shaft (sight_lines.h), also in the source's plane. Stop if one piece hides more
// than
//    the source: its vertices may move a little, too.
// 2. Look for vertices by which there is no derivative: in each plane through x with different lines, or with an edge
//    that lies in the source's plane (sight_plane.h).
// 3. Add up the arcs of the visible boundary, for each vertex that moves them: those of the edge engine in
//    double-double (contour/quick_contour.h), unless a plane cuts their lines, and where that does not suffice in
//    balls. Of the Booleans' boundary only the planes through x are used: the lines in each are those that step 2
//    finds.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "exactff/exact.h"
#include "gradient/gradient.h"
#include "gradient/sight_lines.h"
#include "gradient/sight_plane.h"
#include "visibility/visible_edges.h"

namespace exactff::gradient {

// A workspace. Its queries look at pieces (BoundaryRequest::by_pieces).
class VertexGradient {
 public:
  // Starts a new one.
  void start(const View& view);
  // Takes what is seen of one plane.
  void add(const PlaneQuery& query, const ArcSection& seen);

  // As those of PointGradient.
  [[nodiscard]] bool finish(int cap, Gradient& result);
  void add_exactly(const PlaneQuery& query, const ArcSection& seen);
  void certify(int cap, Gradient& result);

 private:
  [[nodiscard]] bool gather(const PlaneQuery& query);
  void find_kinks(const PlaneQuery& query, const VertexMotions& motions, bool is_visible);
  [[nodiscard]] bool is_beside_source(CornerId a, CornerId b) const;
  [[nodiscard]] bool differ(const VertexMotions& motions, std::span<const EdgeId> group);
  [[nodiscard]] bool overlaps_source(const VertexMotions& motions, std::span<const std::uint32_t> vertices);
  void add_quickly(const VertexMotions& motions, const ArcSection& seen);
  void add_by_edges(const VertexMotions& motions, const ArcSection& seen);
  void add_by_planes(const PlaneQuery& query, const VertexMotions& motions, const ArcSection& seen);
  [[nodiscard]] bool is_of_source(const Outlines::Edge& edge) const;
  [[nodiscard]] bool is_of_source(const ArcLine& line) const;
  [[nodiscard]] std::optional<VertexMotions::VertexPair> vertices_of(const VertexMotions& motions,
                                                                     const ArcSection& seen, const ArcLine& line) const;
  [[nodiscard]] std::uint32_t piece_of_cut(const VertexMotions& motions, const ArcSection& seen,
                                           const ArcLine& line) const;

  struct Sums {
    std::array<kernel::double_double::Bounded, 3> value;
    std::array<bool, 3> has_terms{};  // other than those that are certainly 0

    void decline() {
      value.fill(kernel::double_double::kDeclined);
      has_terms.fill(true);
    }
  };

  Vec3 normal_;
  Profile profile_;
  SightGroups groups_;
  std::set<EdgeId> in_source_plane_;
  QuickArcs quick_;
  std::map<std::uint32_t, Sums> sums_;  // by place
  std::set<std::uint32_t> kinks_;
  std::map<std::uint32_t, std::vector<VertexArc>> arcs_;  // by place
  std::vector<std::array<std::uint32_t, 3>> frames_;
};

}  // namespace exactff::gradient
