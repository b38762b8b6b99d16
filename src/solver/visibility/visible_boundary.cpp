#include "visibility/visible_boundary.h"

#include "kernel/expect.h"
#include "visibility/boolean_walk.h"
#include "visibility/edge_walk.h"

namespace exactff::visibility {

PlaneVisibility find_visible_boundary(const View& view, const SourcePlane& plane, const BoundaryRequest& request,
                                      EdgeWorkspace& workspace) {
  EXACTFF_EXPECT(!(view.n == Vec3{}));
  if (request.engine == Engine::kBoolean) return find_by_booleans(view, plane, request);
  std::optional<PlaneVisibility> found = find_by_edges(view, plane, request, workspace);
  if (!found) return find_by_booleans(view, plane, request);
  if (request.list_cutters) found->cutters = find_cutters(view, plane, request);
  return std::move(*found);
}

}  // namespace exactff::visibility
