// A source prepared for the recursion: its faces as triangles and quadrilaterals, and which pieces lie in their planes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adaptive/sub_patch.h"
#include "exactff/scene.h"

namespace exactff::adaptive {

struct SourcePlane {
  std::array<Vec3, 3> frame;            // scaled; counter-clockwise seen from the front
  std::array<Vec3, 3> exact_frame;      // not scaled
  std::vector<std::uint32_t> coplanar;  // pieces exactly in this plane, ascending
};

struct SourceRoot {
  std::array<Vec3, 4> corners;  // scaled
  int corner_count = 0;
  std::uint32_t plane = 0;
  std::uint32_t piece = 0;
};

struct SourceRoots {
  std::vector<SourcePlane> planes;
  std::vector<SourceRoot> roots;
};

// `points` are the scene's vertices scaled to about 1. A piece with three or four corners is a root, any other a fan of
// triangles. A piece with the same corners as an earlier one of the source is left out; other overlaps of coplanar
// faces are not detected.
[[nodiscard]] SourceRoots make_source_roots(const Scene& scene, const std::vector<Vec3>& points,
                                            const Selection& selection);

}  // namespace exactff::adaptive
