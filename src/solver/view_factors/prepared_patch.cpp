#include "view_factors/prepared_patch.h"

#include <algorithm>
#include <tuple>

#include "scene/contacts.h"
#include "view_factors/patch_parts.h"

namespace exactff::view_factors {
namespace {

bool is_partly_buried(const Scene& scene, const Selection& patch) {
  if (contacts(scene).empty()) return false;
  return std::ranges::any_of(scene.faces_of(patch), [&](FaceId face) {
    const std::uint32_t first = scene.face(face).first_piece;
    for (std::uint32_t piece = first; piece < first + scene.face(face).piece_count; ++piece) {
      if (!contacts(scene).covers(piece).empty()) return true;
    }
    return false;
  });
}

bool is_opaque(const Scene& scene, const Selection& patch) {
  return std::ranges::none_of(scene.faces_of(patch), [&](FaceId face) { return scene.face(face).transparent; });
}

}  // namespace

PreparedPatch::PreparedPatch(const ExactScene& scene, const Selection& patch, Columns what_it_is)
    : selection(patch),
      parts(parts_of(scene, patch)),
      exposed_share{.centre = 1.0},
      enclosed_area(enclosed_area_of(parts, scene.units)),
      opaque(is_opaque(scene.scene, patch)),
      what(what_it_is) {
  std::tie(unit_area, area) = areas_of(scene, patch, parts);
  whole_area = area;
  if (is_partly_buried(scene.scene, patch)) leave_out_buried(scene);
}

void PreparedPatch::leave_out_buried(const ExactScene& scene) {
  parts = parts_of(scene, selection, PartsOf::kExposed);
  if (parts.empty()) {
    exposed_share = {};
    return;
  }
  const kernel::Disc whole = enclosed_area;
  enclosed_area = enclosed_area_of(parts, scene.units);
  exposed_share = enclosed_area / whole;
  std::tie(unit_area, area) = areas_of(scene, selection, parts);
}

double counted_area(const PreparedPatch& from, const PreparedPatch& to) {
  return to.what == Columns::kPatches ? std::min(from.unit_area, to.unit_area) : from.unit_area;
}

bool are_reciprocal(const PreparedPatch& column) { return !column.surrounds(); }

double largest_factor(const PreparedPatch& i, const PreparedPatch& j) {
  const kernel::Disc ratio = j.enclosed_area / i.enclosed_area;
  return are_reciprocal(j) && i.opaque && is_finite(ratio) ? std::min(1.0, upper_end(ratio)) : 1.0;
}

bool are_separated(const SeenParts& seen, const PreparedPatch& row, std::size_t i, const PreparedPatch& column,
                   std::size_t j) {
  return column.what == Columns::kBacks &&
         are_separated(row.seen.windings(seen, row.parts)[i], column.seen.windings(seen, column.parts)[j]);
}

}  // namespace exactff::view_factors
