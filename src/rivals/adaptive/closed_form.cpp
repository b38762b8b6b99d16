// F = -1/(2 pi) sum_i angle(R_i, R_i+1) / |R_i x R_i+1| * (R_i x R_i+1) . N_r
//
// Notation of F. Tampieri, "Accurate Form-Factor Computation" (1992), Eq. (4), which prints no minus: that is an
// erratum for vertices that run counter-clockwise as x sees them, and both variants below correct it. The formula is
// homogeneous in every R_i, so R_i need not be a unit vector.
//   1. a x b is computed as a x (b - a): the plain product loses a factor r/h of accuracy to cancellation twice;
//   2. the angle is atan2(|a x b|, a . b), since acos cannot resolve angles below 1e-8. Where all angles are small, as
//      they are after a split or two, angle / |a x b| = g(q^2) / (a . b) with q = |a x b| / (a . b) and g(z) =
//      atan(sqrt z) / sqrt z = 1 - z/3 + z^2/5 - ..., which needs no root and no atan2. It is computed for four edges
//      at a time.
#include <numbers>

#include "adaptive/sub_patch.h"
#include "kernel/expect.h"
#include "kernel/lanes.h"

namespace exactff::adaptive {

using namespace kernel::lanes;

namespace {

// Edge i runs from corner i to corner i + 1; a triangle's third edge is degenerate and adds 0.
struct Edges {
  Four height;        // (a x b) . N_r
  Four cosine;        // a . b
  Four squared_sine;  // |a x b|^2
};

inline void make_edges(const SubPatch& s, const Vec3& n, Edges& edges) {
  const Four ax = load(s.x), ay = load(s.y), az = load(s.z);
  const Four bx = next_lane(ax), by = next_lane(ay), bz = next_lane(az);
  const Four ex = bx - ax, ey = by - ay, ez = bz - az;
  const Four cx = ay * ez - az * ey, cy = az * ex - ax * ez, cz = ax * ey - ay * ex;
  edges.height = cx * n.x + cy * n.y + cz * n.z;
  edges.cosine = ax * bx + ay * by + az * bz;
  edges.squared_sine = cx * cx + cy * cy + cz * cz;
}

// g(z) for z in [0, 1/64]; the first term left out is below 2^-64
constexpr double kLargestSeriesArgument = 1.0 / 64.0;
constexpr double kSeries[] = {1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1};

inline double series_sum(const Edges& e) {
  const Four z = e.squared_sine / (e.cosine * e.cosine);
  Four g{};
  for (const double c : kSeries) g = c - z * g;
  return lane_sum(g * e.height / e.cosine);
}

double atan2_sum(const Edges& e) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double sine = std::sqrt(e.squared_sine[i]);
    if (sine > 0.0) sum += std::atan2(sine, e.cosine[i]) / sine * e.height[i];
  }
  return sum;
}

// For patches this small, squares of cosines and fourth powers of sines underflow or lose digits. The formula is
// homogeneous, so such a patch is scaled to a size of about 1 first. Corners that are nearer than others by this factor
// stay so.
constexpr double kLeastSize = 0x1p-200;
constexpr double kLeastCosine = 0x1p-400;

inline double size_of(const SubPatch& s) {
  return highest(larger(larger(absolute(load(s.x)), absolute(load(s.y))), absolute(load(s.z))));
}

SubPatch scaled(const SubPatch& s, int exponent) {
  SubPatch result = s;
  for (double* axis : {result.x, result.y, result.z}) {
    for (int i = 0; i < 4; ++i) axis[i] = std::scalbn(axis[i], -exponent);
  }
  return result;
}

}  // namespace

EXACTFF_CLONES
double unoccluded_form_factor(const SubPatch& s, const Vec3& unit_normal) {
  EXACTFF_EXPECT(std::abs(unit_normal.x * unit_normal.x + unit_normal.y * unit_normal.y +
                          unit_normal.z * unit_normal.z - 1.0) < 1e-9);
  Edges e;
  make_edges(s, unit_normal, e);
  const Four least = four(kLeastCosine);
  if (!all_lanes((e.cosine >= least) | (e.cosine <= -least))) {  // in a room many edges are seen at a right angle, too
    const double size = size_of(s);
    if (size > 0.0 && size < kLeastSize) make_edges(scaled(s, std::ilogb(size)), unit_normal, e);
  }
  const FourMask small = (e.squared_sine <= kLargestSeriesArgument * e.cosine * e.cosine) & (e.cosine >= least);
  const double sum = all_lanes(small) ? series_sum(e) : atan2_sum(e);
  return std::min(1.0, std::max(0.0, sum * (-0.5 * std::numbers::inv_pi)));
}

namespace {

struct Float3 {
  float x, y, z;
};

float dot(const Float3& a, const Float3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Float3 cross(const Float3& a, const Float3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Only directions matter below: a corner whose squares are outside the range of floats is scaled to about length 1.
Vec3 within_floats(const Vec3& v) {
  constexpr double kLeast = 0x1p-50, kLargest = 0x1p50;
  const double size = max_norm(v);
  if (size == 0.0 || (size >= kLeast && size <= kLargest)) return v;
  int exponent = 0;
  return normalised(v, exponent);
}

Float3 to_float(const Vec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

Float3 unit(const Vec3& corner) {
  const Float3 v = to_float(within_floats(corner));
  const float square = dot(v, v);
  if (square == 0.0F) return v;
  const float reciprocal = 1.0F / std::sqrt(square);
  return {v.x * reciprocal, v.y * reciprocal, v.z * reciprocal};
}

}  // namespace

// The cosine is clamped to [-1, 1] and a vanishing cross product skipped, where the printed formula would give NaN.
double literal_unoccluded_form_factor(const SubPatch& s, const Vec3& unit_normal) {
  const Float3 normal = to_float(unit_normal);
  float sum = 0.0F;
  const int n = s.corner_count();
  for (int i = 0; i < n; ++i) {
    const Float3 a = unit(s.corner(i));
    const Float3 b = unit(s.corner(i + 1 == n ? 0 : i + 1));
    const Float3 c = cross(a, b);
    const float sine = std::sqrt(dot(c, c));
    const float angle = std::acos(std::clamp(dot(a, b), -1.0F, 1.0F));
    if (sine > 0.0F) sum -= angle / sine * dot(c, normal);
  }
  return static_cast<double>(sum) * (0.5 * std::numbers::inv_pi);
}

}  // namespace exactff::adaptive
