// A picture of one receiver's view of one source: each plane of the source as seen from x, the projected occluders, the
// exact visible region and, if present, the leaves of the adaptive recursion.
#pragma once

#include <string>

#include "exactff/adaptive.h"
#include "exactff/exact.h"

namespace exactff::report {

// Returns a self-contained SVG document. With `sampled`, it shows the leaves in its leaf_list. Leaves that are not in
// the list, and planes that x does not face, are left out, with a note.
[[nodiscard]] std::string visibility_svg(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                                         const FormFactor& result, const AdaptiveResult* sampled = nullptr);

}  // namespace exactff::report
