// Scenes of a few polygons, and receivers on all of their faces, for the tests of sets of receivers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::validation {

struct PolygonFace {
  using Ring = std::vector<std::uint32_t>;

  std::vector<Vec3> vertices;
  std::vector<Ring> rings;
  std::string patch = "face";
};

inline Scene scene_of(const std::vector<PolygonFace>& polygons) {
  SceneBuilder builder("test");
  const MaterialId material = builder.add_material({});
  for (const PolygonFace& polygon : polygons) {
    const auto first = static_cast<std::uint32_t>(builder.vertex_count());
    for (const Vec3& v : polygon.vertices) builder.add_vertex(v);
    std::vector<PolygonFace::Ring> rings = polygon.rings;
    for (PolygonFace::Ring& ring : rings) {
      for (std::uint32_t& v : ring) v += first;
    }
    builder.add_face(builder.patch(polygon.patch), material, std::move(rings));
  }
  return builder.build();
}

// One ring through all of the points.
inline PolygonFace polygon(std::vector<Vec3> vertices, std::string patch = "face") {
  PolygonFace::Ring ring(vertices.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<std::uint32_t>(i);
  return {std::move(vertices), {std::move(ring)}, std::move(patch)};
}

inline std::vector<FaceId> every_face(const Scene& scene) {
  std::vector<FaceId> faces;
  for (std::size_t i = 0; i < scene.faces().size(); ++i) faces.push_back(FaceId(static_cast<std::uint32_t>(i)));
  return faces;
}

inline std::vector<Receiver> samples_of(const Scene& scene, std::uint64_t count, std::uint64_t seed = 1) {
  return sample_receivers(scene, every_face(scene), count, seed);
}

inline std::vector<std::string> ids_of(const std::vector<Receiver>& receivers) {
  std::vector<std::string> ids;
  for (const Receiver& receiver : receivers) ids.push_back(receiver.id);
  return ids;
}

inline bool all_differ(std::vector<std::string> ids) {
  std::sort(ids.begin(), ids.end());
  return std::adjacent_find(ids.begin(), ids.end()) == ids.end();
}

// A square of side 3 with a hole: the square in its middle is missing.
inline PolygonFace window_frame() {
  return {{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}},
          {{0, 1, 2, 3}, {4, 5, 6, 7}}};
}

// Three unit squares.
inline PolygonFace letter_l() { return polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}); }

}  // namespace exactff::validation
