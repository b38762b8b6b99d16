// Triangles: J. Arvo, "Stratified Sampling of Spherical Triangles" (SIGGRAPH 1995). Rectangles: C. Ureña, M. Fajardo
// and A. King, "An Area-Preserving Parametrization for Spherical Rectangles" (Eurographics Symposium on Rendering
// 2013).
//
// Both compute with angles of the spherical polygon, whose excess over those of a plane one is the solid angle. Where
// it is small, nothing is left of it. So a triangle (A, B, C) is treated in the plane instead, with e = C - A and the
// solid angle W of A. van Oosterom and J. Strackee (1983):
//
//   tan(W / 2) = det / (|A| |B| |C| + (A.B) |C| + (B.C) |A| + (C.A) |B|),   det = twice the area times the height of x.
//
//   1. Take the point C' = A + t e for which (A, B, C') has the solid angle u W. In the formula above for C', |C'| is
//      the only square root. With it alone on one side, the square of the equation is linear in t.
//   2. Take the point on the arc from B to C' whose angle T from B has 1 - cos T = v (1 - cos(B, C')), as Arvo does. It
//      is the point of the plane that divides the side from B to C' in the ratio of two sines.
// Nothing is subtracted from nearly the same, so that small and far triangles lose no digits. Small rectangles are
// divided into triangles.
#include "methods/solid_angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adaptive/sub_patch.h"

namespace exactff::methods {

using namespace adaptive;

namespace {

constexpr double kLeastRectangle = 1e-3;  // steradians; the angles of smaller ones lose too many digits

// `low` for what is no number: where x is at a corner or on a side, nothing is left to choose.
double within(double t, double low, double high) { return t > low ? std::min(t, high) : low; }
double within_unit(double t) { return within(t, 0.0, 1.0); }

// The components are about 1 or negligible: nothing overflows.
double plain_hypotenuse(double a, double b) { return std::sqrt(a * a + b * b); }

double cosine(const Vec3& a, const Vec3& b) {
  const double lengths = length(a) * length(b);
  return lengths > 0.0 ? dot(a, b) / lengths : 1.0;
}

// |a| |b| + a.b
double half_angle_term(const Vec3& a, const Vec3& b) {
  const double lengths = length(a) * length(b), product = dot(a, b);
  if (product >= 0.0) return lengths + product;
  const Vec3 normal = cross(a, b);
  return dot(normal, normal) / (lengths - product);
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

// Only the choice of the map depends on it, as for parallelograms (sub_patch.cpp).
bool is_rectangle(std::span<const Vec3> corners) {
  if (corners.size() != 4 || make_sub_patch(corners).shape != PatchShape::kParallelogram) return false;
  const Vec3 u = corners[1] - corners[0], v = corners[3] - corners[0];
  const double lengths = length(u) * length(v);
  return lengths > 0.0 && std::abs(dot(u, v)) <= 1e-12 * lengths;
}

}  // namespace

SolidAnglePart SolidAnglePart::triangle(const Vec3& a, const Vec3& b, const Vec3& c, double height) {
  SolidAnglePart part;
  part.corners_ = {a, b, c};
  // The side that x sees under the largest angle becomes (A, B): where that is almost a half turn, only p tells how far
  // x is from the side.
  const double ab = cosine(a, b), bc = cosine(b, c), ca = cosine(c, a);
  if (bc < ab && bc <= ca) part.corners_ = {b, c, a};
  if (ca < ab && ca < bc) part.corners_ = {c, a, b};
  part.prepare_triangle(height);
  return part;
}

SolidAnglePart SolidAnglePart::rectangle(std::span<const Vec3> corners, double height) {
  SolidAnglePart part;
  part.is_rectangle_ = true;
  part.corners_ = {corners[0], corners[1], corners[3]};
  part.prepare_rectangle(height);
  return part;
}

Vec3 SolidAnglePart::point_at(const UnitPoint& at) const { return is_rectangle_ ? on_rectangle(at) : on_triangle(at); }

void SolidAnglePart::prepare_triangle(double height) {
  const auto& [a, b, c] = corners_;
  e_ = c - a;
  length_a_ = length(a);
  length_b_ = length(b);
  length_e_ = length(e_);
  const double length_c = length(c);
  det_ = length(cross(b - a, e_)) * height;
  p_ = half_angle_term(a, b);
  q_ = length_a_ * dot(b, e_) + length_b_ * dot(a, e_);
  solid_angle_ = 2.0 * std::atan2(det_, p_ * length_c + dot(b, c) * length_a_ + dot(c, a) * length_b_);
}

Vec3 SolidAnglePart::on_triangle(const UnitPoint& at) const {
  const auto& [a, b, c] = corners_;
  const double half = 0.5 * at.u * solid_angle_;
  const double g = p_ * std::sin(half);
  const double m = det_ * std::cos(half) - q_ * std::sin(half);
  const double above = 2.0 * g * (m * length_a_ + g * dot(a, e_));
  const double t = within_unit(above / ((m - g * length_e_) * (m + g * length_e_)));
  const Vec3 on_side = a + e_ * t;
  const double whole = angle_between(b, on_side);
  const double angle = 2.0 * std::asin(within_unit(std::sqrt(at.v) * std::sin(0.5 * whole)));
  const double of_b = std::sin(whole - angle) * length(on_side), of_side = std::sin(angle) * length_b_;
  return b + (on_side - b) * within_unit(of_side / (of_b + of_side));
}

// The notation is the paper's. The normals n0 to n3 of the sides' planes are written out, and w0 = 1 - b0^2, whose
// difference would lose digits.
void SolidAnglePart::prepare_rectangle(double height) {
  auto& [corner, x, y] = corners_;
  const double length_x = length(x - corner), length_y = length(y - corner);
  x = (x - corner) * (1.0 / length_x);
  y = (y - corner) * (1.0 / length_y);
  x0_ = dot(corner, x);
  y0_ = dot(corner, y);
  x1_ = x0_ + length_x;
  y1_ = y0_ + length_y;
  z_ = height;
  const double n0 = std::hypot(y0_, z_), n1 = std::hypot(x1_, z_), n2 = std::hypot(y1_, z_), n3 = std::hypot(x0_, z_);
  b0_ = -y0_ / n0;
  b1_ = y1_ / n2;
  w0_ = (z_ / n0) * (z_ / n0);
  // The angles between neighbouring sides, as x sees them.
  const double g0 = std::acos(std::clamp(-b0_ * x1_ / n1, -1.0, 1.0)),
               g1 = std::acos(std::clamp(-x1_ / n1 * b1_, -1.0, 1.0));
  const double g2 = std::acos(std::clamp(b1_ * x0_ / n3, -1.0, 1.0)),
               g3 = std::acos(std::clamp(x0_ / n3 * b0_, -1.0, 1.0));
  k_ = 2.0 * std::numbers::pi - g2 - g3;
  s_ = g0 + g1 - k_;
  solid_angle_ = s_;
}

Vec3 SolidAnglePart::on_rectangle(const UnitPoint& at) const {
  const double au = at.u * s_ + k_;
  const double fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
  const double xu = within(std::copysign(z_ / std::sqrt(std::max(0.0, fu * fu - w0_)), fu), x0_, x1_);
  const double d = plain_hypotenuse(xu, z_);
  const double h0 = y0_ / plain_hypotenuse(d, y0_), h1 = y1_ / plain_hypotenuse(d, y1_);
  const double hv = h0 + at.v * (h1 - h0);
  const double yv = within(hv * d / std::sqrt(std::max(0.0, (1.0 - hv) * (1.0 + hv))), y0_, y1_);
  const auto& [corner, x, y] = corners_;
  return corner + x * (xu - x0_) + y * (yv - y0_);
}

void add_solid_angle_parts(std::span<const Vec3> polygon, double height, std::vector<SolidAnglePart>& parts) {
  const std::size_t first = parts.size();
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    parts.push_back(SolidAnglePart::triangle(polygon[0], polygon[i], polygon[i + 1], height));
    sum += parts.back().solid_angle();
  }
  if (!(sum > kLeastRectangle) || !(height > 0.0) || !is_rectangle(polygon)) return;
  parts.resize(first, SolidAnglePart::triangle({}, {}, {}, 0.0));
  parts.push_back(SolidAnglePart::rectangle(polygon, height));
}

}  // namespace exactff::methods
