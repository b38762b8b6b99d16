// The memory of the edge engine, reused from one plane to the next.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/panels.h"
#include "visibility/cover_memory.h"
#include "visibility/run_marks.h"
#include "visibility/search_memory.h"
#include "visibility/silhouette_walk.h"
#include "visibility/visible_edges.h"

namespace exactff::visibility {

// What a search for the visible parts of one plane works on. It depends on nothing that an earlier search left here.
struct EdgeSearch {
  VisibleEdges edges;
  ClipMemory clip;
  ShaftMemory shaft;
  BacksMemory backs;
  RunMarks seen;                        // panels
  std::vector<PanelId> outline_panels;  // of the occluders' outlines
};

struct EdgeWorkspace {
  EdgeSearch search;   // what it found remains valid until the next one
  EdgeSearch attempt;  // to hide the plane as before
  CoverMemory covers;
  SilhouetteWalk silhouettes;
};

}  // namespace exactff::visibility
