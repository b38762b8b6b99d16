#include "contour/measures.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/expect.h"
#include "kernel/poll.h"

namespace exactff::contour {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::sign;
using kernel::to_ball;

MeasureTerms terms_of(const Measure& measure, const Vec3& n) {
  if (measure.kind != MeasureKind::kOvercast) return MeasureTerms::kSolidAngle;
  if (n == measure.up) return MeasureTerms::kUpright;
  const ExactVec3 exact = kernel::exact_vector(n).v, up = kernel::exact_vector(measure.up).v;
  if (!is_zero(cross(exact, up))) return MeasureTerms::kTilted;
  return sign(dot(exact, up)) > 0 ? MeasureTerms::kUpright : MeasureTerms::kNone;
}

double most_of(const Measure& measure) {
  if (measure.kind != MeasureKind::kSolidAngle) return 1.0;
  return std::nextafter((measure.sphere ? 4.0 : 2.0) * std::numbers::pi, 13.0);  // pi is rounded down
}

void MeasureIntegral::start(const Vec3& n) {
  normal_ = kernel::exact_vector(n).v;
  kind_ = terms_of(measure_, n);
  middle_ = normal_ * dot(up_, up_) - up_ * dot(normal_, up_);
}

void MeasureIntegral::add(const visibility::BoundaryPiece& piece) {
  if (kind_ != MeasureTerms::kTilted) return add(piece.from(), piece.to());
  add_above(piece.from(), piece.to());
}

// Only what is above z's horizon.
void MeasureIntegral::add_above(const ExactVec3& p, const ExactVec3& q) {
  const Integer at_p = dot(up_, p), at_q = dot(up_, q);
  const bool from_above = sign(at_p) > 0, to_above = sign(at_q) > 0;
  if (from_above && to_above) return add(p, q);
  if (!from_above && !to_above) return;
  ExactVec3 crossing = p * abs(at_q) + q * abs(at_p);
  make_primitive(crossing);
  if (from_above) {
    add(p, crossing);
    add(crossing, middle_);
  } else {
    add(middle_, crossing);
    add(crossing, q);
  }
}

void MeasureIntegral::add(const ExactVec3& p, const ExactVec3& q) {
  const ExactVec3 c = cross(p, q);
  if (kind_ == MeasureTerms::kNone || is_zero(c)) return;  // an arc that begins where it ends
  terms_.push_back({dot(p, p), dot(q, q), dot(c, c), dot(p, q), dot(normal_, p), dot(normal_, q), dot(normal_, c),
                    dot(up_, c), dot(normal_, normal_), dot(normal_, up_)});
}

void MeasureIntegral::add_hemisphere() {
  const Integer one(1), minus(-1);
  const ExactVec3 axis = kind_ == MeasureTerms::kTilted ? up_
                         : longest_axis(normal_) == 0   ? ExactVec3{0, 1, 0}
                                                        : ExactVec3{1, 0, 0};
  const ExactVec3 e = cross(normal_, axis), f = cross(e, normal_);  // e x f has the direction of -n
  const ExactVec3 corners[] = {e, f, e * minus, f * minus};
  for (int k = 0; k < 4; ++k) {
    const ExactVec3 &p = corners[k], &q = corners[(k + 1) % 4];
    add(visibility::BoundaryPiece{p, q, {one, Integer(0)}, {Integer(0), one}});
  }
}

// In the notation of measures.h.
Ball MeasureIntegral::evaluate(long bits) const {
  const auto number = [bits](const Integer& value) { return to_ball(value, bits); };
  const auto whole = [bits](double value) { return to_ball(value, bits); };
  const bool overcast = measure_.kind == MeasureKind::kOvercast;
  const Ball up = sqrt(number(dot(up_, up_)));
  Ball sum(bits);
  for (const Term& term : terms_) {
    kernel::poll();
    const Ball p = sqrt(number(term.squared_p)), q = sqrt(number(term.squared_q)), lengths = p * q;
    const Ball cosine = number(term.ends_dot);
    // |C|^2 = (|p||q| + p . q) (|p||q| - p . q), which avoids a cancellation.
    const Ball e = sign(term.ends_dot) < 0 ? number(term.squared_cross) / (lengths - cosine) : lengths + cosine;
    const Ball s = number(term.normal_p) * q + number(term.normal_q) * p;
    const Ball n = sqrt(number(term.squared_normal)), n_cross = number(term.normal_cross);
    const Ball fan = atan2(n_cross, n * e + s);
    if (!overcast) {
      sum = sum + fan;
      continue;
    }
    const Ball sine = sqrt(number(term.squared_cross));
    const Ball lambert = whole(3.0) * up * atan2(sine, cosine) * n_cross / sine;
    const Ball second = whole(4.0) * s * number(term.up_cross) / (lengths * e);
    sum = sum + (lambert + whole(8.0) * number(term.normal_up) * fan + second) / n;
  }
  if (overcast) return whole(-1.0) * sum / (whole(14.0) * kernel::pi(bits) * up);
  const Ball half = whole(-1.0) * sum;  // of sigma
  return measure_.kind == MeasureKind::kSolidAngle ? twice(half) : half / twice(kernel::pi(bits));
}

Ball whole_measure(const Measure& measure, const Vec3& n, long bits) {
  const MeasureTerms terms = terms_of(measure, n);
  if (terms == MeasureTerms::kTilted) {
    MeasureIntegral sky(measure);
    sky.start(n);
    sky.add_hemisphere();
    return sky.evaluate(bits);
  }
  if (terms == MeasureTerms::kNone) return Ball(bits);
  if (measure.kind != MeasureKind::kSolidAngle) return to_ball(1.0, bits);
  const Ball turn = twice(kernel::pi(bits));
  return measure.sphere ? twice(turn) : turn;
}

}  // namespace exactff::contour
