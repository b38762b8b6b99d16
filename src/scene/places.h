// Which vertices lie at one and the same point.
#pragma once

#include <cstdint>
#include <span>

#include "exactff/scene.h"

namespace exactff {

// For every vertex one vertex at its position, the same for all that lie there. Found when first asked for; safe to
// call from several threads.
[[nodiscard]] std::span<const std::uint32_t> places(const Scene& scene);

}  // namespace exactff
