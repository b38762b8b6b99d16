#include "scene/scene_copy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace exactff {
namespace {

using Rings = std::vector<std::vector<std::uint32_t>>;

// A face that was left out stays so, whatever vertices are added.
Rings rings_of(const Face& face) { return face.piece_count > 0 ? face.rings : Rings{{0, 0, 0}}; }

}  // namespace

SceneCopy::SceneCopy(const Scene& scene, const Vec3& origin)
    : scene_(scene), builder_({}, {.bad_faces = BadFaces::kSkip}) {
  for (const Vec3& v : scene.vertices()) builder_.add_vertex({v.x - origin.x, v.y - origin.y, v.z - origin.z});
  for (const Material& material : scene.materials()) builder_.add_material(material);
  for (const Patch& patch : scene.patches()) (void)builder_.patch(patch.name);
  for (const Face& face : scene.faces()) {
    builder_.add_face(face.patch, face.material, rings_of(face));
    if (face.is_twin) builder_.mark_as_twin();
  }
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
  builder_.mark_as_twin();
}

std::optional<Scene> near_origin(const Scene& scene) {
  constexpr double kFar = 16.0;
  struct Range {
    double low = HUGE_VAL, high = -HUGE_VAL;
  };
  std::array<Range, 3> ranges;
  for (const Vec3& v : scene.vertices()) {
    const std::array<double, 3> at{v.x, v.y, v.z};
    for (std::size_t k = 0; k < 3; ++k) {
      ranges[k].low = std::min(ranges[k].low, at[k]);
      ranges[k].high = std::max(ranges[k].high, at[k]);
    }
  }
  double extent = 0.0;
  for (const Range& range : ranges) extent = std::max(extent, range.high - range.low);
  const auto origin_of = [&](const Range& range) {
    const double nearest = range.low > 0.0 ? range.low : range.high < 0.0 ? -range.high : 0.0;
    return nearest >= kFar * extent ? range.low : 0.0;
  };
  const Vec3 origin{origin_of(ranges[0]), origin_of(ranges[1]), origin_of(ranges[2])};
  if (!(extent > 0.0) || (origin.x == 0.0 && origin.y == 0.0 && origin.z == 0.0)) return std::nullopt;
  return SceneCopy(scene, origin).take();
}

}  // namespace exactff
