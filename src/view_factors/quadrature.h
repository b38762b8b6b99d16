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

// A point of a polygon: corner 0 + s * ((corner i - corner 0) + t * (corner i + 1 - corner i)).
struct Place {
  std::size_t i;
  double s, t;
};

// Integral over the polygon, cut into triangles at its first corner. Each is a square whose first side has collapsed.
// Calls f(x, place).
template <unsigned kCount, class Function>
double integral_over(const std::vector<Vec3>& ring, const Function& f) {
  double total = 0.0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const Vec3 b = kernel::difference(ring[i - 1], ring[0]), c = kernel::difference(ring[i], ring[i - 1]);
    const Vec3 n = kernel::cross(b, c);
    const double twice_area = std::sqrt(kernel::dot(n, n));
    double sum = 0.0;
    for (const Node& s : gauss_rule<kCount>()) {
      double row = 0.0;
      for (const Node& t : gauss_rule<kCount>()) {
        const Vec3 x{ring[0].x + s.x * (b.x + t.x * c.x), ring[0].y + s.x * (b.y + t.x * c.y),
                     ring[0].z + s.x * (b.z + t.x * c.z)};
        row += t.weight * f(x, Place{i - 1, s.x, t.x});
      }
      sum += s.weight * s.x * row;
    }
    total += twice_area * sum;
  }
  return total;
}

}  // namespace exactff::view_factors
