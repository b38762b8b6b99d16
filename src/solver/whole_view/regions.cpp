#include "whole_view/regions.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "exact/source_planes.h"
#include "kernel/poll.h"
#include "kernel/vec.h"

namespace exactff::whole_view {

using kernel::ExactVec3;
using kernel::Integer;

namespace {

Side reversed(const Side& side) { return {side.to, side.from, kernel::scaled(side.inward, -1.0), side.on_horizon}; }

}  // namespace

std::size_t Regions::Hash::operator()(const ExactVec3& v) const {
  std::size_t hash = 0;
  for (const Integer* c : {&v.x, &v.y, &v.z}) {
    const std::size_t limb = mpz_get_ui(c->get_mpz_t()) ^ static_cast<std::size_t>(sgn(*c) < 0);
    hash = (hash ^ limb) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 29U;
  }
  return hash;
}

Regions::Regions(ViewEdges& edges, const ExactVec3& up, const ThingOf& thing_of) {
  for (std::size_t i = 0; i < edges.parts().size(); ++i) {
    if (i % 256 == 0) kernel::poll();
    add_arc(edges, i, thing_of);
  }
  close_horizon(up);
  std::stable_sort(sides_.begin(), sides_.end(), [](const OfThing& a, const OfThing& b) {
    return std::tie(a.thing, a.side.from) < std::tie(b.thing, b.side.from);
  });
  for (auto first = sides_.begin(); first != sides_.end();) {
    const auto last =
        std::find_if(first, sides_.end(), [&](const OfThing& side) { return side.thing != first->thing; });
    trace({first, last});
    first = last;
  }
}

std::uint32_t Regions::corner_at(ExactVec3 direction) {
  make_primitive(direction);
  const auto [at, is_new] = corner_at_.try_emplace(direction, static_cast<std::uint32_t>(corners_.size()));
  if (is_new) corners_.push_back(kernel::make_direction(std::move(direction)));
  return at->second;
}

void Regions::add_arc(ViewEdges& edges, std::size_t arc, const ThingOf& thing_of) {
  const ViewEdges::Sides& sides = edges.sides()[arc];
  const std::uint32_t left = thing_of(sides.left), right = sides.right == kNothing ? kOpen : thing_of(sides.right);
  if (left == right) return;
  const visibility::BoundaryPiece piece = edges.exact(edges.parts()[arc]);
  const Side side{corner_at(piece.from()), corner_at(piece.to()), exact::rounded(cross(piece.b, piece.a)),
                  sides.on_horizon};
  sides_.push_back({left, side});
  if (sides.on_horizon) {
    horizon_.push_back(side);
  } else {
    sides_.push_back({right, reversed(side)});
  }
}

// The corners on the horizon in order, with above on the left, and four directions at right angles, so that every side
// is less than a half turn. Nothing covers the horizon between a corner where only a covered part ends and the next one
// where only a covered part begins.
void Regions::close_horizon(const ExactVec3& up) {
  const ExactVec3 axis = up.x == 0 ? ExactVec3{1, 0, 0} : up.y == 0 ? ExactVec3{0, 1, 0} : ExactVec3{0, 0, 1};
  std::array<ExactVec3, 4> quarter;
  quarter[0] = cross(up, axis);
  quarter[1] = cross(quarter[0], up);
  quarter[2] = ExactVec3{0, 0, 0} - quarter[0];
  quarter[3] = ExactVec3{0, 0, 0} - quarter[1];
  struct Point {
    std::uint32_t corner = 0;
    bool far = false;  // a half turn or more after the first one
    int begins = 0;    // parts that begin here less parts that end here
  };
  std::vector<Point> points;
  for (const ExactVec3& direction : quarter) points.push_back({corner_at(direction)});
  for (const Side& side : horizon_) {
    points.push_back({side.from, false, 1});
    points.push_back({side.to, false, -1});
  }
  const auto after = [&](const ExactVec3& p, const ExactVec3& q) { return sgn(dot(up, cross(q, p))); };  // q after p
  for (Point& point : points) {
    const ExactVec3& p = corners_[point.corner].exact;
    const int side = after(quarter[0], p);
    point.far = side < 0 || (side == 0 && sgn(dot(p, quarter[0])) < 0);
  }
  std::stable_sort(points.begin(), points.end(), [&](const Point& p, const Point& q) {
    if (p.far != q.far) return q.far;
    return after(corners_[p.corner].exact, corners_[q.corner].exact) > 0;
  });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].corner == points[kept].corner) {
      points[kept].begins += points[i].begins;
    } else {
      points[++kept] = points[i];
    }
  }
  points.resize(kept + 1);
  const auto gap = std::ranges::find_if(points, [](const Point& p) { return p.begins < 0; });
  if (gap == points.end() && !horizon_.empty()) return;  // all is covered
  const auto first = gap == points.end() ? std::size_t{0} : static_cast<std::size_t>(gap - points.begin());
  bool open = true;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point &here = points[(first + k) % points.size()], &next = points[(first + k + 1) % points.size()];
    open = here.begins < 0 || (open && here.begins == 0);
    if (open) sides_.push_back({kOpen, {here.corner, next.corner, exact::rounded(up), true}});
  }
}

// The sign of det(a, b, c): positive where c is clockwise of b around a, as seen from x.
int Regions::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const int filtered = kernel::sign_of_det(corners_[a].approx, corners_[b].approx, corners_[c].approx);
  return filtered != kernel::kUncertain ? filtered : kernel::orientation(corners_[a], corners_[b], corners_[c]);
}

// The sides are sorted by their beginnings.
Regions::OfThing* Regions::next_side(std::span<OfThing> sides, const Side& side, const OfThing& start) const {
  auto at = std::ranges::lower_bound(sides, side.to, {}, [](const OfThing& s) { return s.side.from; });
  const auto is_same_way = [&](const Side& s) {
    const ExactVec3& v = corners_[side.to].exact;
    return sgn(dot(cross(v, corners_[side.from].exact), cross(v, corners_[s.to].exact))) > 0;
  };
  // By the angle, clockwise, from the way back: less than a half turn, a half turn, more, the way back itself.
  const auto quadrant = [&](const Side& s) {
    const int sign = turn(side.to, side.from, s.to);
    return sign > 0 ? 0 : sign < 0 ? 2 : is_same_way(s) ? 3 : 1;
  };
  OfThing* best = nullptr;
  for (; at != sides.end() && at->side.from == side.to; ++at) {
    if (at->used && &*at != &start) continue;
    if (best != nullptr) {
      const int mine = quadrant(at->side), known = quadrant(best->side);
      if (mine > known || (mine == known && turn(side.to, at->side.to, best->side.to) <= 0)) continue;
    }
    best = &*at;
  }
  return best;
}

void Regions::trace(std::span<OfThing> sides) {
  Region region{sides.front().thing, {}};
  for (OfThing& start : sides) {
    if (start.used) continue;
    SideLoop loop;
    OfThing* at = &start;
    do {
      at->used = true;
      loop.push_back(at->side);
      at = next_side(sides, loop.back(), start);
      if (at == nullptr) throw std::logic_error("a region of the view has no closed boundary");
    } while (at != &start);
    region.loops.push_back(merged(loop));
  }
  regions_.push_back(std::move(region));
}

SideLoop Regions::merged(const SideLoop& loop) const {
  const auto goes_on = [&](std::size_t k) {
    const Side &a = loop[(k + loop.size() - 1) % loop.size()], &b = loop[k];
    return !a.on_horizon && kernel::dot(a.inward, b.inward) > 0.0 && turn(a.from, a.to, b.to) == 0;
  };
  std::size_t first = 0;  // the loop may begin in the middle of a side
  while (first < loop.size() && goes_on(first)) ++first;
  SideLoop result;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t k = (first + i) % loop.size();
    if (i > 0 && goes_on(k)) {
      result.back().to = loop[k].to;
    } else {
      result.push_back(loop[k]);
    }
  }
  return result;
}

}  // namespace exactff::whole_view
