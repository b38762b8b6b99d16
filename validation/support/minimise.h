// Makes a failing scene small before anyone has to look at it.
#pragma once

#include <functional>

#include "support/case_file.h"

namespace exactff::validation {

// Drops patches, faces, holes and corners, then gives coordinates shorter mantissas, as long as `fails` stays true.
// Requires fails(scene). Corners no face uses are gone from the result.
[[nodiscard]] generate::PlainScene minimised(generate::PlainScene scene,
                                             const std::function<bool(const generate::PlainScene&)>& fails);

// The scene as a case file, with what the oracle says as the expected value. The format knows patches of one polygon
// or of triangles: an occluder of several polygons becomes one patch a face, and such a source the triangles of its
// convex pieces, which leaves its region as it is.
[[nodiscard]] CaseFile as_case(const std::string& name, const generate::PlainScene& scene);

}  // namespace exactff::validation
