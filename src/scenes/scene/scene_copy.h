// A scene again, to be added to.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// With the name, the files, the unit and the materials of the scene, and nothing else.
[[nodiscard]] SceneBuilder begun_as(const Scene& scene);

// The same scene with these faces turned round, and these transparent.
[[nodiscard]] Scene with_faces(const Scene& scene, std::vector<FaceId> flipped, std::vector<FaceId> transparent);

// The ids of all patches, faces and vertices of the given scene stay the same. Refers to that scene.
class SceneCopy {
 public:
  // Vertices are relative to the origin, and rounded if that is not exact.
  explicit SceneCopy(const Scene& scene, const Vec3& origin = {});

  // Named so, with an apostrophe if the scene has a patch of this name.
  PatchId add_patch(std::string name);
  std::uint32_t add_vertex(const Vec3& vertex) { return builder_.add_vertex(vertex); }
  // A transparent face with the material of the first face.
  void add_face(PatchId patch, std::vector<std::uint32_t> corners);
  // The face turned round, with its material, transparent if it is.
  void add_twin(PatchId patch, const Face& face);

  Scene take() { return with_faces(builder_.build(), {}, std::move(transparent_)); }

 private:
  FaceId next_face() { return static_cast<FaceId>(scene_.faces().size() + added_++); }

  const Scene& scene_;
  SceneBuilder builder_;
  std::vector<FaceId> transparent_;
  std::size_t added_ = 0;
};

// The same scene in which face f belongs to the patch names[patch_of_face[f]], with further warnings. Patches without
// faces are left out.
[[nodiscard]] Scene regrouped(const Scene& scene, const std::vector<std::string>& names,
                              const std::vector<std::size_t>& patch_of_face, std::vector<Problem> warnings = {});

// The same scene near the origin, where coordinates of far away leave few bits for its shape. Only where every
// difference is exact: an axis is moved if all its coordinates lie within a sixteenth of the nearest one, so that each
// of them is at most twice another (Sterbenz, "Floating-Point Computation", 1974), and if this is at least sixteen
// times the scene's extent. Nothing if no axis is.
[[nodiscard]] std::optional<Scene> near_origin(const Scene& scene);

}  // namespace exactff
