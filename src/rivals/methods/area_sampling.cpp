// Area sampling: n points of the source, uniform in area over all its faces,
//
//   F ~ A/n sum_i V(x, y_i) cos th_r cos th_s / (pi r_i^2).
//
// The unit square is mapped to the source by area, the faces side by side along u, each by its own map that preserves
// ratios of areas. So one point set serves for random, stratified and low-discrepancy sampling.
//
// In the same way the points can be uniform in the solid angle W of what x sees of the source's unoccluded part above
// the horizon:
//
//   F ~ W/n sum_i V(x, y_i) cos th_r / pi.
#include "methods/area_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "adaptive/sampled_scene.h"
#include "methods/method_files.h"
#include "methods/ray_sum.h"

namespace exactff::methods {

using namespace adaptive;

namespace {

constexpr std::int64_t kMostSamples = std::int64_t{1} << 24;

PointSet point_set_named(std::string_view name) {
  if (name == "random") return PointSet::kRandom;
  return name == "stratified" ? PointSet::kStratified : PointSet::kSobol;
}

class AreaSampling : public Evaluator {
 public:
  AreaSampling(const SampledScene& sampled, const Scene& /*scene*/, const Settings& settings)
      : rays_(sampled),
        points_(point_set_named(settings.word("pattern")), static_cast<int>(settings.whole("samples"))),
        by_solid_angle_(settings.word("measure") == "solid-angle"),
        seed_(static_cast<std::uint64_t>(settings.whole("seed"))) {}

  void look_from(const Receiver& receiver) override {
    const kernel::StandardArithmetic arithmetic;
    rays_.look_from(receiver);
  }

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& prepared) override {
    const kernel::StandardArithmetic arithmetic;
    const auto& source = own<RaySource>(prepared);
    Estimate result;
    if (!(source.area() > 0.0)) return result;  // nothing to sample, or too small for a double
    points_.place(stream_key(rays_.view(), source.selection(), seed_), square_);
    const double measure = by_solid_angle_ ? add_by_solid_angle(source) : add_by_area(source);
    result.form_factor =
        move_into_range(rays_.take() * (measure / static_cast<double>(square_.size())), Formula::kNotNegative);
    result.counters.add("samples", square_.size());
    result.counters.add("rays", rays_.take_rays());
    return result;
  }

 private:
  double add_by_area(const RaySource& source) {
    share_out(source.area_up_to);
    for (std::size_t root = 0; root < source.roots.size(); ++root) add_root(source, root);
    return source.area();
  }

  // `up_to`: the measure of all parts before each part; the last entry is the measure of all. Sorts the points by the
  // part that they fall on, and maps them to the unit square of that part.
  void share_out(const std::vector<double>& up_to) {
    by_part_.resize(up_to.size() - 1);
    if (by_part_.size() == 1) {
      by_part_[0] = square_;
      return;
    }
    for (std::vector<UnitPoint>& points : by_part_) points.clear();
    for (const UnitPoint& p : square_) {
      const double measure = p.u * up_to.back();
      const auto after = std::upper_bound(up_to.begin() + 1, up_to.end() - 1, measure);
      const auto part = static_cast<std::size_t>(after - up_to.begin()) - 1;
      const double width = up_to[part + 1] - up_to[part];
      const double u = width > 0.0 ? (measure - up_to[part]) / width : 0.0;
      by_part_[part].push_back({std::clamp(u, 0.0, 1.0), p.v});
    }
  }

  void add_root(const RaySource& source, std::size_t root) {
    const std::vector<UnitPoint>& points = by_part_[root];
    if (points.empty() || !rays_.aim(source, root, Reach::kVisible, points.size())) return;
    place_by_area(rays_.patch(), points, places_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      rays_.add(places_[i], rays_.kernel(places_[i]));
    }
  }

  // The parts of the source above the horizon, each with its root. Returns their solid angle.
  double find_parts(const RaySource& source) {
    parts_.clear();
    units_.clear();
    first_part_.assign(1, 0);
    angle_up_to_.assign(1, 0.0);
    for (std::size_t root = 0; root < source.roots.size(); ++root) {
      if (rays_.look_at(source, root, Reach::kVisible)) add_parts();
      while (angle_up_to_.size() <= parts_.size()) {
        angle_up_to_.push_back(angle_up_to_.back() + parts_[angle_up_to_.size() - 1].solid_angle());
      }
      first_part_.push_back(parts_.size());
    }
    return angle_up_to_.back();
  }

  // In a unit in which the farthest corner is at a distance of about 1, so that no square underflows.
  void add_parts() {
    polygon_ = rays_.polygon();
    double farthest = 0.0;
    for (const Vec3& corner : polygon_) farthest = std::max(farthest, max_norm(corner));
    if (farthest == 0.0) return;
    const int exponent = std::ilogb(farthest);
    for (Vec3& c : polygon_)
      c = {std::scalbn(c.x, -exponent), std::scalbn(c.y, -exponent), std::scalbn(c.z, -exponent)};
    add_solid_angle_parts(polygon_, std::scalbn(rays_.height(), -exponent), parts_);
    units_.resize(parts_.size(), std::ldexp(1.0, exponent));
  }

  double add_by_solid_angle(const RaySource& source) {
    const double solid_angle = find_parts(source);
    if (!(solid_angle > 0.0)) return 0.0;
    share_out(angle_up_to_);
    for (std::size_t root = 0; root < source.roots.size(); ++root) {
      if (first_part_[root] == first_part_[root + 1]) continue;
      if (!rays_.aim(source, root, Reach::kVisible, square_.size())) continue;
      for (std::size_t k = first_part_[root]; k < first_part_[root + 1]; ++k) add_part(k);
    }
    return solid_angle;
  }

  void add_part(std::size_t k) {
    for (const UnitPoint& at : by_part_[k]) {
      const Vec3 point = parts_[k].point_at(at);
      rays_.add(point * units_[k], rays_.cosine_kernel(point));
    }
  }

  RaySum rays_;
  UnitPoints points_;
  bool by_solid_angle_;
  std::uint64_t seed_;
  std::vector<UnitPoint> square_;
  std::vector<std::vector<UnitPoint>> by_part_;
  RayEnds places_;
  std::vector<Vec3> polygon_;
  std::vector<SolidAnglePart> parts_;
  std::vector<double> units_;            // of the coordinates of each part
  std::vector<std::size_t> first_part_;  // of each root; the last entry is the number of parts
  std::vector<double> angle_up_to_;
};

}  // namespace

Method area_sampling_method() {
  return {
      .name = "area-sampling",
      .summary = "the mean of integrand times visibility (one shadow ray) over points of the source",
      .source =
          "P. Shirley, C. Wang and K. Zimmerman, Monte Carlo Techniques for Direct Lighting (1996); by solid angle: "
          "J. Arvo (1995) and C. Ureña, M. Fajardo and A. King (2013)",
      .settings = {whole_setting("samples", 64, 1, kMostSamples, "sample points, with one ray to each"),
                   word_setting("pattern", {"random", "stratified", "sobol"},
                                "random: independent points; stratified: one in each cell; sobol: the start of a "
                                "low-discrepancy sequence, shifted at random"),
                   word_setting("measure", {"area", "solid-angle"},
                                "the points are uniform in the source's area, or in the solid angle that x sees"),
                   seed_setting()},
      .prepare = prepare_as<OnScene<SceneForRays, RaySource, AreaSampling>>,
      .can_leave_unit = [](const Settings&) { return true; }};
}

// --- Solid angle ---

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

// --- Unit points ---

// Sobol's sequence, its first two dimensions (van der Corput's, and the one of the polynomial x + 1: the direction
// numbers follow from v <- v xor v/2, T. Kollig and A. Keller 2002), of which every 2^k points from the start are a (0,
// k, 2)-net.

namespace {

UnitPoint sobol_point(std::uint32_t index) {
  std::uint32_t u = 0, v = 0;
  std::uint32_t direction_u = 0x80000000U, direction_v = 0x80000000U;
  for (; index != 0; index >>= 1) {
    if ((index & 1U) != 0) {
      u ^= direction_u;
      v ^= direction_v;
    }
    direction_u >>= 1;
    direction_v ^= direction_v >> 1;
  }
  return {u * kUnit32, v * kUnit32};
}

}  // namespace

UnitPoints::UnitPoints(PointSet set, int count) : set_(set), count_(count) {
  if (set == PointSet::kStratified) {
    cells_.prepare(SamplePattern::kJittered, count);
    ends_.resize(cells_.ray_count());
  } else if (set == PointSet::kSobol) {
    for (int i = 0; i < count; ++i) sequence_.push_back(sobol_point(static_cast<std::uint32_t>(i)));
  }
}

void UnitPoints::place(std::uint64_t key, std::vector<UnitPoint>& points) {
  points.resize(static_cast<std::size_t>(count_));
  if (set_ == PointSet::kStratified) return place_stratified(key, points);
  if (set_ == PointSet::kRandom) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = random_point(key, i);
    return;
  }
  const UnitPoint shift = random_point(key, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {wrapped(sequence_[i].u + shift.u), wrapped(sequence_[i].v + shift.v)};
  }
}

// The plan maps the unit square to itself without changing a bit.
void UnitPoints::place_stratified(std::uint64_t key, std::vector<UnitPoint>& points) {
  static const SubPatch kSquare = make_sub_patch(std::array<Vec3, 4>{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  cells_.place(kSquare, key, ends_);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {ends_.x[i], ends_.y[i]};
}

}  // namespace exactff::methods
