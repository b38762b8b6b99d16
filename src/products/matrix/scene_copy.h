// A scene again, to be added to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff::matrix {

// The ids of all patches, faces and vertices of the given scene stay the same. Refers to that scene.
class SceneCopy {
 public:
  explicit SceneCopy(const Scene& scene);

  // Named so, with an apostrophe if the scene has a patch of this name.
  Selection add_patch(std::string name);
  std::uint32_t add_vertex(const Vec3& vertex) { return builder_.add_vertex(vertex); }
  // A transparent face with the material of the first face.
  void add_face(const Selection& patch, std::vector<std::uint32_t> corners);
  // The face turned round, with its material, transparent if it is.
  void add_twin(const Selection& patch, const Face& face);

  Scene take() { return builder_.build().with_transparent(transparent_); }

 private:
  void add_transparent(PatchId patch, FaceId face) { transparent_.push_back({patch, face}); }
  FaceId next_face() { return static_cast<FaceId>(scene_.faces().size() + added_++); }

  const Scene& scene_;
  SceneBuilder builder_;
  std::vector<Selection> transparent_;
  std::size_t added_ = 0;
};

}  // namespace exactff::matrix
