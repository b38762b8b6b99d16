#include "visibility/outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/lane_types.h"
#include "scene/places.h"

namespace exactff::visibility {

using kernel::Approx3;
using kernel::Direction;
using kernel::ExactVec3;
using kernel::Integer;

namespace {

constexpr double kSideError = 0x1p-46;

double size_of(const Approx3& t) {
  const double largest = std::max({std::abs(t.x), std::abs(t.y), std::abs(t.z)});
  const bool usable = largest >= 0x1p-300 && largest <= 0x1p300;  // false for NaN
  const double sum = t.x + t.y + t.z;                             // NaN if one of them is, which std::max may pass over
  return usable && sum == sum ? largest : std::numeric_limits<double>::quiet_NaN();
}

bool scaled_safely(double from, double to) { return from == 0.0 || std::abs(to) >= std::numeric_limits<double>::min(); }

// Of the power of two nearest below 1 / length, within the range of normal doubles.
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
  if (!exact_.empty()) exact_.clear();
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
  const bool exact_scaling =  // to larger numbers it always is, or they become infinite
      scale_ >= 1.0 || (scaled_safely(d.x, t.x) && scaled_safely(d.y, t.y) && scaled_safely(d.z, t.z));
  run = run_;
  corner = add_corner(t, exact_scaling ? size_of(t) : std::numeric_limits<double>::quiet_NaN(), {.p = vertex});
  return corner;
}

void Outlines::corners_of(std::span<const std::uint32_t> vertices, std::vector<CornerId>& corners) {
  corners.clear();
  for (const std::uint32_t vertex : vertices) corners.push_back(corner_of_vertex(vertex));
}

const ExactVec3& Outlines::keep_exact(Origin& origin, ExactVec3 direction, long exponent) {
  origin.exact = static_cast<std::uint32_t>(exact_.size());
  origin.exponent = exponent;
  return exact_.emplace_back(std::move(direction));
}

CornerId Outlines::add_exactly(Direction direction) {
  Origin origin;
  const long bits = bit_length(direction.exact);
  keep_exact(origin, std::move(direction.exact), -bits);
  return add_corner(direction.approx, size_of(direction.approx), origin);
}

void Outlines::set_source_plane(const ExactVec3& normal, const FineNormal& fine_normal, const Vec3& point) {
  crossings_[std::size_t(Plane::kSource)].start(x_, fine_normal, point, scale_exponent_);
  normal_ = &normal;
}

void Outlines::set_horizon(const Vec3& normal) {
  crossings_[std::size_t(Plane::kHorizon)].start(x_, fine_normal(normal), x_, scale_exponent_);
  horizon_ = normal;
  exact_horizon_.reset();
}

const ExactVec3& Outlines::exact_normal(Plane plane) {
  if (plane == Plane::kSource) return *normal_;
  if (!exact_horizon_) exact_horizon_ = kernel::exact_vector(horizon_).v;
  return *exact_horizon_;
}

PlaneCrossings::Exact Outlines::exact_crossing(Plane plane, std::uint32_t p, std::uint32_t q, long exponent) {
  return crossings(plane).exact(position(p), position(q), static_cast<int>(exponent), exact_normal(plane));
}

CornerId Outlines::add_crossing(Plane plane, std::uint32_t p, std::uint32_t q) {
  const auto fine = crossings(plane).fine(position(p), position(q));
  if (!fine) return add_exactly(kernel::make_direction(exact_crossing(plane, p, q, 0).direction));
  const auto& [hi, lo, error] = fine->direction;
  fine_.push_back(fine->direction);
  const Approx3 t{hi[0], hi[1], hi[2]};
  return add_corner(t, size_of(t),
                    {.p = p,
                     .q = q,
                     .fine = static_cast<std::uint32_t>(fine_.size() - 1),
                     .plane = plane,
                     .exponent = fine->exponent});
}

OutlineId Outlines::add(std::span<const CornerId> corners, bool whole) {
  add_edges(corners, whole);
  return static_cast<OutlineId>(outlines_.size() - 1);
}

OutlineId Outlines::add(const kernel::Ring& ring) {
  ring_.clear();
  for (const Direction& direction : ring) ring_.push_back(add_exactly(direction));
  return add(ring_, false);
}

OutlineId Outlines::add(const Piece& piece, bool mirrored) {
  corners_of(scene_->corners(piece), ring_);
  if (mirrored) std::reverse(ring_.begin(), ring_.end());
  return add(ring_, true);
}

void Outlines::add_edges(std::span<const CornerId> corners, bool whole) {
  const auto outline = static_cast<OutlineId>(outlines_.size());
  outlines_.push_back(
      {static_cast<EdgeId>(edges_.size()), static_cast<std::uint32_t>(corners.size()), whole, false, 0});
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const CornerId a = corners[i], b = corners[i + 1 == corners.size() ? 0 : i + 1];
    const Approx3 &p = corners_[a].t, &q = corners_[b].t;
    edges_.push_back({a,
                      b,
                      outline,
                      {q.y * p.z - q.z * p.y, q.z * p.x - q.x * p.z, q.x * p.y - q.y * p.x},
                      kSideError * corners_[a].size * corners_[b].size});
  }
}

void Outlines::remove_last() {
  edges_.resize(outlines_.back().first);
  outlines_.pop_back();
}

const ExactVec3& Outlines::exact(CornerId id) {
  Origin& origin = origins_[id];
  if (origin.exact != kNone) return exact_[origin.exact];
  if (origin.is_vertex()) {
    kernel::ScaledVec3 difference = kernel::exact_difference(position(origin.p), x_);
    return keep_exact(origin, std::move(difference.v), difference.exponent + scale_exponent_);
  }
  PlaneCrossings::Exact crossing = exact_crossing(origin.plane, origin.p, origin.q, origin.exponent);
  return keep_exact(origin, std::move(crossing.direction), crossing.fine_exponent);
}

Integer Outlines::exact_height(const Edge& edge, CornerId t) {
  return dot(cross(exact(edge.b), exact(edge.a)), exact(t));
}

int Outlines::side_by_filter(const Approx3& normal, CornerId t) const {
  const Corner& c = corners_[t];
  return c.size == c.size ? kernel::sign_of_dot(normal, c.t) : kernel::kUncertain;
}

int Outlines::side(const Edge& edge, CornerId t) {
  const Height h = height(edge, t);
  if (h.value > h.error) return 1;
  if (h.value < -h.error) return -1;
  if (t == edge.a || t == edge.b) return 0;
  const Origin &a = origins_[edge.a], &b = origins_[edge.b], &c = origins_[t];
  if (!a.is_vertex() || !b.is_vertex() || !c.is_vertex()) return kernel::sign(exact_height(edge, t));
  return kernel::orientation(x_, position(b.p), position(a.p), position(c.p));
}

}  // namespace exactff::visibility
