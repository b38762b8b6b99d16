#include "view_factors/local_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "view_factors/cell.h"

namespace exactff::view_factors {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kNearest = 8, kFewestOfPlane = 4;
constexpr std::size_t kOfBox = 4;       // values, on average, before there are more boxes: one each
constexpr std::size_t kMostOfBox = 16;  // the newest ones of a box that are looked at
constexpr double kAtPlace = 0.05;       // of the farthest one's squared distance, added to each: no weight is too large
constexpr double kThin = 1e-4;          // of values along a line

std::uint32_t clamped(double x, std::uint32_t count) {
  return x > 0.0 ? static_cast<std::uint32_t>(std::min(x, static_cast<double>(count - 1))) : 0U;
}

}  // namespace

void LocalPlanes::prepare(const Part& part, Shown& shown) {
  const std::vector<Vec3> ring = positions_of(part.corners);
  shown.origin = ring[0];
  Vec3 normal;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    normal = kernel::sum(normal,
                         kernel::cross(kernel::difference(ring[i], ring[0]), kernel::difference(ring[i + 1], ring[0])));
  }
  shown.along_u = kernel::unit(kernel::difference(ring[1], ring[0]));
  shown.along_v = kernel::cross(kernel::unit(normal), shown.along_u);
  double high_u = 0.0, high_v = 0.0;
  shown.low_u = shown.low_v = 0.0;
  for (const Vec3& corner : ring) {
    const Vec3 from = kernel::difference(corner, shown.origin);
    const double u = kernel::dot(from, shown.along_u), v = kernel::dot(from, shown.along_v);
    shown.low_u = std::min(shown.low_u, u);
    shown.low_v = std::min(shown.low_v, v);
    high_u = std::max(high_u, u);
    high_v = std::max(high_v, v);
  }
  shown.width = high_u - shown.low_u;
  shown.height = high_v - shown.low_v;
}

std::uint32_t& LocalPlanes::box_of(Shown& shown, const Value& value) {
  const std::uint32_t column = clamped((value.u - shown.low_u) / shown.size, shown.columns),
                      row = clamped((value.v - shown.low_v) / shown.size, shown.rows);
  return shown.first[std::size_t{row} * shown.columns + column];
}

void LocalPlanes::make_grid(Shown& shown) {
  const double boxes = static_cast<double>(shown.values.size());
  shown.size = std::max(std::sqrt(shown.width * shown.height / boxes), std::max(shown.width, shown.height) / boxes);
  shown.columns = 1 + clamped(shown.width / shown.size, 1U << 20);
  shown.rows = 1 + clamped(shown.height / shown.size, 1U << 20);
  shown.first.assign(std::size_t{shown.columns} * shown.rows, kNone);
  shown.next_grid = kOfBox * shown.values.size();
  for (std::uint32_t i = 0; i < shown.values.size(); ++i) {
    Value& value = shown.values[i];
    std::uint32_t& first = box_of(shown, value);
    value.next = first;
    first = i;
  }
}

void LocalPlanes::add(std::size_t part, const Vec3& at, double value) {
  Shown& shown = shown_[part];
  if (shown.values.empty()) prepare(parts_[part], shown);
  const Vec3 from = kernel::difference(at, shown.origin);
  shown.values.push_back({kernel::dot(from, shown.along_u), kernel::dot(from, shown.along_v), value, kNone});
  if (shown.values.size() >= shown.next_grid) return make_grid(shown);
  std::uint32_t& first = box_of(shown, shown.values.back());
  shown.values.back().next = first;
  first = static_cast<std::uint32_t>(shown.values.size() - 1);
}

// The nearest, more or less: of those in the box of the place and around it, until there are enough, and once more
// around.
void LocalPlanes::find_near(const Shown& shown, double u, double v, std::vector<Near>& near) {
  const auto column = static_cast<std::int64_t>(clamped((u - shown.low_u) / shown.size, shown.columns)),
             row = static_cast<std::int64_t>(clamped((v - shown.low_v) / shown.size, shown.rows));
  const std::int64_t columns = shown.columns, rows = shown.rows;
  const auto add_box = [&](std::int64_t c, std::int64_t r) {
    if (c < 0 || c >= columns) return;
    std::size_t left = kMostOfBox;
    for (std::uint32_t i = shown.first[static_cast<std::size_t>(r * columns + c)]; i != kNone && left > 0;
         i = shown.values[i].next, --left) {
      const double du = shown.values[i].u - u, dv = shown.values[i].v - v;
      near.push_back({du, dv, shown.values[i].value, du * du + dv * dv});
    }
  };
  bool is_last = false;
  for (std::int64_t reach = 0; reach < std::max(columns, rows) && !is_last; ++reach) {
    is_last = near.size() >= kNearest;
    for (std::int64_t r = std::max<std::int64_t>(0, row - reach); r <= std::min(rows - 1, row + reach); ++r) {
      if (std::abs(r - row) < reach) {
        add_box(column - reach, r);
        add_box(column + reach, r);
        continue;
      }
      const std::int64_t last = std::min(columns - 1, column + reach);
      for (std::int64_t c = std::max<std::int64_t>(0, column - reach); c <= last; ++c) add_box(c, r);
    }
  }
  const auto is_nearer = [](const Near& a, const Near& b) { return a.square < b.square; };
  const std::size_t count = std::min(near.size(), kNearest);
  std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(count), is_nearer);
  near.resize(count);
}

std::optional<LocalPlanes::Plane> LocalPlanes::about(std::size_t part, const Vec3& at) const {
  const Shown& shown = shown_[part];
  if (shown.values.empty()) return std::nullopt;
  const Vec3 from = kernel::difference(at, shown.origin);
  near_.clear();
  find_near(shown, kernel::dot(from, shown.along_u), kernel::dot(from, shown.along_v), near_);
  const double added = kAtPlace * near_.back().square;
  if (!(added > 0.0)) return Plane{near_.back().value, {}};
  double sum = 0.0, u = 0.0, v = 0.0, f = 0.0;  // means
  for (const Near& value : near_) {
    const double weight = 1.0 / (value.square + added);
    sum += weight;
    u += weight * value.u;
    v += weight * value.v;
    f += weight * value.value;
  }
  u /= sum;
  v /= sum;
  f /= sum;
  if (near_.size() < kFewestOfPlane) return Plane{f, {}};
  double uu = 0.0, uv = 0.0, vv = 0.0, uf = 0.0, vf = 0.0;
  for (const Near& value : near_) {
    const double weight = 1.0 / (value.square + added), du = value.u - u, dv = value.v - v, df = value.value - f;
    uu += weight * du * du;
    uv += weight * du * dv;
    vv += weight * dv * dv;
    uf += weight * du * df;
    vf += weight * dv * df;
  }
  const auto plane = [&](double along_u, double along_v) {
    return Plane{f - along_u * u - along_v * v,
                 kernel::sum(kernel::scaled(shown.along_u, along_u), kernel::scaled(shown.along_v, along_v))};
  };
  const double determinant = uu * vv - uv * uv;
  if (determinant > kThin * (uu + vv) * (uu + vv)) {
    return plane((vv * uf - uv * vf) / determinant, (uu * vf - uv * uf) / determinant);
  }
  // Nearly along a line, of which alone they tell something.
  const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv), c = std::cos(angle), d = std::sin(angle);
  const double along = (c * uf + d * vf) / (c * c * uu + 2.0 * c * d * uv + d * d * vv);
  return std::isfinite(along) ? plane(along * c, along * d) : Plane{f, {}};
}

}  // namespace exactff::view_factors
