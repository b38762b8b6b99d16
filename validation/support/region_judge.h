// Judges of the regions of a whole view (exactff/view.h) that share no code with what makes them. Both need a
// scene without glass.
#pragma once

#include <set>
#include <string>

#include "exactff/receiver.h"

namespace exactff::validation {

// In both projections every group of the picture has the area that is the share of its patch, and nothing else is
// drawn. The document is read and integrated by code of its own.
void expect_picture_of_shares(const Scene& scene, const Receiver& receiver);

// In both projections, with `up` upwards, a name that is written into the picture covers what it names: rays through
// the middles of squares of 4 pixels in its box meet this patch first (render.h). Returns the names in both
// pictures. Requires that own faces are planar.
std::set<std::string> expect_names_on_what_they_name(const Scene& scene, const Receiver& receiver, const Vec3& up);

// The shares of the regions, front and back, are the rational numbers that CGAL's Booleans find for each face on its
// own, where no coplanar faces overlap. The triangles of the mesh have these areas.
void expect_regions_as_booleans_find(const Scene& scene, const Receiver& receiver);

}  // namespace exactff::validation
