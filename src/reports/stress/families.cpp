// The families of stiff scenes, with the closed form that the result must agree with.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "kernel/ball.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "stress/stress.h"

namespace exactff::stress {
namespace {

using kernel::Rational;
using kernel::to_ball;
using kernel::to_rational;

// --- Formulas ---

// The true values of stiff scenes: the form factor from the origin to axis-aligned rectangles, by the closed form of
// Howell's catalogue, independent of visibility, clipping and Eq. (4).
//
// For a rectangle [u1,u2] x [v1,v2] in the plane w = +-h, h > 0, Lambert's vector is
//   L_u = D Hu,  L_v = D Hv,  L_w = +-D G,    D f = f(u2,v2) - f(u1,v2) - f(u2,v1) + f(u1,v1),
//   Hu(u,v) = -h/(2 pi A) atan(v/A),  Hv(u,v) = -h/(2 pi B) atan(u/B),
//   G(u,v) = (u/A atan(v/A) + v/B atan(u/B)) / (2 pi),    A = sqrt(u^2 + h^2), B = sqrt(v^2 + h^2),
// and F = n . L / |n| if the rectangle lies above the horizon. Hu and Hv are the factor of a perpendicular rectangle, G
// that of a parallel one (J. R. Howell's catalogue, B-4 and B-3).

struct Interval {
  Rational low, high;
};
Interval intersection(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}
bool is_empty(const Interval& a) { return a.low >= a.high; }  // also if it is a single number

// A rectangle perpendicular to `axis` (0, 1, 2: x, y, z) at the signed distance from the origin; u and v are the next
// axes in cyclic order. Empty if one of the intervals is.
struct Rectangle {
  int axis = 2;
  Rational distance;  // not zero
  Interval u, v;
};

// atan(b / root) / root, root = sqrt(a^2 + h^2)
Ball angle_over_root(const Rational& a, const Rational& b, const Rational& h, long bits) {
  const Ball root = sqrt(to_ball(Rational(a * a + h * h), bits));
  return atan(to_ball(b, bits) / root) / root;
}

// 2 pi n . (Hu, Hv, +-G) at one corner: H has atan(v/A)/A and atan(u/B)/B.
Ball corner_value(const Rational& u, const Rational& v, const Rational& h, const std::array<Rational, 3>& n,
                  long bits) {
  return angle_over_root(u, v, h, bits) * to_ball(Rational(n[2] * u - n[0] * h), bits) +
         angle_over_root(v, u, h, bits) * to_ball(Rational(n[2] * v - n[1] * h), bits);
}

// 2 pi n . L
Ball rectangle_value(const Rectangle& r, const std::array<Rational, 3>& normal, long bits) {
  const auto axis = static_cast<std::size_t>(r.axis);
  const Rational h = abs(r.distance);
  std::array<Rational, 3> n = {normal[(axis + 1) % 3], normal[(axis + 2) % 3], normal[axis]};
  if (kernel::sign(r.distance) < 0) n[2] = -n[2];
  const auto at = [&](const Rational& u, const Rational& v) { return corner_value(u, v, h, n, bits); };
  return at(r.u.high, r.v.high) - at(r.u.low, r.v.high) - at(r.u.high, r.v.low) + at(r.u.low, r.v.low);
}

// A signed sum of rectangles, all of which must be above the horizon of the normal.
class ClosedForm {
 public:
  explicit ClosedForm(const Vec3& normal)
      : normal_{to_rational(normal.x), to_rational(normal.y), to_rational(normal.z)} {}

  void add(const Rectangle& rectangle, const Rational& weight = 1) {
    if (!is_empty(rectangle.u) && !is_empty(rectangle.v)) terms_.push_back({rectangle, weight});
  }

  // Encloses the sum with a relative radius of at most 2^-120, or returns the ball at 2^17 bits. Exactly zero if there
  // are no rectangles.
  [[nodiscard]] Enclosure value() const {
    if (terms_.empty()) return {};
    constexpr long kWanted = 120, kFirst = 192, kLast = 1L << 17;
    Ball ball = evaluate(kFirst);
    for (long bits = 2 * kFirst; bits <= kLast && kernel::certain_bits(ball) < kWanted; bits *= 2) {
      ball = evaluate(bits);
    }
    return EnclosureInside::of(ball);
  }

 private:
  struct Term {
    Rectangle rectangle;
    Rational weight;
  };
  [[nodiscard]] Ball evaluate(long bits) const {
    Ball sum(bits);
    for (const Term& term : terms_) {
      sum.add_product(rectangle_value(term.rectangle, normal_, bits), to_ball(term.weight, bits));
    }
    const Rational squared_length = normal_[0] * normal_[0] + normal_[1] * normal_[1] + normal_[2] * normal_[2];
    return sum / sqrt(to_ball(squared_length, bits)) / twice(kernel::pi(bits));
  }

  std::array<Rational, 3> normal_;
  std::vector<Term> terms_;
};

// --- Stages ---

// low < high
struct Span {
  double low = 0.0;
  double high = 0.0;
};

constexpr Vec3 kUp{0, 0, 1};
constexpr Span kSide{-1, 1};

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
  static std::vector<Vec3> level_ring(const Span& x, const Span& y, double z) {
    return {{x.low, y.low, z}, {x.low, y.high, z}, {x.high, y.high, z}, {x.high, y.low, z}};
  }
  void add_level_source(const Span& x, const Span& y, double z) { add_source(level_ring(x, y, z)); }
  void add_level_occluder(const Span& x, const Span& y, double z) { add_occluder(level_ring(x, y, z)); }
  // A plate whose profile in the xz plane is the segment between the two points, with the extent `y` along y.
  void add_slat(const ProfilePoint& from, const ProfilePoint& to, const Span& y) {
    add_occluder({{from.x, y.low, from.z}, {from.x, y.high, from.z}, {to.x, y.high, to.z}, {to.x, y.low, to.z}});
  }

  [[nodiscard]] Case finish(double stiffness) {
    return {stiffness, builder_.build(), {.point = point_, .normal = normal_, .on = {}, .id = {}}, std::nullopt};
  }
  [[nodiscard]] Case finish(double stiffness, const ClosedForm& truth) {
    Case made = finish(stiffness);
    made.truth = truth.value();
    return made;
  }

 private:
  void add(std::string_view patch, const std::vector<std::vector<Vec3>>& rings) {
    std::vector<std::vector<std::uint32_t>> indices;
    for (const std::vector<Vec3>& ring : rings) {
      std::vector<std::uint32_t>& one = indices.emplace_back();
      for (const Vec3& corner : ring) one.push_back(builder_.add_vertex(corner));
    }
    builder_.add_face(builder_.patch(patch), material_, std::move(indices));
  }

  Vec3 point_, normal_;
  SceneBuilder builder_;
  MaterialId material_;
};

// Projects from the receiver at x onto the level plane z = `level`. Results are rational coordinates relative to x.
class LevelView {
 public:
  LevelView(const Vec3& x, double level) : x_(x), distance_(to_rational(level) - to_rational(x.z)) {}

  // The shadow of the profile point (u, z), with u along x or along y.
  [[nodiscard]] Rational along_x(double u, double z) const { return project(u, x_.x, z); }
  [[nodiscard]] Rational along_y(double u, double z) const { return project(u, x_.y, z); }
  // The shadow along x of a plate with this profile.
  [[nodiscard]] Interval shadow(const ProfilePoint& from, const ProfilePoint& to) const {
    const Rational a = along_x(from.x, from.z), b = along_x(to.x, to.z);
    return {std::min(a, b), std::max(a, b)};
  }
  // The shadow of a level rectangle. For z = level it is the rectangle itself.
  [[nodiscard]] Rectangle shadow(const Span& x, const Span& y, double z) const {
    return {2, distance_, {along_x(x.low, z), along_x(x.high, z)}, {along_y(y.low, z), along_y(y.high, z)}};
  }

 private:
  [[nodiscard]] Rational project(double u, double origin, double z) const {
    return (to_rational(u) - to_rational(origin)) * distance_ / (to_rational(z) - to_rational(x_.z));
  }

  Vec3 x_;
  Rational distance_;
};

// Of two in the same plane.
Rectangle intersection(const Rectangle& a, const Rectangle& b) {
  return {a.axis, a.distance, intersection(a.u, b.u), intersection(a.v, b.v)};
}

// The closed form of a source behind plates that, along v, are at least as wide as the source: the source minus the
// union of their shadows along u.
ClosedForm left_by_strips(const Vec3& normal, const Rectangle& source, std::vector<Interval> shadows) {
  std::sort(shadows.begin(), shadows.end(), [](const Interval& a, const Interval& b) { return a.low < b.low; });
  ClosedForm form(normal);
  Interval gap{source.u.low, source.u.low};
  const auto close_gap_at = [&](const Rational& end) {
    gap.high = std::min(end, source.u.high);
    form.add({source.axis, source.distance, gap, source.v});
  };
  for (const Interval& shadow : shadows) {
    close_gap_at(shadow.low);
    gap.low = std::max(gap.low, shadow.high);
  }
  close_gap_at(source.u.high);
  return form;
}

// One level plate before a level source.
struct PlateBeforeSource {
  Vec3 point, normal;
  Span source_x, source_y;
  double source_z;
  Span plate_x, plate_y;
  double plate_z;
};
Case plate_before_source(double stiffness, const PlateBeforeSource& p) {
  Stage stage(p.point, p.normal);
  stage.add_level_source(p.source_x, p.source_y, p.source_z);
  stage.add_level_occluder(p.plate_x, p.plate_y, p.plate_z);
  const LevelView view(p.point, p.source_z);
  const Rectangle source = view.shadow(p.source_x, p.source_y, p.source_z);
  ClosedForm truth(p.normal);
  truth.add(source);
  truth.add(intersection(source, view.shadow(p.plate_x, p.plate_y, p.plate_z)), -1);
  return stage.finish(stiffness, truth);
}

// --- near, far, small, thin, barely above the horizon: no occluder hides anything ---

Interval relative(const Span& span, double origin) {
  return {to_rational(span.low) - to_rational(origin), to_rational(span.high) - to_rational(origin)};
}

// An unoccluded level source.
Case level_source(double stiffness, const Vec3& point, const Vec3& normal, const Span& x, const Span& y, double z) {
  Stage stage(point, normal);
  stage.add_level_source(x, y, z);
  ClosedForm truth(normal);
  truth.add(LevelView(point, z).shadow(x, y, z));
  return stage.finish(stiffness, truth);
}

Case approach_interior(double s) { return level_source(s, {0.3, 0.2, 0}, kUp, {-1, 1}, {-1, 1}, 1 / s); }
Case approach_edge(double s) { return level_source(s, {0, 0.2, 0}, kUp, {0, 1}, {-1, 1}, 1 / s); }
Case approach_vertex(double s) { return level_source(s, {0, 0, 0}, kUp, {0, 1}, {0, 1}, 1 / s); }

Case shrink(double s) { return level_source(s, {100, 37, -50}, kUp, {-0.5 / s, 0.5 / s}, {-0.5 / s, 0.5 / s}, 0); }
Case recede(double s) { return level_source(s, {100 * s, 37 * s, -50 * s}, kUp, {-0.5, 0.5}, {-0.5, 0.5}, 0); }
Case sliver(double s) { return level_source(s, {0.7, 0.2, 0}, kUp, {0, 1 / s}, {-0.4, 1}, 0.5); }

Case foot_of_wall(double s) {
  const Vec3 point{0, 0.2, 0};
  const double d = 1 / s;
  Stage stage(point, kUp);
  stage.add_source({{d, -1, 0}, {d, -1, 1}, {d, 1, 1}, {d, 1, 0}});
  ClosedForm truth(kUp);
  truth.add({0, to_rational(d), relative({-1, 1}, point.y), relative({0, 1}, point.z)});
  return stage.finish(s, truth);
}

// A wall in the plane y = 1. Only its part from the receiver's height `z` up to `top` is above the horizon.
Case wall_over_horizon(double s, double z, double top) {
  const Vec3 point{0, 0, z};
  const Span x{-0.5, 0.75};
  Stage stage(point, kUp);
  stage.add_source({{x.low, 1, z - 1}, {x.high, 1, z - 1}, {x.high, 1, top}, {x.low, 1, top}});
  ClosedForm truth(kUp);
  truth.add({1, 1, relative({z, top}, z), relative(x, 0)});
  return stage.finish(s, truth);
}

Case horizon_grazed(double s) { return wall_over_horizon(s, 0, 1 / s); }
Case horizon_ulp(double s) { return wall_over_horizon(s, 1, 1 + 1 / s); }

// The horizon cuts the level square [-1,1]^2 along x = 1 - 1/s.
Case horizon_tilted(double s) {
  const double cut = 1 - 1 / s;
  const Vec3 normal{1, 0, -cut};
  Stage stage({0, 0, 0}, normal);
  stage.add_level_source({-1, 1}, {-1, 1}, 1);
  ClosedForm truth(normal);
  truth.add({2, 1, relative({cut, 1}, 0), relative({-1, 1}, 0)});
  return stage.finish(s, truth);
}

// --- cracks, contacts, planes that nearly coincide ---
//
// Occluders that almost touch each other, the receiver, the source, or the plane of the receiver or source.
//
// The source is a level square, [-1,1]^2 or similar, that faces down. Where only the profile of the plates in the xz
// plane matters, the plates are wider than the source.

constexpr Span kWide{-4, 4};

// Two level plates at half the height of the source: one extends to the left from `left`, the other to the right from
// `right`.
Case two_plates(double s, double left, double right) {
  const Vec3 point{0.3, 0.2, 0};
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, 1);
  stage.add_level_occluder({-4, left}, kWide, 0.5);
  stage.add_level_occluder({right, 4}, kWide, 0.5);
  const LevelView view(point, 1);
  return stage.finish(s, left_by_strips(kUp, view.shadow(kSide, kSide, 1),
                                        {view.shadow({-4, 0.5}, {left, 0.5}), view.shadow({right, 0.5}, {4, 0.5})}));
}

Case crack(double s) { return two_plates(s, 0, 1 / s); }
Case crack_ulp(double s) { return two_plates(s, 0.25, 0.25 + 1 / s); }
Case overlap(double s) { return two_plates(s, 0.25 + 1 / s, 0.25); }

// One level plate between the given receiver and the given source.
Case one_plate(double s, const Vec3& point, double source_z, const Span& x, const Span& y, double z) {
  return plate_before_source(s, {point, kUp, kSide, kSide, source_z, x, y, z});
}

Case near_receiver(double s) { return one_plate(s, {0, 0, 0}, 1, {-0.25 / s, 0.3 / s}, {-0.2 / s, 0.35 / s}, 0.5 / s); }
Case near_source(double s) { return one_plate(s, {0.1, 0.2, -1}, 0, {-0.3, 0.4}, {-0.2, 0.5}, -0.5 / s); }

// Plates with the given profiles before a source at `source_z`.
struct Slat {
  ProfilePoint from, to;
};

Case slats(double s, const Vec3& point, double source_z, const std::vector<Slat>& profiles) {
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, source_z);
  const LevelView view(point, source_z);
  std::vector<Interval> shadows;
  for (const auto& [from, to] : profiles) {
    stage.add_slat(from, to, kWide);
    shadows.push_back(view.shadow(from, to));
  }
  return stage.finish(s, left_by_strips(kUp, view.shadow(kSide, kSide, source_z), std::move(shadows)));
}

Case contact_with_source(double s) { return slats(s, {0.1, 0.2, -1}, 0, {{{-0.45, 0}, {0.55, -0.5 / s}}}); }

Case crossing(double s) {
  const double t = 0.5 / s;
  return slats(s, {0, 0, -1}, 1, {{{-0.25, -0.25 * t}, {0.5, 0.5 * t}}, {{-0.375, 0.375 * t}, {0.5, -0.5 * t}}});
}

// A wall from the receiver's own plane up to half the height of the source: its shadow extends from the wall to
// infinity.
Case wall_beside(double s) {
  const double d = 0.25 / s;
  const Span x{-1, 1.3};
  const Vec3 point{0, 0.2, 0};
  Stage stage(point, kUp);
  stage.add_level_source(x, kSide, 1);
  stage.add_slat({d, 0}, {d, 0.5}, kWide);
  const LevelView view(point, 1);
  return stage.finish(s, left_by_strips(kUp, view.shadow(x, kSide, 1), {{view.along_x(d, 0.5), Rational(8)}}));
}

// Two plates leave a crack of width 2 d. A third plate stands in it, seen edge-on: the receiver is at the distance d
// from its plane.
Case edge_on(double s) {
  const double d = 0.25 / s;
  return slats(s, {0, 0.2, 0}, 1, {{{d, 0.25}, {d, 0.5}}, {{-1, 0.5}, {0, 0.5}}, {{2 * d, 0.5}, {1, 0.5}}});
}

// A bar along x, low at one end and high at the other, and its rotations by quarter turns: each bar lies over the next.
Case pinwheel(double s) {
  const double t = 0.25 / s;
  Stage stage({0.0625, 0.03125, -1}, kUp);
  stage.add_level_source(kSide, kSide, 1);
  std::vector<Vec3> bar = {{-0.5, 0.2, -t}, {0.5, 0.2, t}, {0.5, 0.3, t}, {-0.5, 0.3, -t}};
  for (int k = 0; k < 4; ++k) {
    stage.add_occluder(bar);
    for (Vec3& corner : bar) corner = {corner.y, -corner.x, corner.z};
  }
  return stage.finish(s);
}

// --- many occluders, shared edges, or edges through one point: the stiffness is their number ---

constexpr Vec3 kOrigin{0, 0, 0};

// The side n of a square of n × n.
int side_of(double count) { return static_cast<int>(std::lround(std::sqrt(count))); }

// Tile k of n across [-1/2, 1/2]. Neighbours abut exactly, since both round the same quotient.
Span tile(int k, int n) { return {static_cast<double>(k) / n - 0.5, static_cast<double>(k + 1) / n - 0.5}; }

template <class Keep>
Stage tile_stage(int n, const Keep& keep) {
  Stage stage(kOrigin, kUp);
  stage.add_level_source(kSide, kSide, 1);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (keep(i, j)) stage.add_level_occluder(tile(i, n), tile(j, n), 0.5);
    }
  }
  return stage;
}

Case tiles(double s) {
  return tile_stage(side_of(s), [](int, int) { return true; }).finish(s, ClosedForm(kUp));
}

Case tiles_one_missing(double s) {
  const int n = side_of(s), middle = n / 2;
  ClosedForm truth(kUp);
  truth.add(LevelView(kOrigin, 1).shadow(tile(middle, n), tile(middle, n), 0.5));
  return tile_stage(n, [&](int i, int j) { return i != middle || j != middle; }).finish(s, truth);
}

Case rings(double s) {
  const Vec3 point{0.0625, 0.03125, 0};
  const int n = static_cast<int>(s);
  const LevelView view(point, 1);
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, 1);
  ClosedForm truth(kUp);
  truth.add(view.shadow(kSide, kSide, 1));
  for (int k = 0; k < n; ++k) {
    const double inner = 0.4 * (2 * k + 1) / (2 * n), outer = 0.4 * (2 * k + 2) / (2 * n);
    const Span in{-inner, inner}, out{-outer, outer};
    stage.add_occluder_with_hole(Stage::level_ring(out, out, 0.5), Stage::level_ring(in, in, 0.5));
    truth.add(view.shadow(out, out, 0.5), -1);
    truth.add(view.shadow(in, in, 0.5));
  }
  return stage.finish(s, truth);
}

Case blinds(double s) {
  const Vec3 point{0.1, 0.05, 0};
  const int n = static_cast<int>(s);
  const double pitch = 1.2 / n;
  const LevelView view(point, 1);
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, 1);
  std::vector<Interval> shadows;
  for (int k = 0; k < n; ++k) {
    const double x = -0.6 + (k + 0.5) * pitch, half = 0.25 * pitch;
    const ProfilePoint from{x - half, 0.5 + half}, to{x + half, 0.5 - half};
    stage.add_slat(from, to, {-4, 4});
    shadows.push_back(view.shadow(from, to));
  }
  return stage.finish(s, left_by_strips(kUp, view.shadow(kSide, kSide, 1), std::move(shadows)));
}

// Triangles from the point (0, 0, 1/2) outwards, between directions that run counter-clockwise through one quadrant.
// Every other sector is hidden, and a quarter turn exchanges hidden and visible sectors. Requires an even number of
// directions, the last a quarter turn from the first.
struct Direction {
  double x = 1.0;
  double y = 0.0;
};

Case fan_of(double s, std::vector<Direction> quadrant) {
  Stage stage(kOrigin, kUp);
  stage.add_level_source(kSide, kSide, 1);
  for (std::size_t turn = 0; turn < 4; ++turn) {
    for (std::size_t k = turn % 2; k + 1 < quadrant.size(); k += 2) {
      const Direction &a = quadrant[k], &b = quadrant[k + 1];
      stage.add_occluder({{0, 0, 0.5}, {2 * b.x, 2 * b.y, 0.5}, {2 * a.x, 2 * a.y, 0.5}});
    }
    for (Direction& d : quadrant) d = {-d.y, d.x};
  }
  ClosedForm truth(kUp);
  truth.add(LevelView(kOrigin, 1).shadow(kSide, kSide, 1), Rational(1, 2));
  return stage.finish(s, truth);
}

Case fan(double s) {
  const int n = static_cast<int>(s);
  std::vector<Direction> quadrant;
  for (int k = 0; k < n; ++k) quadrant.push_back({1, static_cast<double>(k) / n});
  for (int k = n; k >= 0; --k) quadrant.push_back({static_cast<double>(k) / n, 1});
  quadrant.insert(quadrant.begin() + 1, {1, 0.5 / n});
  return fan_of(s, std::move(quadrant));
}

Case thin_fan(double s) { return fan_of(s, {{1, 0}, {1, 1 / s}, {0.5, 1}, {0, 1}}); }

// Plates that leave a polygon about as wide as 1/s between them: the lines of their edges almost meet in one point.
Case concurrent(double s) {
  constexpr int kSteps = 8;  // directions per half quadrant
  Stage stage({0.0625, 0.03125, 0}, kUp);
  stage.add_level_source(kSide, kSide, 1);
  for (int k = 0; k < kSteps; ++k) {
    Direction d{1, static_cast<double>(k) / kSteps};
    for (int turn = 0; turn < 4; ++turn) {
      const Direction n{d.y / s, -d.x / s};
      stage.add_occluder({{n.x + 4 * d.x, n.y + 4 * d.y, 0.5},
                          {n.x - 4 * d.x, n.y - 4 * d.y, 0.5},
                          {n.x + 4 * d.y, n.y - 4 * d.x, 0.5}});
      d = {-d.y, d.x};
    }
  }
  return stage.finish(s);
}

// --- one plate before a square, in numbers of every size: the result hardly changes ---

Span scaled(const Span& span, double factor) { return {span.low * factor, span.high * factor}; }
Span moved(const Span& span, double by) { return {span.low + by, span.high + by}; }

// Scales source and plate about the receiver, each by its own factor.
Case with_factors(double s, double source_factor, double plate_factor) {
  const Span side = scaled(kSide, source_factor), x = scaled({-0.25, 0.3}, plate_factor),
             y = scaled({-0.2, 0.35}, plate_factor);
  return plate_before_source(s, {kOrigin, kUp, side, side, source_factor, x, y, 0.5 * plate_factor});
}

Case tiny(double s) { return with_factors(s, 1 / s, 1 / s); }
Case huge(double s) { return with_factors(s, s, s); }
Case mixed(double s) { return with_factors(s, s, 1 / s); }

// Multiples of 1/64, translated by a power of two: every coordinate of the translated scene is exact.
Case moved_away(double s) {
  const Span side{-1, 1}, plate{-0.265625, 0.296875};
  return plate_before_source(
      s, {{s, -s, s}, kUp, moved(side, s), moved(side, -s), 1 + s, moved(plate, s), moved(plate, -s), 0.5 + s});
}

// All normals have the direction (1, 2, 3); the last of them are denormal numbers.
Case short_normal(double s) {
  const double unit = std::ldexp(1.0, -74) / s;
  const Vec3 normal{unit, 2 * unit, 3 * unit};
  return plate_before_source(s, {{0, 0, 0}, normal, {0, 1}, {0, 1}, 1, {0.15, 0.3}, {0.05, 0.2}, 0.5});
}

// --- stiffnesses ---

// 1, 10, 100, ... to 10^16, then every 20th decade, and the last.
std::vector<double> decades(int last) {
  constexpr int kEveryOneTo = 16, kStep = 20;
  const auto power = [](int exponent) { return std::stod("1e" + std::to_string(exponent)); };
  std::vector<double> list;
  for (int e = 0; e < last; e += e < kEveryOneTo ? 1 : kStep) list.push_back(power(e));
  list.push_back(power(last));
  return list;
}

// 1, 2, 4, ... 2^last; every step-th of them.
std::vector<double> octaves(int last, int step = 1) {
  std::vector<double> list;
  for (int e = 0; e <= last; e += step) list.push_back(std::ldexp(1.0, e));
  return list;
}

}  // namespace

const std::vector<Family>& all_families() {
  static const std::vector<Family> all = {
      {"approach-interior", "Receiver approaching the inside of the source", "1 / distance",
       "The receiver approaches a square of side 2 from below, away from its centre. F tends to 1: every edge "
       "subtends almost 180°.",
       decades(300), approach_interior},
      {"approach-edge", "Receiver approaching an edge of the source", "1 / distance",
       "The receiver approaches a point of an edge from right below. F tends to 1/2. The edge subtends almost 180°, "
       "where a × b vanishes compared with a · b.",
       decades(300), approach_edge},
      {"approach-vertex", "Receiver approaching a vertex of the source", "1 / distance",
       "The receiver approaches a corner from right below. F tends to 1/4. In the limit, two edges end at the "
       "receiver.",
       decades(300), approach_vertex},
      {"foot-of-wall", "Receiver at the foot of a wall", "1 / distance",
       "The receiver approaches a wall that stands on its surface at a right angle. F tends to 1/2. A program that "
       "drops perpendicular pairs returns 0.",
       decades(300), foot_of_wall},
      {"shrink", "Source shrinking", "1 / side",
       "A square off the receiver's axis, at (100, 37, 50), shrinks. The terms of its edges fall with its side, but F "
       "falls with the square of the side, to 10⁻²⁸⁵. The terms cancel almost completely.",
       decades(140), shrink},
      {"recede", "Source receding", "distance / side, over 118",
       "A unit square off the receiver's axis recedes. Differences of its coordinates are lost in rounding: a program "
       "computes zero or noise.",
       decades(140), recede},
      {"sliver", "Sliver as source", "aspect ratio, over 1.4",
       "A rectangle of length 1.4 becomes thinner. Its two long edges almost coincide and their terms cancel.",
       decades(300), sliver},
      {"horizon-grazed", "Source hardly above the horizon", "1 / height above the horizon",
       "A wall crosses the receiver's horizon (the plane of its surface), and less and less of the wall rises above "
       "it. F falls with the square of that height. Without clipping at the horizon, Eq. (4) returns the part above "
       "minus the part below; the printed listing drops the pair and returns 0.",
       decades(150), horizon_grazed},
      {"horizon-ulp", "Source above the horizon by an ulp", "1 / height above the horizon",
       "The same with the receiver at height 1. The last wall rises above the horizon by one unit in the last place "
       "of its coordinates.",
       octaves(52), horizon_ulp},
      {"horizon-tilted", "Horizon leaving a strip of the source", "1 / width left",
       "The receiver turns away until only a strip of the square is above its horizon, down to a width of 2⁻⁵². Both "
       "the strip and the cosine at the receiver vanish.",
       octaves(52), horizon_tilted},
      {"crack", "Crack between two occluders", "1 / width",
       "Two plates hide everything except a crack. F is proportional to its width, down to 10⁻³⁰⁰. Soon no shadow ray "
       "hits it, and after rounding its two sides coincide.",
       decades(300), crack},
      {"crack-ulp", "Crack of an ulp", "1 / width",
       "The same crack at x = 1/4, where the narrowest crack that doubles can represent is 2⁻⁵⁴ wide.", octaves(54, 2),
       crack_ulp},
      {"overlap", "Overlap of two occluders", "1 / width",
       "The two plates overlap, down to one unit in the last place. F is exactly 0; errors are relative to the "
       "unoccluded form factor.",
       octaves(54, 2), overlap},
      {"near-receiver", "Occluder approaching the receiver", "1 / distance, over 2",
       "A plate approaches the receiver and shrinks, so that its shadow stays the same. Coordinates of 10⁻³⁰⁰ are as "
       "important as those of order 1.",
       decades(300), near_receiver},
      {"near-source", "Occluder approaching the source", "1 / distance, over 2",
       "A plate lies almost on the source. A plate exactly on the source hides nothing.", decades(300), near_source},
      {"edge-on", "Occluder seen edge on", "1 / distance of its plane from the receiver, over 4",
       "A third plate stands in the crack between two plates. Its plane almost contains the receiver. The crack and "
       "the shadow of the third plate are as thin as the distance of the receiver from that plane.",
       decades(300), edge_on},
      {"wall-beside", "Wall beside the receiver", "1 / distance of its plane from the receiver, over 4",
       "A wall rises from the receiver's own plane. In the limit it hides half of the source; if its plane contains "
       "the receiver, it hides nothing.",
       decades(300), wall_beside},
      {"contact-with-source", "Occluder nearly in the plane of the source", "1 / slope, over 2",
       "A plate touches the source along a line and rises from it at a vanishing slope. In the source's plane, it "
       "would hide nothing.",
       decades(300), contact_with_source},
      {"crossing", "Occluders that cross", "1 / slope, over 2",
       "Two plates cross each other at a vanishing angle. Their shadows overlap.", decades(300), crossing},
      {"pinwheel", "Occluders that overlap in a cycle", "1 / slope, over 2",
       "Four bars, each in front of the next, so that no order from front to back exists.", decades(300), pinwheel,
       Evidence::kCertified},
      {"tiles",
       "Tiles that cover the source exactly",
       "number of tiles",
       "n × n abutting squares; the outermost edges fall exactly on the source's. F is exactly 0; errors are relative "
       "to the unoccluded form factor.",
       {1, 4, 16, 64, 256, 1024, 4096},
       tiles},
      {"tiles-one-missing",
       "Tiles at rounded corners, one missing",
       "number of tiles",
       "n × n squares with the middle one missing. Their corners are multiples of 1 / odd number, rounded to doubles. "
       "Only the gap is visible.",
       {1, 9, 25, 81, 289, 1089, 4225},
       tiles_one_missing},
      {"rings",
       "Nested rings",
       "number of rings",
       "Nested square rings (faces with holes). The gaps between them are as wide as the rings.",
       {1, 3, 10, 30, 100, 300, 1000},
       rings},
      {"blinds",
       "Venetian blind",
       "number of slats",
       "Tilted slats. From ten slats on, about half of the source is visible.",
       {1, 10, 30, 100, 300, 1000, 3000, 10000},
       blinds},
      {"fan",
       "Edges meeting at a point",
       "(edges - 4) / 8",
       "Triangles with one common corner hide every second sector around it. A quarter turn exchanges hidden and "
       "visible sectors, so F is half of the unoccluded form factor.",
       {1, 3, 10, 30, 100, 300},
       fan,
       Evidence::kSymmetry},
      {"thin-fan", "Edges that meet at a vanishing angle", "1 / angle",
       "The same with four sectors that become thinner and thinner.", decades(300), thin_fan, Evidence::kSymmetry},
      {"concurrent", "Edges that almost meet", "1 / distance from the common point",
       "32 plates whose edges pass a point at a vanishing distance leave a polygon of that size.", octaves(48, 2),
       concurrent, Evidence::kCertified},
      {"tiny", "Everything tiny", "1 / size",
       "All coordinates are scaled down. Squares of lengths underflow below 10⁻¹⁵⁴; |a × b|², a fourth power, "
       "underflows below about 10⁻⁸⁰.",
       decades(300), tiny},
      {"huge", "Everything huge", "size",
       "All coordinates are scaled up. Squares of lengths overflow above 10¹⁵⁴, |a × b|² above 10⁷⁷.", decades(300),
       huge},
      {"mixed-scales", "Tiny and huge at once", "size of the source, and 1 / size of the occluder",
       "The source is scaled up and the plate in front of it is scaled down: up to 10³⁰⁰ and 10⁻³⁰⁰ in one scene.",
       decades(300), mixed},
      {"moved-away", "Everything far from the origin", "distance from the origin",
       "The scene is moved by a power of two. Its coordinates remain exact, and F stays the same to the last bit. Eq. "
       "(4) is not affected; shadow rays hit other points.",
       octaves(46, 2), moved_away},
      {"short-normal", "Denormal normal", "1 / length, over 5·10²¹",
       "The receiver's normal is not a unit vector and becomes shorter, down to denormal numbers. Its direction stays "
       "the same.",
       octaves(1000, 40), short_normal},
  };
  return all;
}

}  // namespace exactff::stress
