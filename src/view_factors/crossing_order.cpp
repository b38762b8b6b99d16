#include "view_factors/crossing_order.h"

#include <array>

#include "kernel/vec.h"
#include "view_factors/polar_form.h"

namespace exactff::view_factors {
namespace {

using kernel::Rational;
using Exact3 = std::array<Rational, 3>;

constexpr double kFilter = 0x1p-34;
constexpr int kDeclined = kMixed + 1;

Exact3 exact_place(const Point& point) {
  Exact3 place;
  for (std::size_t i = 0; i < 3; ++i) {
    place[i] = Rational(point.exact[i], point.exact[3]);
    place[i].canonicalize();
  }
  return place;
}

Exact3 minus(const Exact3& a, const Exact3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational dot(const Exact3& a, const Exact3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// f in doubles and in rationals.
struct Rounded {
  std::array<Vec3, 6> ends;

  [[nodiscard]] double at(const Vec3& x) const {
    const auto normal = [&](std::size_t i) {
      return kernel::cross(kernel::difference(ends[i], x), kernel::difference(ends[i + 1], x));
    };
    return kernel::dot(normal(0), kernel::cross(normal(2), normal(4)));
  }
};
struct Exact {
  std::array<Exact3, 6> ends;

  [[nodiscard]] Rational at(const Exact3& x) const {
    const auto normal = [&](std::size_t i) { return cross(minus(ends[i], x), minus(ends[i + 1], x)); };
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

// kDeclined: the filter decides nothing.
int filtered_order(const Rounded& f, const Cell& cell) {
  CommonSign sign;
  bool is_certain = true;
  const auto at = [&](const Vec3& x) { return f.at(x); };
  for_each_coefficient(at, rounded(cell.corners), [&](double b) {
    is_certain = b > kFilter || b < -kFilter;
    return is_certain && sign.take(b > 0.0 ? 1 : -1);
  });
  return is_certain ? sign.sign() : kDeclined;
}

int exact_order(const Exact& f, const Cell& cell) {
  CommonSign sign;
  std::vector<Exact3> places;
  std::vector<Rational> values;
  for (const Point& corner : cell.corners) {
    places.push_back(exact_place(corner));
    values.push_back(f.at(places.back()));
    if (!sign.take(sgn(values.back()))) return kMixed;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = i + 1; j < places.size(); ++j) {
      Exact3 between;
      for (std::size_t k = 0; k < 3; ++k) between[k] = (places[i][k] + places[j][k]) / 2;
      const Rational b = 2 * f.at(between) - (values[i] + values[j]) / 2;
      if (!sign.take(sgn(b))) return kMixed;
    }
  }
  return sign.sign();
}

}  // namespace

int crossing_order(const Points& points, const Cell& cell, LineId e, LineId g, LineId h) {
  Rounded rounded;
  std::array<const Point*, 6> ends{};
  std::size_t count = 0;
  for (const LineId line : {e, g, h}) {
    for (const PointId id : {points.line(line).a, points.line(line).b}) {
      rounded.ends[count] = points[id].at;
      ends[count++] = &points[id];
    }
  }
  const int filtered = filtered_order(rounded, cell);
  if (filtered != kDeclined) return filtered;
  Exact exact;
  for (std::size_t i = 0; i < 6; ++i) exact.ends[i] = exact_place(*ends[i]);
  return exact_order(exact, cell);
}

}  // namespace exactff::view_factors
