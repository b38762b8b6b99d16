#include "matrix/scene_copy.h"

#include <algorithm>
#include <utility>

namespace exactff::matrix {
namespace {

using Rings = std::vector<std::vector<std::uint32_t>>;

// A face that was left out stays so, whatever vertices are added.
Rings rings_of(const Face& face) { return face.piece_count > 0 ? face.rings : Rings{{0, 0, 0}}; }

}  // namespace

SceneCopy::SceneCopy(const Scene& scene) : scene_(scene), builder_({}, {.bad_faces = BadFaces::kSkip}) {
  for (const Vec3& vertex : scene.vertices()) builder_.add_vertex(vertex);
  for (const Material& material : scene.materials()) builder_.add_material(material);
  for (const Patch& patch : scene.patches()) (void)builder_.patch(patch.name);
  for (const Face& face : scene.faces()) builder_.add_face(face.patch, face.material, rings_of(face));
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    if (scene.faces()[f].transparent) add_transparent(scene.faces()[f].patch, static_cast<FaceId>(f));
  }
}

Selection SceneCopy::add_patch(std::string name) {
  while (std::ranges::any_of(scene_.patches(), [&](const Patch& p) { return p.name == name; })) name += '\'';
  return {builder_.patch(name), {}};
}

void SceneCopy::add_face(const Selection& patch, std::vector<std::uint32_t> corners) {
  add_transparent(patch.patch, next_face());
  builder_.add_face(patch.patch, scene_.faces().front().material, {std::move(corners)});
}

void SceneCopy::add_twin(const Selection& patch, const Face& face) {
  const FaceId twin = next_face();
  if (face.transparent) add_transparent(patch.patch, twin);
  Rings rings = face.rings;
  for (std::vector<std::uint32_t>& ring : rings) std::ranges::reverse(ring);
  builder_.add_face(patch.patch, face.material, std::move(rings));
}

}  // namespace exactff::matrix
