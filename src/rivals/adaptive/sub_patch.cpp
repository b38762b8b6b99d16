#include "adaptive/sub_patch.h"

#include <algorithm>
#include <set>
#include <unordered_map>

#include "scene/panels.h"

namespace exactff::adaptive {
namespace {

void set_corner(SubPatch& s, int i, const Vec3& p) {
  s.x[i] = p.x;
  s.y[i] = p.y;
  s.z[i] = p.z;
}

SubPatch quadrilateral(PatchShape shape, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  SubPatch s;
  set_corner(s, 0, a);
  set_corner(s, 1, b);
  set_corner(s, 2, c);
  set_corner(s, 3, d);
  s.shape = shape;
  return s;
}

SubPatch triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return quadrilateral(PatchShape::kTriangle, a, b, c, c);
}

// This affects only the choice of the sampling map: an area density within 1e-12 of constant counts as constant.
PatchShape shape_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double gap = max_norm((a - b) + (c - d));
  const double size = std::max(max_norm(c - a), max_norm(d - b));
  return gap <= 1e-12 * size ? PatchShape::kParallelogram : PatchShape::kQuadrilateral;
}

Vec3 middle(const Vec3& a, const Vec3& b) { return (a + b) * 0.5; }

std::array<SubPatch, 4> split_triangle(const SubPatch& s) {
  const Vec3 a = s.corner(0), b = s.corner(1), c = s.corner(2);
  const Vec3 ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
  return {triangle(a, ab, ca), triangle(ab, b, bc), triangle(ca, bc, c), triangle(ab, bc, ca)};
}

std::array<SubPatch, 4> split_quadrilateral(const SubPatch& s) {
  const Vec3 a = s.corner(0), b = s.corner(1), c = s.corner(2), d = s.corner(3);
  const Vec3 ab = middle(a, b), bc = middle(b, c), cd = middle(c, d), da = middle(d, a);
  const Vec3 centre = middle(ab, cd);
  return {quadrilateral(s.shape, a, ab, centre, da), quadrilateral(s.shape, ab, b, bc, centre),
          quadrilateral(s.shape, centre, bc, c, cd), quadrilateral(s.shape, da, centre, cd, d)};
}

}  // namespace

SubPatch make_sub_patch(std::span<const Vec3> corners) {
  EXACTFF_EXPECT(corners.size() == 3 || corners.size() == 4);
  if (corners.size() == 3) return triangle(corners[0], corners[1], corners[2]);
  const PatchShape shape = shape_of(corners[0], corners[1], corners[2], corners[3]);
  return quadrilateral(shape, corners[0], corners[1], corners[2], corners[3]);
}

// Half the cross product of the diagonals; a triangle's repeated corner makes one diagonal an edge.
double area(const SubPatch& s) { return 0.5 * length(cross(s.corner(2) - s.corner(0), s.corner(3) - s.corner(1))); }

Vec3 centroid(const SubPatch& s) {
  const Vec3 sum = s.corner(0) + s.corner(1) + s.corner(2);
  return s.shape == PatchShape::kTriangle ? sum * (1.0 / 3.0) : (sum + s.corner(3)) * 0.25;
}

std::array<SubPatch, 4> split_patch(const SubPatch& s) {
  return s.shape == PatchShape::kTriangle ? split_triangle(s) : split_quadrilateral(s);
}

namespace {

// The point at i/m of the way from a to b; exact at the ends.
Vec3 between(const Vec3& a, const Vec3& b, int i, int m) {
  if (i == 0) return a;
  if (i == m) return b;
  return a + (b - a) * (static_cast<double>(i) / m);
}

void split_triangle(const SubPatch& s, int m, std::vector<SubPatch>& parts) {
  const Vec3 a = s.corner(0), b = s.corner(1), c = s.corner(2);
  const auto at = [&](int i, int j) {  // row j of m from ab to c, with m - j steps in it
    return j == m ? c : between(between(a, c, j, m), between(b, c, j, m), i, m - j);
  };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < m - j; ++i) {
      parts.push_back(make_sub_patch(std::array{at(i, j), at(i + 1, j), at(i, j + 1)}));
      if (i + 1 < m - j) parts.push_back(make_sub_patch(std::array{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}));
    }
  }
}

void split_quadrilateral(const SubPatch& s, int m, std::vector<SubPatch>& parts) {
  const Vec3 a = s.corner(0), b = s.corner(1), c = s.corner(2), d = s.corner(3);
  const auto at = [&](int i, int j) { return between(between(a, b, i, m), between(d, c, i, m), j, m); };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < m; ++i) {
      parts.push_back(make_sub_patch(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}));
    }
  }
}

}  // namespace

void split_evenly(const SubPatch& s, int m, std::vector<SubPatch>& parts) {
  parts.clear();
  if (m == 1) {
    parts.push_back(s);
  } else if (s.shape == PatchShape::kTriangle) {
    split_triangle(s, m, parts);
  } else {
    split_quadrilateral(s, m, parts);
  }
}

void clip_by_horizon(std::span<const Vec3> polygon, const Vec3& normal, std::vector<Vec3>& clipped) {
  clipped.clear();
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % n];
    const double height_a = dot(normal, a);
    const double height_b = dot(normal, b);
    if (height_a >= 0.0) clipped.push_back(a);
    const bool crosses = (height_a > 0.0 && height_b < 0.0) || (height_a < 0.0 && height_b > 0.0);
    if (crosses) clipped.push_back(a + (b - a) * (height_a / (height_a - height_b)));
  }
  const bool all_on_horizon =
      std::none_of(clipped.begin(), clipped.end(), [&](const Vec3& p) { return dot(normal, p) > 0.0; });
  if (clipped.size() < 3 || all_on_horizon) clipped.clear();
}

// --- Plane side ---

namespace {

double magnitude(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : std::max(std::abs(a * b), 0x1p-400); }

Vec3 absolute(const Vec3& a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }

}  // namespace

Normal plane_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  return {cross(p, q),
          {magnitude(p.y, q.z) + magnitude(p.z, q.y), magnitude(p.z, q.x) + magnitude(p.x, q.z),
           magnitude(p.x, q.y) + magnitude(p.y, q.x)}};
}

Normal exact_normal(const Vec3& n) { return {n, absolute(n)}; }

Bounded bounded_dot(const Normal& n, const Vec3& d) {
  const double m = magnitude(n.magnitude.x, d.x) + magnitude(n.magnitude.y, d.y) + magnitude(n.magnitude.z, d.z);
  return {dot(n.value, d), 0x1p-48 * m};
}

// --- Source roots ---

namespace {

class RootMaker {
 public:
  RootMaker(const Scene& scene, const std::vector<Vec3>& points) : scene_(scene), points_(points) {}

  void add_face(FaceId face) {
    const std::uint32_t first = scene_.face(face).first_piece;
    const std::uint32_t count = scene_.face(face).piece_count;
    for (std::uint32_t piece = first; piece < first + count; ++piece) {
      if (is_new(piece)) add_piece(piece);
    }
  }

  SourceRoots take() { return std::move(result_); }

 private:
  using Key = std::vector<std::array<double, 3>>;

  // The corners in order, starting at the least one.
  bool is_new(std::uint32_t piece) {
    Key key;
    for (const std::uint32_t v : scene_.corners(scene_.pieces()[piece])) {
      const Vec3& p = scene_.vertices()[v];
      key.push_back({p.x, p.y, p.z});
    }
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    return seen_.insert(std::move(key)).second;
  }

  void add_piece(std::uint32_t index) {
    const Piece& piece = scene_.pieces()[index];
    const std::span<const std::uint32_t> corners = scene_.corners(piece);
    const std::uint32_t plane = plane_of(index);
    if (corners.size() <= 4) {
      add_root(corners, plane, index);
      return;
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      add_root(std::array{corners[0], corners[i], corners[i + 1]}, plane, index);
    }
  }

  void add_root(std::span<const std::uint32_t> corners, std::uint32_t plane, std::uint32_t piece) {
    SourceRoot root{{}, static_cast<int>(corners.size()), plane, piece};
    std::transform(corners.begin(), corners.end(), root.corners.begin(), [&](std::uint32_t v) { return points_[v]; });
    result_.roots.push_back(root);
  }

  std::uint32_t plane_of(std::uint32_t index) {
    const auto found = plane_of_piece_.find(index);
    if (found != plane_of_piece_.end() && same_front(index, result_.planes[found->second])) return found->second;
    const auto plane = static_cast<std::uint32_t>(result_.planes.size());
    result_.planes.push_back(make_plane(index));
    for (const std::uint32_t piece : result_.planes.back().coplanar) plane_of_piece_[piece] = plane;
    return plane;
  }

  SourcePlane make_plane(std::uint32_t index) const {
    SourcePlane plane;
    const Piece& piece = scene_.pieces()[index];
    for (std::size_t i = 0; i < 3; ++i) {
      plane.frame[i] = points_[piece.frame[i]];
      plane.exact_frame[i] = scene_.vertices()[piece.frame[i]];
    }
    const Planes& all = planes(scene_);
    const auto coplanar = all.pieces_in(all.of_piece(index));
    plane.coplanar.assign(coplanar.begin(), coplanar.end());
    return plane;
  }

  // Two faces in one plane may face opposite sides.
  bool same_front(std::uint32_t index, const SourcePlane& plane) const {
    const std::uint32_t* f = scene_.pieces()[index].frame;
    const Vec3 normal = plane_normal(points_[f[0]], points_[f[1]], points_[f[2]]).value;
    return dot(normal, plane_normal(plane.frame[0], plane.frame[1], plane.frame[2]).value) > 0.0;
  }

  const Scene& scene_;
  const std::vector<Vec3>& points_;
  SourceRoots result_;
  std::set<Key> seen_;
  std::unordered_map<std::uint32_t, std::uint32_t> plane_of_piece_;
};

}  // namespace

SourceRoots make_source_roots(const Scene& scene, const std::vector<Vec3>& points, const Selection& selection) {
  RootMaker maker(scene, points);
  for (const FaceId face : scene.faces_of(selection)) maker.add_face(face);
  return maker.take();
}

// --- Sample points ---

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
