// The memory behind a Workspace.
#pragma once

#include <memory>
#include <vector>

#include "exact/quick_tier.h"
#include "exactff/exact.h"
#include "gradient/gradient.h"
#include "gradient/vertex_gradient.h"
#include "visibility/edge_workspace.h"

namespace exactff {

struct Workspace::Memory {
  // Memory of a module that builds upon this one.
  struct Guest {
    virtual ~Guest() = default;
  };

  visibility::EdgeWorkspace edges;
  exact::QuickTier quick;
  std::unique_ptr<gradient::PointGradient> gradient;   // made where one is asked for
  std::unique_ptr<gradient::VertexGradient> vertices;  // likewise
  // Sources differ in their number of planes: records that one source does not need are kept for the next one.
  std::vector<PlaneRecord> spare_records;
  std::unique_ptr<Guest> view;  // of the whole view
};

struct WorkspaceInside {
  using Memory = Workspace::Memory;
  [[nodiscard]] static Memory& memory(Workspace& workspace) { return workspace.memory(); }
};

}  // namespace exactff
