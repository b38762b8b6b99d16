// The roundings of the bound on event cells (view_factors/cell.h), against the same quantities in rational
// numbers and balls.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "generate/random.h"
#include "kernel/ball.h"
#include "view_factors/cell.h"

namespace exactff::view_factors {
namespace {

using generate::Random;
using kernel::Rational;
using Exact3 = std::array<Rational, 3>;

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

TEST(EventBound, BoundsHoldOnTheWholeCell) {
  Random random(3);
  int known = 0;
  for (int round = 0; round < 100; ++round) {
    const Event event = some_event(random, std::ldexp(1.0, -random.integer(0, 20)), random.one_in(3));
    const TriangleBounds bounds = event.bounds();
    known += has_crossings(bounds) ? 1 : 0;
    for (const Exact3& x : event.places()) {
      ASSERT_LE(kernel::nearest_double(Rational(abs(event.order(x)))), bounds.order) << round;
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_LE(bounds.cross[i], exact_length(event.crossing(i, x))) << round;
        const double normal = has_crossings(bounds) ? exact_length(event.normal(i, x)) : 0.0;
        ASSERT_LE(normal, kOfNormal * bounds.normal[i]) << round;
      }
    }
  }
  EXPECT_GE(known, 20);
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
