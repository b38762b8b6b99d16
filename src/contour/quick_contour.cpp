// Once an edge:
//   1. a x b, as the smaller of a and b times b - a, whose error then shrinks with the edge (b x (b - a) = a x b), its
//      length, and n . (a x b) / |a x b|.
// Once a piece:
//   2. p and q, corners or crossings, and w (contour.h);
//   3. the angle atan2(w |a x b|, p . q), with the sign of w;
//   4. its product with n . (a x b) / |a x b|, added to the sum.
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

// --- Crossings ---

namespace {

EXACTFF_INLINE Vector vector_of(const QuickCorner& corner) {
  return vector({DoubleDouble{corner.hi[0], corner.lo[0]}, {corner.hi[1], corner.lo[1]}, {corner.hi[2], corner.lo[2]}},
                corner.error);
}

// Scaling the normal may have lost a component.
EXACTFF_INLINE Vector vector_of(const std::array<double, 3>& normal) {
  return vector({DoubleDouble{normal[0]}, {normal[1]}, {normal[2]}}, kUnderflow);
}

EXACTFF_INLINE bool has_moderate_size(const Vector& v) {
  const double largest = std::max({std::abs(v.c[0].hi), std::abs(v.c[1].hi), std::abs(v.c[2].hi)});
  return largest >= 0x1p-200 && largest <= 0x1p200 && v.norm <= 0x1p202;  // the last is false for NaN
}

// A point l a + m b of the edge, and (l : m).
struct Point {
  Bounded l;
  Bounded m;
  Vector direction;
};

// normal . p, the normal being that of a plane through c: loses less as normal . (p - t c) where p and t c are near.
EXACTFF_INLINE Bounded height(const Vector& normal, const Vector& c, const Vector& p) {
  const double t = p.norm / c.norm;
  const double distance =
      std::abs(p.c[0].hi - t * c.c[0].hi) + std::abs(p.c[1].hi - t * c.c[1].hi) + std::abs(p.c[2].hi - t * c.c[2].hi);
  return distance < 0.25 * p.norm ? dot(normal, near_cancellation(p, t, c)) : dot(normal, p);
}

// Requires scale, a power of two, to be such that nothing overflows.
EXACTFF_INLINE Bounded scaled(const Bounded& x, double scale) {
  return {x.hi * scale, x.lo * scale, x.error * scale + kUnderflow};
}

// The power of two that brings x into [1, 2). Requires that x and its inverse are normal.
EXACTFF_INLINE double inverse_power_of_two(double x) {
  const std::uint64_t biased = (std::bit_cast<std::uint64_t>(x) >> 52) & 0x7FF;
  return std::bit_cast<double>((2046 - biased) << 52);
}

EXACTFF_FMA_CLONES
bool cross_edge(const QuickLine& line, const QuickLine& edge, Point& result) {
  if (!line.usable) return false;
  const Bounded height_a = height(line.cross, line.a, edge.a);
  const Bounded height_b = height(line.cross, line.a, edge.b);
  if (!sign_is_certain(height_a) || !sign_is_certain(height_b)) return false;
  if ((height_a.hi < 0.0) == (height_b.hi < 0.0)) return false;
  const double scale = inverse_power_of_two(std::max(std::abs(height_a.hi), std::abs(height_b.hi)));
  result.l = scaled(absolute(height_b), scale);
  result.m = scaled(absolute(height_a), scale);
  result.direction = combination(result.l, edge.a, result.m, edge.b);
  return true;
}

EXACTFF_INLINE bool locate(const QuickLine& edge, const QuickEnd& end, Point& result) {
  if (end.kind == QuickEnd::Kind::kCrossing) return cross_edge(*end.line, edge, result);
  const bool at_a = end.kind == QuickEnd::Kind::kA;
  result = {{at_a ? 1.0 : 0.0}, {at_a ? 0.0 : 1.0}, at_a ? edge.a : edge.b};
  return true;
}

}  // namespace

// --- Terms ---

namespace {

EXACTFF_FMA_CLONES
QuickLine line_of(const std::array<double, 3>& normal, const QuickCorner& from, const QuickCorner& to) {
  QuickLine line;
  line.a = vector_of(from);
  line.b = vector_of(to);
  line.usable = has_moderate_size(line.a) && has_moderate_size(line.b);
  if (!line.usable) return line;
  line.cross = cross_of_edge(line.a, line.b);
  line.size = square_root(dot(line.cross, line.cross));
  line.weight = dot(vector_of(normal), line.cross) / line.size;
  return line;
}

// The angle of the piece, with the sign of w.
EXACTFF_FMA_CLONES
Bounded angle_between(const QuickLine& edge, const QuickEnd& begin, const QuickEnd& end, const AngleConstants& known) {
  Point p;
  Point q;
  if (!locate(edge, begin, p) || !locate(edge, end, q)) return kDeclined;
  const Bounded w = sum_of_products(p.l, q.m, -p.m, q.l);
  return atan2(w * edge.size, dot(p.direction, q.direction), known);
}

EXACTFF_FMA_CLONES
Bounded term(const QuickLine& edge, const QuickEnd& begin, const QuickEnd& end, const AngleConstants& known) {
  if (!edge.usable) return kDeclined;
  const bool is_whole = begin.kind == QuickEnd::Kind::kA && end.kind == QuickEnd::Kind::kB;
  const Bounded angle =
      is_whole ? atan2(edge.size, dot(edge.a, edge.b), known) : angle_between(edge, begin, end, known);
  return angle * edge.weight;
}

std::array<double, 3> scaled_normal(const Vec3& n) {
  int exponent = 0;
  std::frexp(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), &exponent);
  return {std::ldexp(n.x, -exponent), std::ldexp(n.y, -exponent), std::ldexp(n.z, -exponent)};
}

}  // namespace

QuickContour::QuickContour(const Vec3& normal) : normal_(scaled_normal(normal)) {}

QuickLine QuickContour::line(const QuickCorner& a, const QuickCorner& b) const { return line_of(normal_, a, b); }

void QuickContour::add(const QuickLine& edge, const QuickEnd& begin, const QuickEnd& end) {
  sum_ = sum_ + term(edge, begin, end, angle_constants());
}

QuickContour::Value QuickContour::value() const {
  const Vector normal = vector_of(normal_);
  const Bounded f = -sum_ / (square_root(dot(normal, normal)) * (2.0 * constant(angle_constants().pi)));
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
