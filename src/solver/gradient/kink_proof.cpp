#include "gradient/kink_proof.h"

namespace exactff::gradient {

using visibility::EdgeId;
using visibility::Outlines;
using visibility::PieceClip;
using visibility::PlaneQuery;
using visibility::Silhouettes;
using visibility::View;

namespace {

bool is_on_horizon(const View& view, Outlines& outlines, EdgeId id) {
  const Outlines::Edge edge = outlines.edge(id);
  const kernel::ExactVec3 n = view.normal().exact;
  return kernel::sign(dot(n, outlines.exact(edge.a))) == 0 && kernel::sign(dot(n, outlines.exact(edge.b))) == 0;
}

}  // namespace

bool KinkProof::excludes_kinks(const PlaneQuery& query) {
  if (query.request.engine == Engine::kBoolean || !searches_silhouettes(query)) return false;
  const std::size_t sources = PieceClip(query, outlines_, memory_.clip).add_source().count;
  if (sources == 0) return true;
  Silhouettes silhouettes(query, outlines_, memory_);
  PlaneRecord uncounted;
  silhouettes.gather(sources, uncounted);
  if (silhouettes.some_edge_on()) return false;
  groups_.clear();
  for (EdgeId id = 0; id < outlines_.edges().size(); ++id) groups_.add(outlines_, id);
  return groups_.for_each(outlines_, [&](std::span<const EdgeId> group) {
    return are_on_one_line(outlines_, group) || is_on_horizon(query.view, outlines_, group.front());
  });
}

}  // namespace exactff::gradient
