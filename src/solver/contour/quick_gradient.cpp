#include "contour/quick_gradient.h"

#include <algorithm>
#include <cmath>

#include "contour/quick_angle.h"
#include "contour/quick_vector.h"
#include "kernel/vec.h"

namespace exactff::contour {

using namespace kernel::double_double;

namespace {

Vector vector_of(const QuickCorner& corner) {
  const auto component = [&](int i) -> DoubleDouble { return {corner.hi[i], corner.lo[i]}; };
  return vector<double>({component(0), component(1), component(2)}, corner.error);
}

// The receiver's normal with an error, because scaling it may have lost a component to underflow.
Vector vector_of(const std::array<double, 3>& normal) {
  return vector<double>({DoubleDouble{normal[0], 0.0}, {normal[1], 0.0}, {normal[2], 0.0}}, kUnderflow);
}

Bounded component(const Vector& v, int i) { return {v.c[i].hi, v.c[i].lo, v.error}; }

// False for NaN.
bool has_moderate_size(const Vector& v) {
  const double largest = std::max({std::abs(v.c[0].hi), std::abs(v.c[1].hi), std::abs(v.c[2].hi)});
  return largest >= 0x1p-200 && largest <= 0x1p200 && v.norm <= 0x1p202;
}

Bounded psi(const Vector& w, const Vector& n, const Vector& d) { return dot(w, n) * dot(w, d) / dot(w, w); }

// A point of a line: s a + m d.
struct Point {
  Bounded s, m;
  Vector direction;
  Bounded psi;
};

}  // namespace

QuickCorner lifted(const QuickCorner& direction, const std::array<Bounded, 3>& normal, const Bounded& offset) {
  const Vector c = vector_of(direction);
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

QuickGradient::Line QuickGradient::line_between(const QuickCorner& p, const QuickCorner& q) const {
  Line line;
  const Vector n = vector_of(normal_), from = vector_of(p), to = vector_of(q);
  line.reversed = to.norm < from.norm;
  line.a = line.reversed ? to : from;
  line.b = line.reversed ? from : to;
  line.along = difference(line.b, line.a);
  line.cross = cross(line.a, line.along);
  if (!has_moderate_size(from) || !has_moderate_size(to)) line.cross.error = kDeclined.error;
  const Bounded squared = dot(line.cross, line.cross);
  line.size = square_root(squared);
  line.inverse = Bounded{1.0, 0.0, 0.0} / line.size;
  line.growth = dot(cross(n, line.along), line.cross) * line.inverse / squared;
  line.psi_a = psi(line.a, n, line.along);
  line.psi_b = psi(line.b, n, line.along);
  return line;
}

namespace {

using Line = QuickGradient::Line;

// Where the plane through x and another line crosses the line. Declined unless that is certain.
Point crossing(const Line& line, const Line& other, const Vector& n) {
  const Bounded height_a = dot(other.cross, line.a), rise = dot(other.cross, line.along), height_b = height_a + rise;
  const bool crosses =
      sign_is_certain(height_a) && sign_is_certain(height_b) && (height_a.hi < 0.0) != (height_b.hi < 0.0);
  if (!crosses) return {kDeclined, kDeclined, line.a, kDeclined};
  int exponent = 0;
  std::frexp(rise.hi, &exponent);
  const double scale = std::ldexp(1.0, std::clamp(-exponent, -900, 900));
  Point point;
  point.s = scale * (rise.hi < 0.0 ? -rise : rise);
  point.m = scale * (height_a.hi < 0.0 ? -height_a : height_a);
  point.direction = combination(point.s, line.a, point.m, line.along);
  point.psi = psi(point.direction, n, line.along);
  return point;
}

Point end_of(const Line& line, std::uint32_t end, std::span<const Line> lines, const Vector& n) {
  if (end < QuickPiece::kAtA) return crossing(line, lines[end], n);
  const bool at_a = end == (line.reversed ? QuickPiece::kAtB : QuickPiece::kAtA);
  constexpr Bounded kOne{1.0, 0.0, 0.0};
  return at_a ? Point{kOne, Bounded{}, line.a, line.psi_a} : Point{kOne, kOne, line.b, line.psi_b};
}

// x 2^exponent; declined where that is not certain to be exact.
Bounded scaled(const Bounded& x, int exponent) {
  if (exponent < -900 || exponent > 900) return kDeclined;
  const double scale = std::ldexp(1.0, exponent);
  return {x.hi * scale, x.lo * scale, x.error * scale + kUnderflow};
}

}  // namespace

void QuickGradient::add(std::span<const QuickPiece> pieces, std::span<const Line> lines, int exponent) {
  const Vector n = vector_of(normal_);
  const AngleConstants& known = angle_constants();
  std::array<Bounded, 3> sum{};
  for (const QuickPiece& piece : pieces) {
    const Line& line = lines[piece.edge];
    const Point p = end_of(line, piece.begin, lines, n), q = end_of(line, piece.end, lines, n);
    const Bounded w = sum_of_products(p.s, q.m, -p.m, q.s);
    const Bounded theta = atan2(w * line.size, dot(p.direction, q.direction), known);
    const Bounded over_size = theta * line.inverse;
    const Bounded moved = theta * line.growth + (q.psi - p.psi) * (line.inverse * line.inverse);
    for (int i = 0; i < 3; ++i) {
      const Bounded c = component(line.cross, i);
      sum[i] = sum[i] - c * moved;
      v_[i] = v_[i] - c * over_size;
    }
  }
  for (int i = 0; i < 3; ++i) position_[i] = position_[i] + scaled(sum[i], exponent);
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

QuickGradient::Value QuickGradient::position(int axis) const {
  const Vector n = vector_of(normal_);
  return value_of(position_[axis] / (square_root(dot(n, n)) * (2.0 * constant(angle_constants().pi))));
}

QuickGradient::Value QuickGradient::normal(int axis) const {
  return value_of(v_[axis] / (2.0 * constant(angle_constants().pi)));
}

}  // namespace exactff::contour
