// Reduces a failing scene before anyone has to look at it.
#pragma once

#include <functional>

#include "support/case_file.h"

namespace exactff::validation {

// Removes patches, faces, holes and corners, then shortens the mantissas of coordinates, as long as `fails` stays true.
// Requires fails(scene). The result has no corners that no face uses.
[[nodiscard]] generate::PlainScene minimised(generate::PlainScene scene,
                                             const std::function<bool(const generate::PlainScene&)>& fails);

// The scene as a case file. The expected value is the oracle's. The format has patches of one polygon or of triangles
// only. So an occluder of several polygons becomes one patch per face, and a source of several polygons becomes the
// triangles of its convex pieces, which does not change its region.
[[nodiscard]] CaseFile as_case(const std::string& name, const generate::PlainScene& scene);

}  // namespace exactff::validation
