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
  RaySource(const sampled::SampledScene& scene, const Selection& selection);

  std::vector<sampled::SourceRoot> roots;
  std::vector<RayPlane> planes;
  std::vector<double> area_up_to;  // total area of the roots before the k-th; the last entry is that of all; scaled

  [[nodiscard]] double area() const { return area_up_to.back(); }
};

// Base of the methods that trace rays.
class RaysOnScene : public PreparedScene {
 public:
  explicit RaysOnScene(const Scene& scene);
  [[nodiscard]] std::unique_ptr<PreparedSource> prepare_source(const Selection& selection) const override;
  [[nodiscard]] const sampled::SampledScene& sampled() const { return sampled_; }

 private:
  sampled::SampledScene sampled_;
};

}  // namespace exactff::methods
