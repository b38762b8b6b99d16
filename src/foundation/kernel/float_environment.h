// The arithmetic that every proof in this library assumes: rounding to nearest, gradual underflow, no traps; and
// bounds by doubles that rely on it.
#pragma once

#include <cfenv>
#include <cmath>
#include <limits>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace exactff::kernel {

// While an object of this class exists, its thread and the threads that it starts compute with this arithmetic. The
// destructor restores the previous settings. Programs may use other settings: ray tracers often flush small numbers to
// zero, and debuggers trap divisions by zero or inexact results. Every public function that computes creates such an
// object first, and no other function does: validation/support/check_arithmetic.py checks it.
class StandardArithmetic {
 public:
  StandardArithmetic() {
    if (is_set()) return;
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
    has_changed_ = true;
  }
  ~StandardArithmetic() {
    if (has_changed_) std::fesetenv(&before_);
  }
  StandardArithmetic(const StandardArithmetic&) = delete;
  StandardArithmetic& operator=(const StandardArithmetic&) = delete;

 private:
  [[nodiscard]] static bool is_set() {
#ifdef __SSE2__
    constexpr unsigned kRounding = 0x6000, kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040, kTrapsMasked = 0x1F80;
    return (_mm_getcsr() & (kRounding | kFlushToZero | kDenormalsAreZero | kTrapsMasked)) == kTrapsMasked;
#else
    const volatile double least_normal = 0x1p-1022, half = 0.5;
    const volatile double below_normal = least_normal * half;
#ifdef __GLIBC__
    if (fegetexcept() != 0) return false;
#endif
    return std::fegetround() == FE_TONEAREST && below_normal + below_normal == least_normal;
#endif
  }
  std::fenv_t before_{};
  bool has_changed_ = false;
};

// --- Outward ---

// Bounds by doubles. With rounding to nearest, the exact result of an operation lies between the
// two neighbours of the computed one. An infinite bound stays valid: the neighbour of an infinity is the largest
// double.

[[nodiscard]] inline double below(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }
[[nodiscard]] inline double above(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }

}  // namespace exactff::kernel
