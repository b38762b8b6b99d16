#include "division/cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kernel/vec.h"

namespace exactff::division {
namespace {

constexpr double kStraight = 1e-6;  // the share of the area that a corner cuts off

struct Chord {
  std::size_t from = 0, to = 0;  // corners, from < to
  double squared_length = 0.0;
  double smaller_area = 0.0;
};

// A polygon around the origin, in a frame where its coordinates are at most 2.
class FlatPolygon {
 public:
  FlatPolygon(const Polygon& polygon, const CutPoints& points) {
    const Vec3& origin = points[polygon.front()];
    for (const std::uint32_t v : polygon) {
      extent_ = std::max(extent_, kernel::max_norm(kernel::difference(points[v], origin)));
    }
    extent_ = std::min(extent_, std::numeric_limits<double>::max());
    for (const std::uint32_t v : polygon) at_.push_back(difference_over(points[v], origin, extent_));
    Vec3 twice_area;
    for (std::size_t k = 0; k < size(); ++k) {
      twice_area = kernel::sum(twice_area, kernel::cross(at_[k], at_[(k + 1) % size()]));
    }
    normal_ = kernel::unit(twice_area);
    swept_.push_back(0.0);
    for (std::size_t k = 0; k + 1 < size(); ++k) swept_.push_back(swept_.back() + sweep(k, k + 1));
  }

  [[nodiscard]] std::size_t size() const { return at_.size(); }
  [[nodiscard]] double extent() const { return extent_; }  // the length of 1
  [[nodiscard]] double area() const { return part(0, size() - 1); }
  // Of the part from one corner to a later one.
  [[nodiscard]] double part(std::size_t from, std::size_t to) const {
    return swept_[to] - swept_[from] + sweep(to, from);
  }
  [[nodiscard]] Chord chord(std::size_t from, std::size_t to) const {
    const Vec3 d = kernel::difference(at_[to], at_[from]);
    const double beyond = part(from, to);
    return {from, to, kernel::dot(d, d), std::min(beyond, area() - beyond)};
  }
  [[nodiscard]] bool has_straight_corner() const {
    for (std::size_t k = 0; k < size(); ++k) {
      const Vec3& x = at_[k];
      const Vec3 a = kernel::difference(at_[(k + 1) % size()], x);
      const Vec3 b = kernel::difference(at_[(k + size() - 1) % size()], x);
      if (0.5 * kernel::dot(normal_, kernel::cross(a, b)) <= kStraight * area()) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] double sweep(std::size_t a, std::size_t b) const {
    return 0.5 * kernel::dot(normal_, kernel::cross(at_[a], at_[b]));
  }

  std::vector<Vec3> at_;
  double extent_ = 0.0;
  Vec3 normal_;
  std::vector<double> swept_;
};

template <class Visit>
void for_each_chord(const FlatPolygon& polygon, const Visit& visit) {
  const std::size_t n = polygon.size();
  for (std::size_t from = 0; from + 2 < n; ++from) {
    for (std::size_t to = from + 2; to < n; ++to) {
      if (from != 0 || to + 1 != n) visit(polygon.chord(from, to));
    }
  }
}

// Step 2. Where no chord leaves a quarter, the one that leaves the most.
Chord best_chord(const FlatPolygon& polygon) {
  constexpr double kLeast = 0.25 * (1.0 - kTolerance);
  const double least = kLeast * polygon.area();
  std::optional<double> shortest;
  for_each_chord(polygon, [&](const Chord& chord) {
    if (chord.smaller_area >= least && (!shortest || chord.squared_length < *shortest)) {
      shortest = chord.squared_length;
    }
  });
  std::optional<Chord> best;
  for_each_chord(polygon, [&](const Chord& chord) {
    if (shortest && (chord.smaller_area < least || chord.squared_length > *shortest * (1.0 + kTolerance))) return;
    if (!best || chord.smaller_area > best->smaller_area * (1.0 + kTolerance)) best = chord;
  });
  return *best;
}

class Cutter {
 public:
  Cutter(CutPoints& points, std::vector<Polygon>& cells) : points_(points), cells_(cells) {}

  void cut(const Polygon& polygon) {
    if (polygon.size() == 3) return cells_.push_back(polygon);
    const FlatPolygon flat(polygon, points_);
    const bool fits = is_cell(polygon, flat);
    if (fits && is_planar(points_, polygon)) return cells_.push_back(polygon);
    const Chord chord = best_chord(flat);
    const std::uint32_t a = polygon[chord.from], b = polygon[chord.to];
    const std::vector<std::uint32_t> between =
        fits || is_small(flat) ? std::vector<std::uint32_t>() : points_.between(a, b);
    Polygon left(polygon.begin() + static_cast<std::ptrdiff_t>(chord.to), polygon.end());
    left.insert(left.end(), polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(chord.from) + 1);
    left.insert(left.end(), between.begin(), between.end());
    Polygon right(polygon.begin() + static_cast<std::ptrdiff_t>(chord.from),
                  polygon.begin() + static_cast<std::ptrdiff_t>(chord.to) + 1);
    right.insert(right.end(), between.rbegin(), between.rend());
    cut(left);
    cut(right);
  }

 private:
  [[nodiscard]] bool is_cell(const Polygon& polygon, const FlatPolygon& flat) const {
    return (polygon.size() == 4 && !flat.has_straight_corner()) || !is_wide(polygon, points_);
  }
  // Its chords are not cut, so that cutting ends.
  [[nodiscard]] bool is_small(const FlatPolygon& flat) const {
    constexpr double kLeastShare = 1.0 / 64.0;
    const double length = points_.length() / flat.extent();
    return !(flat.area() > kLeastShare * length * length);
  }

  CutPoints& points_;
  std::vector<Polygon>& cells_;
};

}  // namespace

bool is_wide(std::span<const std::uint32_t> vertices, const CutPoints& points) {
  for (std::size_t a = 0; a < vertices.size(); ++a) {
    for (std::size_t b = a + 1; b < vertices.size(); ++b) {
      if (points.parts(vertices[a], vertices[b]) > 1) return true;
    }
  }
  return false;
}

void cut_into_cells(const Polygon& polygon, CutPoints& points, std::vector<Polygon>& cells) {
  Cutter(points, cells).cut(polygon);
}

}  // namespace exactff::division
