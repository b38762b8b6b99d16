#include "view_factors/prepared_patch.h"

#include <tuple>

#include "view_factors/patch_parts.h"

namespace exactff::view_factors {

PreparedPatch::PreparedPatch(const ExactScene& scene, const Selection& patch, bool surrounds_scene)
    : selection(patch),
      parts(parts_of(scene, patch)),
      enclosed_area(enclosed_area_of(parts, scene.units)),
      planar(is_planar(scene.scene, patch)),
      surrounds(surrounds_scene) {
  std::tie(unit_area, area) = areas_of(scene, patch, parts);
}

}  // namespace exactff::view_factors
