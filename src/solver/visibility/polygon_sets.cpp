#include "visibility/polygon_sets.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_set_2.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/convex_hull_2.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <list>
#include <memory>

namespace exactff::visibility {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::Ring;
using kernel::sign;

// --- Plane frame ---

PlaneFrame::PlaneFrame(const ExactVec3& front, std::span<const Ring> rings) : m_(front), k_(longest_axis(front)) {
  kernel::negate(m_);
  i_ = (k_ + 1) % 3;
  j_ = (k_ + 2) % 3;
  keeps_orientation_ = sign(front[k_]) > 0;

  Point2 high;
  bool first = true;
  for (const Ring& ring : rings) {
    for (const kernel::Direction& corner : ring) {
      const Point2 point = affine(corner.exact);
      low_ = first ? point : Point2{std::min(low_.u, point.u), std::min(low_.v, point.v)};
      high = first ? point : Point2{std::max(high.u, point.u), std::max(high.v, point.v)};
      first = false;
    }
  }
  size_ = {high.u - low_.u, high.v - low_.v};
}

Point2 PlaneFrame::affine(const ExactVec3& t) const {
  const Integer depth = dot(m_, t);
  return {kernel::ratio(t[i_], depth), kernel::ratio(t[j_], depth)};
}

Point2 PlaneFrame::to_plane(const ExactVec3& direction) const {
  const Point2 point = affine(direction);
  return {(point.u - low_.u) / size_.u, (point.v - low_.v) / size_.v};
}

ExactVec3 PlaneFrame::to_direction(const Point2& point) const {
  const Rational p = low_.u + point.u * size_.u;
  const Rational q = low_.v + point.v * size_.v;
  const Rational r = (1 - m_[i_] * p - m_[j_] * q) / m_[k_];
  Integer denominator;
  mpz_lcm(denominator.get_mpz_t(), p.get_den_mpz_t(), q.get_den_mpz_t());
  mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), r.get_den_mpz_t());
  const auto scaled = [&](const Rational& a) -> Integer { return a.get_num() * (denominator / a.get_den()); };
  ExactVec3 direction;
  Integer* const components[] = {&direction.x, &direction.y, &direction.z};
  *components[i_] = scaled(p);
  *components[j_] = scaled(q);
  *components[k_] = scaled(r);
  return direction;
}

Polygon2 PlaneFrame::to_polygon(const Ring& ring) const {
  Polygon2 polygon;
  polygon.reserve(ring.size());
  for (const kernel::Direction& corner : ring) polygon.push_back(to_plane(corner.exact));
  if (!keeps_orientation_) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

Rational doubled_area(const Polygon2& polygon) {
  Rational sum;
  for (std::size_t a = 0; a < polygon.size(); ++a) {
    const Point2& p = polygon[a];
    const Point2& q = polygon[(a + 1) % polygon.size()];
    sum += p.u * q.v - p.v * q.u;
  }
  return sum;
}

// --- Polygon sets ---

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_2;
using Polygon = CGAL::Polygon_2<Kernel>;
using PolygonWithHoles = CGAL::Polygon_with_holes_2<Kernel>;
using PolygonSet = CGAL::Polygon_set_2<Kernel>;

static_assert(std::is_same_v<Kernel::Exact_kernel::FT, kernel::Rational>,
              "CGAL's exact number and ours must be one type, so that nothing is converted");

// Explicit rationals: the lazy kernel starts from evaluated numbers, so its expression trees stay shallow.
Point to_point(const Point2& p) { return {Kernel::FT(p.u), Kernel::FT(p.v)}; }
Point2 from_point(const Point& p) { return {p.x().exact(), p.y().exact()}; }

Polygon to_polygon(const Polygon2& polygon) {
  Polygon result;
  for (const Point2& corner : polygon) result.push_back(to_point(corner));
  return result;
}

// If memory ends in the middle of an operation, CGAL leaves a set whose destructor may crash or not end. Such a set is
// leaked.
class SafeSet {
 public:
  SafeSet() = default;
  SafeSet(const SafeSet&) = delete;
  SafeSet& operator=(const SafeSet&) = delete;
  ~SafeSet() {
    if (std::uncaught_exceptions() > exceptions_before_) static_cast<void>(set_.release());
  }

  PolygonSet* operator->() { return set_.get(); }
  PolygonSet& operator*() { return *set_; }

 private:
  int exceptions_before_ = std::uncaught_exceptions();
  std::unique_ptr<PolygonSet> set_ = std::make_unique<PolygonSet>();
};

void join_into(SafeSet& set, std::span<const Polygon2> polygons) {
  if (polygons.size() == 1) return set->insert(to_polygon(polygons.front()));
  std::vector<Polygon> converted;
  converted.reserve(polygons.size());
  for (const Polygon2& polygon : polygons) converted.push_back(to_polygon(polygon));
  set->join(converted.begin(), converted.end());
}

// Collinear corners are dropped here: pieces of one edge become one again.
RegionLoop to_loop(const Polygon& polygon, bool hole) {
  RegionLoop loop{{}, hole};
  std::vector<Point> kept;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point& before = kept.empty() ? polygon.vertex(n - 1) : kept.back();
    if (!CGAL::collinear(before, polygon.vertex(i), polygon.vertex((i + 1) % n))) kept.push_back(polygon.vertex(i));
  }
  loop.corners.reserve(kept.size());
  for (const Point& p : kept) loop.corners.push_back(from_point(p));
  return loop;
}

std::vector<RegionLoop> loops_of(const PolygonSet& set) {
  std::vector<PolygonWithHoles> parts;
  set.polygons_with_holes(std::back_inserter(parts));
  std::vector<RegionLoop> loops;
  for (const PolygonWithHoles& part : parts) {
    loops.push_back(to_loop(part.outer_boundary(), false));
    for (auto hole = part.holes_begin(); hole != part.holes_end(); ++hole) loops.push_back(to_loop(*hole, true));
  }
  return loops;
}

}  // namespace

std::vector<RegionLoop> join(std::span<const Polygon2> polygons) {
  SafeSet set;
  join_into(set, polygons);
  return loops_of(*set);
}

std::vector<RegionLoop> difference(std::span<const Polygon2> source, std::span<const Polygon2> occluders) {
  SafeSet visible, hidden;
  join_into(visible, source);
  join_into(hidden, occluders);
  visible->difference(*hidden);
  return loops_of(*visible);
}

Polygon2 convex_hull(std::span<const Polygon2> polygons) {
  std::vector<Point> points;
  for (const Polygon2& polygon : polygons) {
    for (const Point2& corner : polygon) points.push_back(to_point(corner));
  }
  std::vector<Point> hull;
  CGAL::convex_hull_2(points.begin(), points.end(), std::back_inserter(hull));
  Polygon2 result;
  for (const Point& p : hull) result.push_back(from_point(p));
  return result;
}

kernel::Rational doubled_area(std::span<const RegionLoop> loops) {
  kernel::Rational sum;
  for (const RegionLoop& loop : loops) sum += doubled_area(loop.corners);
  return sum;
}

}  // namespace exactff::visibility
