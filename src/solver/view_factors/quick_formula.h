// Tampieri's Eq. (4) over a boundary that is constant on a cell, in doubles, at four points at a time. Certified
// integrals are those of certified_integral.h.
//
// Roundings. A coordinate is at most 1 and carries a few roundings, so a difference of two points errs by less than
// e = 2^-50. This turns the direction of a vertex by e / distance, and the plane through x and an edge by
// e (|a| + |a - b|) / |a x b|; a crossing of two lines moves along its edge as its weights do. To first order, a term
// angle * cosine errs by |angle| times what turns the plane and |cosine| times what turns both ends. Four times that is
// a bound where it is below 2^-6: it covers the higher orders, and the arithmetic, which errs by less than 2^-50 times
// the same magnitudes, but for 2^-49 of the term itself.
//
// Shared crossings. Where two edges are almost seen along one another, their crossing Y can be anywhere on them, but F
// hardly depends on it. So if exactly two parts end at it, with opposite signs, both end at the same point P, which
// lies on the first of the two edges, between its ends, as Y does. Then the contour is wrong by the sides of a
// triangle: from Y to P along the first edge, and along the second one from Y to the point of it that is nearest to P.
// The third side, of length d, is missing. With z the angle from Y to P, the triangle's area is at most d tan(z / 2),
// and z is at most the angle w of the first edge. So by Eq. (4), 2 pi F is wrong by at most d (1 + 2 tan(w / 2)), to
// first order in d.
#pragma once

#include <span>

#include "exactff/geometry.h"

namespace exactff::view_factors {

struct Evaluated {
  double value = 0.0;
  double rounding = 0.0;  // below 2^-6: a bound of the error that rounding makes
};

// A part of an edge, between vertices or crossings with other edges.
struct QuickPart {
  struct Segment {
    Vec3 a, along;  // from a to a + along
    double length = 0.0;
  };
  struct End {
    enum class Kind { kVertex, kCrossing, kSharedOnEdge, kSharedOnOther };  // shared: where the point lies
    Kind kind = Kind::kVertex;
    Vec3 at;        // of a vertex
    Segment other;  // else: crosses the edge there
  };
  Segment edge;
  End from, to;
  double sign = 1.0;
};

// At every point; `normal` is the receiver's, of length 1. Points do not affect one another.
void evaluate(std::span<const QuickPart> parts, const Vec3& normal, std::span<const Vec3> points,
              std::span<Evaluated> values);

}  // namespace exactff::view_factors
