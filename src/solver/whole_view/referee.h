// The whole view against the solver of single sources.
#pragma once

#include "exactff/view.h"

namespace exactff::whole_view {

// Computes every patch by both engines of the solver of single sources, and throws std::logic_error where a value, a
// status or a ball of `seen` is not the same. Patches with transparent faces and values that are not certified are left
// out. Requires that `seen` is the view of this receiver with these options.
void require_agreement(const Scene& scene, const Receiver& receiver, const ViewOptions& options, const WholeView& seen);

}  // namespace exactff::whole_view
