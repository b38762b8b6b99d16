// The memory behind a Workspace.
#pragma once

#include <vector>

#include "exact/quick_tier.h"
#include "exactff/exact.h"
#include "visibility/edge_walk.h"

namespace exactff {

struct Workspace::Memory {
  visibility::EdgeWorkspace edges;
  exact::QuickTier quick;
  // Sources differ in their number of planes: records that one source does not need are kept for the next one.
  std::vector<PlaneRecord> spare_records;
};

}  // namespace exactff
