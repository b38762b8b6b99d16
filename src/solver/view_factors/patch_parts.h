// A patch as convex parts that do not overlap.
#pragma once

#include <utility>
#include <vector>

#include "kernel/disc.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// The patch's panels (scene/panels.h); where they overlap in one oriented plane, each point belongs to the first.
// kExposed: without what is buried (scene/contacts.h).
enum class PartsOf { kWhole, kExposed };
[[nodiscard]] std::vector<Part> parts_of(const ExactScene& scene, const Selection& patch,
                                         PartsOf what = PartsOf::kWhole);

// Positive in front.
[[nodiscard]] Plane plane_of(const Part& part, const Units& units);

// For sampling: the part, cut along the lines in which other faces meet its plane from the front. Form factors jump
// there. At most eight lines cut it, the longest that do. A line cuts, from side to side, the fragments whose boxes it
// meets. Transparent faces do not cut.
[[nodiscard]] std::vector<Part> cut_at_contacts(const ExactScene& scene, const Part& part);

// In squares of the unit of Point::at: an estimate within a few roundings.
[[nodiscard]] double area_of(const std::vector<Part>& parts);
// The same, enclosed.
[[nodiscard]] kernel::Disc enclosed_area_of(const std::vector<Part>& parts, const Units& units);

// A mean over the parts, with their weights, changes by at most this times its range if their areas are as wrong as
// roundings make them.
[[nodiscard]] double error_of_shares(const std::vector<Part>& parts, const Units& units);

// The area of a patch with these parts, in squares of the unit of Point::at and of the scene's unit of length: both
// positive and finite. Throws InputError otherwise.
[[nodiscard]] std::pair<double, double> areas_of(const ExactScene& scene, const Selection& patch,
                                                 const std::vector<Part>& parts);

}  // namespace exactff::view_factors
