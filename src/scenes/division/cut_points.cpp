#include "division/cut_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "kernel/rational_vec.h"
#include "kernel/vec.h"

namespace exactff::division {
namespace {

using kernel::Rational;
using kernel::RationalVec3;

bool comes_before(const Vec3& a, const Vec3& b) { return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z); }

// Scaled so that the square is about 1. Positive unless the square is 0.
double root_of(const Rational& square) {
  if (kernel::sign(square) == 0) return 0.0;
  const long exponent = (kernel::bit_length(square.get_num()) - kernel::bit_length(square.get_den())) / 2;
  const double root = std::sqrt(kernel::nearest_double(kernel::times_power_of_two(square, -2 * exponent)));
  return std::max(std::ldexp(root, static_cast<int>(exponent)), std::numeric_limits<double>::denorm_min());
}

RationalVec3 point_of_segment(const Vec3& p, const Vec3& q, std::size_t k, std::size_t n) {
  const RationalVec3 from = kernel::to_rational(p);
  Rational share(static_cast<unsigned long>(k), static_cast<unsigned long>(n));
  share.canonicalize();
  return from + (kernel::to_rational(q) - from) * share;
}

Vec3 nearest(const RationalVec3& a) {
  return {kernel::nearest_double(a.x), kernel::nearest_double(a.y), kernel::nearest_double(a.z)};
}

}  // namespace

Vec3 difference_over(const Vec3& to, const Vec3& from, double length) {
  const auto quotient = [length](double a, double b) {
    const double difference = a - b;
    return std::isfinite(difference) ? difference / length : (0.5 * a - 0.5 * b) / (0.5 * length);
  };
  return {quotient(to.x, from.x), quotient(to.y, from.y), quotient(to.z, from.z)};
}

std::size_t CutPoints::parts(std::uint32_t a, std::uint32_t b) const {
  const double ratio = kernel::distance(difference_over(vertices_[b], vertices_[a], length_), {});
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(ratio * (1.0 - kTolerance))));
}

std::vector<std::uint32_t> CutPoints::between(std::uint32_t a, std::uint32_t b) {
  const bool turned = comes_before(vertices_[b], vertices_[a]);
  const Vec3 p = vertices_[turned ? b : a], q = vertices_[turned ? a : b];
  const std::size_t n = parts(a, b);
  std::vector<std::uint32_t> made;
  for (std::size_t k = 1; k < n; ++k) {
    const RationalVec3 exact = point_of_segment(p, q, k, n);
    const Vec3 rounded = nearest(exact);
    const RationalVec3 off = kernel::to_rational(rounded) - exact;
    largest_displacement_ = std::max(largest_displacement_, root_of(dot(off, off)));
    made.push_back(static_cast<std::uint32_t>(vertices_.size()));
    vertices_.push_back(rounded);
  }
  if (turned) std::ranges::reverse(made);
  return made;
}

double distance_from_plane(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const RationalVec3 origin = kernel::to_rational(a);
  const RationalVec3 normal = cross(kernel::to_rational(b) - origin, kernel::to_rational(c) - origin);
  const Rational height = dot(normal, kernel::to_rational(x) - origin);
  return root_of(height * height / dot(normal, normal));
}

bool is_planar(const CutPoints& points, std::span<const std::uint32_t> polygon) {
  const Vec3& a = points[polygon[0]];
  std::size_t c = 2;
  const auto straight = [&](std::size_t third) {
    return is_zero(cross(kernel::exact_difference(points[polygon[1]], a).v,
                         kernel::exact_difference(points[polygon[third]], a).v));
  };
  while (c < polygon.size() && straight(c)) ++c;
  for (std::size_t d = c + 1; d < polygon.size(); ++d) {
    if (kernel::orientation(a, points[polygon[1]], points[polygon[c]], points[polygon[d]]) != 0) return false;
  }
  return true;
}

}  // namespace exactff::division
