#include "contour/contour.h"

#include <utility>

namespace exactff::contour {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::sign;
using visibility::BoundaryPiece;
using visibility::EdgeParameter;

ContourIntegral::ContourIntegral(ExactVec3 normal) : normal_(std::move(normal)) {}

namespace {

ExactVec3 point_at(const BoundaryPiece& piece, const EdgeParameter& t) {
  if (sign(t.m) == 0 && t.l == 1) return piece.a;
  if (sign(t.l) == 0 && t.m == 1) return piece.b;
  return piece.a * t.l + piece.b * t.m;
}

}  // namespace

void ContourIntegral::add(const BoundaryPiece& piece) {
  const ExactVec3 a_cross_b = cross(piece.a, piece.b);
  const Integer w = piece.begin.l * piece.end.m - piece.begin.m * piece.end.l;
  if (sign(w) == 0) return;  // the piece begins where it ends
  const Integer normal_dot = dot(normal_, a_cross_b);
  if (sign(normal_dot) == 0) return;  // the normal lies in the plane of the edge and x: the term is 0
  terms_.push_back({dot(a_cross_b, a_cross_b), sign(w) > 0 ? normal_dot : Integer(-normal_dot), abs(w),
                    dot(point_at(piece, piece.begin), point_at(piece, piece.end))});
}

Ball ContourIntegral::evaluate(long bits) const {
  Ball sum;
  Ball norm;
  Ball sine;
  for (const Term& term : terms_) {
    arb_sqrt(norm.get(), kernel::to_ball(term.squared_cross, bits).get(), bits);
    arb_mul(sine.get(), norm.get(), kernel::to_ball(term.parameter_span, bits).get(), bits);
    Ball value;
    arb_atan2(value.get(), sine.get(), kernel::to_ball(term.ends_dot, bits).get(), bits);
    arb_mul(value.get(), value.get(), kernel::to_ball(term.normal_dot, bits).get(), bits);
    arb_div(value.get(), value.get(), norm.get(), bits);
    arb_sub(sum.get(), sum.get(), value.get(), bits);
  }
  Ball scale;
  arb_const_pi(scale.get(), bits);
  arb_mul_2exp_si(scale.get(), scale.get(), 1);
  arb_sqrt(norm.get(), kernel::to_ball(dot(normal_, normal_), bits).get(), bits);
  arb_mul(scale.get(), scale.get(), norm.get(), bits);
  arb_div(sum.get(), sum.get(), scale.get(), bits);
  return sum;
}

}  // namespace exactff::contour
