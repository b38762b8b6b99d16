#include "view_factors/event_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vec.h"
#include "view_factors/polar_form.h"

namespace exactff::view_factors {
namespace {

using kernel::cross;
using kernel::dot;

constexpr double kInfinity = HUGE_VAL;
constexpr double kRoundings = 0x1p-34;  // of a coefficient of a polar form, eight times
constexpr double kMargin = 1.0 + 0x1p-20;

class EventBounds {
 public:
  EventBounds(const Points& points, const Cell& cell, const Vec3& centre)
      : points_(points), corners_(positions_of(cell.corners)), centre_(centre) {}

  [[nodiscard]] double largest_order(const CrossingTriple& t) const {
    const auto f = [&](const Vec3& x) { return dot(normal(t[0], x), cross(normal(t[1], x), normal(t[2], x))); };
    double largest = 0.0;
    for_each_coefficient(f, corners_, [&](double b) {
      largest = std::max(largest, std::abs(b));
      return true;
    });
    return largest + kRoundings;
  }

  [[nodiscard]] double largest_normal(LineId line) const {
    double largest = 0.0;
    for (const Vec3& corner : corners_) largest = std::max(largest, length(normal(line, corner)));
    return largest * kMargin;
  }

  [[nodiscard]] double least_cross(LineId g, LineId h) const {
    const Vec3 at_centre = cross(normal(g, centre_), normal(h, centre_));
    const double size = length(at_centre);
    if (!(size > 0.0)) return 0.0;
    const Vec3 direction = kernel::scaled(at_centre, 1.0 / size);
    double least = kInfinity;
    const auto component = [&](const Vec3& x) { return dot(cross(normal(g, x), normal(h, x)), direction); };
    for_each_coefficient(component, corners_, [&](double b) {
      least = std::min(least, b);
      return true;
    });
    return least / kMargin - kRoundings;
  }

 private:
  [[nodiscard]] Vec3 normal(LineId line, const Vec3& x) const {
    const Line& ends = points_.line(line);
    return cross(kernel::difference(points_[ends.a].at, x), kernel::difference(points_[ends.b].at, x));
  }

  const Points& points_;
  std::vector<Vec3> corners_;
  Vec3 centre_;
};

// The lengths of the triangle's sides, together.
double perimeter(const TriangleBounds& bounds) {
  if (!std::ranges::all_of(bounds.cross, [](double cross) { return cross > 0.0; })) return kInfinity;
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double denominator = bounds.cross[i] * bounds.cross[(i + 2) % 3];
    if (!(denominator > 0.0)) return kInfinity;
    const double sine = bounds.normal[i] * bounds.order / denominator;
    if (!(sine < 0.5)) return kInfinity;
    sum += std::asin(sine);
  }
  return sum * kMargin;
}

bool share_a_line(const std::vector<CrossingTriple>& triples) {
  std::vector<LineId> lines;
  for (const CrossingTriple& t : triples) lines.insert(lines.end(), t.begin(), t.end());
  std::ranges::sort(lines);
  return std::ranges::adjacent_find(lines) != lines.end();
}

}  // namespace

TriangleBounds triangle_bounds(const Points& points, const Cell& cell, const Vec3& centre,
                               const CrossingTriple& triple) {
  const EventBounds bounds(points, cell, centre);
  TriangleBounds result;
  result.order = bounds.largest_order(triple);
  for (std::size_t i = 0; i < 3; ++i) {
    result.normal[i] = bounds.largest_normal(triple[i]);
    result.cross[i] = bounds.least_cross(triple[i], triple[(i + 1) % 3]);
  }
  return result;
}

double event_bound(const Points& points, const Cell& cell, const Vec3& centre, std::vector<CrossingTriple> triples) {
  std::ranges::sort(triples);
  triples.erase(std::unique(triples.begin(), triples.end()), triples.end());
  const bool shared = share_a_line(triples);
  double sum = 0.0;
  for (const CrossingTriple& triple : triples) {
    const double sides = perimeter(triangle_bounds(points, cell, centre, triple));
    sum += shared ? sides / std::numbers::pi : sides * sides / (std::numbers::pi * std::numbers::pi);
  }
  return sum;
}

}  // namespace exactff::view_factors
