// What a scene contains, patch by patch: the rows of `exactff info`. For people who look at a scene; estimates.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

struct PatchSummary {
  std::string name;
  std::size_t face_count = 0;         // including ignored faces
  double area = 0.0;                  // in the square of the scene's unit of length; finite
  std::optional<Vec3> front;          // mean unit normal; empty if the faces have different directions
  std::vector<MaterialId> materials;  // in the order of first use
  bool emits = false;
};

[[nodiscard]] PatchSummary summarise(const Scene& scene, PatchId id);
// Of every patch, in the order of the scene.
[[nodiscard]] std::vector<PatchSummary> summarise(const Scene& scene);
// The sum of the patches' areas; finite.
[[nodiscard]] double total_area(const std::vector<PatchSummary>& rows);
// Zero stays zero. Nothing overflows or underflows.
[[nodiscard]] Vec3 unit_vector(const Vec3& v);

}  // namespace exactff
