#include "view_factors/polygons.h"

#include <algorithm>

namespace exactff::view_factors {

PointId Points::add(Point point) {
  own_.push_back(std::move(point));
  return refer_to(own_.back());
}

PointId Points::refer_to(const Point& point) {
  points_.push_back(&point);
  return static_cast<PointId>(points_.size() - 1);
}

Edge Points::edge(PointId from, PointId to) {
  const auto [place, is_new] = line_of_.try_emplace(std::minmax(from, to), static_cast<LineId>(lines_.size()));
  if (is_new) lines_.push_back({from, to});
  return {from, to, place->second, lines_[place->second].a == from};
}

Ring Points::ring(const std::vector<PointId>& corners) {
  Ring result;
  for (std::size_t i = 0; i < corners.size(); ++i)
    result.push_back(edge(corners[i], corners[(i + 1) % corners.size()]));
  return result;
}

Plane Points::plane_of(const Ring& ring) const {
  return make_plane(join((*this)[ring[0].from], (*this)[ring[1].from], (*this)[ring[2].from]), units_);
}

PointId Points::crossing(const Edge& edge, const Plane& plane, std::uint32_t name) {
  const auto [place, is_new] = crossing_of_.try_emplace({edge.line, name}, static_cast<PointId>(points_.size()));
  if (is_new) {
    const auto height = [&](PointId id) {
      Integer sum;
      for (std::size_t i = 0; i < 4; ++i) sum += plane.exact[i] * points_[id]->exact[i];
      return sum;
    };
    const Line& line = lines_[edge.line];
    const Integer a = height(line.a), b = height(line.b);
    Homogeneous point;
    for (std::size_t i = 0; i < 4; ++i) point[i] = points_[line.a]->exact[i] * b - points_[line.b]->exact[i] * a;
    add(make_point(std::move(point), units_));
  }
  return place->second;
}

Ring Points::clip(const Ring& ring, const Plane& plane, std::uint32_t name) {
  std::vector<int> sides;
  for (const Edge& e : ring) sides.push_back(side_of(plane, *points_[e.from]));
  if (std::ranges::all_of(sides, [](int s) { return s >= 0; })) {
    return std::ranges::any_of(sides, [](int s) { return s > 0; }) ? ring : Ring{};
  }
  if (std::ranges::all_of(sides, [](int s) { return s <= 0; })) return {};
  // What stays of every edge, in order. One gap is left, along the plane.
  Ring result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const int from = sides[i], to = sides[(i + 1) % ring.size()];
    if (from <= 0 && to <= 0) continue;
    Edge kept = ring[i];
    if (from < 0) kept.from = crossing(ring[i], plane, name);
    if (to < 0) kept.to = crossing(ring[i], plane, name);
    result.push_back(kept);
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Edge& next = result[(i + 1) % result.size()];
    if (result[i].to == next.from) continue;
    result.insert(result.begin() + static_cast<std::ptrdiff_t>(i) + 1, edge(result[i].to, next.from));
    break;
  }
  return result;
}

void Points::complete() {
  line_of_.clear();
  crossing_of_.clear();
  points_.shrink_to_fit();
  lines_.shrink_to_fit();
}

}  // namespace exactff::view_factors
