// Method: over the corners a, b of each polygon
//   |sum n.(a x b) / |a x b| * 2 atan(|a x b| / (|a||b| + a.b))| / (2 pi |n|),
// in ball arithmetic from exact rational products, the precision doubled until one double and 30 digits are left.
//
// Other measures: the solid angle is that of the triangles from one corner of each polygon (van Oosterom and Strackee,
// 1983), and the second moment is Arvo's (SIGGRAPH '95) with normal and `up` exchanged, which changes its terms, but
// not their sum.
#include "support/oracle_sum.h"

#include <arb.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

namespace exactff::validation {

namespace {

class Real {
 public:
  Real() { arb_init(x_); }
  Real(const Rational& value, slong bits) : Real() {
    fmpz_t top;
    fmpz_t bottom;
    fmpz_init_set_readonly(top, value.get_num_mpz_t());
    fmpz_init_set_readonly(bottom, value.get_den_mpz_t());
    arb_fmpz_div_fmpz(x_, top, bottom, bits);
    fmpz_clear_readonly(top);
    fmpz_clear_readonly(bottom);
  }
  Real(const Real&) = delete;
  Real& operator=(const Real&) = delete;
  ~Real() { arb_clear(x_); }
  operator arb_ptr() { return x_; }

 private:
  arb_t x_;
};

// Adds n.(a x b) / |a x b| times the angle between a and b.
void add_edge(arb_ptr sum, const Vector& a, const Vector& b, const Vector& n, slong bits) {
  const Vector c = cross(a, b);
  if (is_zero(c)) return;
  Real sine(dot(c, c), bits);
  Real cosine(dot(a, b), bits);
  Real lengths(dot(a, a) * dot(b, b), bits);
  Real weight(dot(n, c), bits);
  arb_sqrt(sine, sine, bits);
  arb_sqrt(lengths, lengths, bits);
  arb_div(weight, weight, sine, bits);
  arb_add(cosine, cosine, lengths, bits);
  arb_div(sine, sine, cosine, bits);
  arb_atan(sine, sine, bits);
  arb_mul(weight, weight, sine, bits);
  arb_mul_2exp_si(weight, weight, 1);
  arb_add(sum, sum, weight, bits);
}

void evaluate(arb_ptr form_factor, const std::vector<Corners>& polygons, const Vector& n, slong bits) {
  Real part;
  arb_zero(form_factor);
  for (const Corners& corners : polygons) {
    arb_zero(part);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      add_edge(part, corners[i], corners[(i + 1) % corners.size()], n, bits);
    }
    arb_abs(part, part);
    arb_add(form_factor, form_factor, part, bits);
  }
  Real divisor(dot(n, n), bits);
  arb_sqrt(divisor, divisor, bits);
  arb_const_pi(part, bits);
  arb_mul(divisor, divisor, part, bits);
  arb_mul_2exp_si(divisor, divisor, 1);
  arb_div(form_factor, form_factor, divisor, bits);
}

// The end of the interval that rounds to `value`: halfway to the next double in the direction of `limit`, exact.
void set_halfway(arf_t out, double value, double limit) {
  arf_t next;
  arf_init(next);
  arf_set_d(out, value);
  arf_set_d(next, std::nextafter(value, limit));
  arf_add(out, out, next, ARF_PREC_EXACT, ARF_RND_DOWN);
  arf_mul_2exp_si(out, out, -1);
  arf_clear(next);
}

bool rounds_to(arb_ptr ball, double value) {
  arf_t end;
  Real low;
  Real high;
  arf_init(end);
  set_halfway(end, value, -1.0);
  arb_set_arf(low, end);
  set_halfway(end, value, 20.0);
  arb_set_arf(high, end);
  arf_clear(end);
  return arb_gt(ball, low) && arb_lt(ball, high);
}

Rational rational(arf_srcptr number) {
  fmpz_t mantissa;
  fmpz_t exponent;
  fmpz_init(mantissa);
  fmpz_init(exponent);
  arf_get_fmpz_2exp(mantissa, exponent, number);
  mpz_class top;
  fmpz_get_mpz(top.get_mpz_t(), mantissa);
  const slong shift = fmpz_get_si(exponent);
  fmpz_clear(mantissa);
  fmpz_clear(exponent);
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 2, static_cast<unsigned long>(std::abs(shift)));
  return shift < 0 ? Rational(top, power) : Rational(top * power);
}

SumBounds ends_of(arb_ptr ball, slong bits) {
  SumBounds result;
  arf_t low;
  arf_t high;
  arf_init(low);
  arf_init(high);
  arb_get_interval_arf(low, high, ball, bits);
  result.low = rational(low);
  result.high = rational(high);
  arf_clear(low);
  arf_clear(high);
  return result;
}

// False if the ball does not determine the double and 30 digits.
bool settle(RoundedSum& result, arb_ptr ball) {
  if (arb_rel_accuracy_bits(ball) < 110) return false;
  result.value = arf_get_d(arb_midref(ball), ARF_RND_NEAR);
  char* text = arb_get_str(ball, 30, ARB_STR_NO_RADIUS);
  result.decimals = text;
  flint_free(text);
  constexpr slong kBitsOfEnds = 256;
  const SumBounds ends = ends_of(ball, kBitsOfEnds);
  result.low = ends.low;
  result.high = ends.high;
  return rounds_to(ball, result.value);
}

}  // namespace

SumBounds bounds_of_lambert_sum(const std::vector<Corners>& polygons, const Vector& n, long bits) {
  Real ball;
  evaluate(ball, polygons, n, bits);
  return ends_of(ball, bits);
}

RoundedSum lambert_sum(const std::vector<Corners>& polygons, const Vector& n) {
  RoundedSum result;
  Real ball;
  for (slong bits = 192; bits <= 65536; bits *= 2) {
    evaluate(ball, polygons, n, bits);
    if (settle(result, ball)) return result;
  }
  throw std::runtime_error("the oracle found no end of precision");
}

namespace {

// tan(half the solid angle) = a . (b x c) / (|a||b||c| + (a . b) |c| + (b . c) |a| + (c . a) |b|).
void add_triangle(arb_ptr sum, const Vector& a, const Vector& b, const Vector& c, slong bits) {
  Real la(dot(a, a), bits), lb(dot(b, b), bits), lc(dot(c, c), bits);
  for (Real* const length : {&la, &lb, &lc}) arb_sqrt(*length, *length, bits);
  Real top(dot(a, cross(b, c)), bits), bottom, part;
  arb_mul(bottom, la, lb, bits);
  arb_mul(bottom, bottom, lc, bits);
  const auto add = [&](const Rational& product, Real& length) {
    Real term(product, bits);
    arb_addmul(bottom, term, length, bits);
  };
  add(dot(a, b), lc);
  add(dot(b, c), la);
  add(dot(c, a), lb);
  arb_atan2(part, top, bottom, bits);
  arb_mul_2exp_si(part, part, 1);
  arb_add(sum, sum, part, bits);
}

// Adds tan(theta / 2) (m . (a^ + b^)) (n . k), k the unit vector of a x b.
void add_moment(arb_ptr sum, const Vector& a, const Vector& b, const Vector& n, const Vector& m, slong bits) {
  const Vector c = cross(a, b);
  if (is_zero(c)) return;
  Real la(dot(a, a), bits), lb(dot(b, b), bits), sine(dot(c, c), bits), cosine(dot(a, b), bits), ma(dot(m, a), bits),
      mb(dot(m, b), bits), weight(dot(n, c), bits), lengths;
  for (Real* const length : {&la, &lb, &sine}) arb_sqrt(*length, *length, bits);
  arb_mul(lengths, la, lb, bits);
  arb_add(cosine, cosine, lengths, bits);
  arb_div(ma, ma, la, bits);
  arb_div(mb, mb, lb, bits);
  arb_add(ma, ma, mb, bits);
  arb_div(cosine, sine, cosine, bits);  // tan(theta / 2)
  arb_div(weight, weight, sine, bits);
  arb_mul(ma, ma, weight, bits);
  arb_addmul(sum, ma, cosine, bits);
}

// Clockwise as seen from the origin.
Corners clockwise(Corners corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const int sense = sgn(dot(corners[0], cross(corners[i - 1], corners[i])));
    if (sense == 0) continue;
    if (sense < 0) std::ranges::reverse(corners);
    break;
  }
  return corners;
}

void evaluate_measure(arb_ptr result, const std::vector<Corners>& polygons, const Vector& n, const SumMeasure& measure,
                      slong bits) {
  const bool overcast = measure.kind == SumMeasure::Kind::kOvercast;
  Real angle, moment, pi;
  for (const Corners& any : polygons) {
    const Corners corners = clockwise(any);
    for (std::size_t i = 2; i < corners.size(); ++i) add_triangle(angle, corners[0], corners[i - 1], corners[i], bits);
    for (std::size_t i = 0; overcast && i < corners.size(); ++i) {
      add_moment(moment, corners[i], corners[(i + 1) % corners.size()], n, measure.up, bits);
    }
  }
  arb_const_pi(pi, bits);
  if (!overcast) {
    arb_set(result, angle);
    if (measure.kind == SumMeasure::Kind::kSolidAngle) return;
    arb_div(result, result, pi, bits);
    arb_mul_2exp_si(result, result, -2);
    return;
  }
  // 3 / (7 pi) (pi F + 2/3 ((n . up) sigma + moment) / (|n||up|))
  Real lambert, normal_up(dot(n, measure.up), bits), lengths(dot(n, n) * dot(measure.up, measure.up), bits);
  evaluate(lambert, polygons, n, bits);
  arb_mul(lambert, lambert, pi, bits);
  arb_addmul(moment, normal_up, angle, bits);
  arb_sqrt(lengths, lengths, bits);
  arb_div(moment, moment, lengths, bits);
  arb_mul_2exp_si(moment, moment, 1);
  arb_div_ui(moment, moment, 3, bits);
  arb_add(lambert, lambert, moment, bits);
  arb_mul_ui(lambert, lambert, 3, bits);
  arb_div_ui(lambert, lambert, 7, bits);
  arb_div(result, lambert, pi, bits);
}

}  // namespace

RoundedSum measure_sum(const std::vector<Corners>& polygons, const Vector& n, const SumMeasure& measure) {
  RoundedSum result;
  Real ball;
  for (slong bits = 192; bits <= 65536; bits *= 2) {
    evaluate_measure(ball, polygons, n, measure, bits);
    if (settle(result, ball)) return result;
  }
  throw std::runtime_error("the oracle found no end of precision for a measure");
}

namespace {

double nearest_double(const Rational& value) {
  const double below = value.get_d();  // rounds towards zero
  const double above = std::nextafter(below, 2.0);
  const Rational twice_middle = Rational(below) + Rational(above);
  if (2 * value != twice_middle) return 2 * value < twice_middle ? below : above;
  return (std::bit_cast<std::uint64_t>(below) & 1u) == 0 ? below : above;
}

void evaluate_share(arb_ptr ratio, const std::vector<Share>& shares, slong bits) {
  Real visible;
  Real whole;
  for (const Share& share : shares) {
    Real factor(share.squared_factor, bits);
    Real part(share.visible, bits);
    Real all(share.whole, bits);
    arb_sqrt(factor, factor, bits);
    arb_addmul(visible, part, factor, bits);
    arb_addmul(whole, all, factor, bits);
  }
  arb_div(ratio, visible, whole, bits);
}

}  // namespace

double rounded_share(const std::vector<Share>& shares) {
  if (shares.empty()) return 0.0;
  const Share& first = shares.front();
  const auto as_first = [&](const Share& s) { return s.visible * first.whole == first.visible * s.whole; };
  if (std::ranges::all_of(shares, as_first)) return nearest_double(first.visible / first.whole);
  Real ratio;
  for (slong bits = 192; bits <= 65536; bits *= 2) {
    evaluate_share(ratio, shares, bits);
    const double value = arf_get_d(arb_midref(static_cast<arb_ptr>(ratio)), ARF_RND_NEAR);
    if (rounds_to(ratio, value)) return value;
  }
  throw std::runtime_error("the oracle found no end of precision for the visible fraction");
}

}  // namespace exactff::validation
