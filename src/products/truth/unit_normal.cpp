// n_i / |n| in balls of rising precision, until the ball rounds to one double.
//
// Why this ends: the ball never has to decide a tie. A midpoint of two doubles, and every double but 0 and +-1 in this
// range, is p / 2^k with p odd and k >= 1. If n_i / |n| were such a number, then n_j^2 + n_l^2 = n_i^2 (4^k - p^2) /
// p^2, so that 4^k - p^2 were a sum of two rational squares, hence of two integer squares. But 4^k - p^2 is 3 modulo 4.
// The values 0 and +-1 are no ties.
#include "truth/unit_normal.h"

#include "exactff/enclosure.h"
#include "kernel/ball.h"
#include "kernel/expect.h"
#include "kernel/vec.h"

namespace exactff::truth {
namespace {

double component(double value, const Vec3& normal) {
  if (value == 0.0) return 0.0;
  for (long bits = 128;; bits *= 2) {
    const Ball x = kernel::to_ball(normal.x, bits), y = kernel::to_ball(normal.y, bits),
               z = kernel::to_ball(normal.z, bits);
    const Ball length = sqrt(x * x + y * y + z * z);
    if (const auto nearest = EnclosureInside::of(kernel::to_ball(value, bits) / length).nearest()) return *nearest;
  }
}

}  // namespace

Vec3 unit_normal(const Vec3& normal) {
  EXACTFF_EXPECT(kernel::is_finite(normal) && !(normal == Vec3{}));
  return {component(normal.x, normal), component(normal.y, normal), component(normal.z, normal)};
}

}  // namespace exactff::truth
