// Whether the fronts of two planes differ by less than an angle, decided exactly.
#pragma once

#include "exactff/scene.h"
#include "kernel/numbers.h"

namespace exactff {

// n . m > c |n| |m| for vectors other than 0, where c is the double nearest to the angle's cosine.
class AngleBelow {
 public:
  explicit AngleBelow(double degrees);
  [[nodiscard]] bool holds(const kernel::ExactVec3& n, const kernel::ExactVec3& m) const;

 private:
  int sign_ = 0;              // of c
  kernel::Rational squared_;  // c c
};

// A normal of the piece, towards its front: exact, of any length.
[[nodiscard]] kernel::ExactVec3 exact_normal(const Scene& scene, const Piece& piece);

}  // namespace exactff
