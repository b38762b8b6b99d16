// Texture coordinates of faces.
#include <algorithm>
#include <string>

#include "scene/scene.h"

namespace exactff {

std::size_t texture_set(int set) {
  if (set >= 0 && set < kTextureSets) return static_cast<std::size_t>(set);
  refuse_argument("there is no set " + std::to_string(set) + " of texture coordinates", "sets are 0 and 1");
}

std::size_t corner_count(const std::vector<std::vector<std::uint32_t>>& rings) {
  std::size_t count = 0;
  for (const auto& ring : rings) count += ring.size();
  return count;
}

bool Scene::has_texture(int set) const { return !data().textures[texture_set(set)].points.empty(); }

std::span<const TexturePoint> Scene::texture(FaceId id, int set) const {
  const Texture& all = data().textures[texture_set(set)];
  require_face(*this, id);
  if (index_of(id) >= all.first.size() || all.first[index_of(id)] == Texture::kNone) return {};
  return std::span(all.points).subspan(all.first[index_of(id)], corner_count(face(id).rings));
}

FaceTexture::FaceTexture(const Scene& scene, FaceId face, int set) : set_(set) {
  const std::span<const TexturePoint> points = scene.texture(face, set);
  if (points.empty()) return;
  const std::span<const std::uint32_t> place = places(scene);
  std::size_t k = 0;
  for (const auto& ring : scene.face(face).rings) {
    for (const std::uint32_t v : ring) at_.emplace_back(place[v], points[k++]);
  }
  std::ranges::stable_sort(at_, {}, [](const auto& one) { return one.first; });
}

const TexturePoint* FaceTexture::find(std::uint32_t place) const {
  const auto found = std::ranges::lower_bound(at_, place, {}, [](const auto& one) { return one.first; });
  return found != at_.end() && found->first == place ? &found->second : nullptr;
}

void copy_texture(const Scene& scene, FaceId face, const std::vector<std::vector<std::uint32_t>>& rings,
                  SceneBuilder& builder) {
  copy_texture(scene, face, rings, builder, [place = places(scene)](const FaceTexture& texture, std::uint32_t v) {
    return *texture.find(place[v]);
  });
}

}  // namespace exactff
