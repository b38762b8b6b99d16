// How fast point factors change, judged by the exact solver.
#include <gmpxx.h>

#include "kernel/ball.h"
#include "kernel/vec.h"
#include "support/test.h"
#include "unit/solver/factor_at.h"
#include "view_factors/cell.h"
#include "view_factors/exact_scene.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"

namespace exactff::view_factors {
namespace {

using kernel::Rational;
using validation::scaled_count;
using validation::seed_of;
using Exact3 = std::array<Rational, 3>;

// Of a source seen from points of a floor.
class Seen {
 public:
  explicit Seen(const Scene& scene)
      : exact_(scene),
        receiver_(parts_of(exact_, scene.select("floor")).front()),
        source_(scene, scene.select("source")),
        sight_(sight_of(exact_, SeenParts(exact_).seen_from(receiver_).occluders, receiver_,
                        parts_of(exact_, scene.select("source")).front())) {}

  [[nodiscard]] bool sees() const { return sight_.has_value(); }
  [[nodiscard]] const Part& receiver() const { return receiver_; }
  [[nodiscard]] SlopeBound bound() const { return SlopeBound(*sight_); }
  // All in the scene's unit.
  [[nodiscard]] double slope(const Vec3& at, double radius) const {
    const double unit = std::ldexp(1.0, static_cast<int>(exact_.units.exponent + exact_.units.shift));
    return bound().about(kernel::scaled(at, 1.0 / unit), radius / unit) / unit;
  }
  [[nodiscard]] double factor(const Vec3& at) const {
    return factor_at(exact_, at, sight_->receiver, receiver_.face, source_);
  }

 private:
  ExactScene exact_;
  Part receiver_;
  ExactSource source_;
  std::optional<Sight> sight_;
};

// Points of a small tile of the part, and its middle first.
std::vector<Vec3> points_of_tile(const Part& part, Random& random, double size) {
  const std::vector<Point>& corners = part.corners;
  const double s = random.unit() * (1.0 - size), t = random.unit() * (1.0 - size);
  const auto at = [&](double along, double up) {
    const Vec3& from = corners[0].at;
    return kernel::along(kernel::along(from, kernel::difference(corners[1].at, from), s + size * along),
                         kernel::difference(corners.back().at, from), t + size * up);
  };
  std::vector<Vec3> points{at(0.5, 0.5)};
  for (int i = 0; i < 6; ++i) points.push_back(at(random.unit(), random.unit()));
  return points;
}

// Faces of all kinds stand in between.
Scene scene_of(Random& random, std::uint64_t seed) {
  const std::string model = random.one_in(2) ? "soup" : random.one_in(2) ? "lattice" : "karkanis";
  return models::make_scene(model + ":n=" + std::to_string(random.integer(1, 6)) +
                            ",cover=1,seed=" + std::to_string(seed % 1000000));
}

struct Judged {
  int finite = 0, tight = 0;
};

// On tiles from large to tiny.
template <class Factor>
void judge(const SlopeBound& bound, const Part& receiver, const Factor& factor, Random& random, Judged& judged) {
  for (const double size : {0.25, 0.03, 0.004}) {
    const std::vector<Vec3> points = points_of_tile(receiver, random, size);
    double radius = 0.0;
    for (const Vec3& point : points) radius = std::max(radius, kernel::distance(points[0], point));
    const double slope = bound.about(points[0], radius);
    if (!(slope < HUGE_VAL)) continue;
    ++judged.finite;
    double steepest = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const double distance = kernel::distance(points[i], points[i + 1]);
      const double change = std::abs(factor(points[i]) - factor(points[i + 1]));
      EXPECT_LE(change, slope * distance + 0x1p-40) << size;
      steepest = std::max(steepest, change / distance);
    }
    judged.tight += steepest > 0.1 * slope ? 1 : 0;
  }
}

TEST(SlopeBound, IsAtLeastEveryChangeOfThePointFactor) {
  Judged judged;
  for (std::uint64_t s = 0; s < scaled_count(120); ++s) {
    SCOPED_TRACE(s);
    Random random(seed_of(s));
    const Scene scene = scene_of(random, seed_of(s));
    const Seen seen(scene);
    if (!seen.sees()) continue;
    const auto factor = [&](const Vec3& at) { return seen.factor(at); };
    judge(seen.bound(), seen.receiver(), factor, random, judged);
  }
  EXPECT_GT(judged.finite, 100);
  EXPECT_GT(judged.tight, judged.finite / 20);
}

// From all faces, since those of the model's occluders see one another.
TEST(SlopeBound, OfWhatIsOpenIsAtLeastEveryChangeInTheView) {
  Judged judged;
  for (std::uint64_t s = 0; s < scaled_count(40); ++s) {
    SCOPED_TRACE(s);
    Random random(seed_of(s));
    const Scene scene = scene_of(random, seed_of(s));
    const ExactScene exact(scene);
    const Selection patch{static_cast<PatchId>(random.below(scene.patches().size())), {}, scene.id()};
    const std::vector<Part> parts = parts_of(exact, patch);
    const Part& receiver = parts[random.below(parts.size())];
    const Sight sight = sight_of_open(exact, SeenParts(exact).seen_from(receiver).occluders, receiver);
    const auto open = [&](const Vec3& at) {
      return view(scene, receiver_at(exact, at, sight.receiver, receiver.face)).open.value;
    };
    judge(SlopeBound(sight), receiver, open, random, judged);
  }
  EXPECT_GT(judged.finite, 50);
  EXPECT_GT(judged.tight, judged.finite / 20);
}

// A long roof of which nothing but the ridge can be seen before the source: from beside, it is an outline.
TEST(SlopeOfSquares, CountsRidgesThatAreOutlines) {
  PlainScene plain;
  add(plain, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  add(plain, "source", {{0.375, 0.625, 1}, {0.625, 0.625, 1}, {0.625, 0.375, 1}, {0.375, 0.375, 1}});
  const Vec3 beside{0.3125, 0.5, 0};
  const double open = Seen(generate::build(plain)).slope(beside, 0.001);
  plain.vertices.insert(plain.vertices.end(), {{0.375, -2, 0.125},
                                               {0.375, 3, 0.125},
                                               {0.40625, 3, 0.5},
                                               {0.40625, -2, 0.5},
                                               {0.4375, 3, 0.125},
                                               {0.4375, -2, 0.125}});
  plain.patch("roof").faces = {{{{8, 9, 10, 11}}}, {{{11, 10, 12, 13}}}};
  EXPECT_GT(Seen(generate::build(plain)).slope(beside, 0.001), open + 0.05);
}

// --- the roundings of the bound on event cells (view_factors/cell.h), against rationals ---

constexpr double kOfNormal = 1.003;  // the error of a normal, by the header
constexpr long kBits = 200;

Exact3 operator-(const Exact3& a, const Exact3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Exact3 operator+(const Exact3& a, const Exact3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Exact3 operator*(const Rational& k, const Exact3& a) { return {k * a[0], k * a[1], k * a[2]}; }
Exact3 exact_cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational exact_dot(const Exact3& a, const Exact3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double exact_length(const Exact3& a) {
  return kernel::nearest_to_midpoint(sqrt(kernel::to_ball(exact_dot(a, a), kBits)));  // of the nearest double
}

Exact3 rational_place(const Point& point) {
  Exact3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = Rational(point.exact[i], point.exact[3]);
    result[i].canonicalize();
  }
  return result;
}

// Three lines and a cell whose coordinates are rational numbers, not doubles.
class Event {
 public:
  Point point_at(const Vec3& near) {
    const double whole = std::ldexp(1.0, 60);
    const Integer w = Integer(whole) + 2 * random_.integer(1, 1 << 29) + 1;
    const auto scaled = [&](double x) { return Integer(Rational(Rational(x) * Rational(w))); };
    return make_point({scaled(near.x), scaled(near.y), scaled(near.z), w}, units_);
  }
  void add_line(const Vec3& a, const Vec3& b) {
    std::array<PointId, 3> ids{};
    for (std::size_t i = 0; i < 2; ++i) ids[i] = points_.add(point_at(i == 0 ? a : b));
    ids[2] = points_.add(point_at({0.0, 0.0, 0.0}));
    triple_[lines_++] = points_.ring({ids[0], ids[1], ids[2]}).front().line;
  }
  void add_corner(const Vec3& at) { cell_.corners.push_back(point_at(at)); }

  [[nodiscard]] Vec3 centre() const {
    Vec3 sum;
    const double share = 1.0 / static_cast<double>(cell_.corners.size());
    for (const Point& c : cell_.corners) sum = {sum.x + share * c.at.x, sum.y + share * c.at.y, sum.z + share * c.at.z};
    return sum;
  }
  [[nodiscard]] TriangleBounds bounds() const { return triangle_bounds(points_, cell_, centre(), triple_); }
  [[nodiscard]] double bound() const { return event_bound(points_, cell_, centre(), {triple_}); }

  [[nodiscard]] Exact3 normal(std::size_t i, const Exact3& x) const {
    const Line& line = points_.line(triple_[i]);
    return exact_cross(rational_place(points_[line.a]) - x, rational_place(points_[line.b]) - x);
  }
  [[nodiscard]] Exact3 crossing(std::size_t i, const Exact3& x) const {
    return exact_cross(normal(i, x), normal((i + 1) % 3, x));
  }
  [[nodiscard]] Rational order(const Exact3& x) const { return exact_dot(normal(0, x), crossing(1, x)); }
  // Corners, and the middles between them.
  [[nodiscard]] std::vector<Exact3> places() const {
    std::vector<Exact3> result;
    for (std::size_t i = 0; i < cell_.corners.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        result.push_back(Rational(1, 2) * (rational_place(cell_.corners[i]) + rational_place(cell_.corners[j])));
      }
    }
    return result;
  }
  // The bound of the header at x: L^2 / pi^2. Nothing where a sine is not below 1.
  [[nodiscard]] std::optional<double> true_bound(const Exact3& x) const {
    const auto ball_length = [](const Exact3& a) { return sqrt(kernel::to_ball(exact_dot(a, a), kBits)); };
    Ball sum(kBits);
    for (std::size_t i = 0; i < 3; ++i) {
      const Ball sides = ball_length(crossing(i, x)) * ball_length(crossing((i + 2) % 3, x));
      const Ball sine = ball_length(normal(i, x)) * kernel::to_ball(Rational(abs(order(x))), kBits) / sides;
      if (!(kernel::nearest_to_midpoint(sine) < 1.0)) return std::nullopt;
      sum = sum + atan2(sine, sqrt(kernel::to_ball(1.0, kBits) - sine * sine));
    }
    const Ball share = sum / kernel::pi(kBits);
    return kernel::nearest_to_midpoint(share * share);
  }

 private:
  Random random_{7};
  Units units_{};  // coordinates are the integers' quotients
  Points points_{units_};
  Cell cell_;
  CrossingTriple triple_{};
  std::size_t lines_ = 0;
};

Vec3 somewhere(Random& random) {
  return {random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0)};
}
// At a corner of the cube that holds all coordinates, nearly: where the roundings are largest.
Vec3 at_corner(Random& random) {
  const auto side = [&] { return random.one_in(2) ? 1.0 - 0x1p-50 : 0x1p-50 - 1.0; };
  return {side(), side(), side()};
}
Vec3 moved(const Vec3& a, const Vec3& by, double factor) {
  return {a.x + factor * by.x, a.y + factor * by.y, a.z + factor * by.z};
}

// Lines anywhere, or at the limits of the coordinates, and a cell of up to four corners as small as `size`.
Event some_event(Random& random, double size, bool at_limits) {
  Event event;
  const auto end = [&] { return at_limits && !random.one_in(4) ? at_corner(random) : somewhere(random); };
  for (int line = 0; line < 3; ++line) event.add_line(end(), end());
  const Vec3 middle = moved({}, somewhere(random), 1.0 - size);
  const int corners = random.integer(1, 4);
  for (int k = 0; k < corners; ++k) event.add_corner(moved(middle, somewhere(random), size));
  return event;
}

bool has_crossings(const TriangleBounds& bounds) {
  return std::ranges::all_of(bounds.cross, [](double cross) { return cross > 0.0; });
}

// The line passes so close by the cell that its normal is little more than a rounding, and the crossings with the
// others are just known to differ from 0.
TEST(EventBound, MarginCoversTheShortestNormals) {
  Random random(4);
  int known = 0;
  double worst = 0.0;
  for (int round = 0; round < 3000; ++round) {
    const Vec3 x = at_corner(random), to = at_corner(random);
    Event event;
    const Vec3 along{to.x - x.x, to.y - x.y, to.z - x.z};
    const double off = std::ldexp(1.0, -random.integer(33, 36));
    event.add_line(moved(moved(x, along, 0.3), somewhere(random), off), to);
    for (int line = 0; line < 2; ++line) event.add_line(at_corner(random), at_corner(random));
    event.add_corner(x);
    const TriangleBounds bounds = event.bounds();
    if (!has_crossings(bounds)) continue;
    ++known;
    worst = std::max(worst, exact_length(event.normal(0, event.places().front())) / bounds.normal[0]);
  }
  EXPECT_GE(known, 20);
  EXPECT_GT(worst, 1.0);  // the length's own margin is too small here
  EXPECT_LE(worst, kOfNormal);
}

TEST(EventBound, TimesItsMarginIsNotBelowTheTruth) {
  Random random(5);
  int known = 0, tight = 0;
  for (int round = 0; round < 500; ++round) {
    const Event event = some_event(random, std::ldexp(1.0, -random.integer(2, 50)), random.one_in(3));
    const double bound = event.bound();
    if (!has_crossings(event.bounds()) || !(bound < HUGE_VAL)) continue;
    ++known;
    double largest = 0.0;
    for (const Exact3& x : event.places()) {
      const std::optional<double> truth = event.true_bound(x);
      ASSERT_TRUE(truth) << round;
      ASSERT_LE(*truth, kEventMargin * bound) << round;
      largest = std::max(largest, *truth);
    }
    tight += bound <= kEventMargin * largest ? 1 : 0;
  }
  EXPECT_GE(known, 20);
  EXPECT_GE(tight, 10);  // with a margin below 1 / kEventMargin this test would fail
}

}  // namespace
}  // namespace exactff::view_factors
