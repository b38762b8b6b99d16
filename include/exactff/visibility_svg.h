// A picture of one receiver's view of one source: each plane of the source as seen from x, the projected occluders, the
// exact visible region and, if present, the leaves of the adaptive recursion.
#pragma once

#include <span>
#include <string>

#include "exactff/adaptive.h"
#include "exactff/exact.h"

namespace exactff {

// Returns a self-contained SVG document. `leaves` may be empty. Planes that x does not face are left out, with a note.
[[nodiscard]] std::string visibility_svg(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                                         const FormFactor& result, std::span<const Leaf> leaves);

}  // namespace exactff
