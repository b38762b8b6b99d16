// A scene's pieces in exact coordinates, prepared once for all pairs.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "scene/closed_surfaces.h"
#include "scene/panels.h"
#include "view_factors/exact_space.h"

namespace exactff::view_factors {

// A box of points, in the units of Point::at. Each of its numbers is rounded once.
struct Box {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};

  void include(const Vec3& v);
  // Certainly: apart by more than the roundings.
  [[nodiscard]] bool is_apart_from(const Box& other) const;
};

[[nodiscard]] Box box_of(std::span<const Point> points);

inline constexpr std::uint32_t kNoSurface = std::numeric_limits<std::uint32_t>::max();

// A convex piece, or a panel of several (scene/panels.h), without corners in the middle of a straight side.
struct ExactPiece {
  FaceId face{};  // of a joined panel one of several
  bool transparent = false;
  std::uint32_t surface = kNoSurface;  // an index of ExactScene::surfaces
  std::vector<std::uint32_t> corners;  // vertex indices, counter-clockwise from the front; one index for each position
  Plane plane;                         // positive in front
  Box box;
};

// A closed surface of the scene (scene/closed_surfaces.h).
struct ExactSurface {
  Box box;
  bool turned_inside_out = false;
  std::optional<Plane> rim;           // of one with holes: the surface lies on its positive side
  std::vector<std::uint32_t> pieces;  // ascending
};

struct ExactScene {
  explicit ExactScene(const Scene& scene);

  // Of a piece or a joined panel.
  [[nodiscard]] const ExactPiece& panel(PanelId id) const {
    return id < pieces.size() ? pieces[id] : joined[id - pieces.size()];
  }

  const Scene& scene;
  Units units;
  std::vector<Point> vertices;     // by vertex index; those of other vertices at a known position are left empty
  std::vector<ExactPiece> pieces;  // as Scene::pieces()
  std::vector<ExactPiece> joined;  // the panels of several pieces
  std::vector<ExactSurface> surfaces;

 private:
  [[nodiscard]] ExactPiece exact_piece(const Piece& piece, std::span<const std::uint32_t> corners);
};

// By their indices.
[[nodiscard]] std::vector<ExactSurface> exact_surfaces(const ClosedSurfaces& closed, std::span<const ExactPiece> pieces,
                                                       const Units& units);

}  // namespace exactff::view_factors
