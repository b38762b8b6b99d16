// Arithmetic in double-double with running error bounds: numbers, vectors and angles.
#include "kernel/bounded_vectors.h"

#include "support/test.h"
#include "unit/solver/quick_contour_support.h"

namespace exactff::contour {
namespace {

using namespace kernel::double_double;
using kernel::Integer;
using kernel::Rational;

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

// Both sides of every step of the table, in every octant; each of the four lanes has another step and octant, and has
// the bits of one that is computed alone.
TEST_F(Angle, OfEveryStepAndOctantHoldTheTruthInEveryLane) {
  for (int k = 0; k <= 2 * kAtanSteps; ++k) {
    const double step = static_cast<double>(k) / (2 * kAtanSteps);  // between two steps for odd k
    const double ratios[] = {step, std::nextafter(step, -1), std::nextafter(step, 2), (37 * k) % 509 / 509.0};
    for (int octant = 0; octant < 8; ++octant) {
      Four sines{}, cosines{};
      for (int i = 0; i < 4; ++i) {
        const int o = (octant + i) % 8;
        const double x = o & 1 ? -1.0 : 1.0, y = o & 2 ? -ratios[i] : ratios[i];
        sines[i] = o & 4 ? x : y;
        cosines[i] = o & 4 ? y : x;
      }
      const FourBounded four = atan2(FourBounded{sines, {}, {}}, FourBounded{cosines, {}, {}}, angle_constants());
      for (int i = 0; i < 4; ++i) {
        const Bounded found{four.hi[i], four.lo[i], four.error[i]};
        const Bounded alone = atan2(Bounded{sines[i]}, Bounded{cosines[i]}, angle_constants());
        ASSERT_EQ(std::memcmp(&found, &alone, sizeof found), 0) << k << ' ' << octant << ' ' << i;
        if (sines[i] == 0.0) continue;  // an axis; declined if it is the negative one
        ASSERT_TRUE(holds(found, true_angle(exactly(sines[i], 0), exactly(cosines[i], 0)))) << k << ' ' << octant;
        ASSERT_LT(found.error, 0x1p-99 * std::abs(found.hi) + 8 * kUnderflow) << k << ' ' << octant << ' ' << i;
      }
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
