// Gauss-Legendre rules on [0, 1], enclosed.
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/ball.h"
#include "kernel/disc.h"

namespace exactff::kernel {

// Holds every number of the ball.
[[nodiscard]] Disc to_disc(const Ball& ball);

struct GaussNode {
  Disc at, weight;
};

inline constexpr std::size_t kMostNodes = 16;
// The rule of `count` nodes; 1 <= count <= kMostNodes.
[[nodiscard]] const std::vector<GaussNode>& enclosed_gauss_rule(std::size_t count);

}  // namespace exactff::kernel
