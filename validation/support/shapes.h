// Faces of small scenes, by their corners.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

inline void add(generate::PlainScene& scene, std::string_view patch, std::vector<Vec3> corners, bool turned = false) {
  if (turned) std::ranges::reverse(corners);
  scene.add_ring(scene.patch(patch), corners);
}

// A patch with a material of its own.
inline void add(generate::PlainScene& scene, const std::string& patch, const std::vector<Vec3>& corners, const Rgb& kd,
                const Rgb& ke) {
  add(scene, patch, corners);
  scene.patch(patch).material = "of " + patch;
  scene.materials.push_back({.name = "of " + patch, .reflectance = kd, .radiosity = ke});
}

using Side = std::pair<std::string, std::vector<Vec3>>;

// The sides of a room, whose fronts look inward.
inline std::array<Side, 6> sides_of(const Vec3& a, const Vec3& b) {
  return {Side{"floor", {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}}},
          Side{"left", {{a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z}}},
          Side{"right", {{b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}}},
          Side{"near", {{a.x, a.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z}}},
          Side{"far", {{a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}},
          Side{"ceiling", {{a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}}}};
}

enum class Fronts { kOutside, kInside };

// A box as one patch, with or without its bottom.
inline void add_box(generate::PlainScene& scene, std::string_view patch, const Vec3& low, const Vec3& high,
                    Fronts fronts = Fronts::kOutside, bool has_bottom = true) {
  for (const auto& [side, corners] : sides_of(low, high)) {
    if (has_bottom || side != "floor") add(scene, patch, corners, fronts == Fronts::kOutside);
  }
}

inline std::vector<Selection> all_patches(const Scene& scene) {
  std::vector<Selection> patches;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) patches.push_back({PatchId(i), {}, scene.id()});
  return patches;
}

}  // namespace exactff::validation

namespace exactff {

using generate::PlainScene;
using generate::Random;
using validation::add;
using validation::add_box;
using validation::all_patches;
using validation::Fronts;
using validation::sides_of;

}  // namespace exactff
