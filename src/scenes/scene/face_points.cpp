#include "scene/face_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace exactff {

using kernel::bit_length;
using kernel::cross;
using kernel::dot;
using kernel::ExactVec3;
using kernel::Integer;
using kernel::is_zero;
using kernel::ScaledVec3;

namespace {

constexpr long kLargestExponent = 1000;  // of a Newell vector that is not scaled
constexpr long kSmallestExponent = -900;

// a * 2^-shift, truncated to a double; the error is below 2^-52 where |a| < 2^shift.
double scaled(const Integer& a, long shift) {
  long exponent = 0;
  const double mantissa = mpz_get_d_2exp(&exponent, a.get_mpz_t());
  return std::ldexp(mantissa, static_cast<int>(std::max<long>(exponent - shift, -2000)));
}

long lowest_exponent(const std::vector<ScaledVec3>& vectors) {
  long exponent = std::numeric_limits<long>::max();
  for (const ScaledVec3& v : vectors) {
    if (!is_zero(v.v)) exponent = std::min(exponent, v.exponent);
  }
  return exponent == std::numeric_limits<long>::max() ? 0 : exponent;
}

}  // namespace

FacePoints face_points(std::span<const Vec3> vertices, const std::vector<std::vector<std::uint32_t>>& rings) {
  FacePoints points;
  for (const auto& ring : rings) {
    points.ring_start.push_back(points.vertex.size());
    points.vertex.insert(points.vertex.end(), ring.begin(), ring.end());
  }
  points.ring_start.push_back(points.vertex.size());
  std::vector<ScaledVec3> differences;
  differences.reserve(points.vertex.size());
  for (const std::uint32_t v : points.vertex) {
    differences.push_back(kernel::exact_difference(vertices[v], vertices[points.vertex.front()]));
  }
  points.exponent = lowest_exponent(differences);
  points.at.reserve(differences.size());
  for (ScaledVec3& difference : differences) {
    if (!is_zero(difference.v)) kernel::lower_exponent(difference, points.exponent);
    points.at.push_back(std::move(difference.v));
  }
  return points;
}

std::size_t next_in_ring(const FacePoints& points, std::size_t point) {
  const auto end = std::upper_bound(points.ring_start.begin(), points.ring_start.end(), point);
  return point + 1 < *end ? point + 1 : *(end - 1);
}

ExactVec3 newell(const FacePoints& points, std::size_t first, std::size_t last) {
  ExactVec3 sum;
  for (std::size_t i = first; i < last; ++i) {
    sum = sum + cross(points.at[i], points.at[i + 1 < last ? i + 1 : first]);
  }
  return sum;
}

ExactVec3 newell(const FacePoints& points, std::span<const std::size_t> polygon) {
  ExactVec3 sum;
  const ExactVec3& base = points.at[polygon[0]];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum = sum + cross(points.at[polygon[i]] - base, points.at[polygon[i + 1]] - base);
  }
  return sum;
}

ExactVec3 some_normal(const FacePoints& points) {
  const auto differs = [](const ExactVec3& p) { return !is_zero(p); };
  const auto second = std::find_if(points.at.begin(), points.at.end(), differs);  // the first point is zero
  if (second == points.at.end()) return {};
  for (auto third = second + 1; third != points.at.end(); ++third) {
    ExactVec3 normal = cross(*second, *third);
    if (!is_zero(normal)) return normal;
  }
  return {};
}

bool all_in_plane(const FacePoints& points, const ExactVec3& normal) {
  return std::all_of(points.at.begin(), points.at.end(),
                     [&](const ExactVec3& p) { return kernel::sign(dot(normal, p)) == 0; });
}

Vec3 nearest_vector(const ExactVec3& v, long exponent) {
  if (is_zero(v)) return {};
  const long top = bit_length(v) + exponent;
  if (top > kLargestExponent || top <= kSmallestExponent) exponent -= top;
  return {kernel::nearest_double(v.x, exponent), kernel::nearest_double(v.y, exponent),
          kernel::nearest_double(v.z, exponent)};
}

Length length(const ExactVec3& v) {
  const long exponent = bit_length(v);
  return {std::hypot(scaled(v.x, exponent), scaled(v.y, exponent), scaled(v.z, exponent)), exponent};
}

Length operator+(const Length& a, const Length& b) {
  if (a.mantissa == 0.0) return b;
  if (b.mantissa == 0.0) return a;
  if (a.exponent < b.exponent) return b + a;
  const auto shift = static_cast<int>(std::max<long>(b.exponent - a.exponent, -2000));
  return {a.mantissa + std::ldexp(b.mantissa, shift), a.exponent};
}

double ratio(const Length& a, const Length& b) {
  return std::ldexp(a.mantissa / b.mantissa, static_cast<int>(a.exponent - b.exponent));
}

double to_double(const Length& a) {
  if (a.mantissa == 0.0) return 0.0;
  const double value = std::ldexp(a.mantissa, static_cast<int>(a.exponent));
  return std::clamp(value, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max());
}

namespace {

// Index and distance of the point farthest from the given one.
std::pair<std::size_t, double> farthest(const std::vector<Vec3>& points, std::size_t from) {
  std::pair<std::size_t, double> best{from, 0.0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 &p = points[i], &q = points[from];
    const double distance = std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
    if (distance > best.second) best = {i, distance};
  }
  return best;
}

// Goes from each of a few points to the farthest one, and on from there. This gives the true diameter except for
// contrived faces.
double diameter(const std::vector<Vec3>& points) {
  constexpr std::size_t kStarts = 64;
  double best = 0.0;
  for (std::size_t start = 0; start < std::min(points.size(), kStarts); ++start) {
    best = std::max(best, farthest(points, farthest(points, start).first).second);
  }
  return best;
}

}  // namespace

double out_of_plane(const FacePoints& points, const ExactVec3& normal) {
  std::vector<Integer> heights;  // times |normal|
  Integer sum = 0;
  for (const ExactVec3& p : points.at) {
    heights.push_back(dot(normal, p));
    sum += heights.back();
  }
  const Integer count = points.size();
  Integer largest = 0;  // times |normal| * count
  for (const Integer& height : heights) largest = std::max<Integer>(largest, abs(height * count - sum));

  long size = 0;
  for (const ExactVec3& p : points.at) size = std::max(size, bit_length(p));
  std::vector<Vec3> rounded;
  for (const ExactVec3& p : points.at) rounded.push_back({scaled(p.x, size), scaled(p.y, size), scaled(p.z, size)});
  const Length deviation = length({largest, 0, 0});
  const Length unit = length(normal);
  return ratio(deviation,
               {unit.mantissa * static_cast<double>(points.size()) * diameter(rounded), unit.exponent + size});
}

PlanePoints::PlanePoints(const FacePoints& points, const ExactVec3& normal, Projection projection) {
  const int drop = longest_axis(normal);
  int u = (drop + 1) % 3;
  int v = (drop + 2) % 3;
  if (kernel::sign(normal[drop]) < 0) std::swap(u, v);
  // Slide each point along the normal into the coordinate plane; the factor |normal[drop]| keeps integers.
  const Integer scale = abs(normal[drop]);
  const Integer slope_u = kernel::sign(normal[drop]) * normal[u];
  const Integer slope_v = kernel::sign(normal[drop]) * normal[v];
  for (const ExactVec3& p : points.at) {
    const bool slide = projection == Projection::kAlongNormal;
    x_.push_back(slide ? Integer(p[u] * scale - p[drop] * slope_u) : p[u]);
    y_.push_back(slide ? Integer(p[v] * scale - p[drop] * slope_v) : p[v]);
  }
  approximate();
}

void PlanePoints::approximate() {
  long size = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) size = std::max({size, bit_length(x_[i]), bit_length(y_[i])});
  for (std::size_t i = 0; i < x_.size(); ++i) {
    near_x_.push_back(scaled(x_[i], size));
    near_y_.push_back(scaled(y_[i], size));
  }
}

int PlanePoints::orientation(std::size_t a, std::size_t b, std::size_t c) const {
  const double near =
      (near_x_[b] - near_x_[a]) * (near_y_[c] - near_y_[a]) - (near_y_[b] - near_y_[a]) * (near_x_[c] - near_x_[a]);
  if (near > kOrientationError) return 1;
  if (near < -kOrientationError) return -1;
  const Integer exact = (x_[b] - x_[a]) * (y_[c] - y_[a]) - (y_[b] - y_[a]) * (x_[c] - x_[a]);
  return kernel::sign(exact);
}

int PlanePoints::compare(std::size_t a, std::size_t b) const {
  const int by_x = cmp(x_[a], x_[b]);
  const int order = by_x != 0 ? by_x : cmp(y_[a], y_[b]);
  return order < 0 ? -1 : order > 0 ? 1 : 0;
}

}  // namespace exactff
