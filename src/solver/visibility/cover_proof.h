// Step 5 of the exact method, for the edge engine: a few occluders that hide all of the source together. That they do
// is proved by step 6 for their own edges and the source's alone (visible_edges.h).
#pragma once

#include <optional>

#include "visibility/edge_workspace.h"
#include "visibility/plane_visibility.h"

namespace exactff::visibility {

// Whether some of the candidates hide all. Requires the outlines of all candidates in the search, the source's first.
// If the request allows it, remembers them.
[[nodiscard]] bool hidden_by_few(const PlaneQuery& query, std::size_t source_count, EdgeWorkspace& workspace);

// The record, if the pieces that hid the plane from the receiver before hide it again, and no piece does so alone. Else
// forgets them. A narrow query of the tree decides whether one piece hides all, so no candidates are gathered.
// The attempt has memory of its own: the search does not change.
[[nodiscard]] std::optional<PlaneRecord> hidden_as_before(const PlaneQuery& query, EdgeWorkspace& workspace);

}  // namespace exactff::visibility
