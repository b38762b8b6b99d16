// Closed surfaces among the pieces of a scene.
//
// A surface is made of pieces that hang together by edges; edges are told by the positions of their ends. It is closed
// where along each of its edges as many pieces run one way as the other. Nothing else is asked of it: it may pass
// through itself, more than two pieces may share an edge, and its front may be the inner side.
//
// Winding numbers. Almost every segment meets a surface in the interiors of its pieces alone. Let w(y), off a closed
// surface, be the number of its pieces that a ray from y crosses from back to front, less those that it crosses from
// front to back. This is the same for almost every ray and constant along whatever does not meet the surface, since
// its edges cancel; outside the surface's box it is 0, where some rays meet nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/shaft_tree.h"

namespace exactff {

struct ClosedSurface {
  Box box;
  bool turned_inside_out = false;  // its fronts enclose the most of its volume, as far as doubles see it
};

class ClosedSurfaces {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  ClosedSurfaces() = default;
  explicit ClosedSurfaces(const Scene& scene);

  [[nodiscard]] bool empty() const { return surfaces_.empty(); }
  [[nodiscard]] std::span<const ClosedSurface> surfaces() const { return surfaces_; }
  // The index of the closed surface that a piece belongs to, or kNone. Requires that there is one.
  [[nodiscard]] std::uint32_t of_piece(std::uint32_t piece) const { return of_piece_[piece]; }

 private:
  std::vector<ClosedSurface> surfaces_;
  std::vector<std::uint32_t> of_piece_;
};

// Those of the scene, found when first asked for; safe to call from several threads.
const ClosedSurfaces& closed_surfaces(const Scene& scene);

}  // namespace exactff
