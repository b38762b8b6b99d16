#include "scene/triangles.h"

#include <utility>

#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "scene/ear_clipping.h"

namespace exactff {

// Some corners of a piece may be on a straight side, so a fan from one corner would not do.
std::vector<std::vector<std::uint32_t>> triangles_of(const Scene& scene, const Piece& piece) {
  const auto corners = scene.corners(piece);
  const std::vector<std::uint32_t> ring(corners.begin(), corners.end());
  if (ring.size() == 3) return {ring};
  const FacePoints points = face_points(scene.vertices(), {ring});
  const PlanePoints plane(points, newell(points, 0, points.size()), PlanePoints::Projection::kDropAxis);
  const auto triangles = clip_ears(plane, points.vertex);
  EXACTFF_EXPECT(triangles.has_value());
  std::vector<std::vector<std::uint32_t>> result;
  for (const auto& [a, b, c] : *triangles) result.push_back({ring[a], ring[b], ring[c]});
  return result;
}

Scene triangulated(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  SceneBuilder builder;
  for (const Vec3& vertex : scene.vertices()) builder.add_vertex(vertex);
  for (const Material& material : scene.materials()) builder.add_material(material);
  for (const Patch& patch : scene.patches()) (void)builder.patch(patch.name);
  std::vector<Selection> transparent;
  std::uint32_t count = 0;
  for (const Piece& piece : scene.pieces()) {
    const Face& face = scene.face(piece.face);
    for (std::vector<std::uint32_t>& triangle : triangles_of(scene, piece)) {
      if (face.transparent) transparent.push_back({face.patch, static_cast<FaceId>(count)});
      builder.add_face(face.patch, face.material, {std::move(triangle)});
      ++count;
    }
  }
  return builder.build().with_transparent(transparent);
}

}  // namespace exactff
