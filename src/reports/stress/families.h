// The families of stiff scenes. A family is a list of stiffnesses and a function that makes the scene for one of them:
// one receiver, one patch `source`, one patch `occluder`, and the closed form that the result must agree with.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/geometry.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "kernel/ball.h"
#include "kernel/numbers.h"
#include "stress/stress.h"

namespace exactff::stress {

// --- Formulas ---

// Two ways to compute the form factors of stiff scenes. The true value: the form factor from the origin to axis-aligned
// rectangles, by the closed form of Howell's catalogue, independent of visibility, clipping and Eq. (4). And what
// programs do: Eq. (4) in plain double.
//
// For a rectangle [u1,u2] x [v1,v2] in the plane w = +-h, h > 0, Lambert's vector is
//   L_u = D Hu,  L_v = D Hv,  L_w = +-D G,    D f = f(u2,v2) - f(u1,v2) - f(u2,v1) + f(u1,v1),
//   Hu(u,v) = -h/(2 pi A) atan(v/A),  Hv(u,v) = -h/(2 pi B) atan(u/B),
//   G(u,v) = (u/A atan(v/A) + v/B atan(u/B)) / (2 pi),    A = sqrt(u^2 + h^2), B = sqrt(v^2 + h^2),
// and F = n . L / |n| if the rectangle lies above the horizon. Hu and Hv are the factor of a perpendicular rectangle, G
// that of a parallel one (J. R. Howell's catalogue, B-4 and B-3).

using kernel::Rational;

struct Interval {
  Rational low, high;
};
[[nodiscard]] Interval intersection(const Interval& a, const Interval& b);
[[nodiscard]] bool is_empty(const Interval& a);  // also if it is a single number

// A rectangle perpendicular to `axis` (0, 1, 2: x, y, z) at the signed distance from the origin; u and v are the next
// axes in cyclic order. Empty if one of the intervals is.
struct Rectangle {
  int axis = 2;
  Rational distance;  // not zero
  Interval u, v;
};

// A signed sum of rectangles, all of which must be above the horizon of the normal.
class ClosedForm {
 public:
  explicit ClosedForm(const Vec3& normal);

  void add(const Rectangle& rectangle, const Rational& weight = 1);

  // Encloses the sum with a relative radius of at most 2^-120, or returns the ball at 2^17 bits. Exactly zero if there
  // are no rectangles.
  [[nodiscard]] Enclosure value() const;

 private:
  struct Term {
    Rectangle rectangle;
    Rational weight;
  };
  [[nodiscard]] Ball evaluate(long bits) const;

  std::array<Rational, 3> normal_;
  std::vector<Term> terms_;
};

// --- Eq. (4) in double ---
//
// Eq. (4) of F. Tampieri (1992) in plain double, in the three forms that programs use: the results of careful and of
// careless code. Each estimates the form factor of a region from its boundary.

enum class AngleFormula {
  kAcos,             // unit vectors a and b, acos(a . b), a x b
  kAtan2,            // atan2(|a x b|, a . b)
  kAtan2Difference,  // the same, but a x b is computed as a x (b - a)
};

// A closed polygon, counter-clockwise seen from the front of the source; holes are clockwise.
using Polygon = std::vector<Vec3>;

// -1/(2 pi |n|) times the sum over the edges of angle n . (a x b) / |a x b|, with a and b relative to x. Nothing is
// clamped, but the angle of two unit vectors is 0 or pi if their product rounds beyond 1. An edge with a x b = 0 adds
// nothing.
[[nodiscard]] double form_factor_in_double(std::span<const Polygon> region, const Vec3& x, const Vec3& normal,
                                           AngleFormula formula);

// --- Families ---

// A scene with its receiver and source, and what is known about the result.
struct Case {
  double stiffness = 1.0;
  Scene scene;
  Receiver receiver;
  std::optional<ClosedForm> truth;  // none: compared with the exact method's own enclosure
};

// low < high
struct Span {
  double low = 0.0;
  double high = 0.0;
};

inline constexpr Vec3 kUp{0, 0, 1};
inline constexpr Span kSide{-1, 1};

// In the xz plane.
struct ProfilePoint {
  double x = 0.0;
  double z = 0.0;
};

class Stage {
 public:
  Stage(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal), material_(builder_.add_material({})) {}

  // The ring is counter-clockwise as seen from the front.
  void add_source(const std::vector<Vec3>& ring) { add("source", {ring}); }
  void add_occluder(const std::vector<Vec3>& ring) { add("occluder", {ring}); }
  void add_occluder_with_hole(const std::vector<Vec3>& ring, const std::vector<Vec3>& hole) {
    add("occluder", {ring, hole});
  }
  // Rectangles parallel to the xy plane; the front faces down, towards a receiver below.
  [[nodiscard]] static std::vector<Vec3> level_ring(const Span& x, const Span& y, double z);
  void add_level_source(const Span& x, const Span& y, double z);
  void add_level_occluder(const Span& x, const Span& y, double z);
  // A plate whose profile in the xz plane is the segment between the two points, with the extent `y` along y.
  void add_slat(const ProfilePoint& from, const ProfilePoint& to, const Span& y);

  [[nodiscard]] const Vec3& normal() const { return normal_; }
  [[nodiscard]] Case finish(double stiffness, std::optional<ClosedForm> truth);

 private:
  void add(std::string_view patch, const std::vector<std::vector<Vec3>>& rings);

  Vec3 point_, normal_;
  SceneBuilder builder_;
  MaterialId material_;
};

// Projects from the receiver at x onto the level plane z = `level`. Results are rational coordinates relative to x.
class LevelView {
 public:
  LevelView(const Vec3& x, double level) : x_(x), distance_(kernel::to_rational(level) - kernel::to_rational(x.z)) {}

  // The shadow of the profile point (u, z), with u along x or along y.
  [[nodiscard]] Rational along_x(double u, double z) const { return project(u, x_.x, z); }
  [[nodiscard]] Rational along_y(double u, double z) const { return project(u, x_.y, z); }
  // The shadow along x of a plate with this profile.
  [[nodiscard]] Interval shadow(const ProfilePoint& from, const ProfilePoint& to) const;
  // The shadow of a level rectangle. For z = level it is the rectangle itself.
  [[nodiscard]] Rectangle shadow(const Span& x, const Span& y, double z) const;

 private:
  [[nodiscard]] Rational project(double u, double origin, double z) const;

  Vec3 x_;
  Rational distance_;
};

[[nodiscard]] Rectangle intersection(const Rectangle& a, const Rectangle& b);  // both in the same plane

// The closed form of a source behind plates that, along v, are at least as wide as the source: the source minus the
// union of their shadows along u.
[[nodiscard]] ClosedForm left_by_strips(const Vec3& normal, const Rectangle& source, std::vector<Interval> shadows);

// One level plate before a level source.
struct PlateBeforeSource {
  Vec3 point, normal;
  Span source_x, source_y;
  double source_z;
  Span plate_x, plate_y;
  double plate_z;
};
[[nodiscard]] Case plate_before_source(double stiffness, const PlateBeforeSource& p);

struct Family {
  FamilyInfo info;
  std::vector<double> stiffnesses;  // ascending
  Case (*make)(double stiffness);
};
[[nodiscard]] const std::vector<Family>& all_families();  // in the order of the report

}  // namespace exactff::stress
