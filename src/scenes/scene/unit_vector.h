// Directions of estimates, such as those of a summary.
#pragma once

#include "exactff/geometry.h"

namespace exactff {

// Zero stays zero. Nothing overflows or underflows.
[[nodiscard]] Vec3 unit_vector(const Vec3& v);

}  // namespace exactff
