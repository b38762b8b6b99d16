#include "adaptive/sample_points.h"

namespace exactff::adaptive {

namespace {

double radical_inverse_base2(std::uint32_t i) {
  i = (i << 16) | (i >> 16);
  i = ((i & 0x00ff00ffU) << 8) | ((i & 0xff00ff00U) >> 8);
  i = ((i & 0x0f0f0f0fU) << 4) | ((i & 0xf0f0f0f0U) >> 4);
  i = ((i & 0x33333333U) << 2) | ((i & 0xccccccccU) >> 2);
  i = ((i & 0x55555555U) << 1) | ((i & 0xaaaaaaaaU) >> 1);
  return i * kUnit32;
}

// Each map is stored as an origin and directions, so that a point costs a few multiplications.
struct ParallelogramMap {
  Vec3 origin, along_u, along_v;
  explicit ParallelogramMap(const SubPatch& s)
      : origin(s.corner(0)), along_u(s.corner(1) - origin), along_v(s.corner(3) - origin) {}
  Vec3 operator()(double u, double v) const { return origin + along_u * u + along_v * v; }
};

// From the unit square to a triangle, continuous and area-preserving: the square is folded along its diagonal and
// each half sheared (E. Heitz, "A low-distortion map between triangle and square", 2019).
struct TriangleMap {
  Vec3 origin, along_b, along_c;
  explicit TriangleMap(const SubPatch& s)
      : origin(s.corner(2)), along_b(s.corner(0) - origin), along_c(s.corner(1) - origin) {}
  Vec3 operator()(double u, double v) const {
    const double smaller = 0.5 * std::min(u, v);
    return origin + along_b * (u - smaller) + along_c * (v - smaller);
  }
};

// The bilinear map of a convex quadrilateral has the area density j(u, v) = j0 + ju u + jv v (no uv term: the patch is
// planar). Its marginal in u and its conditional in v are linear, so both are inverted in closed form.
struct QuadrilateralMap {
  Vec3 origin, along_u, along_v, twist;
  double j0, ju, jv;

  explicit QuadrilateralMap(const SubPatch& s)
      : origin(s.corner(0)),
        along_u(s.corner(1) - origin),
        along_v(s.corner(3) - origin),
        twist((s.corner(0) - s.corner(1)) + (s.corner(2) - s.corner(3))) {
    const Vec3 whole = cross(s.corner(2) - s.corner(0), s.corner(3) - s.corner(1));
    j0 = dot(cross(along_u, along_v), whole);
    ju = dot(cross(along_u, twist), whole);
    jv = dot(cross(twist, along_v), whole);
  }

  // The t in [0, 1] at which the share r of the mass of a density proportional to d0 + slope t lies below t.
  static double inverse(double d0, double slope, double r) {
    const double low = std::max(d0, 0.0);
    const double high = std::max(d0 + slope, 0.0);
    const double root = std::sqrt(low * low * (1.0 - r) + high * high * r);
    return low + root > 0.0 ? std::min(1.0, (low + high) * r / (low + root)) : r;
  }

  Vec3 operator()(double r1, double r2) const {
    const double u = inverse(j0 + 0.5 * jv, ju, r1);
    const double v = inverse(j0 + ju * u, jv, r2);
    return origin + along_u * u + along_v * v + twist * (u * v);
  }
};

// Calls act(map) with the map from the unit square to the sub-patch.
template <class Act>
void with_map(const SubPatch& s, const Act& act) {
  if (s.shape == PatchShape::kParallelogram) return act(ParallelogramMap(s));
  if (s.shape == PatchShape::kTriangle) return act(TriangleMap(s));
  act(QuadrilateralMap(s));
}

void pad(RayEnds& ends) {
  const auto count = static_cast<std::size_t>(ends.count), padded = static_cast<std::size_t>(ends.padded_count);
  for (std::size_t i = count; i < padded; ++i) ends.set(i, ends[count - 1]);
}

}  // namespace

void RayEnds::resize(int rays) {
  count = rays;
  padded_count = (rays + kLanes - 1) / kLanes * kLanes;
  for (std::vector<double>* values : {&x, &y, &z}) values->resize(static_cast<std::size_t>(padded_count));
}

void SamplePlan::prepare(SamplePattern pattern, int rays) {
  if (pattern == pattern_ && rays == rays_) return;
  pattern_ = pattern;
  rays_ = rays;
  cells_.clear();
  if (pattern == SamplePattern::kCentre) {
    cells_.push_back({0.0, 0.0, 1.0, 1.0});
  } else if (pattern == SamplePattern::kLowDiscrepancy) {
    make_hammersley(rays);
  } else {
    make_rows(rays);
  }
}

// Row k of m holds the cells from k n / m to (k + 1) n / m, so every cell has the area 1/n.
void SamplePlan::make_rows(int rays) {
  const auto n = static_cast<std::int64_t>(rays);
  const auto m = static_cast<std::int64_t>(std::lround(std::sqrt(static_cast<double>(rays))));
  for (std::int64_t k = 0; k < m; ++k) {
    const std::int64_t first = k * n / m;
    const std::int64_t count = (k + 1) * n / m - first;
    const double height = static_cast<double>(count) / static_cast<double>(n);
    const double v = static_cast<double>(first) / static_cast<double>(n);
    const double width = 1.0 / static_cast<double>(count);
    for (std::int64_t i = 0; i < count; ++i) cells_.push_back({static_cast<double>(i) * width, v, width, height});
  }
}

void SamplePlan::make_hammersley(int rays) {
  for (int i = 0; i < rays; ++i) {
    cells_.push_back({static_cast<double>(i) / rays, radical_inverse_base2(static_cast<std::uint32_t>(i)), 1.0, 1.0});
  }
}

namespace {

// Runs point_of(cell, i) for every cell and stores the images.
template <class Cells, class Map, class PointOf>
void place_all(const Cells& cells, const Map& map, const PointOf& point_of, RayEnds& ends) {
  double* const x = ends.x.data();
  double* const y = ends.y.data();
  double* const z = ends.z.data();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const UnitPoint point = point_of(cells[i], i);
    const Vec3 p = map(point.u, point.v);
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
  }
}

}  // namespace

template <class Map>
void SamplePlan::place_by(const Map& map, std::uint64_t key, RayEnds& ends) const {
  const auto jittered = [key](const Cell& cell, std::size_t i) {
    const UnitPoint r = random_point(key, i);
    return UnitPoint{cell.u + cell.width * r.u, cell.v + cell.height * r.v};
  };
  const auto shifted = [shift = random_point(key, 0)](const Cell& cell, std::size_t) {
    return UnitPoint{wrapped(cell.u + shift.u), wrapped(cell.v + shift.v)};
  };
  const auto central = [](const Cell& cell, std::size_t) {
    return UnitPoint{cell.u + 0.5 * cell.width, cell.v + 0.5 * cell.height};
  };
  if (pattern_ == SamplePattern::kJittered) return place_all(cells_, map, jittered, ends);
  if (pattern_ == SamplePattern::kLowDiscrepancy) return place_all(cells_, map, shifted, ends);
  place_all(cells_, map, central, ends);
}

void SamplePlan::place(const SubPatch& s, std::uint64_t key, RayEnds& ends) const {
  if (pattern_ == SamplePattern::kCentre) {
    ends.set(0, centroid(s));
  } else {
    with_map(s, [&](const auto& map) { place_by(map, key, ends); });
  }
  pad(ends);
}

void place_by_area(const SubPatch& s, std::span<const UnitPoint> points, RayEnds& ends) {
  if (points.empty()) return ends.resize(0);
  ends.resize(static_cast<int>(points.size()));
  const auto given = [](const UnitPoint& point, std::size_t) { return point; };
  with_map(s, [&](const auto& map) { place_all(points, map, given, ends); });
  pad(ends);
}

}  // namespace exactff::adaptive
