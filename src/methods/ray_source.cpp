#include "methods/ray_source.h"

#include <algorithm>
#include <utility>

#include "kernel/float_environment.h"
#include "methods/ray_sum.h"
#include "sampled/plane_side.h"

namespace exactff::methods {

using namespace sampled;

namespace {

SourcePlane seen_from_behind(SourcePlane plane) {
  std::swap(plane.frame[1], plane.frame[2]);
  std::swap(plane.exact_frame[1], plane.exact_frame[2]);
  return plane;
}

std::vector<std::uint32_t> close_pieces(const SampledScene& scene, const SourcePlane& plane, const Vec3& unit_normal) {
  const Scene& s = *scene.scene.scene;
  const double blur = scene.unit_box.blur();
  std::vector<std::uint32_t> close;
  for (std::uint32_t k = 0; k < s.pieces().size(); ++k) {
    const auto corners = s.corners(s.pieces()[k]);
    const bool near = std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
      return std::abs(dot(unit_normal, scene.scene.points[v] - plane.frame[0])) <= blur;
    });
    if (near && !std::binary_search(plane.coplanar.begin(), plane.coplanar.end(), k)) close.push_back(k);
  }
  return close;
}

// 0 where rounding leaves no normal. Edges are scaled to a length of about 1 where their product would underflow.
Vec3 unit_normal_of(const SourcePlane& plane) {
  Vec3 normal = plane_normal(plane.frame[0], plane.frame[1], plane.frame[2]).value;
  if (max_norm(normal) < kLeastSquare) {
    const Vec3 p = plane.frame[1] - plane.frame[0], q = plane.frame[2] - plane.frame[0];
    if (p == Vec3{} || q == Vec3{}) return {};
    int exponent = 0;
    normal = cross(normalised(p, exponent), normalised(q, exponent));
    if (normal == Vec3{}) return {};
    normal = normalised(normal, exponent);
  }
  const Vec3 unit = normal * (1.0 / max_norm(normal));  // so that no square underflows
  return unit * (1.0 / length(unit));
}

RayPlane make_plane(const SampledScene& scene, SourcePlane plane) {
  RayPlane result;
  result.unit_normal = unit_normal_of(plane);
  result.close = close_pieces(scene, plane, result.unit_normal);
  result.back = seen_from_behind(plane);
  result.front = std::move(plane);
  return result;
}

double area_of(const SourceRoot& root) {
  return area(make_sub_patch({root.corners.data(), static_cast<std::size_t>(root.corner_count)}));
}

}  // namespace

RaySource::RaySource(const SampledScene& sampled, const Scene& scene, const Selection& chosen)
    : PreparedSource(chosen) {
  SourceRoots source = make_source_roots(scene, sampled.scene.points, chosen);
  for (SourcePlane& plane : source.planes) planes.push_back(make_plane(sampled, std::move(plane)));
  roots = std::move(source.roots);
  area_up_to.push_back(0.0);
  for (const SourceRoot& root : roots) area_up_to.push_back(area_up_to.back() + area_of(root));
}

SceneForRays::SceneForRays(const Scene& given) : SampledScene(given) {
  if (given.pieces().size() > kMostPiecesWithoutEmbree) (void)ray_scene();
}

}  // namespace exactff::methods
