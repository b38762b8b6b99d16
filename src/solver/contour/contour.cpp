#include "contour/contour.h"

#include <utility>

#include "kernel/expect.h"
#include "kernel/poll.h"

namespace exactff::contour {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::sign;
using kernel::to_ball;
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
  EXACTFF_EXPECT(!kernel::is_zero(a_cross_b));
  const Integer w = piece.begin.l * piece.end.m - piece.begin.m * piece.end.l;
  if (sign(w) == 0) return;  // the piece begins where it ends
  const Integer normal_dot = dot(normal_, a_cross_b);
  if (sign(normal_dot) == 0) return;  // the normal lies in the plane of the edge and x: the term is 0
  terms_.push_back({dot(a_cross_b, a_cross_b), sign(w) > 0 ? normal_dot : Integer(-normal_dot), abs(w),
                    dot(point_at(piece, piece.begin), point_at(piece, piece.end))});
}

// Eq. (4), in the notation of contour.h.
Ball ContourIntegral::evaluate(long bits) const {
  Ball sum(bits);
  for (const Term& term : terms_) {
    kernel::poll();
    const Ball norm = sqrt(to_ball(term.squared_cross, bits));
    const Ball angle = atan2(norm * to_ball(term.parameter_span, bits), to_ball(term.ends_dot, bits));
    sum = sum - angle * to_ball(term.normal_dot, bits) / norm;
  }
  return sum / (twice(kernel::pi(bits)) * sqrt(to_ball(dot(normal_, normal_), bits)));
}

}  // namespace exactff::contour
