// Discs of the complex plane in doubles hold what Arb's complex balls say, at random numbers, and not much more.
#include "kernel/disc.h"

#include <acb.h>

#include "kernel/gauss.h"
#include "support/test.h"

namespace exactff::kernel {
namespace {

constexpr long kBits = 256;
constexpr int kTrials = 2000;
constexpr double kInside = 1.0 - 0x1p-40;  // of the radius, so that a rounded point of the rim lies in the disc

// A complex number of Arb.
class Complex {
 public:
  Complex() { acb_init(z_); }
  Complex(double real, double imaginary) : Complex() { acb_set_d_d(z_, real, imaginary); }
  Complex(const Complex& other) : Complex() { acb_set(z_, other.z_); }
  Complex& operator=(const Complex& other) {
    acb_set(z_, other.z_);
    return *this;
  }
  ~Complex() { acb_clear(z_); }
  acb_ptr get() { return z_; }
  [[nodiscard]] acb_srcptr get() const { return z_; }

 private:
  acb_t z_;
};

// The distance of z from the centre, rounded up: at least the true one, by far less than a double's precision.
double distance(const Complex& z, double centre) {
  Complex difference;
  acb_sub(difference.get(), z.get(), Complex(centre, 0.0).get(), kBits);
  Ball size(kBits);
  acb_abs(size.get(), difference.get(), kBits);
  arf_t end;
  arf_init(end);
  arb_get_ubound_arf(end, size.get(), kBits);
  const double result = arf_get_d(end, ARF_RND_UP);
  arf_clear(end);
  return result;
}

class Discs : public testing::Test {
 protected:
  double between(double low, double high) { return low + (high - low) * random_.unit(); }
  // A double with any last bits, of many sizes.
  double number() { return std::ldexp(between(-1.0, 1.0), static_cast<int>(random_.below(40)) - 20); }
  Disc disc() {
    const double centre = number();
    return {centre,
            random_.below(4) == 0 ? 0.0 : std::abs(centre) * std::ldexp(random_.unit(), -int(random_.below(50)))};
  }
  static Complex on_rim(const Disc& a, double angle) {
    const double radius = a.radius * kInside;
    Complex z(radius * std::cos(angle), radius * std::sin(angle));
    acb_add(z.get(), z.get(), Complex(a.centre, 0.0).get(), kBits);
    return z;
  }

  using Operation = std::function<Disc(const Disc&, const Disc&)>;
  using Truth = std::function<void(acb_ptr, acb_srcptr, acb_srcptr)>;
  // At random points of random discs; the left end of an operand's rim, where most radii are attained, among them.
  void expect_held(const Operation& operation, const Truth& truth) {
    int finite = 0;
    for (int i = 0; i < kTrials; ++i) {
      const Disc a = disc(), b = disc();
      const Disc found = operation(a, b);
      if (!is_finite(found)) continue;
      ++finite;
      for (int k = 0; k < 4; ++k) {
        const auto angle = [&] { return k == 0 ? std::numbers::pi : between(0.0, 2.0 * std::numbers::pi); };
        const Complex z = on_rim(a, angle()), w = on_rim(b, angle());
        Complex value;
        truth(value.get(), z.get(), w.get());
        EXPECT_LE(distance(value, found.centre), found.radius) << a.centre << ' ' << a.radius;
      }
    }
    EXPECT_GT(finite, kTrials / 4);
  }

  Random random_{20261123};
};

TEST_F(Discs, HoldSumsAndProducts) {
  expect_held([](const Disc& a, const Disc& b) { return a + b; },
              [](acb_ptr f, acb_srcptr z, acb_srcptr w) { acb_add(f, z, w, kBits); });
  expect_held([](const Disc& a, const Disc& b) { return a - b; },
              [](acb_ptr f, acb_srcptr z, acb_srcptr w) { acb_sub(f, z, w, kBits); });
  expect_held([](const Disc& a, const Disc& b) { return a * b; },
              [](acb_ptr f, acb_srcptr z, acb_srcptr w) { acb_mul(f, z, w, kBits); });
  expect_held([](const Disc& a, const Disc&) { return square(a); },
              [](acb_ptr f, acb_srcptr z, acb_srcptr) { acb_sqr(f, z, kBits); });
  expect_held([](const Disc& a, const Disc&) { return 0.7 * a; },
              [](acb_ptr f, acb_srcptr z, acb_srcptr) { acb_mul(f, z, Complex(0.7, 0.0).get(), kBits); });
}

TEST_F(Discs, FailWhereTheFunctionIsNotAnalytic) {
  EXPECT_FALSE(is_finite(inverse(Disc{1.0, 1.0})));
  EXPECT_FALSE(is_finite(inverse(Disc{-1.0, 2.0})));
  EXPECT_FALSE(is_finite(square_root(Disc{1.0, 1.0})));
  EXPECT_FALSE(is_finite(square_root(Disc{-1.0, 0.0})));
  EXPECT_FALSE(is_finite(atan_of_root(Disc{0.0, 1.0})));
  EXPECT_FALSE(is_finite(atan_of_root(Disc{-2.0, 0.0})));
  const Disc failed = inverse(Disc{0.0, 0.0});
  for (const Disc& f : {failed + Disc{1.0, 0.0}, failed * Disc{0.0, 0.0}, inverse(failed), square_root(failed),
                        atan_of_root(failed), square(failed), 0.0 * failed}) {
    EXPECT_FALSE(is_finite(f));
  }
  EXPECT_FALSE(is_finite(Disc{0x1p1000, 0.0} * Disc{0x1p1000, 0.0}));
}

TEST(GaussRules, IntegratePowersExactly) {
  for (std::size_t n = 1; n <= kMostNodes; ++n) {
    for (std::size_t k = 0; k <= 2 * n; ++k) {
      Disc sum;
      for (const GaussNode& node : enclosed_gauss_rule(n)) {
        Disc term = node.weight;
        for (std::size_t i = 0; i < k; ++i) term = term * node.at;
        sum = sum + term;
      }
      const double integral = 1.0 / static_cast<double>(k + 1);
      const bool holds = std::abs(sum.centre - integral) <= sum.radius + 0x1p-54;
      EXPECT_LE(sum.radius, 1e-14);
      if (k < 2 * n || n <= 8) {  // else the error is not above rounding
        EXPECT_EQ(holds, k < 2 * n) << n << ' ' << k;
      }
    }
  }
}

}  // namespace
}  // namespace exactff::kernel
