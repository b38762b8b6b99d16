// A ball (an interval given by midpoint and radius) of arbitrary precision. Every operation on balls encloses the true
// result. Only the kernel calls Arb; other modules write formulas in balls.
//
// A ball carries a number of bits, to which the results that are computed from it are rounded. Of two operands, the
// larger number counts. A ball made without one has 0 bits and leaves the choice to the other operand.
#pragma once

#include <arb.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "exactff/enclosure.h"
#include "kernel/numbers.h"

namespace exactff {

namespace kernel {

// FLINT keeps memory and constants for each thread. They are freed when the thread ends.
class ThreadCache {
 public:
  ~ThreadCache();
  void touch() const {}
};
inline thread_local const ThreadCache thread_cache;

}  // namespace kernel

class Ball {
 public:
  explicit Ball(long bits = 0) : bits_(bits) {  // zero
    kernel::thread_cache.touch();  // constructs it, and so schedules its destructor, in every thread that makes balls
    arb_init(x_);
  }
  Ball(const Ball& other) : Ball(other.bits_) { arb_set(x_, other.x_); }
  Ball(Ball&& other) noexcept : Ball(other.bits_) { arb_swap(x_, other.x_); }
  Ball& operator=(const Ball& other) {
    arb_set(x_, other.x_);
    bits_ = other.bits_;
    return *this;
  }
  Ball& operator=(Ball&& other) noexcept {
    arb_swap(x_, other.x_);
    std::swap(bits_, other.bits_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }

  [[nodiscard]] arb_ptr get() { return x_; }
  [[nodiscard]] arb_srcptr get() const { return x_; }
  [[nodiscard]] long bits() const { return bits_; }

  // Without an intermediate rounding.
  void add_product(const Ball& a, const Ball& b) {
    bits_ = std::max({bits_, a.bits_, b.bits_});
    arb_addmul(x_, a.x_, b.x_, bits_);
  }

 private:
  arb_t x_;
  long bits_;
};

namespace kernel {

template <auto kFunction>
Ball ball_of(const Ball& a) {
  Ball result(a.bits());
  kFunction(result.get(), a.get(), result.bits());
  return result;
}
template <auto kFunction>
Ball ball_of(const Ball& a, const Ball& b) {
  Ball result(std::max(a.bits(), b.bits()));
  kFunction(result.get(), a.get(), b.get(), result.bits());
  return result;
}

}  // namespace kernel

inline Ball operator+(const Ball& a, const Ball& b) { return kernel::ball_of<arb_add>(a, b); }
inline Ball operator-(const Ball& a, const Ball& b) { return kernel::ball_of<arb_sub>(a, b); }
inline Ball operator*(const Ball& a, const Ball& b) { return kernel::ball_of<arb_mul>(a, b); }
inline Ball operator/(const Ball& a, const Ball& b) { return kernel::ball_of<arb_div>(a, b); }
inline Ball sqrt(const Ball& a) { return kernel::ball_of<arb_sqrt>(a); }
inline Ball atan(const Ball& a) { return kernel::ball_of<arb_atan>(a); }
inline Ball atan2(const Ball& y, const Ball& x) { return kernel::ball_of<arb_atan2>(y, x); }
Ball twice(const Ball& a);  // not rounded

namespace kernel {

// Encloses the number, with a relative radius of at most 2^(1 - bits).
Ball to_ball(const Integer& value, long bits);
Ball to_ball(const Rational& value, long bits);
// Exactly the number.
Ball to_ball(double value, long bits);
Ball pi(long bits);
// The sign of a - b cos(degrees)^2. Exact, for positive b and from 0 to 180 degrees.
int compare_with_squared_cosine(const Integer& a, const Integer& b, double degrees);
// The same ball with another number of bits.
Ball with_bits(Ball ball, long bits);
// Contains every number within `error` of hi + lo; the error may be infinite.
Ball ball_around(double hi, double lo, double error);
// The double nearest to every number within `error` of hi + lo, if that is one for all of them and not 0.
std::optional<double> nearest_around(double hi, double lo, double error);

// The double nearest to the midpoint of the ball: an estimate of the enclosed number.
double nearest_to_midpoint(const Ball& ball);
// Bits of the midpoint that the radius leaves certain.
long certain_bits(const Ball& ball);

}  // namespace kernel

struct EnclosureInside {
  [[nodiscard]] static Enclosure of(const Ball& ball) { return Enclosure(ball); }
  static void set(Enclosure& enclosure, const Ball& ball) { enclosure.set(ball); }
  [[nodiscard]] static const Ball& ball(const Enclosure& enclosure) { return enclosure.ball(); }
};

}  // namespace exactff

namespace exactff::kernel {

// --- Tangent ---

// The tangent in balls.

[[nodiscard]] Ball tan(const Ball& a);

}  // namespace exactff::kernel
