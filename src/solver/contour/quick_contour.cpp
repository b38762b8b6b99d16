// Once per edge:
//   1. d = b - a; a x b as a x d, whose error then shrinks with the edge; its length; and n . (a x b) / |a x b|.
// Once per piece:
//   2. p and q, corners or crossings, and w (contour.h);
//   3. the angle atan2(w |a x b|, p . q), with the sign of w;
//   4. its product with n . (a x b) / |a x b|, added to the sum.
//
// Four edges or four pieces are processed at a time, one per lane. An incomplete group of four repeats its last item,
// and the results of the repeats are dropped. A lane that declines does not affect the others (kernel/double_double.h).
#include "contour/quick_contour.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "contour/quick_lanes.h"
#include "kernel/vec.h"

namespace exactff::contour {

// --- Four at a time ---

namespace {

EXACTFF_CLONES
void lines_of(const std::array<double, 3>& normal, std::span<const QuickCorner> corners,
              std::span<const QuickEdge> edges, std::span<QuickLine> result) {
  const FourVector n = vector_of<Four>(normal);
  for (std::size_t i = 0; i < edges.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, edges.size() - i);
    const auto [reversed, a, b, along, c] = spans_of(corners, edges.subspan(i, count));
    const FourBounded size = square_root(dot(c, c)), weight = dot(n, c) / size;
    for (std::size_t k = 0; k < count; ++k) {
      result[i + k] = {reversed[k] != 0, lane(a, k),    lane(b, k),     lane(along, k),
                       lane(c, k),       lane(size, k), lane(weight, k)};
    }
  }
}

// --- Terms ---

// For up to four pieces: the terms angle(p, q) n . (a x b) / |a x b| of Eq. (4); zero in lanes without a piece.
EXACTFF_INLINE FourBounded terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines,
                                 const AngleConstants& known) {
  const FourOf<QuickPiece> piece = four_of(pieces);
  const FourEdges edges = edges_of(piece, lines);
  // 2. p, q and w.
  const FourPoints p = locate(edges, piece, &QuickPiece::begin, lines);
  const FourPoints q = locate(edges, piece, &QuickPiece::end, lines);
  const FourBounded w = sum_of_products(p.s, q.m, -p.m, q.s);
  // 3. The angle.
  const FourBounded angle = atan2(w * gather(edges.line, &QuickLine::size), dot(p.direction, q.direction), known);
  // 4. Its product with n . (a x b) / |a x b|.
  const FourMask present = FourMask{0, 1, 2, 3} < static_cast<std::int64_t>(pieces.size());
  return where(present, angle * gather(edges.line, &QuickLine::weight), FourBounded{});
}

EXACTFF_CLONES
void add_terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines, const AngleConstants& known,
               std::array<Bounded, kLanes>& sums) {
  const auto part = [&](double Bounded::*which) __attribute__((always_inline)) {
    return Four{sums[0].*which, sums[1].*which, sums[2].*which, sums[3].*which};
  };
  FourBounded sum{part(&Bounded::hi), part(&Bounded::lo), part(&Bounded::error)};
  for (std::size_t i = 0; i < pieces.size(); i += kLanes) {
    sum = sum + terms(pieces.subspan(i, std::min(kLanes, pieces.size() - i)), lines, known);
  }
  for (std::size_t k = 0; k < kLanes; ++k) sums[k] = lane(sum, k);
}

EXACTFF_CLONES
void terms_of(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines, const AngleConstants& known,
              std::span<Bounded> result) {
  for (std::size_t i = 0; i < pieces.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, pieces.size() - i);
    const FourBounded found = terms(pieces.subspan(i, count), lines, known);
    for (std::size_t k = 0; k < count; ++k) result[i + k] = lane(found, k);
  }
}

}  // namespace

std::array<double, 3> scaled_normal(const Vec3& n) {
  int exponent = 0;
  std::frexp(kernel::max_norm(n), &exponent);
  return {std::ldexp(n.x, -exponent), std::ldexp(n.y, -exponent), std::ldexp(n.z, -exponent)};
}

QuickContour::QuickContour(const Vec3& normal) : normal_(scaled_normal(normal)) {}

void QuickContour::make_lines(std::span<const QuickCorner> corners, std::span<const QuickEdge> edges,
                              std::span<QuickLine> lines) const {
  lines_of(normal_, corners, edges, lines);
}

void QuickContour::add(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines) {
  add_terms(pieces, lines, angle_constants(), sums_);
}

void QuickContour::find_terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines,
                              std::span<Bounded> terms) const {
  terms_of(pieces, lines, angle_constants(), terms);
}

QuickContour::Value QuickContour::value() const { return value((sums_[0] + sums_[1]) + (sums_[2] + sums_[3])); }

QuickContour::Value QuickContour::value(const Bounded& sum) const {
  const Vector normal = vector_of<double>(normal_);
  return value_of(-sum / (square_root(dot(normal, normal)) * (2.0 * constant(angle_constants().pi))));
}

QuickContour::Value value_of(const Bounded& x) {
  const double error = kInflation * x.error;
  if (!std::isfinite(x.hi) || !std::isfinite(x.lo) || !std::isfinite(error)) return {0.0, 0.0, kDeclined.error};
  return {x.hi, x.lo, error};
}

// --- Corners ---

namespace {

// Smaller parts are dropped, so that all parts that are kept, including low parts, are normal numbers.
constexpr double kLeastKept = 0x1p-960;
constexpr double kNothingKept = 0x1p-959;

// Sets a component to value * 2^exponent. Requires |lo| <= u |hi|.
void set_component(QuickCorner& corner, int axis, const DoubleDouble& value, int exponent) {
  const bool plain = exponent >= -1000 && exponent <= 1000;
  const double scale = plain ? std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52) : 0.0;
  const auto times_scale = [&](double part) { return plain ? part * scale : std::ldexp(part, exponent); };
  const auto keep = [&](double part) {
    const double result = times_scale(part);
    if (part == 0.0 || std::abs(result) >= kLeastKept) return result;
    if (std::isnan(result)) return result;
    corner.error = kNothingKept;
    return 0.0;
  };
  corner.hi[axis] = keep(value.hi);
  corner.lo[axis] = keep(value.lo);
  if (!std::isfinite(corner.hi[axis])) corner.hi[axis] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

QuickCorner quick_corner(const Vec3& vertex, const Vec3& x, int scale_exponent) {
  QuickCorner corner;
  set_component(corner, 0, two_sum(vertex.x, -x.x), scale_exponent);
  set_component(corner, 1, two_sum(vertex.y, -x.y), scale_exponent);
  set_component(corner, 2, two_sum(vertex.z, -x.z), scale_exponent);
  return corner;
}

namespace {

constexpr int kKeptBits = 106;

// The first 106 bits of number / 2^bit_length. Requires that the number is not zero.
DoubleDouble leading_bits(const kernel::Integer& number) {
  static_assert(GMP_NUMB_BITS == 64);
  const auto size = static_cast<mp_size_t>(mpz_size(number.get_mpz_t()));
  const auto limb = [&](int below) -> std::uint64_t { return mpz_getlimbn(number.get_mpz_t(), size - 1 - below); };
  const int shift = std::countl_zero(limb(0));
  const auto aligned = [&](int below) {
    return shift == 0 ? limb(below) : (limb(below) << shift) | (limb(below + 1) >> (64 - shift));
  };
  const std::uint64_t first = aligned(0) >> 11;
  const std::uint64_t second = ((aligned(0) & 0x7FF) << 42) | (aligned(1) >> 22);
  const double sign = kernel::sign(number) < 0 ? -1.0 : 1.0;
  return two_sum(sign * 0x1p-53 * static_cast<double>(first), sign * 0x1p-106 * static_cast<double>(second));
}

// True if these 106 bits contain all bits of the number.
bool is_kept_whole(const kernel::Integer& number, long bits) {
  return bits <= kKeptBits || static_cast<long>(mpz_scan1(number.get_mpz_t(), 0)) >= bits - kKeptBits;
}

}  // namespace

QuickCorner quick_corner(const kernel::ExactVec3& direction) {
  const long largest = bit_length(direction);
  QuickCorner corner;
  double truncation = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const kernel::Integer& component = direction[axis];
    if (kernel::sign(component) == 0) continue;
    const long bits = kernel::bit_length(component);
    if (!is_kept_whole(component, bits)) truncation = 0x1p-106;
    constexpr long kFarBelow = 4000;
    set_component(corner, axis, leading_bits(component), -static_cast<int>(std::min(largest - bits, kFarBelow)));
  }
  corner.error += truncation;
  return corner;
}

// --- Quick gradient ---

namespace {

using Line = QuickGradient::Line;

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

QuickGradient::QuickGradient(const Vec3& normal) : normal_(scaled_normal(normal)) {}

namespace {

EXACTFF_CLONES
void gradient_lines_of(const std::array<double, 3>& normal, std::span<const QuickCorner> corners,
                       std::span<const QuickEdge> edges, std::span<Line> result) {
  const FourVector n = vector_of<Four>(normal);
  for (std::size_t i = 0; i < edges.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, edges.size() - i);
    const auto [reversed, a, b, d, c] = spans_of(corners, edges.subspan(i, count));
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

EXACTFF_INLINE FourEnds ends_of(const FourEdges<Line>& edges, const FourVector& n, const FourOf<QuickPiece>& pieces,
                                std::uint32_t QuickPiece::*which, std::span<const Line> lines) {
  const FourPoints point = locate(edges, pieces, which, lines);
  const FourMask at_corner = either(point.at_a, point.at_b);
  FourBounded psi;
  if (in_some_lane(at_corner)) {
    psi = where(point.at_b, gather(edges.line, &Line::psi_b), gather(edges.line, &Line::psi_a));
    if (in_every_lane(at_corner)) return {point, psi};
  }
  return {point, where(at_corner, psi, psi_of(point.direction, n, edges.along))};
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
  const FourEdges edges = edges_of(piece, lines);
  const FourEnds p = ends_of(edges, n, piece, &QuickPiece::begin, lines);
  const FourEnds q = ends_of(edges, n, piece, &QuickPiece::end, lines);
  const FourBounded w = sum_of_products(p.point.s, q.point.m, -p.point.m, q.point.s);
  return {count, edges.line, p, q,
          atan2(w * gather(edges.line, &Line::size), dot(p.point.direction, q.point.direction), known)};
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
