// The edges of a scene's pieces, cut so that all faces along an edge share its points.
//
// 1. An edge that is longer than LENGTH is parted at the corners of other faces that lie on it (T-junctions), exactly.
// 2. Each part is cut into the fewest equal lengths, by the rule of CutPoints::between(), which depends on its ends
//    alone. So faces that have the edge in different parts agree on all points.
// An edge is identified by the positions of its ends, as in closed_surfaces.h.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "division/cut_points.h"
#include "exactff/scene.h"

namespace exactff::division {

class EdgeCuts {
 public:
  // Adds the points of all edges to `points`, whose first vertices are those of the scene.
  EdgeCuts(const Scene& scene, CutPoints& points);

  // A piece with the points of its edges among its corners. All are places.
  [[nodiscard]] std::vector<std::uint32_t> outline(const Piece& piece) const;

 private:
  using Ends = std::pair<std::uint32_t, std::uint32_t>;  // the lower place first

  [[nodiscard]] std::vector<std::uint32_t> junctions(const Ends& ends) const;
  [[nodiscard]] std::vector<std::uint32_t> cut(const Ends& ends);
  [[nodiscard]] std::span<const std::uint32_t> part(std::uint32_t from, std::uint32_t to);

  const Scene& scene_;
  CutPoints& points_;
  std::vector<std::uint32_t> corners_[3];                // places of all pieces' corners, by each coordinate
  std::map<Ends, std::vector<std::uint32_t>> of_parts_;  // the points of edges without junctions, from the lower place
  std::map<Ends, std::vector<std::uint32_t>> of_edges_;  // the points of all edges, with junctions
};

}  // namespace exactff::division
