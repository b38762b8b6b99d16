// Faces of a welded scene that lie closer to each other than the length, face to face.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "exactff/scene.h"
#include "scene/shaft_tree.h"

namespace exactff {

// The box of two points, larger by `reach` on all sides, rounded outward.
inline Box around(const Vec3& a, const Vec3& b, double reach) {
  const auto down = [&](double u, double v) { return std::nextafter(std::min(u, v) - reach, -HUGE_VAL); };
  const auto up = [&](double u, double v) { return std::nextafter(std::max(u, v) + reach, HUGE_VAL); };
  return {{down(a.x, b.x), down(a.y, b.y), down(a.z, b.z)}, {up(a.x, b.x), up(a.y, b.y), up(a.z, b.z)}};
}

class SheetFinder {
 public:
  using Id = std::uint32_t;

  SheetFinder(const Scene& scene, double length) : scene_(scene), length_(length) {}

  // Finds faces that have the same corners, and had not: `before` and `now` are the corners of face f.
  void compare(const std::vector<std::vector<Id>>& before, const std::vector<std::vector<Id>>& now);
  // Finds corners that lie before the inside of a face.
  void look_around();
  // Those farthest apart come first; then by the names.
  [[nodiscard]] std::vector<WeldedScene::Sheets> take() const;

 private:
  void look_around(std::size_t face, const Vec3& x);
  void add(std::size_t face, std::size_t other, double apart);

  const Scene& scene_;
  double length_;
  std::map<std::pair<PatchId, PatchId>, WeldedScene::Sheets> found_;
};

}  // namespace exactff
