#include "view_factors/quick_formula.h"

#include <algorithm>
#include <numbers>

#include "kernel/reals.h"

namespace exactff::view_factors {
namespace {

using kernel::double_double::either;
using kernel::double_double::magnitude;
using kernel::double_double::root;
using kernel::double_double::where;
using kernel::lanes::Four;
using kernel::lanes::four;
using kernel::lanes::FourMask;

constexpr double kInfinity = __builtin_inf();
// Of a difference of two points whose coordinates are at most 1 and carry a few roundings.
constexpr double kDifferenceError = 0x1p-50;
constexpr double kOfFirstOrder = 4.0;
constexpr double kOfTerm = 0x1p-49;
constexpr double kMostAngle = std::numbers::pi - 0x1p-6;
constexpr double kMostShift = 0x1p-4;  // of a shared crossing

struct FourVec {
  Four x, y, z;
};

EXACTFF_INLINE FourVec four(const Vec3& a) { return {four(a.x), four(a.y), four(a.z)}; }
EXACTFF_INLINE FourVec operator-(const FourVec& a, const FourVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
EXACTFF_INLINE FourVec operator+(const FourVec& a, const FourVec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
EXACTFF_INLINE FourVec operator*(const Four& s, const FourVec& a) { return {s * a.x, s * a.y, s * a.z}; }
EXACTFF_INLINE Four dot(const FourVec& a, const FourVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
EXACTFF_INLINE FourVec cross(const FourVec& a, const FourVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
EXACTFF_INLINE Four length(const FourVec& a) { return root(dot(a, a)); }
EXACTFF_INLINE Four at_least_length(const FourVec& a) { return magnitude(a.x) + magnitude(a.y) + magnitude(a.z); }

// atan(z) for |z| <= tan(pi / 8), within 2^-51 of its magnitude. The polynomial in z^2 interpolates at Chebyshev's
// points, and differs from atan(z) / z by less than 2^-57.
EXACTFF_INLINE Four atan_of_small(const Four& z) {
  constexpr double kCoefficients[] = {0x1.0000000000000p+0,  -0x1.555555555552fp-2, 0x1.999999999466ap-3,
                                      -0x1.2492492259b3ep-3, 0x1.c71c70cb775cep-4,  -0x1.745cf64dcc6bdp-4,
                                      0x1.3b10f0f5b1223p-4,  -0x1.10ea1d157f6f4p-4, 0x1.def9ecd6a205bp-5,
                                      -0x1.9c79c07a98714p-5, 0x1.3702ea64c0b03p-5,  -0x1.23b93fac20e4dp-6};
  const Four w = z * z;
  Four sum = four(0.0);
  for (int i = 11; i > 0; --i) sum = w * (sum + kCoefficients[i]);
  return z + z * sum;
}

// The angle of (x, y) in [-pi, pi]; 0 for (0, 0). With the smaller of |x| and |y| over the larger one, q, atan(q) is
// pi / 4 + atan((q - 1) / (q + 1)) where q is large.
EXACTFF_INLINE Four angle_of(const Four& y, const Four& x) {
  constexpr double kPi = std::numbers::pi, kTanOfAnEighth = 0.41421356237309503;
  const Four wide = magnitude(x), high = magnitude(y);
  const FourMask is_steep = high > wide;
  const Four less = where(is_steep, wide, high), more = where(is_steep, high, wide);
  const FourMask is_large = less > kTanOfAnEighth * more;
  const Four numerator = where(is_large, less - more, less);
  const Four denominator = where(is_large, less + more, more);
  const Four part = atan_of_small(numerator / where(denominator > 0.0, denominator, four(1.0)));
  const Four eighth = where(is_large, part + 0.25 * kPi, part);
  const Four quarter = where(is_steep, 0.5 * kPi - eighth, eighth);
  const Four half = where(x < 0.0, kPi - quarter, quarter);
  return where(y < 0.0, -half, half);
}

// A direction; the angle by which rounding may have turned it, an estimate; and what else may be wrong of 2 pi F.
struct FourSightings {
  FourVec direction;
  Four error, of_sum;
};

// A segment relative to x, and the plane through both.
struct FourSegment {
  FourVec a, along, plane;
  Four size, length;

  EXACTFF_INLINE FourSegment(const QuickPart::Segment& segment, const FourVec& x)
      : a(four(segment.a) - x),
        along(four(segment.along)),
        plane(cross(a, along)),
        size(view_factors::length(plane)),
        length(four(segment.length)) {}
  [[nodiscard]] EXACTFF_INLINE FourVec b() const { return a + along; }
  // The angle by which rounding may have turned the plane.
  [[nodiscard]] EXACTFF_INLINE Four turn() const { return kDifferenceError * (at_least_length(a) + length) / size; }
};

// Where a plane crosses a segment from its one side to the other.
struct FourCrossing {
  FourVec at;
  Four weight;

  EXACTFF_INLINE FourCrossing(const FourSegment& segment, const FourVec& plane) {
    const Four at_a = magnitude(dot(plane, segment.a));
    weight = at_a + magnitude(dot(plane, segment.b()));
    at = segment.a + where(weight > 0.0, at_a / weight, Four{}) * segment.along;
  }
};

// The angle by which rounding may have moved the crossing of a segment and a plane along the segment.
EXACTFF_INLINE Four shift_of(const FourCrossing& crossing, const FourSegment& segment, const FourSegment& other) {
  const Four of_plane = kDifferenceError * (at_least_length(other.a) + other.length) *
                        (at_least_length(segment.a) + at_least_length(segment.b())) / crossing.weight;
  const Four shift = (kDifferenceError + of_plane * segment.length) / length(crossing.at);
  return where(crossing.weight > 0.0, shift, four(kInfinity));
}

// The same numbers for both parts that end there: where it lies along them cancels. But if it may lie anywhere, as
// where both planes nearly are the receiver's, the parts may turn the wrong way round x.
EXACTFF_INLINE FourSightings shared(const FourSegment& first, const FourSegment& second) {
  const FourCrossing crossing(first, second.plane);
  const FourVec &at = crossing.at, b = first.b();
  const Four far = length(at);
  const Four d = magnitude(dot(second.plane, at)) / (second.size * far) + second.turn() + kDifferenceError / far;
  const Four tan_of_half = (length(first.a) * length(b) - dot(first.a, b)) / first.size;
  const Four of_sum = d * (1.0 + 2.0 * tan_of_half);
  const Four shift = shift_of(crossing, first, second);
  return {at, Four{}, where(shift < kMostShift, where(of_sum >= 0.0, of_sum, four(kInfinity)), four(kInfinity))};
}

// Of an end of the edge, as seen from x.
EXACTFF_INLINE FourSightings sighting(const QuickPart::End& end, const FourSegment& edge, const FourVec& x) {
  if (end.kind == QuickPart::End::Kind::kVertex) {
    const FourVec d = four(end.at) - x;
    return {d, kDifferenceError / length(d), Four{}};
  }
  const FourSegment other(end.other, x);
  if (end.kind == QuickPart::End::Kind::kSharedOnEdge) return shared(edge, other);
  if (end.kind == QuickPart::End::Kind::kSharedOnOther) return shared(other, edge);
  const FourCrossing crossing(edge, other.plane);
  return {crossing.at, shift_of(crossing, edge, other), Four{}};
}

// An edge that is seen counter-clockwise round the visible region has a normal a x b that points away from the
// region as seen from x. So the sum of angle * (a x b) . n / |a x b| is -2 pi F.
EXACTFF_CLONES void evaluate_four(std::span<const QuickPart> parts, const Vec3& normal, const Vec3* points,
                                  Evaluated* values) {
  const FourVec x{Four{points[0].x, points[1].x, points[2].x, points[3].x},
                  Four{points[0].y, points[1].y, points[2].y, points[3].y},
                  Four{points[0].z, points[1].z, points[2].z, points[3].z}};
  const FourVec n = four(normal);
  Four sum{}, error{};
  for (const QuickPart& part : parts) {
    const FourSegment edge(part.edge, x);
    const FourSightings from = sighting(part.from, edge, x), to = sighting(part.to, edge, x);
    const FourVec &p = from.direction, &q = to.direction;
    const Four angle = angle_of(dot(cross(p, q - p), edge.plane) / edge.size, dot(p, q));
    const Four cosine = dot(edge.plane, n) / edge.size;
    const Four of_part = kOfFirstOrder * (magnitude(angle) * edge.turn() + magnitude(cosine) * (from.error + to.error) +
                                          from.of_sum + to.of_sum) +
                         kOfTerm * magnitude(angle * cosine);
    // Where a shared crossing is far from the edge, the angle may be a whole turn off.
    const FourMask may_turn = where(from.of_sum + to.of_sum > 0.0, magnitude(angle), Four{}) > kMostAngle;
    const FourMask is_seen = edge.size > 0.0;
    sum += where(is_seen, part.sign * angle * cosine, Four{});
    error += where(is_seen, where(may_turn, four(kInfinity), of_part), four(kInfinity));
  }
  const Four value = sum / (-2.0 * std::numbers::pi), rounding = error / (2.0 * std::numbers::pi);
  for (int i = 0; i < 4; ++i) values[i] = {value[i], rounding[i]};
}

}  // namespace

void evaluate(std::span<const QuickPart> parts, const Vec3& normal, std::span<const Vec3> points,
              std::span<Evaluated> values) {
  std::size_t i = 0;
  for (; i + 4 <= points.size(); i += 4) evaluate_four(parts, normal, &points[i], &values[i]);
  if (i == points.size()) return;
  Vec3 last[4];
  Evaluated found[4];
  for (std::size_t k = 0; k < 4; ++k) last[k] = points[std::min(i + k, points.size() - 1)];
  evaluate_four(parts, normal, last, found);
  std::copy_n(found, points.size() - i, &values[i]);
}

}  // namespace exactff::view_factors
