// A ball (an interval given by midpoint and radius) of arbitrary precision. Owns an Arb number. Every operation on
// balls encloses the true result.
#pragma once

#include <arb.h>

#include "kernel/numbers.h"

namespace exactff {

class Ball {
 public:
  Ball() { arb_init(x_); }
  Ball(const Ball& other) : Ball() { arb_set(x_, other.x_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(x_, other.x_); }
  Ball& operator=(const Ball& other) {
    arb_set(x_, other.x_);
    return *this;
  }
  Ball& operator=(Ball&& other) noexcept {
    arb_swap(x_, other.x_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }

  [[nodiscard]] arb_ptr get() { return x_; }
  [[nodiscard]] arb_srcptr get() const { return x_; }

 private:
  arb_t x_;
};

namespace kernel {

// Encloses the number, with a relative radius of at most 2^(1 - bits).
Ball to_ball(const Integer& value, long bits);
Ball to_ball(const Rational& value, long bits);

// The double nearest to the midpoint of the ball: an estimate of the enclosed number.
double nearest_to_midpoint(const Ball& ball);

}  // namespace kernel
}  // namespace exactff
