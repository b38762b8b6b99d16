#include "slips/outlook.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/scene.h"
#include "scene/solids.h"

namespace exactff::slips {
namespace {

using kernel::along;
using kernel::cross;
using kernel::difference;

constexpr std::size_t kMostRaysOfSurfaces = 80'000, kMostPointsOfASurface = 192, kFewestPointsOfASurface = 8;

// The k-th point of a sequence in [0, 1]^4 (Roberts, 2018).
std::array<double, 4> place_of(std::size_t k) {
  constexpr std::array<double, 4> kSteps = {0.8566748838545029, 0.7338918566271259, 0.6287067210378086,
                                            0.5385972572236101};
  std::array<double, 4> place{};
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double x = 0.5 + static_cast<double>(k + 1) * kSteps[i];
    place[i] = x - std::floor(x);
  }
  return place;
}

double area_of(const Scene& scene, std::uint32_t piece) {
  const auto corners = scene.corners(scene.pieces()[piece]);
  const auto at = [&](std::size_t i) { return scene.vertices()[corners[i]]; };
  double area = 0.0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    area += 0.5 * kernel::length(cross(difference(at(i - 1), at(0)), difference(at(i), at(0))));
  }
  return area;
}

// Uniform by area, for `u` and `v` in [0, 1].
Vec3 point_in(const Scene& scene, std::uint32_t piece, double u, double v) {
  const auto corners = scene.corners(scene.pieces()[piece]);
  const auto at = [&](std::size_t i) { return scene.vertices()[corners[i]]; };
  const auto twice_area = [&](std::size_t i) {
    return kernel::length(cross(difference(at(i - 1), at(0)), difference(at(i), at(0))));
  };
  double rest = u * 2.0 * area_of(scene, piece);
  std::size_t i = 2;
  while (i + 1 < corners.size() && rest > twice_area(i)) rest -= twice_area(i++);
  const double root = std::sqrt(std::clamp(rest / twice_area(i), 0.0, 1.0));
  const Vec3 on_side = along(at(i - 1), difference(at(i), at(i - 1)), v);
  return along(at(0), difference(on_side, at(0)), root);
}

// About a normal of length 1, distributed by the cosine.
Vec3 direction_before(const Vec3& normal, double u, double v) {
  const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 a = kernel::unit(cross(normal, axis)), b = cross(normal, a);
  const double radius = std::sqrt(u), turn = 2.0 * std::numbers::pi * v;
  const Vec3 level = along(kernel::scaled(a, radius * std::cos(turn)), b, radius * std::sin(turn));
  return along(level, normal, std::sqrt(1.0 - u));
}

}  // namespace

Outlook::Outlook(const Scene& scene, const SightLines& sight) : scene_(scene), surface_(oriented_surfaces(scene)) {
  if (!sight.usable()) return;
  std::vector<std::vector<std::uint32_t>> pieces;  // by surface
  for (std::uint32_t piece = 0; piece < surface_.size(); ++piece) {
    if (surface_[piece] >= pieces.size()) pieces.resize(surface_[piece] + 1);
    pieces[surface_[piece]].push_back(piece);
  }
  const std::size_t count = std::min(kMostPointsOfASurface, kMostRaysOfSurfaces / (2 * pieces.size()));
  if (count < kFewestPointsOfASurface) return;
  for (const std::vector<std::uint32_t>& of_one : pieces) cast(sight, of_one, count);
}

// The points are spread over the area of the surface.
void Outlook::cast(const SightLines& sight, const std::vector<std::uint32_t>& pieces, std::size_t count) {
  std::vector<double> sums{0.0};
  for (const std::uint32_t piece : pieces) sums.push_back(sums.back() + area_of(scene_, piece));
  const double step = sums.back() / static_cast<double>(count);
  std::size_t p = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + 0.5) * step;
    while (p + 1 < pieces.size() && sums[p + 1] < at) ++p;
    const std::array<double, 4> place = place_of(k);
    const Vec3 point = point_in(scene_, pieces[p], place[0], place[1]);
    if (!is_covered(sight, pieces[p], point)) cast(sight, pieces[p], point, place.data() + 2, step);
  }
}

void Outlook::cast(const SightLines& sight, std::uint32_t piece, const Vec3& point, const double* place, double area) {
  kernel::poll();
  for (const Side side : {0U, 1U}) {
    const Vec3 normal = kernel::scaled(sight.normal(piece), side == 0 ? 1.0 : -1.0);
    Ray& ray = rays_.emplace_back(Ray{.from = 2 * piece + side, .area = area});
    double last = -HUGE_VAL;
    for (const Hit& hit : sight.hits_in_sight(point, direction_before(normal, place[0], place[1]), HUGE_VAL)) {
      ray.clear = ray.clear && hit.distance - last > 1e-9 * sight.diameter();
      ray.ends = ray.ends || !scene_.pieces()[hit.piece].transparent;
      ray.seen.push_back(2 * hit.piece + (hit.front ? 0 : 1));
      last = hit.distance;
    }
  }
}

bool Outlook::is_covered(const SightLines& sight, std::uint32_t piece, const Vec3& point) const {
  bool covered = false;
  visit_pieces_near(scene_, {point, point}, 1e-9 * sight.diameter(), [&](std::uint32_t other) {
    covered = other != piece && sight.holds(other, point);
    return !covered;
  });
  return covered;
}

bool Outlook::is_good(const Ray& ray, const Flipped& flipped) const {
  return is_front(ray.from, flipped) &&
         std::ranges::any_of(ray.seen, [&](Side side) { return is_front(side, flipped); });
}

Outlook::Lost Outlook::lost(const Flipped& flipped) const {
  Lost lost;
  for (const Ray& ray : rays_) {
    if (!is_front(ray.from, flipped) || is_good(ray, flipped)) continue;
    (ray.ends ? lost.to_backs : lost.to_nothing) += ray.area;
  }
  return lost;
}

// --- Oriented surfaces ---

namespace {

class Joiner {
 public:
  explicit Joiner(const Scene& scene) : scene_(scene), parent_(scene.pieces().size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    for (std::uint32_t p = 1; p < parent_.size(); ++p) {
      if (scene.pieces()[p].face == scene.pieces()[p - 1].face) parent_[p] = parent_[p - 1];
    }
  }

  void join() {
    std::vector<EdgeOfPiece> edges = edges_of_pieces(), others;
    join_at(edges, [&](auto first, auto last) { others.insert(others.end(), first, last); });
    cut_at_junctions(others, scene_.vertices());
    join_at(others, [](auto, auto) {});
  }

  std::uint32_t root(std::uint32_t piece) {
    while (parent_[piece] != piece) piece = parent_[piece] = parent_[parent_[piece]];
    return piece;
  }

 private:
  [[nodiscard]] std::vector<EdgeOfPiece> edges_of_pieces() const {
    std::vector<EdgeOfPiece> edges;
    for (std::uint32_t piece = 0; piece < parent_.size(); ++piece) {
      const auto corners = scene_.corners(scene_.pieces()[piece]);
      std::uint32_t from = places(scene_)[corners.back()];
      for (const std::uint32_t corner : corners) {
        const std::uint32_t to = places(scene_)[corner];
        edges.push_back({std::min(from, to), std::max(from, to), piece, from < to});
        from = to;
      }
    }
    return edges;
  }

  template <class TakeOthers>
  void join_at(std::vector<EdgeOfPiece>& edges, const TakeOthers& take_others) {
    for_each_edge(edges, [&](auto first, auto last) {
      if (last - first != 2 || balance_of(first, last) != 0) return take_others(first, last);
      parent_[root(first->piece)] = root((first + 1)->piece);
    });
  }

  const Scene& scene_;
  std::vector<std::uint32_t> parent_;  // by piece
};

}  // namespace

std::vector<std::uint32_t> oriented_surfaces(const Scene& scene) {
  Joiner joiner(scene);
  joiner.join();
  constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::vector<std::uint32_t> number(scene.pieces().size(), kNone), of_piece;
  std::uint32_t count = 0;
  for (std::uint32_t piece = 0; piece < number.size(); ++piece) {
    std::uint32_t& one = number[joiner.root(piece)];
    if (one == kNone) one = count++;
    of_piece.push_back(one);
  }
  return of_piece;
}

}  // namespace exactff::slips
