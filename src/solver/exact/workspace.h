// The memory behind a Workspace.
#pragma once

#include <memory>

#include "exact/region.h"
#include "exactff/exact.h"
#include "visibility/edge_workspace.h"

namespace exactff {

struct Workspace::Memory {
  // Memory of a module that builds upon this one.
  struct Guest {
    virtual ~Guest() = default;
  };

  visibility::EdgeWorkspace edges;
  exact::Region region;         // the last one
  std::unique_ptr<Guest> view;  // of the whole view
};

struct WorkspaceInside {
  using Memory = Workspace::Memory;
  [[nodiscard]] static Memory& memory(Workspace& workspace) { return workspace.memory(); }
};

}  // namespace exactff
