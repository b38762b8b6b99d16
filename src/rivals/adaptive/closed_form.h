// Tampieri's Eq. (4): the unoccluded form factor from the origin to a polygon.
#pragma once

#include "adaptive/sub_patch.h"

namespace exactff::adaptive {

// In double, by atan2; an estimate with a relative error of about 1e-15 r/h for a patch of size h at distance r.
// Requires a unit normal and a patch above the horizon of x.
[[nodiscard]] double unoccluded_form_factor(const SubPatch& s, const Vec3& unit_normal);

// As printed in 1992, in single precision by acos: wrong for small or distant patches, and for patches that the horizon
// cuts.
[[nodiscard]] double literal_unoccluded_form_factor(const SubPatch& s, const Vec3& unit_normal);

}  // namespace exactff::adaptive
