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

#include "contour/quick_angle.h"
#include "contour/quick_lanes.h"
#include "contour/quick_vector.h"
#include "kernel/ball.h"
#include "kernel/vec.h"

namespace exactff::contour {

using namespace kernel::double_double;

// --- Constants ---

namespace {

constexpr long kBits = 160;

// The relative error is at most 2^-106: two roundings to nearest.
DoubleDouble rounded(const Ball& ball) {
  const double hi = kernel::nearest_to_midpoint(ball);
  return {hi, kernel::nearest_to_midpoint(ball - kernel::to_ball(hi, kBits))};
}

AngleConstants compute_constants() {
  AngleConstants result;
  for (int k = 0; k <= kAtanSteps; ++k) {
    result.atan[k] = rounded(atan(kernel::to_ball(static_cast<double>(k) / kAtanSteps, kBits)));
  }
  result.pi = rounded(kernel::pi(kBits));
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

// --- Edges ---

struct FourLines {
  FourMask reversed;
  FourVector a;
  FourVector b;
  FourVector along;
  FourVector cross;
  FourBounded size;
  FourBounded weight;
};

EXACTFF_INLINE QuickLine line_of(const FourLines& lines, std::size_t k) {
  return {lines.reversed[k] != 0, lane(lines.a, k),    lane(lines.b, k),     lane(lines.along, k),
          lane(lines.cross, k),   lane(lines.size, k), lane(lines.weight, k)};
}

// Step 1.
EXACTFF_INLINE FourLines lines_between(const FourVector& normal, const FourVector& p, const FourVector& q) {
  FourLines lines;
  lines.reversed = q.norm < p.norm;
  lines.a = where(lines.reversed, q, p);
  lines.b = where(lines.reversed, p, q);
  lines.along = difference(lines.b, lines.a);
  lines.cross = cross(lines.a, lines.along);
  const FourMask usable = both(has_moderate_size(p), has_moderate_size(q));
  lines.cross.error = where(usable, lines.cross.error, uniform<Four>(kDeclined.error));
  lines.size = square_root(dot(lines.cross, lines.cross));
  lines.weight = dot(normal, lines.cross) / lines.size;
  return lines;
}

// The corner at one end of each of up to four edges.
EXACTFF_INLINE FourVector gather_ends(std::span<const QuickCorner> corners, const FourOf<QuickEdge>& edges,
                                      std::uint32_t QuickEdge::*end) {
  return gather(FourOf<QuickCorner>{&corners[edges[0]->*end], &corners[edges[1]->*end], &corners[edges[2]->*end],
                                    &corners[edges[3]->*end]});
}

EXACTFF_CLONES
void lines_of(const std::array<double, 3>& normal, std::span<const QuickCorner> corners,
              std::span<const QuickEdge> edges, std::span<QuickLine> result) {
  const FourVector n = vector_of<Four>(normal);
  for (std::size_t i = 0; i < edges.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, edges.size() - i);
    const FourOf<QuickEdge> edge = four_of(edges.subspan(i, count));
    const FourLines lines =
        lines_between(n, gather_ends(corners, edge, &QuickEdge::a), gather_ends(corners, edge, &QuickEdge::b));
    for (std::size_t k = 0; k < count; ++k) result[i + k] = line_of(lines, k);
  }
}

// --- Crossings ---

// The edges of four pieces.
struct FourEdges {
  FourOf<QuickLine> line;
  FourVector a;
  FourVector along;
};

// Step 2, for one end of four pieces.
EXACTFF_INLINE FourPoints locate(const FourEdges& edges, const FourOf<QuickPiece>& pieces,
                                 std::uint32_t QuickPiece::*which, std::span<const QuickLine> lines) {
  FourOf<QuickLine> crossing = edges.line;  // the default: a line does not cross itself, so this declines
  FourMask at_a{}, at_b{};
  for (std::size_t k = 0; k < kLanes; ++k) {
    const std::uint32_t end = pieces[k]->*which;
    const std::uint32_t end_at_a = edges.line[k]->reversed ? QuickPiece::kAtB : QuickPiece::kAtA;
    at_a[k] = end == end_at_a ? -1 : 0;
    at_b[k] = end >= QuickPiece::kAtA && end != end_at_a ? -1 : 0;
    if (end < QuickPiece::kAtA) crossing[k] = &lines[end];
  }
  const FourMask at_corner = either(at_a, at_b);
  FourPoints corner;
  if (in_some_lane(at_corner)) {
    const FourBounded zero{}, one{uniform<Four>(1.0), {}, {}};
    corner = {one, where(at_b, one, zero), where(at_b, gather(edges.line, &QuickLine::b), edges.a)};
    if (in_every_lane(at_corner)) return corner;
  }
  return where(at_corner, corner,
               cross_edges(gather(crossing, &QuickLine::cross), gather(crossing, &QuickLine::a), edges.a, edges.along));
}

// --- Terms ---

// For up to four pieces: the terms angle(p, q) n . (a x b) / |a x b| of Eq. (4); zero in lanes without a piece.
EXACTFF_INLINE FourBounded terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines,
                                 const AngleConstants& known) {
  const FourOf<QuickPiece> piece = four_of(pieces);
  const FourOf<QuickLine> line = {&lines[piece[0]->edge], &lines[piece[1]->edge], &lines[piece[2]->edge],
                                  &lines[piece[3]->edge]};
  const FourVector a = gather(line, &QuickLine::a), along = gather(line, &QuickLine::along);
  const FourEdges edges{line, a, along};
  // 2. p, q and w.
  const FourPoints p = locate(edges, piece, &QuickPiece::begin, lines);
  const FourPoints q = locate(edges, piece, &QuickPiece::end, lines);
  const FourBounded w = sum_of_products(p.s, q.m, -p.m, q.s);
  // 3. The angle.
  const FourBounded angle = atan2(w * gather(line, &QuickLine::size), dot(p.direction, q.direction), known);
  // 4. Its product with n . (a x b) / |a x b|.
  const FourMask present = FourMask{0, 1, 2, 3} < static_cast<std::int64_t>(pieces.size());
  return where(present, angle * gather(line, &QuickLine::weight), FourBounded{});
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

std::array<double, 3> scaled_normal(const Vec3& n) {
  int exponent = 0;
  std::frexp(kernel::max_norm(n), &exponent);
  return {std::ldexp(n.x, -exponent), std::ldexp(n.y, -exponent), std::ldexp(n.z, -exponent)};
}

}  // namespace

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
  const Bounded f = -sum / (square_root(dot(normal, normal)) * (2.0 * constant(angle_constants().pi)));
  const double error = kInflation * f.error;
  if (!std::isfinite(f.hi) || !std::isfinite(f.lo) || !std::isfinite(error)) return {0.0, 0.0, kDeclined.error};
  return {f.hi, f.lo, error};
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

}  // namespace exactff::contour
