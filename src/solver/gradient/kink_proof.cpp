#include "gradient/kink_proof.h"

namespace exactff::gradient {

using visibility::EdgeId;
using visibility::Outlines;
using visibility::PieceClip;
using visibility::PlaneQuery;
using visibility::Silhouettes;
using visibility::View;

bool KinkProof::excludes_kinks(const PlaneQuery& query) {
  if (query.request.engine == Engine::kBoolean) return false;
  return searches_silhouettes(query) && by_silhouettes(query);
}

bool KinkProof::by_silhouettes(const PlaneQuery& query) {
  const std::size_t sources = PieceClip(query, outlines_, memory_.clip).add_source().count;
  if (sources == 0) return true;
  Silhouettes silhouettes(query, outlines_, memory_);
  PlaneRecord uncounted;
  silhouettes.gather(sources, uncounted);
  if (silhouettes.some_edge_on()) return false;
  groups_.clear();
  for (EdgeId id = 0; id < outlines_.edges().size(); ++id) groups_.add(outlines_, id);
  return lie_apart_or_on_one_line(query.view, outlines_);
}

// Whether edges that lie in one plane through x lie on one line in space, or on the horizon.
bool KinkProof::lie_apart_or_on_one_line(const View& view, Outlines& outlines) {
  const auto is_on_horizon = [&](const Outlines::Edge& edge) {
    const kernel::ExactVec3 n = view.normal().exact;
    return kernel::sign(dot(n, outlines.exact(edge.a))) == 0 && kernel::sign(dot(n, outlines.exact(edge.b))) == 0;
  };
  return groups_.for_each(outlines, [&](std::span<const EdgeId> group) {
    return are_on_one_line(outlines, group) || is_on_horizon(outlines.edge(group.front()));
  });
}

}  // namespace exactff::gradient
