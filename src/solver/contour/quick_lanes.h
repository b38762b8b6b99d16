// What sums over arcs in double-double share: four edges or pieces at a time, one per lane, and where the plane through
// x and another edge crosses an edge.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "contour/quick_contour.h"

namespace exactff::contour {

// Divided by a power of two, so that the largest component is in [1/2, 1).
[[nodiscard]] std::array<double, 3> scaled_normal(const Vec3& n);
// With the error inflated; infinite unless all of it is finite.
[[nodiscard]] QuickContour::Value value_of(const Bounded& x);

inline constexpr std::size_t kLanes = 4;

template <class T>
using FourOf = std::array<const T*, kLanes>;  // pointers into memory, one per lane

// Pointers to up to four items; the last item is repeated if there are fewer.
template <class T>
EXACTFF_INLINE FourOf<T> four_of(std::span<const T> some) {
  const std::size_t last = some.size() - 1;
  return {&some[0], &some[std::min<std::size_t>(1, last)], &some[std::min<std::size_t>(2, last)],
          &some[std::min<std::size_t>(3, last)]};
}

template <class Line>
EXACTFF_INLINE FourBounded gather(const FourOf<Line>& lines, Bounded Line::*part) {
  const Bounded &x = lines[0]->*part, &y = lines[1]->*part, &z = lines[2]->*part, &t = lines[3]->*part;
  return {Four{x.hi, y.hi, z.hi, t.hi}, Four{x.lo, y.lo, z.lo, t.lo}, Four{x.error, y.error, z.error, t.error}};
}

template <class Line>
EXACTFF_INLINE FourVector gather(const FourOf<Line>& lines, Vector Line::*part) {
  const Vector &p = lines[0]->*part, &q = lines[1]->*part, &r = lines[2]->*part, &s = lines[3]->*part;
  const auto component = [&](int i) -> BasicDoubleDouble<Four> {
    return {Four{p.c[i].hi, q.c[i].hi, r.c[i].hi, s.c[i].hi}, Four{p.c[i].lo, q.c[i].lo, r.c[i].lo, s.c[i].lo}};
  };
  return {{component(0), component(1), component(2)},
          Four{p.norm, q.norm, r.norm, s.norm},
          Four{p.error, q.error, r.error, s.error}};
}

EXACTFF_INLINE FourVector gather(const FourOf<QuickCorner>& corners) {
  const QuickCorner &p = *corners[0], &q = *corners[1], &r = *corners[2], &s = *corners[3];
  const auto component = [&](int i) -> BasicDoubleDouble<Four> {
    return {Four{p.hi[i], q.hi[i], r.hi[i], s.hi[i]}, Four{p.lo[i], q.lo[i], r.lo[i], s.lo[i]}};
  };
  return vector({component(0), component(1), component(2)}, Four{p.error, q.error, r.error, s.error});
}

EXACTFF_INLINE Bounded lane(const FourBounded& x, std::size_t k) { return {x.hi[k], x.lo[k], x.error[k]}; }

EXACTFF_INLINE Vector lane(const FourVector& v, std::size_t k) {
  const auto component = [&](int i) -> DoubleDouble { return {v.c[i].hi[k], v.c[i].lo[k]}; };
  return {{component(0), component(1), component(2)}, v.norm[k], v.error[k]};
}

// The receiver's normal with an error, because scaling it may have lost a component to underflow.
template <class Real>
EXACTFF_INLINE BasicVector<Real> vector_of(const std::array<double, 3>& normal) {
  const auto component = [&](int i) -> BasicDoubleDouble<Real> { return {uniform<Real>(normal[i]), Real{}}; };
  return vector({component(0), component(1), component(2)}, uniform<Real>(kUnderflow));
}

EXACTFF_INLINE FourMask has_moderate_size(const FourVector& v) {
  const Four largest = larger(larger(magnitude(v.c[0].hi), magnitude(v.c[1].hi)), magnitude(v.c[2].hi));
  return both(both(largest >= 0x1p-200, largest <= 0x1p200), v.norm <= 0x1p202);  // the last condition is false for NaN
}

// Four points s a + m d, each of one edge, and their (s : m).
struct FourPoints {
  FourBounded s;
  FourBounded m;
  FourVector direction;
  FourMask at_a{}, at_b{};  // it is that end of the edge
};

// The ends are those of p.
EXACTFF_INLINE FourPoints where(const FourMask& condition, const FourPoints& p, const FourPoints& q) {
  return {where(condition, p.s, q.s), where(condition, p.m, q.m), where(condition, p.direction, q.direction), p.at_a,
          p.at_b};
}

// normal . p, where `normal` is that of a plane through c. normal . (p - t c) loses less accuracy if p and t c are near
// each other.
EXACTFF_INLINE FourBounded height(const FourVector& normal, const FourVector& c, const FourVector& p) {
  const Four t = p.norm / c.norm;
  const Four distance = magnitude(p.c[0].hi - t * c.c[0].hi) + magnitude(p.c[1].hi - t * c.c[1].hi) +
                        magnitude(p.c[2].hi - t * c.c[2].hi);
  const FourMask near = distance < 0.25 * p.norm;
  return dot(normal, in_some_lane(near) ? where(near, near_cancellation(p, t, c), p) : p);
}

// x times a power of two. Requires that nothing overflows.
EXACTFF_INLINE FourBounded scaled(const FourBounded& x, const Four& scale) {
  return {x.hi * scale, x.lo * scale, x.error * scale + kUnderflow};
}

// The power of two that scales x into [1, 2), if x and its inverse are normal; otherwise an arbitrary number.
EXACTFF_INLINE Four inverse_power_of_two(const Four& x) {
  const FourMask biased = (FourMask(x) >> 52) & 0x7FF;
  return Four((2046 - biased) << 52);
}

// The point where the plane with the given normal, through x and c, crosses the edge from a to a + d. Declined unless
// the crossing is certain.
EXACTFF_INLINE FourPoints cross_edges(const FourVector& normal, const FourVector& c, const FourVector& a,
                                      const FourVector& d) {
  const FourBounded height_a = height(normal, c, a), rise = dot(normal, d);
  const FourBounded height_b = height_a + rise;
  const FourMask crosses =
      both(both(sign_is_certain(height_a), sign_is_certain(height_b)), differ(height_a.hi < 0.0, height_b.hi < 0.0));
  const Four scale = inverse_power_of_two(magnitude(rise.hi));
  const FourBounded s = only_where(crosses, scaled(absolute(rise), scale));
  const FourBounded m = only_where(crosses, scaled(absolute(height_a), scale));
  return {s, m, combination(s, a, m, d)};
}

// Step 1 of quick_contour.cpp for four edges: the ends, d and a x d.
struct FourSpans {
  FourMask reversed;
  FourVector a, b, along, cross;
};

// Of up to four edges.
EXACTFF_INLINE FourSpans spans_of(std::span<const QuickCorner> corners, std::span<const QuickEdge> edges) {
  const FourOf<QuickEdge> edge = four_of(edges);
  const auto ends = [&](std::uint32_t QuickEdge::*end) __attribute__((always_inline)) {
    return gather(FourOf<QuickCorner>{&corners[edge[0]->*end], &corners[edge[1]->*end], &corners[edge[2]->*end],
                                      &corners[edge[3]->*end]});
  };
  const FourVector p = ends(&QuickEdge::a), q = ends(&QuickEdge::b);
  FourSpans result;
  result.reversed = q.norm < p.norm;
  result.a = where(result.reversed, q, p);
  result.b = where(result.reversed, p, q);
  result.along = difference(result.b, result.a);
  result.cross = cross(result.a, result.along);
  const FourMask usable = both(has_moderate_size(p), has_moderate_size(q));
  result.cross.error = where(usable, result.cross.error, uniform<Four>(kDeclined.error));
  return result;
}

// The edges of four pieces.
template <class Line>
struct FourEdges {
  FourOf<Line> line;
  FourVector a;
  FourVector along;
};

template <class Line>
EXACTFF_INLINE FourEdges<Line> edges_of(const FourOf<QuickPiece>& piece, std::span<const Line> lines) {
  const FourOf<Line> line = {&lines[piece[0]->edge], &lines[piece[1]->edge], &lines[piece[2]->edge],
                             &lines[piece[3]->edge]};
  return {line, gather(line, &Line::a), gather(line, &Line::along)};
}

// Step 2 of quick_contour.cpp, for one end of four pieces.
template <class Line>
EXACTFF_INLINE FourPoints locate(const FourEdges<Line>& edges, const FourOf<QuickPiece>& pieces,
                                 std::uint32_t QuickPiece::*which, std::span<const Line> lines) {
  FourOf<Line> crossing = edges.line;  // the default: a line does not cross itself, so this declines
  FourPoints corner;
  for (std::size_t k = 0; k < kLanes; ++k) {
    const std::uint32_t end = pieces[k]->*which;
    const std::uint32_t end_at_a = edges.line[k]->reversed ? QuickPiece::kAtB : QuickPiece::kAtA;
    corner.at_a[k] = end == end_at_a ? -1 : 0;
    corner.at_b[k] = end >= QuickPiece::kAtA && end != end_at_a ? -1 : 0;
    if (end < QuickPiece::kAtA) crossing[k] = &lines[end];
  }
  const FourMask at_b = corner.at_b, at_corner = either(corner.at_a, at_b);
  if (in_some_lane(at_corner)) {
    const FourBounded zero{}, one{uniform<Four>(1.0), {}, {}};
    corner.s = one;
    corner.m = where(at_b, one, zero);
    corner.direction = where(at_b, gather(edges.line, &Line::b), edges.a);
    if (in_every_lane(at_corner)) return corner;
  }
  return where(at_corner, corner,
               cross_edges(gather(crossing, &Line::cross), gather(crossing, &Line::a), edges.a, edges.along));
}

}  // namespace exactff::contour
