// The point where the segment between two vertices crosses a plane (the source's plane or the horizon), as a
// direction from x.
//
// With g(y) = N . (y - s), s a point of the plane, N its normal, and g(p), g(q) of different signs, the point lies in
// direction
//   (p - x) |g(q)| + (q - x) |g(p)|.
// It is computed in double-double arithmetic with an error bound first, and exactly where that declines or on request.
#pragma once

#include <array>
#include <optional>

#include "kernel/double_double.h"
#include "kernel/filter.h"
#include "kernel/numbers.h"

namespace exactff::kernel {

// A plane's normal N divided by 2^bit_length(N), so that its largest component is in [1/2, 1).
using FineNormal = std::array<double_double::Bounded, 3>;
[[nodiscard]] FineNormal fine_normal(const ExactVec3& normal);
// The same for the integers of exact_vector(normal).
[[nodiscard]] FineNormal fine_normal(const Vec3& normal);

class PlaneCrossings {
 public:
  // Lengths are multiplied by 2^scale_exponent, which should bring them to the order of 1.
  void start(const Vec3& x, const FineNormal& normal, const Vec3& point, int scale_exponent);

  // Times 2^-bit_length(N) 2^exponent, so that the largest component is in [1/2, 1]. Each hi is within relative error
  // 2u, u = 2^-53, of the true component and zero only where that component is zero.
  struct Fine {
    FineDirection direction;
    int exponent = 0;
  };
  [[nodiscard]] std::optional<Fine> fine(const Vec3& p, const Vec3& q) const;

  // The exact crossing. Reuses the memory of `result`. v 2^exponent is the value that a Fine with `fine_exponent`
  // approximates.
  void set_exact(ScaledVec3& result, const Vec3& p, const Vec3& q, const ExactVec3& normal, long fine_exponent);

 private:
  Vec3 x_, point_;
  FineNormal normal_{};
  int zero_axis_ = -1;  // along which all crossings are 0; -1: none
  int scale_exponent_ = 0;
  double scale_ = 1.0;
  // Scratch of set_exact.
  ScaledVec3 t_p_, t_q_, d_p_, d_q_;
  Integer g_p_, g_q_;
};

}  // namespace exactff::kernel
