// Vectors of discs (kernel/disc.h), and points and planes in them, in the unit of Point::at.
#pragma once

#include "kernel/disc.h"

namespace exactff::view_factors {

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

}  // namespace exactff::view_factors
