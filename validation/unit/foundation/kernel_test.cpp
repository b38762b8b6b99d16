// Exact numbers, filters and balls.
#include <thread>

#include "kernel/ball.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"
#include "kernel/split_mix.h"
#include "support/test.h"

namespace exactff::kernel {
namespace {

constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

Rational power_of_two(long exponent) { return times_power_of_two(1, exponent); }

// Any finite double, all exponents alike.
double any_double(Random& random) {
  const double fraction = random.between(1.0, 2.0) * (random.one_in(2) ? -1.0 : 1.0);
  return std::ldexp(fraction, random.integer(-1074, 1023));
}

Integer any_integer(Random& random, int bits) {
  Integer result(1);
  for (int i = 0; i < bits; ++i) result = 2 * result + random.integer(0, 1);
  return result;
}

TEST(Numbers, NearestDoubleOfAQuotientIsNoFartherThanItsNeighbours) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const Integer n = any_integer(random, random.integer(0, 150)) * (random.one_in(2) ? -1 : 1);
    const Integer d = random.one_in(3) ? Integer(1) << static_cast<unsigned>(random.integer(0, 150))
                                       : any_integer(random, random.integer(0, 150));
    const long exponent = random.one_in(2) ? random.integer(-60, 60) : random.integer(-1200, 800);
    const double nearest = nearest_double(n, d, exponent);
    ASSERT_EQ(nearest_double(n, exponent), nearest_double(n, Integer(1), exponent)) << n << " 2^" << exponent;
    Rational exact(n, d);
    exact.canonicalize();
    exact = times_power_of_two(exact, exponent);
    const Rational error = abs(exact - to_rational(nearest));
    for (const double end : {-HUGE_VAL, HUGE_VAL}) {
      const double neighbour = std::nextafter(nearest, end);
      const Rational other = abs(exact - to_rational(neighbour));
      const bool is_even = decompose(nearest).exponent > decompose(neighbour).exponent;  // more zeros at the end
      ASSERT_TRUE(error < other || (error == other && is_even)) << n << " / " << d << " 2^" << exponent;
    }
  }
}

Vec3 any_vec(Random& random) { return {any_double(random), any_double(random), any_double(random)}; }

TEST(ExactVec, DifferenceIsExactAtAnyScale) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = any_vec(random);
    const Vec3 q = random.one_in(4) ? p : any_vec(random);
    const ScaledVec3 d = exact_difference(p, q);
    const Rational unit = power_of_two(d.exponent);
    ASSERT_EQ(d.v.x * unit, to_rational(p.x) - to_rational(q.x));
    ASSERT_EQ(d.v.y * unit, to_rational(p.y) - to_rational(q.y));
    ASSERT_EQ(d.v.z * unit, to_rational(p.z) - to_rational(q.z));
  }
}

// Vectors whose dot product is 0 or nearly 0, at scales from harmless to hopeless.
struct Pair {
  Vec3 a;
  Vec3 b;
};
Pair nearly_orthogonal(Random& random) {
  const double scale = std::ldexp(1.0, random.integer(-1000, 1000));
  Vec3 a{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  Vec3 b{-a.y * scale, a.x * scale, 0.0};
  if (random.one_in(2)) b.x = std::nextafter(b.x, 1.0);
  if (random.one_in(4)) b.z = std::ldexp(random.between(-1, 1), random.integer(-1074, 0));
  return {a, b};
}

TEST(Filter, ASignItGivesIsTheExactSign) {
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const Pair pair = random.one_in(3) ? Pair{any_vec(random), any_vec(random)} : nearly_orthogonal(random);
    const ExactVec3 a = exact_vector(pair.a).v;
    const ExactVec3 b = exact_vector(pair.b).v;
    const int exact = sign(dot(a, b));
    const int raw = sign_of_dot(approx_difference(pair.a, {}), approx_difference(pair.b, {}));
    const int scaled = sign_of_dot(approx(a), approx(b));
    ASSERT_TRUE(raw == kUncertain || raw == exact);
    ASSERT_TRUE(scaled == kUncertain || scaled == exact);
  }
}

TEST(Filter, DeclinesWhereItCannotKnow) {
  EXPECT_EQ(sign_of_dot({1.0, 0x1p-53, 0.0}, {0x1p-53, -1.0, 0.0}), kUncertain);
  EXPECT_EQ(sign_of_dot({1e-300, 0.0, 0.0}, {1e-300, 0.0, 0.0}), kUncertain);  // underflows
  EXPECT_EQ(sign_of_dot({1e300, 0.0, 0.0}, {1e300, 0.0, 0.0}), kUncertain);    // overflows
  EXPECT_EQ(sign_of_dot({std::nan(""), 1.0, 0.0}, {1.0, 1.0, 0.0}), kUncertain);
  EXPECT_EQ(sign_of_dot({1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), 0);
  EXPECT_EQ(sign_of_dot({1.0, 2.0, 3.0}, {1.0, 1.0, -0.5}), 1);
}

Enclosure ball_of(const Rational& value, long bits) { return EnclosureInside::of(to_ball(value, bits)); }

TEST(Enclosure, NearestAgreesWithTheExactRounding) {
  Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const Rational value = to_rational(any_double(random)) + to_rational(any_double(random)) / 3;
    const std::optional<double> nearest = ball_of(value, 4000).nearest();
    ASSERT_TRUE(nearest.has_value());
    ASSERT_EQ(*nearest, nearest_double(value));
  }
}

TEST(Enclosure, NearestIsUndecidedAcrossAMidpoint) {
  const Rational midpoint = 1 + power_of_two(-53);
  EXPECT_EQ(ball_of(midpoint, 200).nearest(), 1.0);  // exactly the tie
  EXPECT_FALSE(ball_of(midpoint + power_of_two(-400) / 3, 200).nearest().has_value());
  EXPECT_EQ(ball_of(midpoint + power_of_two(-400) / 3, 500).nearest(), 1.0 + 0x1p-52);
}

TEST(Enclosure, NearestAroundASumIsThatOfItsBall) {
  Random random(7);
  int decided = 0;
  for (int i = 0; i < 20000; ++i) {
    const double hi = random.one_in(8) ? std::ldexp(random.between(1.0, 2.0), -1070) : random.between(-2.0, 2.0);
    const double half_ulp = 0.5 * std::abs(std::nextafter(hi, 4.0) - hi);  // 0 for the least exponents
    const double lo = random.one_in(4) ? half_ulp : half_ulp * random.between(-1.0, 1.0);
    const double error = random.one_in(9) ? 0.0 : half_ulp * std::ldexp(1.0, random.integer(-60, 4));
    const std::optional<double> nearest = nearest_around(hi, lo, error);
    const Enclosure ball = EnclosureInside::of(ball_around(hi, lo, error));
    if (!nearest) continue;  // as it may be beside a midpoint
    ++decided;
    ASSERT_EQ(nearest, ball.nearest()) << hi << ' ' << lo << ' ' << error;
    ASSERT_FALSE(ball.contains(0.0));
  }
  EXPECT_GE(decided, 10000);
  EXPECT_EQ(nearest_around(1.0, 0x1p-60, 0x1p-70), 1.0);
  EXPECT_FALSE(nearest_around(1.0, 0x1p-53, 0x1p-200));  // on both sides of a midpoint
  EXPECT_FALSE(nearest_around(0.0, 0.0, 0.0));
  EXPECT_FALSE(nearest_around(1.0, 0.0, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(nearest_around(1.0, 0.0, std::numeric_limits<double>::quiet_NaN()));
}

TEST(Enclosure, EndsAreRoundedOutward) {
  const Enclosure third = ball_of(Rational(1, 3), 300);
  EXPECT_EQ(third.lower(), 1.0 / 3.0);  // 1/3 rounds down
  EXPECT_EQ(third.upper(), std::nextafter(1.0 / 3.0, 1.0));
  EXPECT_TRUE(ball_of(Rational(1, 4), 300).contains(0.25));
  EXPECT_FALSE(third.contains(1.0 / 3.0));
}

TEST(Enclosure, DecimalsAreRoundedOrRefused) {
  const Enclosure third = ball_of(Rational(2, 3), 200);
  EXPECT_EQ(third.decimals(5), "0.66667");
  EXPECT_EQ(third.decimals(1), "0.7");
  EXPECT_FALSE(third.decimals(100).has_value());
  EXPECT_EQ(ball_of(Rational(1, 3000), 200).decimals(3), "0.000333");
  EXPECT_EQ(ball_of(Rational(1, 3000000000), 200).decimals(3), "3.33e-10");
  EXPECT_EQ(ball_of(Rational(999999, 1000000), 200).decimals(3), "1.00");
}

// The first outputs for the seed 1234567, as published with the generator.
TEST(SplitMix, GivesThePublishedNumbers) {
  constexpr std::uint64_t kNumbers[] = {6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                        4593380528125082431U, 16408922859458223821U};
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_EQ(split_mix(1234567, i), kNumbers[i]);
}

}  // namespace
}  // namespace exactff::kernel
