// A scene's pieces in exact coordinates, prepared once for all pairs.
#pragma once

#include <limits>
#include <vector>

#include "exactff/scene.h"
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

// A convex piece, without corners in the middle of a straight side.
struct ExactPiece {
  FaceId face{};
  bool transparent = false;
  std::vector<std::uint32_t> corners;  // vertex indices, counter-clockwise from the front; one index for each position
  Plane plane;                         // positive in front
  Box box;
};

struct ExactScene {
  explicit ExactScene(const Scene& scene);

  const Scene& scene;
  Units units;
  std::vector<Point> vertices;     // by vertex index; those of other vertices at a known position are left empty
  std::vector<ExactPiece> pieces;  // as Scene::pieces()
};

}  // namespace exactff::view_factors
