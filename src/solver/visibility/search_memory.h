// Memory of the parts of a search, reused from one plane to the next.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/shaft_tree.h"
#include "visibility/outlines.h"
#include "visibility/run_marks.h"
#include "visibility/side_planes.h"

namespace exactff::visibility {

struct ClipMemory {
  std::vector<CornerId> corners, ring;
  std::vector<int> depths;  // of the corners: on which side of the plane that may cut them
};

struct ShaftMemory {
  std::vector<HalfSpace> half_spaces;
  HalfSpaceGroups groups;  // the same
  std::vector<SidePlane> side_planes;
};

// By closed surface.
struct BacksMemory {
  RunMarks has_own_piece;  // by surface, as `decided`
  RunMarks decided;
  std::vector<std::uint8_t> left_out;  // where it is decided
};

}  // namespace exactff::visibility
