// clang-format off
#include "kernel/ball.h"

#include <mpfr.h>  // first: only then does FLINT 3 declare what converts to MPFR's numbers

// clang-format on

#include "kernel/ball.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exactff/enclosure.h"
#include "kernel/float_environment.h"

namespace exactff {

Ball twice(const Ball& a) {
  Ball result(a.bits());
  arb_mul_2exp_si(result.get(), a.get(), 1);
  return result;
}

namespace kernel {

ThreadCache::~ThreadCache() { flint_cleanup(); }

Ball to_ball(const Integer& value, long bits) {
  fmpz_t copy;
  fmpz_init(copy);
  fmpz_set_mpz(copy, value.get_mpz_t());
  Ball result(bits);
  arb_set_round_fmpz(result.get(), copy, bits);
  fmpz_clear(copy);
  return result;
}

Ball to_ball(const Rational& value, long bits) {
  return with_bits(to_ball(value.get_num(), bits + 2) / to_ball(value.get_den(), bits + 2), bits);
}

Ball to_ball(double value, long bits) {
  Ball result(bits);
  arb_set_d(result.get(), value);
  return result;
}

Ball pi(long bits) {
  Ball result(bits);
  arb_const_pi(result.get(), bits);
  return result;
}

// The square of the cosine of a rational number of degrees is rational at multiples of 30 and 45 alone (Niven,
// "Irrational Numbers", 1956, corollary 3.12), so more bits decide all others.
int compare_with_squared_cosine(const Integer& a, const Integer& b, double degrees) {
  for (const auto& [angle, fourths] : {std::pair(0.0, 4), {30.0, 3}, {45.0, 2}, {60.0, 1}, {90.0, 0}}) {
    if (degrees == angle || degrees == 180.0 - angle) return sign(Integer(4 * a - fourths * b));
  }
  for (long bits = 64;; bits *= 2) {
    const Ball cosine = ball_of<arb_cos_pi>(to_ball(degrees, bits) / to_ball(180.0, bits));
    const Ball difference = to_ball(a, bits) - cosine * cosine * to_ball(b, bits);
    if (!arb_contains_zero(difference.get())) return arb_is_positive(difference.get()) != 0 ? 1 : -1;
  }
}

Ball with_bits(Ball ball, long bits) {
  Ball result(bits);
  arb_swap(result.get(), ball.get());
  return result;
}

Ball ball_around(double hi, double lo, double error) {
  Ball result;
  arb_add(result.get(), to_ball(hi, 0).get(), to_ball(lo, 0).get(), ARF_PREC_EXACT);
  mag_t radius;
  mag_init(radius);
  mag_set_d(radius, error);  // rounds up
  arb_add_error_mag(result.get(), radius);
  mag_clear(radius);
  return result;
}

// The sums with hi round numbers that are no larger than the least one, and no smaller than the largest; and rounding
// is monotone.
std::optional<double> nearest_around(double hi, double lo, double error) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double first = hi + std::nextafter(lo - error, -kInfinity), last = hi + std::nextafter(lo + error, kInfinity);
  if (first == last && first != 0.0 && std::isfinite(first)) return first;
  return std::nullopt;
}

double nearest_to_midpoint(const Ball& ball) { return arf_get_d(arb_midref(ball.get()), ARF_RND_NEAR); }

long certain_bits(const Ball& ball) { return arb_rel_accuracy_bits(ball.get()); }

}  // namespace kernel

namespace {

// Owns an Arb floating-point number: one end of a ball.
class End {
 public:
  End() { arf_init(x_); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;
  ~End() { arf_clear(x_); }
  arf_ptr get() { return x_; }
  [[nodiscard]] arf_srcptr get() const { return x_; }

 private:
  arf_t x_;
};

// The two ends, rounded outward to more bits than the midpoint has, so that rounding them again loses no relevant
// accuracy.
struct Ends {
  explicit Ends(const Ball& ball) {
    constexpr long kSpareBits = 128;
    const long bits = std::max(arb_bits(ball.get()), 0L) + kSpareBits;
    arb_get_lbound_arf(lower.get(), ball.get(), bits);
    arb_get_ubound_arf(upper.get(), ball.get(), bits);
  }
  End lower, upper;
};

// Significant decimals and the power of ten: the number is 0.DDD * 10^exponent.
struct Decimals {
  bool negative = false;
  std::string digits;
  long exponent = 0;

  friend bool operator==(const Decimals&, const Decimals&) = default;
};

// `count` significant decimals of one end, correctly rounded.
Decimals decimals_of(const End& end, int count) {
  mpfr_t x;
  mpfr_init2(x, std::max(2L, arf_bits(end.get())));
  arf_get_mpfr(x, end.get(), MPFR_RNDN);  // exact: x has as many bits as the end
  mpfr_exp_t exponent = 0;
  char* text = mpfr_get_str(nullptr, &exponent, 10, static_cast<std::size_t>(count), x, MPFR_RNDN);
  Decimals result{text[0] == '-', text[0] == '-' ? text + 1 : text, exponent};
  mpfr_free_str(text);
  mpfr_clear(x);
  return result;
}

// 0.00123 rather than 1.23e-3 as long as that stays short.
std::string format(const Decimals& number) {
  constexpr long kMostLeadingZeros = 5;
  const std::string minus = number.negative ? "-" : "";
  const std::string& digits = number.digits;
  if (digits.find_first_not_of('0') == std::string::npos) return "0";
  if (number.exponent <= 0 && number.exponent >= -kMostLeadingZeros) {
    return minus + "0." + std::string(static_cast<std::size_t>(-number.exponent), '0') + digits;
  }
  std::string result = minus + digits.substr(0, 1);
  if (digits.size() > 1) result += "." + digits.substr(1);
  return number.exponent == 1 ? result : result + "e" + std::to_string(number.exponent - 1);
}

}  // namespace

Enclosure::Enclosure() = default;
Enclosure::Enclosure(const Ball& ball) : ball_(std::make_unique<Ball>(ball)) {}
Enclosure::Enclosure(const Enclosure& other) : Enclosure(other.ball()) {}
Enclosure& Enclosure::operator=(const Enclosure& other) {
  set(other.ball());
  return *this;
}
Enclosure::Enclosure(Enclosure&&) noexcept = default;
Enclosure& Enclosure::operator=(Enclosure&&) noexcept = default;
Enclosure::~Enclosure() = default;

void Enclosure::set(const Ball& ball) {
  if (ball_) {
    *ball_ = ball;
  } else if (arb_is_zero(ball.get()) == 0) {
    ball_ = std::make_unique<Ball>(ball);
  }
}

const Ball& Enclosure::ball() const {
  static const Ball kZero;
  return ball_ ? *ball_ : kZero;
}

Enclosure& Enclosure::operator+=(const Enclosure& other) {
  Ball sum;
  arb_add(sum.get(), ball().get(), other.ball().get(), ARF_PREC_EXACT);
  set(sum);
  return *this;
}

Enclosure& Enclosure::operator-=(const Enclosure& other) {
  Ball difference;
  arb_sub(difference.get(), ball().get(), other.ball().get(), ARF_PREC_EXACT);
  set(difference);
  return *this;
}

Enclosure Enclosure::of(double value) {
  const kernel::StandardArithmetic arithmetic;
  return Enclosure(kernel::to_ball(value, 0));
}

double Enclosure::lower() const {
  const kernel::StandardArithmetic arithmetic;
  return arf_get_d(Ends(ball()).lower.get(), ARF_RND_FLOOR);
}

double Enclosure::upper() const {
  const kernel::StandardArithmetic arithmetic;
  return arf_get_d(Ends(ball()).upper.get(), ARF_RND_CEIL);
}

std::optional<double> Enclosure::nearest() const {
  const kernel::StandardArithmetic arithmetic;
  const Ends ends(ball());
  const double low = arf_get_d(ends.lower.get(), ARF_RND_NEAR);
  const double high = arf_get_d(ends.upper.get(), ARF_RND_NEAR);
  if (low != high) return std::nullopt;  // NaN included
  return high == 0.0 ? 0.0 : high;       // never -0
}

std::optional<std::string> Enclosure::decimals(int digits) const {
  const kernel::StandardArithmetic arithmetic;
  const Ends ends(ball());
  const Decimals low = decimals_of(ends.lower, digits);
  if (low != decimals_of(ends.upper, digits)) return std::nullopt;
  return format(low);
}

bool Enclosure::contains(const Enclosure& other) const { return arb_contains(ball().get(), other.ball().get()) != 0; }
bool Enclosure::overlaps(const Enclosure& other) const { return arb_overlaps(ball().get(), other.ball().get()) != 0; }

bool Enclosure::contains(double value) const {
  if (value == 0.0) return arb_contains_zero(ball().get()) != 0;
  const kernel::StandardArithmetic arithmetic;
  End number;
  arf_set_d(number.get(), value);
  return arb_contains_arf(ball().get(), number.get()) != 0;
}

namespace {

// Arb prints "[midpoint +/- radius]", only the number if the radius is 0, or "[+/- radius]" if the midpoint is 0. The
// printed ball contains the ball.
struct PrintedBall {
  std::string midpoint;
  std::string radius;
};

// The number of bits that are significant for this radius, even if the midpoint itself needs fewer: Arb adds to the
// radius the error of rounding to decimals.
slong meaningful_bits(const Ball& ball) {
  const slong bits = arb_bits(ball.get());
  return arb_is_exact(ball.get()) != 0 ? bits : std::max(bits, arb_rel_accuracy_bits(ball.get()));
}

PrintedBall print(const Ball& ball) {
  constexpr double kDecimalsPerBit = 0.30103;
  const auto digits = static_cast<slong>(static_cast<double>(meaningful_bits(ball)) * kDecimalsPerBit) + 5;
  char* raw = arb_get_str(ball.get(), digits, ARB_STR_MORE);
  const std::string text(raw);
  flint_free(raw);
  const std::size_t sign = text.find("+/- ");
  if (sign == std::string::npos) return {text, "0"};
  const std::string radius = text.substr(sign + 4, text.size() - sign - 5);
  return {sign == 1 ? "0" : text.substr(1, sign - 2), radius};
}

}  // namespace

std::string Enclosure::midpoint() const {
  const kernel::StandardArithmetic arithmetic;
  return print(ball()).midpoint;
}
std::string Enclosure::radius() const {
  const kernel::StandardArithmetic arithmetic;
  return print(ball()).radius;
}

}  // namespace exactff

namespace exactff::kernel {

// --- Tangent ---

Ball tan(const Ball& a) { return ball_of<arb_tan>(a); }

}  // namespace exactff::kernel
