// The families of stiff scenes. A family is a list of stiffnesses and a function that makes the scene for one of them:
// one receiver, one patch `source`, one patch `occluder`, and the closed form that the result must agree with.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "stress/formulas.h"
#include "stress/stress.h"

namespace exactff::stress {

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
