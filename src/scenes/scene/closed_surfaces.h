// Closed surfaces among the pieces of a scene.
//
// A surface is a set of pieces connected by edges; an edge is identified by the positions of its ends. A surface is
// closed if along each of its edges as many pieces run one way as the other. There is no other requirement: it may pass
// through itself, more than two pieces may share an edge, and its front may be the inner side. On request, an edge
// where that is not so is cut where ends of other such edges lie on it (T-junctions). Then surfaces also count that
// have holes in one plane: all of the other edges lie in it, and the surface on one side. So a box without a bottom, on
// a floor, is one, and a room without a wall.
//
// Winding numbers. Almost every segment meets a surface in the interiors of its pieces alone. Let w(y), off a closed
// surface, be the number of its pieces that a ray from y crosses from back to front, less those that it crosses from
// front to back. This is the same for almost every ray and constant along any path that does not meet the surface,
// since its edges cancel. Outside the surface's box it is 0, because some rays from there meet nothing. Of a surface
// with holes, w is known on its side of their plane: by rays that do not meet the plane, as if the holes were filled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "scene/shaft_tree.h"

namespace exactff {

struct ClosedSurface {
  // Of holes in one plane.
  struct Rim {
    std::array<Vec3, 3> plane;                                   // counter-clockwise as seen from the surface
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  // from place to place, as the pieces run
  };

  Box box;
  bool turned_inside_out = false;  // its fronts enclose most of its volume, as computed in doubles
  std::optional<Rim> rim;          // of one with holes
};

class ClosedSurfaces {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  enum class Edges { kWhole, kCutAtJunctions };  // the second: with those that have holes in one plane

  ClosedSurfaces() = default;
  explicit ClosedSurfaces(const Scene& scene, Edges edges = Edges::kWhole);

  [[nodiscard]] bool empty() const { return surfaces_.empty(); }
  [[nodiscard]] std::span<const ClosedSurface> surfaces() const { return surfaces_; }
  // The index of the closed surface that a piece belongs to, or kNone. Callers ask empty()
  // first: without a closed surface, there is no list.
  [[nodiscard]] std::uint32_t of_piece(std::uint32_t piece) const { return of_piece_[piece]; }

 private:
  std::vector<ClosedSurface> surfaces_;
  std::vector<std::uint32_t> of_piece_;
};

// The closed surfaces of the scene, by whole edges, found at the first call; safe to call from several threads.
const ClosedSurfaces& closed_surfaces(const Scene& scene);

}  // namespace exactff
