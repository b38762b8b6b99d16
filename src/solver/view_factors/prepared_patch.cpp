#include "view_factors/prepared_patch.h"

#include <algorithm>
#include <tuple>

#include "view_factors/patch_parts.h"

namespace exactff::view_factors {

PreparedPatch::PreparedPatch(const ExactScene& scene, const Selection& patch, Columns what_it_is)
    : selection(patch),
      parts(parts_of(scene, patch)),
      enclosed_area(enclosed_area_of(parts, scene.units)),
      planar(is_planar(scene.scene, patch)),
      what(what_it_is) {
  std::tie(unit_area, area) = areas_of(scene, patch, parts);
}

double counted_area(const PreparedPatch& from, const PreparedPatch& to) {
  return to.what == Columns::kPatches ? std::min(from.unit_area, to.unit_area) : from.unit_area;
}

bool are_separated(const SeenParts& seen, const PreparedPatch& row, std::size_t i, const PreparedPatch& column,
                   std::size_t j) {
  return column.what == Columns::kBacks &&
         are_separated(row.seen.windings(seen, row.parts)[i], column.seen.windings(seen, column.parts)[j]);
}

}  // namespace exactff::view_factors
