#include "gradient/gradient.h"

#include <algorithm>
#include <utility>

#include "gradient/derivative.h"
#include "gradient/moving_arcs.h"
#include "kernel/ball.h"
#include "kernel/vec.h"

namespace exactff::gradient {

using contour::ArcSum;
using contour::MovingArc;
using kernel::ExactVec3;
using kernel::RationalVec3;
using visibility::PlaneQuery;
using visibility::VisibleBoundary;

void PointGradient::start(const visibility::View& view, const Request& request) {
  x_ = view.x;
  normal_ = view.n;
  list_arcs_ = request.list_arcs;
  along_.reset();
  if (request.along) along_ = kernel::exact_vector(*request.along).v;
  quick_.start(view.n);
  something_visible_ = false;
  kink_.reset();
  kinks_.clear();
  exact_planes_ = 0;
  arcs_.clear();
  contour_arcs_.clear();
}

void PointGradient::add(const PlaneQuery& query, const VisibleBoundary& boundary) {
  something_visible_ = something_visible_ || !boundary.empty();
  quick_.add(query, boundary);
  if (kink_ && !along_) return;
  search_.find(query, !boundary.empty(), along_ ? KinkSearch::Extent::kAll : KinkSearch::Extent::kFirst);
  if (search_.kink() && (!kink_ || search_.kink()->reason == KinkReason::kOnFace)) kink_ = search_.kink();
  if (along_) kinks_.push_back(search_.planes());
}

bool PointGradient::exists_along() const { return !kink_ || kink_->reason != KinkReason::kOnFace; }

Ball PointGradient::form_factor() const {
  const contour::QuickGradient::Value value = quick_.sum().form_factor();
  return kernel::ball_around(value.hi, value.lo, value.error);
}

bool PointGradient::finish(int cap, Gradient& result) {
  result.kink = kink_;
  result.along.reset();
  result.arcs.clear();
  result.vertices.clear();
  result.frames.clear();
  bool done = !(list_arcs_ && something_visible_ && !kink_);
  if (along_) {
    result.along.emplace();
    if (!exists_along()) {
      set_none(*result.along);
    } else if (something_visible_ || kink_) {
      done = false;
    } else {
      set_zero(*result.along);
    }
  }
  const bool quick = cap >= kQuickBits;
  const auto take = [&](const contour::QuickGradient::Value& value, Derivative& derivative) {
    if (!something_visible_) {
      set_zero(derivative);
    } else if (!quick || !is_determined(value.hi, value.lo, value.error, derivative)) {
      derivative.status = DerivativeStatus::kEnclosed;  // so far
      done = false;
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    take(quick_.sum().normal(axis), result.normal[axis]);
    if (kink_) {
      set_none(result.position[axis]);
    } else {
      take(quick_.sum().position(axis), result.position[axis]);
    }
  }
  return done;
}

void PointGradient::add_exactly(const PlaneQuery& query, const VisibleBoundary& boundary) {
  const std::size_t plane = exact_planes_++;
  const std::span<const SightResult> except =
      plane < kinks_.size() ? std::span<const SightResult>(kinks_[plane]) : std::span<const SightResult>();
  add_contour_arcs(boundary, contour_arcs_);
  if (!kink_ || along_) add_moving_arcs(query, boundary, except, arcs_);
}

void PointGradient::list_arcs(const ExactVec3& n, Gradient& result) const {
  constexpr long kBits = 128;
  const auto point = [&](const ExactVec3& t, const RationalVec3& nearness) {
    const RationalVec3 w = kernel::to_rational(t);
    const RationalVec3 at = kernel::to_rational(x_) + w * kernel::Rational(1 / dot(nearness, w));
    return Vec3{kernel::nearest_double(at.x), kernel::nearest_double(at.y), kernel::nearest_double(at.z)};
  };
  const Ball factor =
      kernel::to_ball(1.0, kBits) / (twice(kernel::pi(kBits)) * sqrt(kernel::to_ball(dot(n, n), kBits)));
  for (const MovingArc& arc : arcs_) {
    double part[3];
    for (int axis = 0; axis < 3; ++axis) {
      ArcSum one;
      one.add_position(arc, n, axis);
      part[axis] = kernel::nearest_to_midpoint(one.evaluate(kBits) * factor);
    }
    result.arcs.push_back({point(arc.begin, arc.nearness), point(arc.end, arc.nearness), {part[0], part[1], part[2]}});
  }
  const auto size = [](const GradientArc& arc) { return kernel::max_norm(arc.part); };
  std::ranges::stable_sort(result.arcs, [&](const auto& a, const auto& b) { return size(a) > size(b); });
}

void PointGradient::certify(int cap, Gradient& result) {
  const ExactVec3 n = kernel::make_direction(kernel::exact_vector(normal_).v).exact;
  const auto over_tau = [](long bits) { return kernel::to_ball(1.0, bits) / twice(kernel::pi(bits)); };
  const auto over_length = [&](const ExactVec3& v) {
    return [&](long bits) { return over_tau(bits) / sqrt(kernel::to_ball(dot(v, v), bits)); };
  };
  arcs_ = joined(std::move(arcs_));
  contour_arcs_ = joined(std::move(contour_arcs_));
  for (int axis = 0; axis < 3; ++axis) {
    if (result.position[axis].status == DerivativeStatus::kEnclosed) {
      ArcSum sum;
      for (const MovingArc& arc : arcs_) sum.add_position(arc, n, axis);
      gradient::certify(sum, over_length(n), cap, result.position[axis]);
    }
    if (result.normal[axis].status == DerivativeStatus::kEnclosed) {
      ArcSum sum;
      for (const MovingArc& arc : contour_arcs_) sum.add_normal(arc, axis);
      gradient::certify(sum, over_tau, cap, result.normal[axis]);
    }
  }
  if (list_arcs_ && !kink_) list_arcs(n, result);
  if (!along_ || !exists_along()) return;
  // A single sum with the sign of the movement of each arc.
  ArcSum sum;
  for (const MovingArc& arc : arcs_) sum.add_along(arc, n, *along_);
  for (const std::vector<SightResult>& plane : kinks_) {
    for (const SightResult& sight : plane) {
      const int way = kernel::sign(dot(*along_, sight.normal));
      if (way == 0) continue;
      for (const SightArc& arc : sight.arcs) {
        const RationalVec3& gain = way > 0 ? arc.gain_ahead : arc.gain_back;
        if (!is_zero(gain)) sum.add_gain({arc.begin, arc.end, gain}, n, *along_);
      }
    }
  }
  const ExactVec3& d = *along_;
  gradient::certify(
      sum, [&](long bits) { return over_length(n)(bits) / sqrt(kernel::to_ball(dot(d, d), bits)); }, cap,
      *result.along);
}

}  // namespace exactff::gradient
