// Four at a time: whatever the other lanes hold, a number, a line or a piece has the bits that it has alone.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "contour/quick_arithmetic.h"
#include "contour/quick_contour.h"
#include "generate/random.h"
#include "support/random_scenes.h"
#include "unit/solver/quick_contour_support.h"

namespace exactff::contour {
namespace {

using namespace kernel::double_double;
using generate::Random;

// --- Numbers and angles ---

bool same(double x, double y) {
  return std::isnan(x) ? std::isnan(y) : std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
}

// Compares the results for four lanes with the results for one.
class Lanes : public ::testing::Test {
 protected:
  static constexpr std::size_t kLanes = 4;

  // Operands of every kind: ordinary, at the ends of the range, none.
  static double number(Random& random) {
    constexpr std::array kHostile = {0.0,     -0.0,      5e-324,    -5e-324,    0x1p-1022, 0x1.8p-1030,
                                     0x1p900, -0x1p1023, kInfinity, -kInfinity, 0x1p-600,  1.0};
    if (random.one_in(12)) return std::nan("");
    if (random.one_in(3)) return kHostile[random.below(kHostile.size())];
    return random.between(-1, 1) * std::exp2(random.between(-30, 30));
  }
  static Bounded bounded_number(Random& random) {
    const DoubleDouble x = two_sum(number(random), number(random) * 0x1p-60);
    const double error = random.one_in(3) ? 0.0 : std::abs(number(random)) * 0x1p-70;
    return {x.hi, random.one_in(9) ? number(random) : x.lo, random.one_in(9) ? kDeclined.error : error};
  }

  template <class One, class Make>
  static std::array<One, kLanes> four_of(Random& random, Make make) {
    return {make(random), make(random), make(random), make(random)};
  }
  static Four pack(const std::array<double, kLanes>& x) { return Four{x[0], x[1], x[2], x[3]}; }
  template <class T>
  static Four pack(const std::array<T, kLanes>& x, double T::*part) {
    return Four{x[0].*part, x[1].*part, x[2].*part, x[3].*part};
  }
  static FourBounded pack(const std::array<Bounded, kLanes>& x) {
    return {pack(x, &Bounded::hi), pack(x, &Bounded::lo), pack(x, &Bounded::error)};
  }

  static void expect_lane(const Four& four, std::size_t k, double one) {
    EXPECT_TRUE(same(four[k], one)) << "lane " << k << ": " << four[k] << " for " << one;
  }
  static void expect_lane(const FourBounded& four, std::size_t k, const Bounded& one) {
    expect_lane(four.hi, k, one.hi);
    expect_lane(four.lo, k, one.lo);
    expect_lane(four.error, k, one.error);
  }

  // `function` of four lanes, and of the number in each lane.
  template <class Function, class... Ones>
  static void expect_same_of(Function function, const std::array<Ones, kLanes>&... ones) {
    const auto four = function(pack(ones)...);
    for (std::size_t k = 0; k < kLanes; ++k) expect_lane(four, k, function(ones[k]...));
  }

  template <class Test>
  static void for_many_seeds(Test test) {
    for (std::uint64_t seed = 1; seed <= validation::scaled_count(500) && !HasFailure(); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(validation::seed_of(seed));
      test(random);
    }
  }
};

TEST_F(Lanes, ArithmeticIsThatOfOne) {
  for_many_seeds([](Random& random) {
    const auto t = four_of<double>(random, number);
    const auto a = four_of<Bounded>(random, bounded_number), b = four_of<Bounded>(random, bounded_number);
    const auto c = four_of<Bounded>(random, bounded_number), d = four_of<Bounded>(random, bounded_number);
    expect_same_of([](const auto& x, const auto& y) { return x + y; }, a, b);
    expect_same_of([](const auto& x, const auto& y) { return x - y; }, a, b);
    expect_same_of([](const auto& x, const auto& y) { return x * y; }, a, b);
    expect_same_of([](const auto& x, const auto& y) { return x * y; }, t, b);
    expect_same_of([](const auto& x, const auto& y) { return x / y; }, a, b);
    expect_same_of([](const auto& x) { return square_root(x); }, a);
    expect_same_of([](const auto& x) { return absolute(x); }, a);
    expect_same_of(
        [](const auto& w, const auto& x, const auto& y, const auto& z) { return sum_of_products(w, x, y, z); }, a, b, c,
        d);
  });
}

// Both sides of every step of the table and of every octant; each lane has a different step and octant.
TEST_F(Lanes, AnglesOfEveryStepAreThoseOfOneAndEncloseTheTruth) {
  const auto angle = [](const auto& sine, const auto& cosine) { return atan2(sine, cosine, angle_constants()); };
  const auto point = [](int octant, double ratio) -> std::pair<Bounded, Bounded> {
    const double x = octant & 1 ? -1.0 : 1.0, y = octant & 2 ? -ratio : ratio;
    return octant & 4 ? std::pair<Bounded, Bounded>{{y}, {x}} : std::pair<Bounded, Bounded>{{x}, {y}};
  };
  for (int k = 0; k <= 2 * kAtanSteps; ++k) {
    const double step = static_cast<double>(k) / (2 * kAtanSteps);  // between two steps for odd k
    for (int octant = 0; octant < 8; ++octant) {
      std::array<Bounded, kLanes> s, c;
      for (int i = 0; i < 4; ++i) {
        const double ratio = i == 0   ? step
                             : i == 1 ? std::nextafter(step, -1)
                             : i == 2 ? std::nextafter(step, 2)
                                      : static_cast<double>((37 * k) % 509) / 509;
        std::tie(s[static_cast<std::size_t>(i)], c[static_cast<std::size_t>(i)]) = point((octant + i) % 8, ratio);
      }
      expect_same_of(angle, s, c);
      const FourBounded found = angle(pack(s), pack(c));
      for (std::size_t i = 0; i < kLanes; ++i) {
        if (s[i].hi == 0.0) continue;  // an axis; declined if it is the negative one
        const Enclosure truth = true_angle(exactly(s[i].hi, 0), exactly(c[i].hi, 0));
        ASSERT_TRUE(holds({found.hi[i], found.lo[i], found.error[i]}, truth)) << k << ' ' << octant << ' ' << i;
        ASSERT_LT(found.error[i], 0x1p-99 * std::abs(found.hi[i]) + 8 * kUnderflow) << k << ' ' << octant << ' ' << i;
      }
    }
  }
}

// --- Lines and pieces ---

bool same(const Vector& p, const Vector& q) {
  bool result = same(p.norm, q.norm) && same(p.error, q.error);
  for (std::size_t i = 0; i < 3; ++i) result = result && same(p.c[i].hi, q.c[i].hi) && same(p.c[i].lo, q.c[i].lo);
  return result;
}
bool same(const Bounded& x, const Bounded& y) { return same(x.hi, y.hi) && same(x.lo, y.lo) && same(x.error, y.error); }
bool same(const QuickLine& f, const QuickLine& g) {
  return f.reversed == g.reversed && same(f.a, g.a) && same(f.b, g.b) && same(f.along, g.along) &&
         same(f.cross, g.cross) && same(f.size, g.size) && same(f.weight, g.weight);
}

// Corners that are declined for every possible reason, between other corners.
std::vector<QuickCorner> mixed_corners(Random& random) {
  const double nan = std::nan("");
  std::vector<QuickCorner> corners{{{nan, nan, nan}, {}, 0}, {{kInfinity, 1, 0}, {}, 0},
                                   {{0, 0, 0}, {}, 0},       {{5e-324, 5e-324, 0}, {}, 0},
                                   {{0x1p300, 1, 1}, {}, 0}, {{1, 1, 1}, {}, kInfinity}};
  for (int i = 0; i < 6; ++i) corners.push_back(quick_corner(random_vector(random, 1), random_vector(random, 1), 0));
  return corners;
}

TEST(QuickContourInCompany, ALineIsWhatItIsAlone) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(validation::seed_of(seed));
    const QuickContour contour(random_vector(random, 1));
    const std::vector<QuickCorner> corners = mixed_corners(random);
    const auto any = [&] { return static_cast<std::uint32_t>(random.below(corners.size())); };
    for (std::size_t count = 0; count <= 9; ++count) {
      std::vector<QuickEdge> edges;
      for (std::size_t i = 0; i < count; ++i) edges.push_back({any(), any()});
      std::vector<QuickLine> lines(count + 1);  // one too many: it stays as it is
      contour.make_lines(corners, edges, lines);
      EXPECT_TRUE(same(lines[count], QuickLine()));
      for (std::size_t i = 0; i < count; ++i) {
        std::vector<QuickLine> alone(1);
        contour.make_lines(corners, std::span(edges).subspan(i, 1), alone);
        EXPECT_TRUE(same(lines[i], alone[0])) << seed << ' ' << i << " of " << count;
      }
    }
  }
}

// A declined piece invalidates its own sum in any position; lanes that repeat a piece invalidate none.
TEST(QuickContourInCompany, EveryNumberOfPiecesIsSummedWhole) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(validation::seed_of(seed));
    Both both = cut_triangle(random, 1);
    const std::vector<Part> loop = both.pieces;
    both.pieces.clear();
    for (std::size_t count = 1; count <= 13; ++count) {
      both.pieces.push_back(loop[count % loop.size()]);
      const QuickContour::Value value = both.quick();
      ASSERT_TRUE(answers(value));
      EXPECT_LT(value.error, 0x1p-94);
      EXPECT_TRUE(enclosure_of(value).contains(both.ball())) << seed << ' ' << count;
      Both spoilt = both;
      spoilt.pieces[random.below(count)] = {0, 0, kA, kB};
      EXPECT_FALSE(answers(spoilt.quick())) << seed << ' ' << count;
    }
  }
}

}  // namespace
}  // namespace exactff::contour
