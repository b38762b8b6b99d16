// A patch of a matrix: what all of its factors share, prepared once.
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/disc.h"
#include "view_factors/columns.h"
#include "view_factors/exact_scene.h"
#include "view_factors/seen_parts.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

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

}  // namespace exactff::view_factors
