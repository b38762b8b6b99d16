// A picture of one receiver's view of one source: each plane of the source seen from x's side, the projected
// occluders, the exact visible region, and the leaves of the adaptive recursion if there are any.
#pragma once

#include <span>
#include <string>

#include "exactff/adaptive.h"
#include "exactff/exact.h"

namespace exactff::study {

// A self-contained SVG document. `leaves` may be empty. Planes that x does not face are left out, and said to be.
[[nodiscard]] std::string visibility_svg(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                                         const FormFactor& result, std::span<const Leaf> leaves);

}  // namespace exactff::study
