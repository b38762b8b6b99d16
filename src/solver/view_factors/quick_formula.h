// Tampieri's Eq. (4) over a boundary that is constant on a cell, in doubles, at four points at a time. Certified
// integrals are those of disc_formula.h.
//
// Roundings. A coordinate is at most 1 and carries a few roundings, so a difference of two points errs by less than
// e = 2^-50. This turns the direction of a vertex by e / distance, and the plane through x and an edge by
// e (|a| + |a - b|) / |a x b|; a crossing of two lines moves along its edge as its weights do. To first order, a term
// angle * cosine errs by |angle| times what turns the plane and |cosine| times what turns both ends. Four times that is
// a bound where it is below 2^-6: it covers the higher orders, and the arithmetic, which errs by less than 2^-50 times
// the same magnitudes, but for 2^-49 of the term itself.
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
    Segment line;  // crosses the edge there, if `crosses`
    Vec3 at;       // else
    bool crosses = false;
  };
  Segment edge;
  End from, to;
  double sign = 1.0;
};

// At every point; `normal` is the receiver's, of length 1. Points do not affect one another.
void evaluate(std::span<const QuickPart> parts, const Vec3& normal, std::span<const Vec3> points,
              std::span<Evaluated> values);

}  // namespace exactff::view_factors
