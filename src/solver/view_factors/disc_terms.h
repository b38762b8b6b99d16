// The terms of a cell's formula in discs (certified_integral.h), at points of the unit square that is mapped to the
// cell.
//
// A part of the boundary from P to Q on the line through A and B, with the unit direction l = (B - A) / |B - A|, has
// the term (Eq. (4); F is the sum of the terms, with the opposite sign of the part's)
//
//   T = theta nu / (2 pi d),   nu = n . ((A - x) x l),   d^2 = (A - x)^2 - ((A - x) . l)^2,
//
// n being the receiver's unit normal, d the distance of x from the line and theta the angle between p = P - x and
// q = Q - x, negative if P and Q have changed places. With D = (Q - P) . l, |p x q| = |D| d. Let
// R = sqrt(p.p) sqrt(q.q) and A(z) = atan(sqrt z) / sqrt z. The tangent of half of theta is
// D d / (p.q + R) = (R - p.q) / (D d), hence two forms:
//
//   near   T = nu w A(w^2 d^2) / pi,             w = D / (R + p.q);
//   wide   T = h - nu w A(w^2 d^2) / pi,         w = D / (R - p.q),   D > 0,   h = nu / (2 d).
//
// The first is used up to a right angle, the second beyond. An edge in the receiver's plane has |nu| = d, and
// h = 1/2 or -1/2, the sign of nu: then neither form has a singularity but at P and Q and, for the near form, between
// them.
//
// If Q, say, is where the line through C and E, along e, seems to cross the edge: Q = A + (B - A) f,
//   f = (C - x) . (e x (A - C)) / ((C - x) . ((B - A) x e)),
// a quotient of affine functions. So T is made of affine functions of x by rational operations, by roots and by A, and
// analytic wherever these are.
#pragma once

#include <array>
#include <vector>

#include "kernel/disc.h"

namespace exactff::view_factors {

// --- Disc space ---

// Vectors of discs (kernel/disc.h), and points and planes in them, in the unit of Point::at.

using kernel::Disc;
struct Plane;
struct Point;

struct DiscVec {
  Disc x, y, z;
};

inline DiscVec operator+(const DiscVec& a, const DiscVec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline DiscVec operator-(const DiscVec& a, const DiscVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline DiscVec operator*(const DiscVec& a, const Disc& k) { return {a.x * k, a.y * k, a.z * k}; }
inline Disc dot(const DiscVec& a, const DiscVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline DiscVec cross(const DiscVec& a, const DiscVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Disc squared_length(const DiscVec& a) { return square(a.x) + square(a.y) + square(a.z); }
// Fails for a vector that may be zero.
inline DiscVec unit(const DiscVec& a) { return a * inverse(square_root(squared_length(a))); }

// Coordinates that are doubles have the radius 0, so that differences lose nothing.
[[nodiscard]] DiscVec enclose(const Point& point);
// The plane's normal, of length 1.
[[nodiscard]] DiscVec unit_normal(const Plane& plane);

// --- Disc terms ---

// A function k0 + k2 t + s (k1 + k3 t).
struct Bilinear {
  std::array<double, 4> centres{}, radii{};  // of k
};

// A function of x, (from - x) . gradient.
struct DiscFunction {
  DiscVec from, gradient;
  Bilinear on_square;
};

struct DiscTerm {
  // Where a line crosses the edge: f is the quotient. Or the edge's first or second end: f is 0 or 1.
  struct End {
    bool is_crossing = false;
    double fraction = 0.0;
    DiscFunction above, below;
  };
  DiscFunction along, across, beyond, height;  // (A - x) . l, by two directions perpendicular to l, and nu
  Disc size;                                   // |B - A|
  End from, to;
  bool in_receiver_plane = false;
  double sign = 1.0;
  double side = 0.0;  // the sign of nu on the cell, of an edge in the receiver's plane
};

struct DiscSum {
  double constant = 0.0;  // of F
  std::vector<DiscTerm> terms;
  Bilinear jacobian;  // of the map from the square to the cell
};

// Finds all functions on the square that x = s a + t b + s t c maps to the cell.
struct SquareMap {
  DiscVec a, b, c;
};
void take(DiscSum& sum, const SquareMap& map, const DiscVec& normal);

// For all s and t of the discs.
[[nodiscard]] Disc value_of(const DiscSum& sum, const Disc& s, const Disc& t);
[[nodiscard]] Disc jacobian_of(const DiscSum& sum, const Disc& s, const Disc& t);
// F times the Jacobian, for four pairs of s and t: the discs that `value_of` and `jacobian_of` give, unless one of the
// values is not finite; then all fail.
using FourDiscs = std::array<Disc, 4>;
[[nodiscard]] FourDiscs integrands_of(const DiscSum& sum, const FourDiscs& s, const FourDiscs& t);

}  // namespace exactff::view_factors
