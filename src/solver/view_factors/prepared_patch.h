// A patch of a matrix: its convex parts, and what else all of its factors share, prepared once.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kernel/disc.h"
#include "view_factors/exact_scene.h"
#include "view_factors/seen_parts.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

// --- Columns ---

// What the columns of a matrix are. Only between patches of the scene is the factor of the other direction wanted, too.

enum class Columns {
  kPatches,
  // Each is a patch of copies of faces, turned or not. Where closed surfaces hide these, that is proved first
  // (seen_parts.h).
  kBacks,
  // Each is a patch through which something is seen that lies beyond.
  kWindows,
  // Each is a patch whose fronts lie all around the scene and look inward, at infinity as it were, and that hides
  // nothing. The factor to it is what the occluders leave of all directions.
  kSurroundings,
};

// --- Prepared patch ---

struct PreparedPatch {
  // Throws InputError for a patch without area.
  PreparedPatch(const ExactScene& scene, const Selection& patch, Columns what);

  Selection selection;
  // Factors between patches are found for what is exposed: buried parts neither send nor receive. If nothing is, there
  // are no parts, and the areas are those of the whole patch.
  std::vector<Part> parts;
  double whole_area = 0.0;     // with what is buried, in the scene's unit of length, squared
  kernel::Disc exposed_share;  // of the area; 1 exactly if nothing is buried, 0 exactly if all is
  double area = 0.0;           // of the exposed part, in the same unit
  double unit_area = 0.0;      // the same in squares of the unit of Point::at
  kernel::Disc enclosed_area;  // the same
  bool opaque = true;          // a point sees at most 1 of it
  Columns what;                // of columns; else kPatches
  SeenParts::OfPatch seen;

  [[nodiscard]] bool surrounds() const { return what == Columns::kSurroundings; }

 private:
  void leave_out_buried(const ExactScene& scene);
};

// The area that errors of an integral over the row's patch are divided by: of both directions, if both may be asked
// for.
[[nodiscard]] double counted_area(const PreparedPatch& from, const PreparedPatch& to);

// Whether A_i F_ij = A_j F_ji holds for the factors of this column.
[[nodiscard]] bool are_reciprocal(const PreparedPatch& column);
// F_ij is at most this: 1 and, where F_ji is at most 1, A_j / A_i.
[[nodiscard]] double largest_factor(const PreparedPatch& i, const PreparedPatch& j);

// Whether a closed surface is proved to hide one part of either patch from the other, if the column asks for that.
[[nodiscard]] bool are_separated(const SeenParts& seen, const PreparedPatch& row, std::size_t i,
                                 const PreparedPatch& column, std::size_t j);

// --- Patch parts ---

// A patch as convex parts that do not overlap.

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
