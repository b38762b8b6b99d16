// The visible share, seen from x, of a small convex window in a plane of a source. The control of the sampled algorithm
// uses it for every sub-patch instead of tracing rays.
//
// The visible region of the whole plane is found exactly, once per receiver, with the code of the exact method. A
// window is given by directions from x: its corners are the points where they meet the plane, so rounding cannot move
// them out of the plane. Let c be a point of the window and p_i q_i the oriented pieces of the region's boundary, in
// any order. Then
//
//   visible area = sum_i +- area( triangle(c, p_i, q_i) n window ).
//
// Whether the answer is 0, 1 or in between is decided exactly. It is in between if and only if a piece that is not part
// of the source's own outline runs through the interior of the window. A filter in double with a proved bound decides
// this, or rational numbers if the filter is uncertain. The share itself is then a sum in double.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactff/exact.h"
#include "kernel/expect.h"
#include "kernel/numbers.h"
#include "visibility/plane_visibility.h"
#include "visibility/polygon_sets.h"

namespace exactff::exact {

// --- Window area ---

// Small convex polygons in a plane, in doubles or in rational numbers: the area of a window within a region that is
// given by the pieces of its boundary.

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

// --- Visible share ---

class VisibleShare {
 public:
  // Requires x in front of the plane, as it is in front of all that source_planes finds, and a receiver as for
  // exact_form_factor.
  VisibleShare(const Scene& scene, const Receiver& receiver, const visibility::SourcePlane& plane,
               Workspace& workspace);

  // Selects the piece of the plane in which the next windows lie, up to rounding errors.
  void start(std::uint32_t piece);

  static constexpr double kAccuracy = 0x1p-30;
  // Visible area over whole area of the window: exactly 0, exactly 1, or strictly in between. The errors of the
  // window's corners then change it by less than kAccuracy, and so does rounding for each piece of the region's
  // boundary (see window_blur); usually it is much closer.
  //
  // Requires three or four corners, convex, counter-clockwise as seen from x. Returns 0 if rounding of the corners has
  // left no window: all on one line, clockwise, or some directions that do not meet the plane.
  [[nodiscard]] double of(std::span<const Vec3> directions);
  // The same, computed in rational numbers and rounded once.
  [[nodiscard]] double of_exactly(std::span<const Vec3> directions);

  // Number of pieces and windows that the filter left to rational numbers.
  [[nodiscard]] std::uint64_t undecided() const { return undecided_; }

 private:
  using Rational = kernel::Rational;
  struct Piece {
    Point<Rational> exact_p, exact_q;  // the region lies to the left of pq
    Point<double> p, q;
    bool outline = false;  // part of the outline of the source
    bool horizon = false;
  };
  // A window, counter-clockwise in (u, v).
  struct Window {
    SmallPolygon<double> corners;
    double error = 0.0;  // bound on the error of each coordinate
  };
  enum class Meeting { kNo, kYes, kUnsure };

  [[nodiscard]] Point<double> flat(const Vec3& direction, double& error) const;
  void make_frame();
  void add(const visibility::BoundaryPiece& piece);
  [[nodiscard]] bool on_edge(const Piece& piece, const Point<Rational>& a, const Point<Rational>& b) const;
  void set_window(std::span<const Vec3> directions);
  [[nodiscard]] SmallPolygon<Rational> exact_window(std::span<const Vec3> directions) const;
  [[nodiscard]] bool partly(std::span<const Vec3> directions);
  [[nodiscard]] Meeting meets(const Piece& piece) const;
  [[nodiscard]] bool all_meet_plane(std::span<const Vec3> directions) const;
  [[nodiscard]] double window_blur(double doubled_area_of_window) const;

  const visibility::View view_;
  const visibility::SourcePlane& plane_;
  bool all_ = false;  // the whole source is visible
  std::vector<Piece> pieces_;
  kernel::ExactVec3 away_;                       // the plane's normal turned away from x
  std::optional<visibility::PlaneFrame> frame_;  // its unit square is the source's box
  std::array<double, 3> away_approx_{};          // the frame in doubles
  Point<double> low_approx_{}, size_approx_{};
  Window window_;
  std::uint64_t undecided_ = 0;
};

}  // namespace exactff::exact
