// The arithmetic that every proof in this library assumes: rounding to nearest, gradual underflow.
#pragma once

#include <cfenv>

namespace exactff::kernel {

// While it lives the thread computes so; then as before. A program may have set the thread otherwise: ray tracers have
// numbers flushed to zero that are small.
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
  // Small numbers are neither taken for zero nor made zero, and 1 + 2^-60 is 1, whatever its sign.
  [[nodiscard]] static bool is_set() {
    const volatile double least_normal = 0x1p-1022, half = 0.5, one = 1.0, little = 0x1p-60;
    const volatile double below_normal = least_normal * half;
    return below_normal + below_normal == least_normal && one + little == one && one - little == one;
  }
  std::fenv_t before_{};
  bool has_changed_ = false;
};

}  // namespace exactff::kernel
