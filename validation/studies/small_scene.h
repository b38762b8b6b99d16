// A scene of a few polygons, each of which is a patch.
#pragma once

#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff::experiments {

class SmallScene {
 public:
  // The ring is counter-clockwise as seen from the front.
  void add(std::string_view patch, const std::vector<Vec3>& ring) {
    std::vector<std::uint32_t> corners;
    for (const Vec3& corner : ring) corners.push_back(builder_.add_vertex(corner));
    builder_.add_face(builder_.patch(patch), material_, {corners});
  }
  [[nodiscard]] Scene build() { return builder_.build(); }

 private:
  SceneBuilder builder_;
  MaterialId material_ = builder_.add_material({});
};

}  // namespace exactff::experiments
