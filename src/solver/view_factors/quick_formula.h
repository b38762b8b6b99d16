// Tampieri's Eq. (4) over a boundary that is constant on a cell, in doubles, at four points at a time. An estimate: the
// certified integrals are those of disc_formula.h.
#pragma once

#include <span>

#include "exactff/geometry.h"

namespace exactff::view_factors {

struct Evaluated {
  double value = 0.0;
  double rounding = 0.0;  // an estimate of the error that rounding makes
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
