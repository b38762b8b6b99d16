// Once an edge:
//   1. a x b, as the smaller of a and b times b - a, whose error then shrinks with the edge (b x (b - a) = a x b), its
//      length, and n . (a x b) / |a x b|.
// Once a piece:
//   2. p and q, corners or crossings, and w (contour.h);
//   3. the angle atan2(w |a x b|, p . q), with the sign of w;
//   4. its product with n . (a x b) / |a x b|, added to the sum.
//
// Four edges, or four pieces, at a time, a lane each. A last four that is not full repeats its last lane, and what
// comes of that is left out. What one lane declines is nothing to the others (kernel/double_double.h).
#include "contour/quick_contour.h"

#include <algorithm>
#include <bit>

#include "contour/quick_angle.h"
#include "contour/quick_vector.h"
#include "kernel/ball.h"

namespace exactff::contour {

// --- Constants ---

namespace {

constexpr long kBits = 160;

// Within 2^-106 of itself: two roundings to nearest.
DoubleDouble rounded(const Ball& ball) {
  const double hi = kernel::nearest_to_midpoint(ball);
  Ball rest;
  arb_set_d(rest.get(), hi);
  arb_sub(rest.get(), ball.get(), rest.get(), kBits);
  return {hi, kernel::nearest_to_midpoint(rest)};
}

AngleConstants compute_constants() {
  AngleConstants result;
  Ball ball;
  for (int k = 0; k <= kAtanSteps; ++k) {
    arb_set_d(ball.get(), static_cast<double>(k) / kAtanSteps);
    arb_atan(ball.get(), ball.get(), kBits);
    result.atan[k] = rounded(ball);
  }
  arb_const_pi(ball.get(), kBits);
  result.pi = rounded(ball);
  result.half_pi = {0.5 * result.pi.hi, 0.5 * result.pi.lo};
  return result;
}

}  // namespace

const AngleConstants& angle_constants() {
  static const AngleConstants instance = compute_constants();
  return instance;
}

// --- Four at a time ---

namespace {

constexpr std::size_t kLanes = 4;

template <class T>
using FourOf = std::array<const T*, kLanes>;  // in memory, a lane each

// The i-th, lane by lane; the last where there are no more.
template <class T, class Find>
EXACTFF_INLINE FourOf<T> four_of(std::size_t count, const Find& find) {
  const std::size_t last = count - 1;
  return {&find(0), &find(std::min<std::size_t>(1, last)), &find(std::min<std::size_t>(2, last)),
          &find(std::min<std::size_t>(3, last))};
}

// What `part` gives of each.
template <class T, class Part>
EXACTFF_INLINE Four gather(const FourOf<T>& from, const Part& part) {
  return Four{part(*from[0]), part(*from[1]), part(*from[2]), part(*from[3])};
}

EXACTFF_INLINE FourBounded gather(const FourOf<QuickLine>& lines, Bounded QuickLine::*part) {
  return {gather(lines, [=](const QuickLine& line) { return (line.*part).hi; }),
          gather(lines, [=](const QuickLine& line) { return (line.*part).lo; }),
          gather(lines, [=](const QuickLine& line) { return (line.*part).error; })};
}

EXACTFF_INLINE FourVector gather(const FourOf<QuickLine>& lines, Vector QuickLine::*part) {
  const auto component = [&](int i) -> BasicDoubleDouble<Four> {
    return {gather(lines, [=](const QuickLine& line) { return (line.*part).c[i].hi; }),
            gather(lines, [=](const QuickLine& line) { return (line.*part).c[i].lo; })};
  };
  return {{component(0), component(1), component(2)},
          gather(lines, [=](const QuickLine& line) { return (line.*part).norm; }),
          gather(lines, [=](const QuickLine& line) { return (line.*part).error; })};
}

EXACTFF_INLINE FourVector gather(const FourOf<QuickCorner>& corners) {
  const auto component = [&](int i) -> BasicDoubleDouble<Four> {
    return {gather(corners, [=](const QuickCorner& corner) { return corner.hi[i]; }),
            gather(corners, [=](const QuickCorner& corner) { return corner.lo[i]; })};
  };
  return vector({component(0), component(1), component(2)},
                gather(corners, [](const QuickCorner& corner) { return corner.error; }));
}

EXACTFF_INLINE Bounded lane(const FourBounded& x, std::size_t k) { return {x.hi[k], x.lo[k], x.error[k]}; }

EXACTFF_INLINE Vector lane(const FourVector& v, std::size_t k) {
  const auto component = [&](int i) -> DoubleDouble { return {v.c[i].hi[k], v.c[i].lo[k]}; };
  return {{component(0), component(1), component(2)}, v.norm[k], v.error[k]};
}

}  // namespace

// --- Edges ---

namespace {

// Scaling the normal may have lost a component.
template <class Real>
EXACTFF_INLINE BasicVector<Real> vector_of(const std::array<double, 3>& normal) {
  const auto component = [&](int i) -> BasicDoubleDouble<Real> { return {uniform<Real>(normal[i]), Real{}}; };
  return vector({component(0), component(1), component(2)}, uniform<Real>(kUnderflow));
}

EXACTFF_INLINE FourMask has_moderate_size(const FourVector& v) {
  const Four largest = larger(larger(magnitude(v.c[0].hi), magnitude(v.c[1].hi)), magnitude(v.c[2].hi));
  return both(both(largest >= 0x1p-200, largest <= 0x1p200), v.norm <= 0x1p202);  // the last is false for NaN
}

struct FourLines {
  FourVector a;
  FourVector b;
  FourVector cross;
  FourBounded size;
  FourBounded weight;
};

EXACTFF_INLINE QuickLine lane(const FourLines& lines, std::size_t k) {
  return {lane(lines.a, k), lane(lines.b, k), lane(lines.cross, k), lane(lines.size, k), lane(lines.weight, k)};
}

// Step 1.
EXACTFF_INLINE FourLines lines_between(const FourVector& normal, const FourVector& a, const FourVector& b) {
  FourLines lines{a, b, cross_of_edge(a, b), {}, {}};
  const FourMask usable = both(has_moderate_size(a), has_moderate_size(b));
  lines.cross.error = where(usable, lines.cross.error, uniform<Four>(kDeclined.error));
  lines.size = square_root(dot(lines.cross, lines.cross));
  lines.weight = dot(normal, lines.cross) / lines.size;
  return lines;
}

// Into as many lines.
EXACTFF_FMA_CLONES
void make_lines(const std::array<double, 3>& normal, std::span<const QuickCorner> corners,
                std::span<const QuickEdge> edges, QuickLine* result) {
  const FourVector n = vector_of<Four>(normal);
  for (std::size_t i = 0; i < edges.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, edges.size() - i);
    const auto end = [&](std::uint32_t QuickEdge::*which) {
      return gather(four_of<QuickCorner>(
          count, [&](std::size_t k) -> const QuickCorner& { return corners[edges[i + k].*which]; }));
    };
    const FourLines lines = lines_between(n, end(&QuickEdge::a), end(&QuickEdge::b));
    for (std::size_t k = 0; k < count; ++k) result[i + k] = lane(lines, k);
  }
}

}  // namespace

// --- Crossings ---

namespace {

// Points l a + m b of an edge each, and (l : m).
struct FourPoints {
  FourBounded l;
  FourBounded m;
  FourVector direction;
};

EXACTFF_INLINE FourPoints where(const FourMask& condition, const FourPoints& p, const FourPoints& q) {
  return {where(condition, p.l, q.l), where(condition, p.m, q.m), where(condition, p.direction, q.direction)};
}

// normal . p, the normal being that of a plane through c: loses less as normal . (p - t c) where p and t c are near.
EXACTFF_INLINE FourBounded height(const FourVector& normal, const FourVector& c, const FourVector& p) {
  const Four t = p.norm / c.norm;
  const Four distance = magnitude(p.c[0].hi - t * c.c[0].hi) + magnitude(p.c[1].hi - t * c.c[1].hi) +
                        magnitude(p.c[2].hi - t * c.c[2].hi);
  const FourMask near = distance < 0.25 * p.norm;
  return dot(normal, in_some_lane(near) ? where(near, near_cancellation(p, t, c), p) : p);
}

// Requires scale, a power of two, to be such that nothing overflows.
EXACTFF_INLINE FourBounded scaled(const FourBounded& x, const Four& scale) {
  return {x.hi * scale, x.lo * scale, x.error * scale + kUnderflow};
}

// The power of two that brings x into [1, 2). Requires that x and its inverse are normal.
EXACTFF_INLINE Four inverse_power_of_two(const Four& x) {
  const FourMask biased = (FourMask(x) >> 52) & 0x7FF;
  return Four((2046 - biased) << 52);
}

// What is common to the edges of four pieces.
struct FourEdges {
  FourVector a;
  FourVector b;
};

// Where the line, through c with the given normal, crosses the edge from a to b; declined where that is not certain.
EXACTFF_INLINE FourPoints cross_edges(const FourVector& normal, const FourVector& c, const FourEdges& edges) {
  const FourBounded height_a = height(normal, c, edges.a), height_b = height(normal, c, edges.b);
  const FourMask crosses =
      both(both(sign_is_certain(height_a), sign_is_certain(height_b)), differ(height_a.hi < 0.0, height_b.hi < 0.0));
  const Four scale = inverse_power_of_two(larger(magnitude(height_a.hi), magnitude(height_b.hi)));
  const FourBounded l = only_where(crosses, scaled(absolute(height_b), scale));
  const FourBounded m = only_where(crosses, scaled(absolute(height_a), scale));
  return {l, m, combination(l, edges.a, m, edges.b)};
}

// Step 2, for one end of four pieces; `own` are their edges' lines.
EXACTFF_INLINE FourPoints locate(const FourEdges& edges, const FourOf<QuickLine>& own, const FourOf<QuickPiece>& pieces,
                                 std::uint32_t QuickPiece::*which, std::span<const QuickLine> lines) {
  FourOf<QuickLine> crossing = own;
  FourMask at_a{}, crossed{};
  for (std::size_t k = 0; k < kLanes; ++k) {
    const std::uint32_t end = pieces[k]->*which;
    at_a[k] = end == QuickPiece::kAtA ? -1 : 0;
    crossed[k] = end < QuickPiece::kAtA ? -1 : 0;
    if (end < QuickPiece::kAtA) crossing[k] = &lines[end];
  }
  const FourBounded zero{}, one{uniform<Four>(1.0), {}, {}};
  const FourPoints corner{where(at_a, one, zero), where(at_a, zero, one), where(at_a, edges.a, edges.b)};
  if (!in_some_lane(crossed)) return corner;
  return where(crossed, cross_edges(gather(crossing, &QuickLine::cross), gather(crossing, &QuickLine::a), edges),
               corner);
}

}  // namespace

// --- Terms ---

namespace {

// Steps 2 to 4 for up to four pieces; zero where there are fewer.
EXACTFF_INLINE FourBounded terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines,
                                 const AngleConstants& known) {
  const auto piece = four_of<QuickPiece>(pieces.size(), [&](std::size_t k) -> const QuickPiece& { return pieces[k]; });
  const auto line =
      four_of<QuickLine>(kLanes, [&](std::size_t k) -> const QuickLine& { return lines[piece[k]->edge]; });
  const FourEdges edges{gather(line, &QuickLine::a), gather(line, &QuickLine::b)};
  const FourPoints p = locate(edges, line, piece, &QuickPiece::begin, lines);
  const FourPoints q = locate(edges, line, piece, &QuickPiece::end, lines);
  const FourBounded w = sum_of_products(p.l, q.m, -p.m, q.l);
  const FourBounded angle = atan2(w * gather(line, &QuickLine::size), dot(p.direction, q.direction), known);
  const FourMask present = FourMask{0, 1, 2, 3} < static_cast<std::int64_t>(pieces.size());
  return where(present, angle * gather(line, &QuickLine::weight), FourBounded{});
}

EXACTFF_FMA_CLONES
void add_terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines, const AngleConstants& known,
               std::array<Bounded, kLanes>& sums) {
  const auto part = [&](double Bounded::*which) {
    return Four{sums[0].*which, sums[1].*which, sums[2].*which, sums[3].*which};
  };
  FourBounded sum{part(&Bounded::hi), part(&Bounded::lo), part(&Bounded::error)};
  for (std::size_t i = 0; i < pieces.size(); i += kLanes) {
    sum = sum + terms(pieces.subspan(i, std::min(kLanes, pieces.size() - i)), lines, known);
  }
  for (std::size_t k = 0; k < kLanes; ++k) sums[k] = lane(sum, k);
}

std::array<double, 3> scaled_normal(const Vec3& n) {
  int exponent = 0;
  std::frexp(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), &exponent);
  return {std::ldexp(n.x, -exponent), std::ldexp(n.y, -exponent), std::ldexp(n.z, -exponent)};
}

}  // namespace

QuickContour::QuickContour(const Vec3& normal) : normal_(scaled_normal(normal)) {}

void QuickContour::append_lines(std::span<const QuickCorner> corners, std::span<const QuickEdge> edges,
                                std::vector<QuickLine>& lines) const {
  const std::size_t before = lines.size();
  lines.resize(before + edges.size());
  make_lines(normal_, corners, edges, lines.data() + before);
}

void QuickContour::add(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines) {
  add_terms(pieces, lines, angle_constants(), sums_);
}

QuickContour::Value QuickContour::value() const {
  const Vector normal = vector_of<double>(normal_);
  const Bounded sum = (sums_[0] + sums_[1]) + (sums_[2] + sums_[3]);
  const Bounded f = -sum / (square_root(dot(normal, normal)) * (2.0 * constant(angle_constants().pi)));
  const double error = kInflation * f.error;
  if (!std::isfinite(f.hi) || !std::isfinite(f.lo) || !std::isfinite(error)) return {0.0, 0.0, kDeclined.error};
  return {f.hi, f.lo, error};
}

// The ends of the enclosure are hi and one more double each, taken outward, so that one rounding finds the nearest
// double of either; rounding never reverses an order.
std::optional<double> nearest(const QuickContour::Value& value) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double low = value.hi + std::nextafter(value.lo - value.error, -kInfinity);
  const double high = value.hi + std::nextafter(value.lo + value.error, kInfinity);
  if (low != high || !std::isfinite(high)) return std::nullopt;  // NaN included
  return high == 0.0 ? 0.0 : high;                               // never -0
}

// --- Corners ---

namespace {

// Below this nothing is kept, so that what is kept is normal, the low parts too.
constexpr double kLeastKept = 0x1p-960;
constexpr double kNothingKept = 0x1p-959;

// Sets the component, of which |lo| <= u |hi|, times 2^exponent.
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

// The first 106 bits of the number after the point, over 2^bit_length. Requires that it is not zero.
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

// True if no bit is left out.
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

}  // namespace exactff::contour
