#include "bench/visible_region.h"

#include <map>

#include "adaptive/sub_patch.h"
#include "exact/source_planes.h"
#include "visibility/visible_boundary.h"

namespace exactff::bench {

using adaptive::operator+;
using adaptive::operator*;

namespace {

template <class Take>
void for_every_plane(const BenchScene& s, Engine engine, const Take& take) {
  static visibility::EdgeWorkspace workspace;
  const visibility::View view(s.scene, s.receiver);
  for (const visibility::SourcePlane& plane : ExactSourceInside::planes(s.source).planes) {
    take(find_visible_boundary(view, plane, {.engine = engine}, workspace));
  }
}

void append(const visibility::VisibleBoundary& boundary, std::vector<DoubleEdge>& edges) {
  boundary.for_each_piece([&](const visibility::BoundaryPiece& piece) { edges.push_back(to_double(piece)); });
}

// The result of the edge engine, in its doubles.
void append(visibility::EdgeCovers& engine, std::vector<DoubleEdge>& edges) {
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
    seen.boundary.for_each_piece([&](const visibility::BoundaryPiece& piece) { boundary.push_back(piece); });
  });
  return boundary;
}

void find_double_boundary(const BenchScene& s, Engine engine, std::vector<DoubleEdge>& edges) {
  edges.clear();
  for_every_plane(s, engine, [&](const visibility::PlaneVisibility& seen) {
    if (seen.boundary.edges() == nullptr) {
      append(seen.boundary, edges);
    } else {
      append(*seen.boundary.edges(), edges);
    }
  });
}

double double_form_factor(const BenchScene& s, Engine engine) {
  double sum = 0.0;
  std::vector<DoubleEdge> edges;
  for_every_plane(s, engine, [&](const visibility::PlaneVisibility& seen) {
    if (seen.boundary.edges() == nullptr) {
      edges.clear();
      append(seen.boundary, edges);
      sum += form_factor(edges, s.receiver.normal);
    } else {
      sum += form_factor(*seen.boundary.edges(), s.receiver.normal);
    }
  });
  return sum;
}

}  // namespace exactff::bench
