#include "visibility/outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/lanes.h"
#include "scene/scene.h"

namespace exactff::visibility {

namespace {

double size_of(const Approx3& t) {
  const double largest = kernel::max_norm(t);
  const double sum = t.x + t.y + t.z;  // NaN if a component is; std::max may miss it
  return kernel::is_moderate(largest) && sum == sum ? largest : std::numeric_limits<double>::quiet_NaN();
}

bool scaled_safely(double from, double to) { return from == 0.0 || std::abs(to) >= std::numeric_limits<double>::min(); }

// The exponent of the largest power of two below 1 / length, within the range of normal doubles.
int exponent_for(double length) {
  int exponent = 0;
  if (std::isfinite(length) && length > 0.0) std::frexp(length, &exponent);
  return std::clamp(-exponent, -1000, 1000);
}

}  // namespace

void Outlines::start(const Scene& scene, const Vec3& x, double unit) {
  if (scene_ != &scene || corner_of_vertex_.size() != scene.vertices().size()) {
    corner_of_vertex_.assign(scene.vertices().size(), {0, 0});
    run_ = 0;
  }
  if (++run_ == 0) {
    std::fill(corner_of_vertex_.begin(), corner_of_vertex_.end(), std::pair<std::uint32_t, CornerId>{0, 0});
    run_ = 1;
  }
  scene_ = &scene;
  vertices_ = scene.vertices();
  places_ = places(scene);
  x_ = x;
  scale_exponent_ = exponent_for(unit);
  scale_ = std::ldexp(1.0, scale_exponent_);
  corners_.clear();
  origins_.clear();
  exact_count_ = 0;
  further_count_ = 0;
  normal_a_ = normal_b_ = kNone;
  fine_.clear();
  edges_.clear();
  outlines_.clear();
}

EXACTFF_INLINE CornerId Outlines::add_corner(const Approx3& t, double size, const Origin& origin) {
  corners_.push_back({t, size});
  origins_.push_back(origin);
  return static_cast<CornerId>(corners_.size() - 1);
}

EXACTFF_INLINE CornerId Outlines::corner_of_vertex(std::uint32_t any_vertex) {
  const std::uint32_t vertex = places_[any_vertex];
  auto& [run, corner] = corner_of_vertex_[vertex];
  if (run == run_) {
    shared_corners_ = true;
    return corner;
  }
  const Approx3 d = kernel::approx_difference(position(vertex), x_);
  const Approx3 t{d.x * scale_, d.y * scale_, d.z * scale_};
  const bool exact_scaling =  // scaling up always is, unless numbers become infinite
      scale_ >= 1.0 || (scaled_safely(d.x, t.x) && scaled_safely(d.y, t.y) && scaled_safely(d.z, t.z));
  run = run_;
  corner = add_corner(t, exact_scaling ? size_of(t) : std::numeric_limits<double>::quiet_NaN(), {.p = vertex});
  return corner;
}

CornerId Outlines::corner_at(std::uint32_t vertex) { return corner_of_vertex(vertex); }

void Outlines::corners_of(std::span<const std::uint32_t> vertices, std::vector<CornerId>& corners) {
  corners.clear();
  for (const std::uint32_t vertex : vertices) corners.push_back(corner_of_vertex(vertex));
}

void Outlines::set_source_plane(const ExactVec3& normal, const FineNormal& fine_normal, const Vec3& point) {
  crossings(Plane::kSource).start(x_, fine_normal, point, scale_exponent_);
  normal_ = &normal;
}

void Outlines::set_horizon(const Vec3& normal) {
  crossings(Plane::kHorizon).start(x_, fine_normal(normal), x_, scale_exponent_);
  kernel::set_difference(horizon_, normal, Vec3{});
}

Outlines::Plane Outlines::add_plane(const ExactVec3& normal, const Vec3& point) {
  if (further_planes_.size() == further_count_) further_planes_.emplace_back();
  FurtherPlane& plane = further_planes_[further_count_];
  plane.normal = normal;
  plane.crossings.start(x_, fine_normal(normal), point, scale_exponent_);
  return static_cast<Plane>(kNamedPlanes + further_count_++);
}

CornerId Outlines::add_crossing(Plane plane, std::uint32_t p, std::uint32_t q) {
  Origin origin{.p = p, .q = q, .plane = plane};
  if (const auto fine = crossings(plane).fine(position(p), position(q))) {
    const std::array<double, 3>& hi = fine->direction.hi;
    const Approx3 t{hi[0], hi[1], hi[2]};
    origin.fine = static_cast<std::uint32_t>(fine_.size());
    origin.fine_exponent = fine->exponent;
    fine_.push_back(fine->direction);
    return add_corner(t, size_of(t), origin);
  }
  const CornerId corner = add_corner({}, 0.0, origin);
  Corner& c = corners_[corner];
  c.t = kernel::approx(exact(corner));
  c.size = size_of(c.t);
  return corner;
}

EXACTFF_INLINE Outlines::Edge Outlines::edge_between(CornerId a, CornerId b, OutlineId outline) const {
  const Approx3 &p = corners_[a].t, &q = corners_[b].t;
  return {a,
          b,
          outline,
          {q.y * p.z - q.z * p.y, q.z * p.x - q.x * p.z, q.x * p.y - q.y * p.x},
          kernel::kTripleError * corners_[a].size * corners_[b].size};
}

Outlines::Edge Outlines::line_through(CornerId a, CornerId b) const { return edge_between(a, b, kNone); }

OutlineId Outlines::add(std::span<const CornerId> corners, bool whole) {
  const auto outline = static_cast<OutlineId>(outlines_.size());
  outlines_.push_back(
      {static_cast<EdgeId>(edges_.size()), static_cast<std::uint32_t>(corners.size()), whole, false, 0});
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const CornerId a = corners[i], b = corners[i + 1 == corners.size() ? 0 : i + 1];
    edges_.push_back(edge_between(a, b, outline));
  }
  return outline;
}

EdgeId Outlines::add_edge(CornerId a, CornerId b) {
  edges_.push_back(edge_between(a, b, kNone));
  return static_cast<EdgeId>(edges_.size() - 1);
}

void Outlines::remove_last() {
  edges_.resize(outlines_.back().first);
  outlines_.pop_back();
}

const ScaledVec3& Outlines::scaled(CornerId id) {
  Origin& origin = origins_[id];
  if (origin.exact != kNone) return exact_[origin.exact];
  origin.exact = static_cast<std::uint32_t>(exact_count_++);
  if (exact_.size() < exact_count_) exact_.emplace_back();
  ScaledVec3& result = exact_[origin.exact];
  if (origin.is_vertex()) {
    kernel::set_difference(result, position(origin.p), x_);
    result.exponent += scale_exponent_;
  } else {
    crossings(origin.plane)
        .set_exact(result, position(origin.p), position(origin.q), exact_normal(origin.plane), origin.fine_exponent);
    if (origin.fine == kNone) result.exponent = -bit_length(result.v);  // the scale of approx()
  }
  return result;
}

void Outlines::set_exact_height(Integer& result, const Edge& edge, CornerId t) {
  if (edge.a != normal_a_ || edge.b != normal_b_) {
    set_cross(edge_normal_, exact(edge.b), exact(edge.a));
    normal_a_ = edge.a;
    normal_b_ = edge.b;
  }
  set_dot(result, edge_normal_, exact(t));
}

bool Outlines::are_beside(OutlineId id, std::span<const CornerId> corners) const {
  return std::ranges::any_of(edges_of(outlines_[id]), [&](const Edge& side) {
    return std::ranges::all_of(corners, [&](CornerId corner) {
      const Height h = height(side, corner);
      return h.value < -h.error;
    });
  });
}

bool Outlines::cover(OutlineId by, std::size_t count, int least_side) {
  const Outline& last = outlines_[count - 1];
  return std::ranges::all_of(edges_of(outlines_[by]), [&](const Edge& line) {
    return std::ranges::all_of(edges().first(last.first + last.count),
                               [&](const Edge& edge) { return side(line, edge.a) >= least_side; });
  });
}

int Outlines::side_by_filter(const Approx3& normal, CornerId t) const {
  const Corner& c = corners_[t];
  return c.size == c.size ? kernel::sign_of_dot(normal, c.t) : kUncertain;
}

// True if two coordinates of three vertices agree: the vertices then lie on one line, and x with them in one plane.
bool Outlines::are_on_axis_line(const Edge& edge, CornerId t) const {
  const Origin &a = origins_[edge.a], &b = origins_[edge.b], &c = origins_[t];
  if (!a.is_vertex() || !b.is_vertex() || !c.is_vertex()) return false;
  const Vec3 &p = vertices_[a.p], &q = vertices_[b.p], &r = vertices_[c.p];
  const int agree = static_cast<int>(p.x == q.x && q.x == r.x) + static_cast<int>(p.y == q.y && q.y == r.y) +
                    static_cast<int>(p.z == q.z && q.z == r.z);
  return agree >= 2;
}

int Outlines::side(const Edge& edge, CornerId t) {
  const Height h = height(edge, t);
  if (h.value > h.error) return 1;
  if (h.value < -h.error) return -1;
  if (t == edge.a || t == edge.b || are_on_axis_line(edge, t)) return 0;
  set_exact_height(height_, edge, t);
  return sign(height_);
}

}  // namespace exactff::visibility
