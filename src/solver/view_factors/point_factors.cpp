#include "view_factors/point_factors.h"

#include <algorithm>
#include <cmath>

#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "view_factors/prepared_patch.h"

namespace exactff::view_factors {

// --- Near planes ---

namespace {

constexpr double kNear = 0x1p-20;    // in units of Point::at
constexpr double kNearly = 0x1p-40;  // the same

bool is_nearly_in(const Plane& plane, const Point& point) {
  const Vec3 normal{plane.rounded[0], plane.rounded[1], plane.rounded[2]};
  return std::abs(kernel::dot(normal, point.at) + plane.rounded[3]) <= kNearly * view_factors::length(normal);
}

// More than that on every side.
Box widen(Box box) {
  box.low = {box.low.x - kNear, box.low.y - kNear, box.low.z - kNear};
  box.high = {box.high.x + kNear, box.high.y + kNear, box.high.z + kNear};
  return box;
}

// Exactly the doubles of Point::at.
Point point_at(const Vec3& at, const Units& units) {
  const kernel::BinaryDouble parts[] = {kernel::decompose(at.x), kernel::decompose(at.y), kernel::decompose(at.z)};
  long least = 0;
  for (const kernel::BinaryDouble& p : parts)
    least = p.mantissa == 0 ? least : std::min(least, p.exponent + units.shift);
  Homogeneous exact;
  for (std::size_t i = 0; i < 3; ++i) {
    exact[i] = parts[i].mantissa;
    if (parts[i].mantissa != 0) exact[i] <<= static_cast<mp_bitcnt_t>(parts[i].exponent + units.shift - least);
  }
  exact[3] = Integer(1) << static_cast<mp_bitcnt_t>(-least);
  return make_point(std::move(exact), units);
}

}  // namespace

NearPlanes::NearPlanes(const ExactScene& scene, const Part& part) : scene_(&scene), own_(part.face) {
  const Plane plane = plane_of(part, scene.units);
  const Homogeneous behind = opposite(plane.exact);
  front_ = plane.exact;
  normal_ = {plane.rounded[0], plane.rounded[1], plane.rounded[2]};
  const Box box = widen(box_of(part.corners));
  for (const ExactPiece& piece : scene.pieces) {
    if (piece.box.is_apart_from(box) || piece.plane.exact == plane.exact || piece.plane.exact == behind) continue;
    const auto in_part = [&](std::uint32_t corner) { return is_nearly_in(plane, scene.vertices[corner]); };
    const auto in_piece = [&](const Point& corner) { return is_nearly_in(piece.plane, corner); };
    const bool nearly = std::ranges::all_of(piece.corners, in_part) || std::ranges::all_of(part.corners, in_piece);
    if (nearly) nearly_.push_back(&piece);
  }
}

std::optional<Vec3> NearPlanes::round(const Point& point) const {
  const Units& units = scene_->units;
  const int exponent = static_cast<int>(units.exponent + units.shift);
  const auto in_scene = [&](double x) { return std::ldexp(x, exponent); };
  for (const double x : {point.at.x, point.at.y, point.at.z}) {
    if (std::ldexp(in_scene(x), -exponent) != x) return std::nullopt;
  }
  if (!nearly_.empty()) {
    const Point moved = point_at(point.at, units);
    const Box box = widen(box_of({&point, 1}));
    const auto changes = [&](const ExactPiece* piece) {
      return !piece->box.is_apart_from(box) && side_of(piece->plane, point) != side_of(piece->plane, moved);
    };
    if (std::ranges::any_of(nearly_, changes)) return std::nullopt;
  }
  const Vec3 rounded{in_scene(point.at.x), in_scene(point.at.y), in_scene(point.at.z)};
  const bool is_bent = scene_->scene.face(own_).shape != FaceShape::kPlanar;
  if (is_bent && scene_->pieces[own_piece(scene_->scene, own_, rounded)].plane.exact != front_) return std::nullopt;
  return rounded;
}

// --- Point factors ---

namespace {

// About what they take, measured with many occluders.
constexpr std::uint64_t kEffortOfPoint = 100, kEffortOfPlane = 125, kEffortOfCandidate = 15, kEffortOfEdges = 2;

}  // namespace

std::optional<double> PointFactors::at(const Point& point, const NearPlanes& near, const ExactSource& source) {
  const std::optional<Vec3> rounded = near.round(point);
  if (!rounded) return std::nullopt;
  exact_form_factor(scene_, {.point = *rounded, .normal = near.normal(), .on = {near.own()}, .id = {}}, source, {},
                    factor_, workspace_);
  effort_ += kEffortOfPoint;
  for (const PlaneRecord& plane : factor_.planes) {
    effort_ += kEffortOfPlane + kEffortOfCandidate * plane.tree_candidates + kEffortOfEdges * plane.pairs;
  }
  return factor_.value;
}

}  // namespace exactff::view_factors
