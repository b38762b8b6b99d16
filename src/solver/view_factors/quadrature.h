// Gauss-Legendre rules on convex polygons.
#pragma once

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <vector>

#include "exactff/geometry.h"
#include "kernel/vec.h"

namespace exactff::view_factors {

struct Node {
  double x, weight;
};

// The n-point rule on [0, 1].
template <unsigned kCount>
const std::array<Node, kCount>& gauss_rule() {
  static const std::array<Node, kCount> rule = [] {
    using Rule = boost::math::quadrature::gauss<double, kCount>;
    std::array<Node, kCount> nodes{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
      const double x = Rule::abscissa()[i], weight = 0.5 * Rule::weights()[i];
      nodes[at++] = {0.5 + 0.5 * x, weight};
      if (x != 0.0) nodes[at++] = {0.5 - 0.5 * x, weight};
    }
    return nodes;
  }();
  return rule;
}

// A point of the quadrilateral of the corners 0, i, i + 1 and i + 2, or 0 again where there is no corner i + 2:
//   between(between(corner 0, corner i, s), between(the last corner, corner i + 1, s), t).
struct CellPlace {
  std::size_t i;
  double s, t;
};

struct WeightedPlace {
  Vec3 at;
  double weight;  // the rule's times the area of the map
  CellPlace place;
};

// The rule for integrals over the convex polygon, which is cut into quadrilaterals, and perhaps a triangle, at its
// first corner. Each is the image of a square, whose first side collapses for a triangle.
template <unsigned kCount>
std::vector<WeightedPlace> gauss_places(const std::vector<Vec3>& ring) {
  std::vector<WeightedPlace> places;
  places.reserve(kCount * kCount * (ring.size() / 2));
  for (std::size_t i = 1; i + 1 < ring.size(); i += 2) {
    const Vec3& a = ring[0];
    const Vec3& last = i + 2 < ring.size() ? ring[i + 2] : a;
    const Vec3 b = kernel::difference(ring[i], a), d = kernel::difference(last, a);
    const Vec3 twist = kernel::difference(kernel::difference(ring[i + 1], last), b);
    for (const Node& s : gauss_rule<kCount>()) {
      const Vec3 along_t{d.x + s.x * twist.x, d.y + s.x * twist.y, d.z + s.x * twist.z};
      for (const Node& t : gauss_rule<kCount>()) {
        const Vec3 along_s{b.x + t.x * twist.x, b.y + t.x * twist.y, b.z + t.x * twist.z};
        const Vec3 normal = kernel::cross(along_s, along_t);
        const Vec3 x{a.x + s.x * b.x + t.x * along_t.x, a.y + s.x * b.y + t.x * along_t.y,
                     a.z + s.x * b.z + t.x * along_t.z};
        places.push_back({x, s.weight * t.weight * kernel::length(normal), {i, s.x, t.x}});
      }
    }
  }
  return places;
}

}  // namespace exactff::view_factors
