// The tangent in balls.
#pragma once

#include "kernel/ball.h"

namespace exactff::kernel {

[[nodiscard]] Ball tan(const Ball& a);

}  // namespace exactff::kernel
