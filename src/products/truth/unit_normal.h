// A normal scaled to unit length, correctly rounded.
#pragma once

#include "exactff/geometry.h"

namespace exactff::truth {

// Each component is n_i / |n|, rounded once to the nearest double (ties cannot occur). Requires finite components, not
// all zero.
[[nodiscard]] Vec3 unit_normal(const Vec3& normal);

// The same, with the last result kept: consecutive rows often have the same normal.
class UnitNormal {
 public:
  [[nodiscard]] const Vec3& of(const Vec3& normal) {
    if (!(normal == normal_)) {
      unit_ = unit_normal(normal);
      normal_ = normal;
    }
    return unit_;
  }

 private:
  Vec3 normal_{0.0, 0.0, 1.0};
  Vec3 unit_{0.0, 0.0, 1.0};
};

}  // namespace exactff::truth
