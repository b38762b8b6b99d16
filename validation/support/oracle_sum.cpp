// Method: over the corners a, b of each polygon
//   |sum n.(a x b) / |a x b| * 2 atan(|a x b| / (|a||b| + a.b))| / (2 pi |n|),
// in ball arithmetic from exact rational products, the precision doubled until one double and 30 digits are left.
#include "support/oracle_sum.h"

#include <arb.h>

#include <cmath>
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

// Where the numbers that round to `value` end: halfway to the next double in the direction of `limit`, exactly.
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
  set_halfway(end, value, 2.0);
  arb_set_arf(high, end);
  arf_clear(end);
  return arb_gt(ball, low) && arb_lt(ball, high);
}

// False while the ball does not determine the double and 30 digits.
bool settle(RoundedSum& result, arb_ptr ball) {
  if (arb_rel_accuracy_bits(ball) < 110) return false;
  result.value = arf_get_d(arb_midref(ball), ARF_RND_NEAR);
  char* text = arb_get_str(ball, 30, ARB_STR_NO_RADIUS);
  result.decimals = text;
  flint_free(text);
  return rounds_to(ball, result.value);
}

}  // namespace

RoundedSum lambert_sum(const std::vector<Corners>& polygons, const Vector& n) {
  RoundedSum result;
  Real ball;
  for (slong bits = 192; bits <= 65536; bits *= 2) {
    evaluate(ball, polygons, n, bits);
    if (settle(result, ball)) return result;
  }
  throw std::runtime_error("the oracle found no end of precision");
}

}  // namespace exactff::validation
