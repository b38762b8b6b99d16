// Scene and source in the form used by methods that trace rays to points of the source.
#pragma once

#include <vector>

#include "exactff/methods.h"
#include "sampled/sampled_scene.h"
#include "sampled/source_roots.h"

namespace exactff::methods {

// One plane of a source, seen from the front and from behind.
struct RayPlane {
  sampled::SourcePlane front;
  sampled::SourcePlane back;
  Vec3 unit_normal;                  // front
  std::vector<std::uint32_t> close;  // pieces not in the plane that single precision cannot separate from it
};

struct RaySource : PreparedSource {
  RaySource(const sampled::SampledScene& sampled, const Scene& scene, const Selection& selection);

  std::vector<sampled::SourceRoot> roots;
  std::vector<RayPlane> planes;
  std::vector<double> area_up_to;  // total area of the roots before the k-th; the last entry is that of all; scaled

  [[nodiscard]] double area() const { return area_up_to.back(); }
};

// The scene of methods that trace rays. The ray structure is built here, so that its time is not part of a timed call,
// but only if a list can get long.
struct SceneForRays : sampled::SampledScene {
  explicit SceneForRays(const Scene& scene);
};

}  // namespace exactff::methods
