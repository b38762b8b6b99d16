#include "visibility/plane_frame.h"

#include <algorithm>

namespace exactff::visibility {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::Ring;
using kernel::sign;

namespace {

Rational ratio(const Integer& numerator, const Integer& denominator) {
  Rational result(numerator, denominator);
  result.canonicalize();
  return result;
}

}  // namespace

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
  return {ratio(t[i_], depth), ratio(t[j_], depth)};
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

}  // namespace exactff::visibility
