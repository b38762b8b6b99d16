// Cuts a patch into m x m parts.
#pragma once

#include <vector>

#include "sampled/sub_patch.h"

namespace exactff::methods {

// m^2 parts of the patch's shape that tile it: triangles similar to a triangle; the cells of the bilinear map of a
// quadrilateral.
void split_evenly(const sampled::SubPatch& s, int m, std::vector<sampled::SubPatch>& parts);

// The centroid of a triangle, the mean of the corners of a quadrilateral.
[[nodiscard]] Vec3 centre_of(const sampled::SubPatch& s);

}  // namespace exactff::methods
