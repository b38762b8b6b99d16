#include "receivers/face_plane.h"

#include <utility>

#include "kernel/expect.h"

namespace exactff {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::sign;

Rational quotient(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

FacePlane::FacePlane(const Scene& scene, FaceId id)
    : FacePlane(face_points(scene.vertices(), scene.face(id).rings),
                scene.vertices()[scene.face(id).rings.front().front()]) {}

FacePlane::FacePlane(FacePoints points, const Vec3& first_corner)
    : points_(std::move(points)), first_corner_(first_corner), normal_(newell(points_, 0, points_.ring_start[1])) {
  EXACTFF_EXPECT(!kernel::is_zero(normal_));
  kernel::make_primitive(normal_);
}

bool FacePlane::is_convex() const {
  const std::size_t n = points_.size();
  if (points_.ring_count() != 1) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const ExactVec3 &p = points_.at[i], &q = points_.at[(i + 1) % n], &r = points_.at[(i + 2) % n];
    if (sign(dot(normal_, cross(q - p, r - q))) <= 0) return false;
  }
  return true;
}

Vec3 FacePlane::rounded(const std::array<Rational, 3>& offset) const {
  const auto at = [&](double origin, const Rational& along) {
    return kernel::nearest_double(kernel::to_rational(origin) + kernel::times_power_of_two(along, points_.exponent));
  };
  return {at(first_corner_.x, offset[0]), at(first_corner_.y, offset[1]), at(first_corner_.z, offset[2])};
}

namespace {

ExactVec3 first_edge(const FacePlane& plane) {
  const FacePoints& points = plane.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    ExactVec3 edge = points.at[i] - points.at[i - 1];
    if (!kernel::is_zero(cross(edge, plane.normal()))) return edge;
  }
  return points.at[1] - points.at[0];
}

}  // namespace

FaceFrame::FaceFrame(const FacePlane& plane) : plane_(plane) {
  const ExactVec3& n = plane.normal();
  const ExactVec3 edge = first_edge(plane);
  e_ = edge * dot(n, n) - n * dot(n, edge);
  kernel::make_primitive(e_);
  f_ = cross(n, e_);
  kernel::make_primitive(f_);
  for (const ExactVec3& p : plane.points().at) {
    a_.push_back(dot(e_, p));
    b_.push_back(dot(f_, p));
  }
}

bool FaceFrame::strictly_inside(const Coordinate& a, const Coordinate& b) const {
  bool inside = false;
  for (std::size_t i = 0; i < plane_.points().size(); ++i) {
    const int crossing = crosses(i, a, b);
    if (crossing < 0) return false;
    if (crossing > 0) inside = !inside;
  }
  return inside;
}

// 1 if the ray from (a, b) towards larger a crosses the edge from corner i, 0 if not, -1 if (a, b) lies on the edge. An
// edge includes its lower end and excludes its upper end, so that a ray through a corner gets the correct parity.
int FaceFrame::crosses(std::size_t i, const Coordinate& a, const Coordinate& b) const {
  const std::size_t j = next_in_ring(plane_.points(), i);
  const Integer ai = a_[i] * a.denominator - a.numerator, bi = b_[i] * b.denominator - b.numerator;
  const Integer aj = a_[j] * a.denominator - a.numerator, bj = b_[j] * b.denominator - b.numerator;
  const int side = sign(Integer(ai * bj - aj * bi));  // positive: the point is left of the edge
  const int bi_sign = sign(bi), bj_sign = sign(bj);
  if (side == 0 && bi_sign * bj_sign <= 0 && sign(ai) * sign(aj) <= 0) return -1;
  if ((bi_sign > 0) == (bj_sign > 0)) return 0;
  return (bj_sign > 0) == (side > 0) ? 1 : 0;
}

}  // namespace exactff
