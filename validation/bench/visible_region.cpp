#include "bench/visible_region.h"

#include <map>

#include "exact/source_planes.h"
#include "sampled/vec.h"
#include "visibility/visible_boundary.h"
#include "visibility/visible_edges.h"

namespace exactff::bench {

using sampled::operator+;
using sampled::operator*;

namespace {

template <class Take>
void for_every_plane(const BenchScene& s, Engine engine, const Take& take) {
  const visibility::View view(s.scene, s.receiver);
  for (const visibility::SourcePlane& plane : s.source.planes().planes) {
    take(find_visible_boundary(view, plane, {.engine = engine}));
  }
}

// The result of the edge engine, in its doubles.
void append(visibility::VisibleEdges& engine, std::vector<DoubleEdge>& edges) {
  const visibility::Outlines& outlines = engine.outlines();
  const auto direction = [&](visibility::CornerId corner) {
    const kernel::Approx3& t = outlines.corner(corner).t;
    return Vec3{t.x, t.y, t.z};
  };
  for (const visibility::VisibleEdges::Part& part : engine.parts()) {
    const Vec3 a = direction(outlines.edge(part.edge).a), b = direction(outlines.edge(part.edge).b);
    const auto point = [&](double m) { return a * (1.0 - m) + b * m; };
    edges.push_back({point(part.begin.value), point(part.end.value)});
  }
}

}  // namespace

const std::vector<visibility::BoundaryPiece>& exact_boundary(const BenchScene& s) {
  static std::map<const BenchScene*, std::vector<visibility::BoundaryPiece>> known;
  const auto [entry, is_new] = known.try_emplace(&s);
  std::vector<visibility::BoundaryPiece>& boundary = entry->second;
  if (!is_new) return boundary;
  for_every_plane(s, Engine::kEdges, [&](const visibility::PlaneVisibility& seen) {
    if (seen.edges == nullptr) return;
    for (const auto& part : seen.edges->parts()) boundary.push_back(seen.edges->exact(part));
  });
  return boundary;
}

void find_double_boundary(const BenchScene& s, Engine engine, std::vector<DoubleEdge>& edges) {
  edges.clear();
  for_every_plane(s, engine, [&](const visibility::PlaneVisibility& seen) {
    for (const visibility::BoundaryPiece& piece : seen.boundary) edges.push_back(to_double(piece));
    if (seen.edges != nullptr) append(*seen.edges, edges);
  });
}

double double_form_factor(const BenchScene& s, Engine engine) {
  double sum = 0.0;
  std::vector<DoubleEdge> edges;
  for_every_plane(s, engine, [&](const visibility::PlaneVisibility& seen) {
    edges.clear();
    for (const visibility::BoundaryPiece& piece : seen.boundary) edges.push_back(to_double(piece));
    sum += form_factor(edges, s.receiver.normal);
    if (seen.edges != nullptr) sum += form_factor(*seen.edges, s.receiver.normal);
  });
  return sum;
}

}  // namespace exactff::bench
