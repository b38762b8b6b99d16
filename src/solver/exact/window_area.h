// Small convex polygons in a plane, in doubles or in rational numbers: the area of a window within a region that is
// given by the pieces of its boundary.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "kernel/expect.h"
#include "visibility/plane_frame.h"

namespace exactff::exact {

template <class Number>
using Point = visibility::PlanePoint<Number>;

// A polygon of at most kMost corners: those that three cuts (left_part) can leave of four. Without roundings there are
// at most seven. With them, corners on one line may seem to lie on both sides of it in turn. If k of n corners are cut
// off, n - k corners are left, and two crossings for each of min(k, n - k) corners at most. This is at most 3 n / 2, so
// 4 corners become 6, 9 and 13.
template <class Number>
class SmallPolygon {
 public:
  static constexpr std::size_t kMost = 13;

  void push_back(const Point<Number>& p) {
    EXACTFF_EXPECT(size_ < kMost);
    corners_[size_++] = p;
  }
  void clear() { size_ = 0; }
  void reverse() { std::reverse(corners_.begin(), corners_.begin() + static_cast<std::ptrdiff_t>(size_)); }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Point<Number>& operator[](std::size_t k) const { return corners_[k]; }
  [[nodiscard]] const Point<Number>& after(std::size_t k) const { return corners_[k + 1 < size_ ? k + 1 : 0]; }

 private:
  std::array<Point<Number>, kMost> corners_;
  std::size_t size_ = 0;
};

// Twice the signed area of the triangle abp; positive if a, b, p run counter-clockwise.
template <class Number>
Number turn(const Point<Number>& a, const Point<Number>& b, const Point<Number>& p) {
  return Number((b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u));
}

template <class Number>
Number doubled_area(const SmallPolygon<Number>& polygon) {
  Number sum(0);
  for (std::size_t k = 2; k < polygon.size(); ++k) sum += turn(polygon[0], polygon[k - 1], polygon[k]);
  return sum;
}

template <class Number>
Point<Number> middle_of(const SmallPolygon<Number>& polygon) {
  Point<Number> sum = polygon[0];
  for (std::size_t k = 1; k < polygon.size(); ++k) {
    sum.u += polygon[k].u;
    sum.v += polygon[k].v;
  }
  const Number count(static_cast<double>(polygon.size()));
  return {Number(sum.u / count), Number(sum.v / count)};
}

// The part of a convex polygon to the left of ab.
template <class Number>
SmallPolygon<Number> left_part(const SmallPolygon<Number>& polygon, const Point<Number>& a, const Point<Number>& b) {
  SmallPolygon<Number> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point<Number>& p = polygon[k];
    const Point<Number>& q = polygon.after(k);
    const Number at_p = turn(a, b, p), at_q = turn(a, b, q);
    if (at_p >= 0) kept.push_back(p);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
      const Number t = at_p / (at_p - at_q);
      kept.push_back({Number(p.u + t * (q.u - p.u)), Number(p.v + t * (q.v - p.v))});
    }
  }
  return kept;
}

// Twice the area of triangle(c, p, q) within the window, negative if the triangle is clockwise. The sum over the
// boundary pieces pq of a region, each with the region to its left, is twice the area of the region within the window.
// Requires a window of at most four corners.
template <class Number>
Number wedge(const SmallPolygon<Number>& window, const Point<Number>& c, const Point<Number>& p,
             const Point<Number>& q) {
  const Number whole = turn(c, p, q);
  if (whole == 0) return Number(0);
  const bool left = whole > 0;
  const Point<Number>& a = left ? p : q;
  const Point<Number>& b = left ? q : p;
  const Number part = doubled_area(left_part(left_part(left_part(window, c, a), b, c), a, b));
  return left ? part : Number(-part);
}

}  // namespace exactff::exact
