#include "view_factors/crossing_order.h"

#include <array>
#include <cmath>

#include "kernel/vec.h"

namespace exactff::view_factors {
namespace {

using Exact3 = std::array<Integer, 3>;

constexpr double kError = 0x1p-50;  // e of the header
constexpr double kUnderflow = 0x1p-1000;
constexpr double kOfTheBound = 1.0 + 0x1p-40;  // more than its roundings

// Times the product of both last coordinates.
Exact3 difference(const Homogeneous& a, const Homogeneous& b) {
  Exact3 result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] * b[3] - b[i] * a[3];
  return result;
}
Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Integer dot(const Exact3& a, const Exact3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Bounded {
  double value = 0.0, error = 0.0;
};

// f in doubles, with the bound of the header, and in integers.
struct Rounded {
  struct Edge {
    Vec3 a, along;
    double length;  // L
  };
  std::array<Edge, 3> edges;

  [[nodiscard]] Bounded at(const Vec3& x) const {
    std::array<Vec3, 3> n;
    std::array<double, 3> r{}, s{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 d = kernel::difference(edges[i].a, x);
      const double size = kernel::max_norm(d) + kError;  // A
      n[i] = kernel::cross(d, edges[i].along);
      r[i] = 4.0 * kError * (size + edges[i].length);
      s[i] = 2.0 * size * edges[i].length + r[i];
    }
    const double inherited = r[0] * s[1] * s[2] + s[0] * r[1] * s[2] + s[0] * s[1] * r[2];
    return {kernel::dot(n[0], kernel::cross(n[1], n[2])), 6.0 * (inherited + 2.0 * kError * s[0] * s[1] * s[2])};
  }
};
struct Exact {
  std::array<const Homogeneous*, 6> ends{};

  // Times the sixth power of the last coordinate of x, and a factor that does not depend on x.
  [[nodiscard]] Integer at(const Homogeneous& x) const {
    const auto normal = [&](std::size_t i) { return cross(difference(*ends[i], x), difference(*ends[i + 1], x)); };
    return dot(normal(0), cross(normal(2), normal(4)));
  }
};

// The common sign of numbers of which some may be 0, told one by one.
class CommonSign {
 public:
  // False once there are two signs.
  bool take(int sign) {
    if (sign == 0 || sign == found_) return true;
    if (found_ != 0) mixed_ = true;
    found_ = sign;
    return !mixed_;
  }
  [[nodiscard]] int sign() const { return mixed_ ? kMixed : found_; }

 private:
  int found_ = 0;
  bool mixed_ = false;
};

// The signs of the coefficients b(c_i, c_j) of f's polar form: by the filter, exactly where this declines.
class PolarSigns {
 public:
  PolarSigns(const std::array<const Point*, 6>& ends, const Cell& cell) : ends_(ends), cell_(cell) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 along = kernel::difference(ends[2 * i + 1]->at, ends[2 * i]->at);
      rounded_.edges[i] = {ends[2 * i]->at, along, kernel::max_norm(along) + kError};
    }
    for (const Point& corner : cell.corners) at_corners_.push_back(rounded_.at(corner.at));
  }

  [[nodiscard]] int sign(std::size_t i, std::size_t j) const {
    const Bounded b = estimate(i, j);
    if (std::abs(b.value) > b.error * kOfTheBound + kUnderflow) return b.value > 0.0 ? 1 : -1;
    return sgn(exact(i, j));
  }

 private:
  [[nodiscard]] Bounded estimate(std::size_t i, std::size_t j) const {
    const Bounded &at_y = at_corners_[i], &at_z = at_corners_[j];
    if (i == j) return at_y;
    const Vec3 &y = cell_.corners[i].at, &z = cell_.corners[j].at;
    const Bounded middle = rounded_.at({0.5 * (y.x + z.x), 0.5 * (y.y + z.y), 0.5 * (y.z + z.z)});
    return {2.0 * middle.value - 0.5 * (at_y.value + at_z.value), 2.0 * middle.error + 0.5 * (at_y.error + at_z.error)};
  }

  // Of the same sign. With w the last coordinate of both corners, that of their middle is 2 w, and the polar form is a
  // positive multiple of 2 f(middle) / 2^6 - (f(y) + f(z)) / 2.
  [[nodiscard]] Integer exact(std::size_t i, std::size_t j) const {
    Exact f;
    for (std::size_t k = 0; k < 6; ++k) f.ends[k] = &ends_[k]->exact;
    const Homogeneous &y = cell_.corners[i].exact, &z = cell_.corners[j].exact;
    if (i == j) return f.at(y);
    Homogeneous wide_y, wide_z, middle;
    for (std::size_t k = 0; k < 4; ++k) {
      wide_y[k] = y[k] * z[3];
      wide_z[k] = z[k] * y[3];
      middle[k] = wide_y[k] + wide_z[k];
    }
    return f.at(middle) - 16 * (f.at(wide_y) + f.at(wide_z));
  }

  const std::array<const Point*, 6>& ends_;
  const Cell& cell_;
  Rounded rounded_;
  std::vector<Bounded> at_corners_;
};

}  // namespace

int crossing_order(const Points& points, const Cell& cell, LineId e, LineId g, LineId h) {
  std::array<const Point*, 6> ends{};
  std::size_t count = 0;
  for (const LineId line : {e, g, h}) {
    for (const PointId id : {points.line(line).a, points.line(line).b}) ends[count++] = &points[id];
  }
  const PolarSigns signs(ends, cell);
  CommonSign common;
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    if (!common.take(signs.sign(i, i))) return kMixed;
  }
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    for (std::size_t j = i + 1; j < cell.corners.size(); ++j) {
      if (!common.take(signs.sign(i, j))) return kMixed;
    }
  }
  return common.sign();
}

}  // namespace exactff::view_factors
