#include "contour/quick_gradient.h"

#include <algorithm>
#include <cmath>

#include "contour/quick_angle.h"
#include "contour/quick_lanes.h"
#include "contour/quick_vector.h"
#include "kernel/vec.h"

namespace exactff::contour {

using namespace kernel::double_double;

namespace {

EXACTFF_INLINE Vector vector_of_corner(const QuickCorner& corner) {
  const auto component = [&](int i) -> DoubleDouble { return {corner.hi[i], corner.lo[i]}; };
  return vector<double>({component(0), component(1), component(2)}, corner.error);
}

template <class Real>
EXACTFF_INLINE BasicBounded<Real> component(const BasicVector<Real>& v, int i) {
  return {v.c[i].hi, v.c[i].lo, v.error};
}

EXACTFF_INLINE FourBounded psi_of(const FourVector& w, const FourVector& n, const FourVector& d) {
  return dot(w, n) * dot(w, d) / dot(w, w);
}

}  // namespace

QuickCorner lifted(const QuickCorner& direction, const std::array<Bounded, 3>& normal, const Bounded& offset) {
  const Vector c = vector_of_corner(direction);
  const Bounded height = normal[0] * component(c, 0) + normal[1] * component(c, 1) + normal[2] * component(c, 2);
  const Bounded factor = offset / height;
  QuickCorner result;
  for (int i = 0; i < 3; ++i) {
    const Bounded x = factor * component(c, i);
    result.hi[i] = x.hi;
    result.lo[i] = x.lo;
    result.error = std::max(result.error, x.error);
  }
  const bool usable = sign_is_certain(height) && height.hi > 0.0 && std::isfinite(result.error);
  if (!usable) result.error = kDeclined.error;
  return result;
}

QuickGradient::QuickGradient(const Vec3& normal) {
  int exponent = 0;
  std::frexp(kernel::max_norm(normal), &exponent);
  normal_ = {std::ldexp(normal.x, -exponent), std::ldexp(normal.y, -exponent), std::ldexp(normal.z, -exponent)};
}

namespace {

using Line = QuickGradient::Line;

EXACTFF_CLONES
void gradient_lines_of(const std::array<double, 3>& normal, std::span<const QuickCorner> corners,
                       std::span<const QuickEdge> edges, std::span<Line> result) {
  const FourVector n = vector_of<Four>(normal);
  for (std::size_t i = 0; i < edges.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, edges.size() - i);
    const FourOf<QuickEdge> edge = four_of(edges.subspan(i, count));
    const auto ends = [&](std::uint32_t QuickEdge::*end) __attribute__((always_inline)) {
      return gather(FourOf<QuickCorner>{&corners[edge[0]->*end], &corners[edge[1]->*end], &corners[edge[2]->*end],
                                        &corners[edge[3]->*end]});
    };
    const FourVector p = ends(&QuickEdge::a), q = ends(&QuickEdge::b);
    const FourMask reversed = q.norm < p.norm;
    const FourVector a = where(reversed, q, p), b = where(reversed, p, q), d = difference(b, a);
    FourVector c = cross(a, d);
    c.error = where(both(has_moderate_size(p), has_moderate_size(q)), c.error, uniform<Four>(kDeclined.error));
    const FourBounded squared = dot(c, c), size = square_root(squared);
    const FourBounded inverse = FourBounded{uniform<Four>(1.0), {}, {}} / size;
    const FourBounded growth = dot(cross(n, d), c) * inverse / squared;
    const FourBounded psi_a = psi_of(a, n, d), psi_b = psi_of(b, n, d);
    for (std::size_t k = 0; k < count; ++k) {
      result[i + k] = {reversed[k] != 0, lane(a, k),       lane(b, k),      lane(d, k),     lane(c, k),
                       lane(size, k),    lane(inverse, k), lane(growth, k), lane(psi_a, k), lane(psi_b, k)};
    }
  }
}

// --- Pieces ---

struct FourEnds {
  FourPoints point;
  FourBounded psi;
};

EXACTFF_INLINE FourEnds ends_of(const FourOf<Line>& line, const FourVector& n, const FourOf<QuickPiece>& pieces,
                                std::uint32_t QuickPiece::*which, std::span<const Line> lines) {
  FourOf<Line> crossing = line;  // the default: a line does not cross itself, so this declines
  FourMask at_a{}, at_b{};
  for (std::size_t k = 0; k < kLanes; ++k) {
    const std::uint32_t end = pieces[k]->*which;
    const std::uint32_t end_at_a = line[k]->reversed ? QuickPiece::kAtB : QuickPiece::kAtA;
    at_a[k] = end == end_at_a ? -1 : 0;
    at_b[k] = end >= QuickPiece::kAtA && end != end_at_a ? -1 : 0;
    if (end < QuickPiece::kAtA) crossing[k] = &lines[end];
  }
  const FourMask at_corner = either(at_a, at_b);
  const FourVector a = gather(line, &Line::a);
  FourEnds corner;
  if (in_some_lane(at_corner)) {
    const FourBounded zero{}, one{uniform<Four>(1.0), {}, {}};
    corner = {{one, where(at_b, one, zero), where(at_b, gather(line, &Line::b), a)},
              where(at_b, gather(line, &Line::psi_b), gather(line, &Line::psi_a))};
    if (in_every_lane(at_corner)) return corner;
  }
  const FourPoints found =
      cross_edges(gather(crossing, &Line::cross), gather(crossing, &Line::a), a, gather(line, &Line::along));
  return {where(at_corner, corner.point, found),
          where(at_corner, corner.psi, psi_of(found.direction, n, gather(line, &Line::along)))};
}

struct FourArcs {
  std::size_t count;  // the lanes after them repeat one
  FourOf<Line> line;
  FourEnds p, q;
  FourBounded theta;
};

// Of the first pieces.
EXACTFF_INLINE FourArcs arcs_at(const FourVector& n, std::span<const QuickPiece> pieces, std::span<const Line> lines,
                                const AngleConstants& known) {
  const std::size_t count = std::min(kLanes, pieces.size());
  const FourOf<QuickPiece> piece = four_of(pieces.first(count));
  const FourOf<Line> line = {&lines[piece[0]->edge], &lines[piece[1]->edge], &lines[piece[2]->edge],
                             &lines[piece[3]->edge]};
  const FourEnds p = ends_of(line, n, piece, &QuickPiece::begin, lines);
  const FourEnds q = ends_of(line, n, piece, &QuickPiece::end, lines);
  const FourBounded w = sum_of_products(p.point.s, q.point.m, -p.point.m, q.point.s);
  return {count, line, p, q, atan2(w * gather(line, &Line::size), dot(p.point.direction, q.point.direction), known)};
}

using FourSums = std::array<FourBounded, 3>;

EXACTFF_CLONES
void add_arcs(const std::array<double, 3>& normal, std::span<const QuickPiece> pieces, std::span<const Line> lines,
              const AngleConstants& known, FourSums& position, FourSums& v) {
  const FourVector n = vector_of<Four>(normal);
  for (std::size_t i = 0; i < pieces.size(); i += kLanes) {
    const FourArcs arcs = arcs_at(n, pieces.subspan(i), lines, known);
    const FourOf<Line>& line = arcs.line;
    const FourEnds &p = arcs.p, &q = arcs.q;
    const FourBounded inverse = gather(line, &Line::inverse);
    const FourMask present = FourMask{0, 1, 2, 3} < static_cast<std::int64_t>(arcs.count);
    const FourBounded over_size = where(present, arcs.theta * inverse, FourBounded{});
    const FourBounded moved =
        where(present, arcs.theta * gather(line, &Line::growth) + (q.psi - p.psi) * (inverse * inverse), FourBounded{});
    FourVector c = gather(line, &Line::cross);
    c.error = where(present, c.error, Four{});
    for (int axis = 0; axis < 3; ++axis) {
      position[axis] = position[axis] - component(c, axis) * moved;
      v[axis] = v[axis] - component(c, axis) * over_size;
    }
  }
}

EXACTFF_CLONES
void shares_of(const std::array<double, 3>& normal, std::span<const QuickPiece> pieces, std::span<const Line> lines,
               const AngleConstants& known, std::span<QuickGradient::Shares> result) {
  const FourVector n = vector_of<Four>(normal);
  for (std::size_t i = 0; i < pieces.size(); i += kLanes) {
    const FourArcs arcs = arcs_at(n, pieces.subspan(i), lines, known);
    const FourOf<Line>& line = arcs.line;
    const FourEnds &p = arcs.p, &q = arcs.q;
    const FourVector a = gather(line, &Line::a), b = gather(line, &Line::b), c = gather(line, &Line::cross);
    const FourBounded inverse = gather(line, &Line::inverse), squared = inverse * inverse;
    const FourBounded angle = arcs.theta * inverse * squared;
    const auto share = [&](const FourVector& other) __attribute__((always_inline)) {
      return angle * dot(cross(n, other), c) +
             (psi_of(q.point.direction, n, other) - psi_of(p.point.direction, n, other)) * squared;
    };
    const FourBounded of_a = share(b), of_b = share(a);
    for (std::size_t k = 0; k < arcs.count; ++k) result[i + k] = {lane(of_a, k), -lane(of_b, k)};
  }
}

Bounded sum_of_lanes(const FourBounded& x) { return (lane(x, 0) + lane(x, 1)) + (lane(x, 2) + lane(x, 3)); }

}  // namespace

Bounded times_power(const Bounded& x, int exponent) {
  if (exponent < -900 || exponent > 900) return kDeclined;
  const double scale = std::ldexp(1.0, exponent);
  return {x.hi * scale, x.lo * scale, x.error * scale + kUnderflow};
}

void QuickGradient::make_lines(std::span<const QuickCorner> corners, std::span<const QuickEdge> edges,
                               std::span<Line> lines) const {
  gradient_lines_of(normal_, corners, edges, lines);
}

void QuickGradient::add(std::span<const QuickPiece> pieces, std::span<const Line> lines, int exponent) {
  FourSums position{}, v{};
  add_arcs(normal_, pieces, lines, angle_constants(), position, v);
  for (int axis = 0; axis < 3; ++axis) {
    position_[axis] = position_[axis] + times_power(sum_of_lanes(position[axis]), exponent);
    v_[axis] = v_[axis] + sum_of_lanes(v[axis]);
  }
}

void QuickGradient::find_shares(std::span<const QuickPiece> pieces, std::span<const Line> lines,
                                std::span<Shares> shares) const {
  shares_of(normal_, pieces, lines, angle_constants(), shares);
}

void QuickGradient::decline() {
  for (int i = 0; i < 3; ++i) position_[i] = v_[i] = kDeclined;
}

namespace {

QuickGradient::Value value_of(const Bounded& x) {
  const double error = kInflation * x.error;
  if (!std::isfinite(x.hi) || !std::isfinite(x.lo) || !std::isfinite(error)) return {0.0, 0.0, kDeclined.error};
  return {x.hi, x.lo, error};
}

}  // namespace

QuickGradient::Value QuickGradient::over_turn_and_length(const Bounded& sum) const {
  const Vector n = vector_of<double>(normal_);
  return value_of(sum / (square_root(dot(n, n)) * (2.0 * constant(angle_constants().pi))));
}

QuickGradient::Value QuickGradient::form_factor() const {
  Bounded sum;
  for (int axis = 0; axis < 3; ++axis) sum = sum + Bounded{normal_[axis], 0.0, 0.0} * v_[axis];
  return over_turn_and_length(sum);
}

QuickGradient::Value QuickGradient::position(int axis) const { return over_turn_and_length(position_[axis]); }

QuickGradient::Value QuickGradient::normal(int axis) const {
  return value_of(v_[axis] / (2.0 * constant(angle_constants().pi)));
}

}  // namespace exactff::contour
