// Two estimates. The first needs no edges. Pieces that share a corner form a *body*. Let it have F pieces with U
// corners in all, at P places. It has U uses of edges and, by Euler's formula, about P + F edges; so about U - P - F of
// these are inside it, with two uses each. Of the m edges inside a body, at least about 2 sqrt(m) are silhouettes, as
// on a sphere, and all others are taken to be.
//
// The second is made only where the first promises much. An edge of two pieces is a silhouette from a far point in a
// random direction with the probability a / pi, a being the angle between their normals: of a box, half of the edges.
#include "scene/connectedness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "kernel/vec.h"
#include "scene/edges.h"
#include "scene/places.h"
#include "scene/scene_data.h"

namespace exactff {

namespace {

struct Body {
  double pieces = 0.0, corners = 0.0, places = 0.0;
};

class Bodies {
 public:
  explicit Bodies(const Scene& scene)
      : scene_(scene), places_(places(scene)), parent_(places_.size()), bodies_(places_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    join_corners();
    count();
  }

  // By places; of most there are no pieces.
  [[nodiscard]] const std::vector<Body>& bodies() const { return bodies_; }

 private:
  [[nodiscard]] std::uint32_t root(std::uint32_t place) {
    while (parent_[place] != place) place = parent_[place] = parent_[parent_[place]];
    return place;
  }
  void join_corners();
  void count();

  const Scene& scene_;
  const std::span<const std::uint32_t> places_;
  std::vector<std::uint32_t> parent_;  // by place
  std::vector<Body> bodies_;
};

void Bodies::join_corners() {
  for (const Piece& piece : scene_.pieces()) {
    if (piece.transparent) continue;
    const auto corners = scene_.corners(piece);
    const std::uint32_t first = places_[corners.front()];
    for (const std::uint32_t corner : corners) parent_[root(places_[corner])] = root(first);
  }
}

void Bodies::count() {
  std::vector<bool> used(places_.size());
  for (const Piece& piece : scene_.pieces()) {
    if (piece.transparent) continue;
    const auto corners = scene_.corners(piece);
    Body& body = bodies_[root(places_[corners.front()])];
    body.pieces += 1.0;
    body.corners += static_cast<double>(corners.size());
    for (const std::uint32_t corner : corners) used[places_[corner]] = true;
  }
  for (std::uint32_t place = 0; place < used.size(); ++place) {
    if (used[place]) bodies_[root(place)].places += 1.0;
  }
}

double by_bodies(const Scene& scene) {
  double edges = 0.0, silhouettes = 0.0;
  const Bodies bodies(scene);
  for (const Body& body : bodies.bodies()) {
    const double own = body.places + body.pieces, inside = std::max(body.corners - own, 0.0);
    edges += own;
    silhouettes += std::min(own, std::max(own - inside, 0.0) + 2.0 * std::sqrt(inside));
  }
  return silhouettes > 0.0 ? edges / silhouettes : 1.0;
}

Vec3 normal_of(const Scene& scene, const Piece& piece) {
  const auto vertices = scene.vertices();
  const Vec3& p = vertices[piece.frame[0]];
  return kernel::cross(kernel::difference(vertices[piece.frame[1]], p),
                       kernel::difference(vertices[piece.frame[2]], p));
}

double probability(const Scene& scene, std::span<const EdgeUse> uses) {
  if (uses.size() != 2) return 1.0;
  const Vec3 n = normal_of(scene, scene.pieces()[uses[0].piece()]),
             m = normal_of(scene, scene.pieces()[uses[1].piece()]);
  const double sizes = std::hypot(n.x, n.y, n.z) * std::hypot(m.x, m.y, m.z);
  const double cosine = kernel::dot(n, m) / sizes;
  if (!(sizes > 0.0) || !std::isfinite(cosine)) return 1.0;
  const double agreeing = uses[0].upwards() != uses[1].upwards() ? cosine : -cosine;
  return std::acos(std::clamp(agreeing, -1.0, 1.0)) / std::numbers::pi;
}

double by_angles(const Scene& scene) {
  const SceneEdges& edges = scene_edges(scene);
  double silhouettes = 1.0;
  for (std::uint32_t edge = 0; edge < edges.size(); ++edge) silhouettes += probability(scene, edges.uses(edge));
  return static_cast<double>(edges.size()) / silhouettes;
}

double estimated(const Scene& scene) {
  constexpr double kPromising = 3.0;
  const double estimate = by_bodies(scene);
  return estimate < kPromising ? estimate : std::min(estimate, by_angles(scene));
}

}  // namespace

double edges_per_silhouette(const Scene& scene) {
  const SceneInside::Data& data = SceneInside::data(scene);
  std::call_once(data.connectedness_found, [&] { data.edges_per_silhouette = estimated(scene); });
  return data.edges_per_silhouette;
}

}  // namespace exactff
