// Arithmetic in double-double with running error bounds: numbers, vectors and angles.
#include "contour/quick_arithmetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "generate/random.h"
#include "support/random_scenes.h"
#include "unit/solver/quick_contour_support.h"

namespace exactff::contour {
namespace {

using namespace kernel::double_double;
using generate::Random;
using kernel::Integer;
using kernel::Rational;

// --- Numbers ---

// Every operation, with numbers at the limits that their bounds allow. The bound of the operation must hold. If the
// operands are exact, the bound must not be a hundred times too large for the worst of many cases.
class Arithmetic : public ::testing::Test {
 protected:
  struct Operand {
    Bounded bounded;
    Rational truth;
  };

  static Operand operand(Random& random, bool exact) {
    const double hi = random.between(0.5, 2) * (random.one_in(2) ? 1 : -1) * std::exp2(random.between(-3, 3));
    const DoubleDouble x = two_sum(hi, hi * 0x1p-53 * random.between(-1, 1));
    const double error = exact ? 0.0 : std::abs(hi) * std::exp2(random.between(-100, -30));
    const Rational shift = kernel::to_rational(random.one_in(2) ? error : -error);
    return {{x.hi, x.lo, error}, exactly(x.hi, x.lo) + shift};
  }

  // |result - truth| / error.
  static double share(const Bounded& result, const Rational& truth) {
    const Rational lost = abs(Rational(exactly(result.hi, result.lo) - truth));
    EXPECT_EQ(result.hi, result.hi + result.lo);
    return Rational(lost / kernel::to_rational(kInflation * result.error)).get_d();
  }

  // `shares` returns the share of the bound that one case uses.
  template <typename Shares>
  static void expect_sharp_bounds(Shares shares) {
    double worst = 0.0;
    for (std::uint64_t seed = 1; seed <= validation::scaled_count(4000); ++seed) {
      Random random(validation::seed_of(seed));
      worst = std::max(worst, shares(random, true));
      ASSERT_LE(worst, 1.0) << seed;
      ASSERT_LE(shares(random, false), 1.0) << seed;
    }
    EXPECT_GT(worst, 0.05);
  }
};

TEST_F(Arithmetic, SumsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand x = operand(random, exact);
    const Operand y = operand(random, exact);
    return share(x.bounded + y.bounded, x.truth + y.truth);
  });
}

// Operands that cancel down to a few of their last bits, or completely.
TEST_F(Arithmetic, SumsThatCancelKeepTheirBounds) {
  for (std::uint64_t seed = 1; seed <= validation::scaled_count(4000); ++seed) {
    Random random(validation::seed_of(seed));
    const Operand x = operand(random, true);
    const double hi = -x.bounded.hi * (1 + 0x1p-52 * static_cast<double>(random.below(5)));
    const DoubleDouble y = two_sum(hi, hi * 0x1p-53 * random.between(-1, 1));
    const Rational truth = x.truth + exactly(y.hi, y.lo);
    ASSERT_LE(share(x.bounded + bounded(y, 0), truth), 1.0) << seed;
    const DoubleDouble sum = accurate_sum(parts(x.bounded), y);
    ASSERT_LE(abs(Rational(exactly(sum.hi, sum.lo) - truth)), abs(truth) * kernel::to_rational(0x1p-104)) << seed;
  }
}

TEST_F(Arithmetic, ProductsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand x = operand(random, exact);
    const Operand y = operand(random, exact);
    return share(x.bounded * y.bounded, x.truth * y.truth);
  });
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand y = operand(random, exact);
    const double t = random.between(0, 1);
    return share(t * y.bounded, kernel::to_rational(t) * y.truth);
  });
}

TEST_F(Arithmetic, QuotientsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const Operand x = operand(random, exact);
    const Operand y = operand(random, exact);
    return share(x.bounded / y.bounded, x.truth / y.truth);
  });
}

TEST_F(Arithmetic, RootsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    Operand x = operand(random, exact);
    if (x.bounded.hi < 0.0) x = {-x.bounded, -x.truth};
    // A rational root within 2^-300.
    Integer root;
    const Integer scaled =
        kernel::times_power_of_two(x.truth, 600).get_num() / kernel::times_power_of_two(x.truth, 600).get_den();
    mpz_sqrt(root.get_mpz_t(), scaled.get_mpz_t());
    return share(square_root(x.bounded), kernel::times_power_of_two(Rational(root), -300));
  });
}

// --- Vectors ---

using Truth = std::array<Rational, 3>;

struct VectorOperand {
  Vector bounded;
  Truth truth;
};

class VectorArithmetic : public Arithmetic {
 protected:
  static VectorOperand vector_operand(Random& random, bool exact, double size = 1) {
    VectorOperand result;
    const double error = exact ? 0.0 : size * std::exp2(random.between(-100, -30));
    for (int i = 0; i < 3; ++i) {
      const double hi = random.between(-1, 1) * size;
      result.bounded.c[i] = two_sum(hi, hi * 0x1p-53 * random.between(-1, 1));
      const Rational shift = kernel::to_rational(random.one_in(2) ? error : -error);
      result.truth[i] = exactly(result.bounded.c[i].hi, result.bounded.c[i].lo) + shift;
    }
    result.bounded = vector(result.bounded.c, error);
    return result;
  }

  static double worst_share(const Vector& result, const Truth& truth) {
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
      worst = std::max(worst, share({result.c[i].hi, result.c[i].lo, result.error}, truth[i]));
    }
    return worst;
  }
};

Truth true_combination(const Rational& l, const Truth& p, const Rational& m, const Truth& q) {
  return {l * p[0] + m * q[0], l * p[1] + m * q[1], l * p[2] + m * q[2]};
}

TEST_F(VectorArithmetic, DifferencesKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand p = vector_operand(random, exact);
    VectorOperand q = vector_operand(random, exact, std::exp2(random.between(-60, 0)));
    if (random.one_in(2)) {  // near p
      for (int i = 0; i < 3; ++i) q.truth[i] += p.truth[i];
      q.bounded = difference(p.bounded, vector({-q.bounded.c[0], -q.bounded.c[1], -q.bounded.c[2]}, q.bounded.error));
      if (exact) q.bounded.error = 0;  // the rounded sum is an exact operand
      if (exact) {
        for (int i = 0; i < 3; ++i) q.truth[i] = exactly(q.bounded.c[i].hi, q.bounded.c[i].lo);
      }
    }
    return worst_share(difference(p.bounded, q.bounded), true_combination(1, p.truth, -1, q.truth));
  });
}

TEST_F(VectorArithmetic, CrossProductsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand p = vector_operand(random, exact);
    const VectorOperand q = vector_operand(random, exact);
    const auto component = [&](int j, int k) -> Rational { return p.truth[j] * q.truth[k] - p.truth[k] * q.truth[j]; };
    return worst_share(cross(p.bounded, q.bounded), {component(1, 2), component(2, 0), component(0, 1)});
  });
}

TEST_F(VectorArithmetic, CombinationsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand p = vector_operand(random, exact);
    const VectorOperand q = vector_operand(random, exact);
    const Operand l = operand(random, exact || random.one_in(2));
    const Operand m = operand(random, exact || random.one_in(2));
    return worst_share(combination(l.bounded, p.bounded, m.bounded, q.bounded),
                       true_combination(l.truth, p.truth, m.truth, q.truth));
  });
}

// p is t q up to a relative difference between 2^-100 and 1.
TEST_F(VectorArithmetic, NearCancellationsKeepTheirBounds) {
  expect_sharp_bounds([](Random& random, bool exact) {
    const VectorOperand q = vector_operand(random, exact);
    VectorOperand p;
    const double t = random.between(0.5, 2);
    const double away = std::exp2(random.between(-100, 0));
    for (int i = 0; i < 3; ++i) {
      const Bounded product = t * Bounded{q.bounded.c[i].hi, q.bounded.c[i].lo};
      const Bounded sum = product + Bounded{away * random.between(-1, 1)};
      p.bounded.c[i] = {sum.hi, sum.lo};
      p.truth[i] = exactly(sum.hi, sum.lo);
    }
    p.bounded = vector(p.bounded.c, 0.0);
    return worst_share(near_cancellation(p.bounded, t, q.bounded),
                       true_combination(1, p.truth, kernel::to_rational(-t), q.truth));
  });
}

// --- Angles ---

class Angle : public Arithmetic {};

TEST_F(Angle, AnglesKeepTheirBounds) {
  for (std::uint64_t seed = 1; seed <= validation::scaled_count(4000); ++seed) {
    Random random(validation::seed_of(seed));
    const bool exact = random.one_in(2);
    Operand s = operand(random, exact);
    const Operand c = operand(random, exact);
    const double scale = std::exp2(-static_cast<double>(random.below(60)));
    s = {{s.bounded.hi * scale, s.bounded.lo * scale, s.bounded.error * scale}, s.truth * kernel::to_rational(scale)};
    for (const bool swapped : {false, true}) {
      const Operand& sine = swapped ? c : s;
      const Operand& cosine = swapped ? s : c;
      const Bounded angle = atan2(sine.bounded, cosine.bounded, angle_constants());
      ASSERT_TRUE(std::isfinite(angle.error)) << seed;
      ASSERT_TRUE(holds(angle, true_angle(sine.truth, cosine.truth))) << seed;
      ASSERT_TRUE(!exact || angle.error < 0x1p-99 * std::abs(angle.hi)) << seed;
    }
  }
}

TEST_F(Angle, DeclinesTheOriginAndTheNegativeAxis) {
  const auto declined = [](const Bounded& s, const Bounded& c) {
    return std::isinf(atan2(s, c, angle_constants()).error);
  };
  EXPECT_TRUE(declined({0, 0, 0}, {0, 0, 0}));
  EXPECT_TRUE(declined({1, 0, 0x1p-10}, {1, 0, 0}));
  EXPECT_TRUE(declined({1, 0, 0}, {1, 0, 0x1p-10}));
  EXPECT_TRUE(declined({0, 0, 0}, {-1, 0, 0}));
  EXPECT_TRUE(declined({0x1p-50, 0, 0x1p-50}, {-1, 0, 0}));
  EXPECT_TRUE(declined({1, 0, 0}, {std::nan(""), 0, 0}));
  EXPECT_TRUE(declined({std::nan(""), 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(declined({0x1p-48, 0, 0x1p-50}, {-1, 0, 0}));
}

}  // namespace
}  // namespace exactff::contour
