// The contour integral alone, over the boundary that the edge engine finds, and a lower limit for the time of any exact
// method: Eq. (4) in double over the visible edges, plus reading every occluder once.
#include <benchmark/benchmark.h>

#include <bit>
#include <string>
#include <vector>

#include "bench/scenes.h"
#include "bench/subjects.h"
#include "bench/visible_region.h"
#include "contour/contour.h"
#include "visibility/visible_boundary.h"

namespace exactff::bench {

namespace {

std::vector<DoubleEdge> double_boundary(const BenchScene& s) {
  std::vector<DoubleEdge> edges;
  find_double_boundary(s, Engine::kEdges, edges);
  return edges;
}

contour::ContourIntegral contour_of(const BenchScene& s, const std::vector<visibility::BoundaryPiece>& boundary) {
  contour::ContourIntegral contour(visibility::View(s.scene, s.receiver).normal().exact);
  for (const visibility::BoundaryPiece& piece : boundary) contour.add(piece);
  return contour;
}

void count_edges(benchmark::State& state, std::size_t edges) {
  state.counters["edges"] = static_cast<double>(edges);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(edges));
}

// The exact terms, which all precisions share.
void terms(benchmark::State& state, const BenchScene& s) {
  const auto& boundary = exact_boundary(s);
  for (auto _ : state) keep(contour_of(s, boundary));
  count_edges(state, boundary.size());
}

void balls(benchmark::State& state, const BenchScene& s, long bits) {
  const auto& boundary = exact_boundary(s);
  const contour::ContourIntegral contour = contour_of(s, boundary);
  for (auto _ : state) keep(contour.evaluate(bits));
  count_edges(state, boundary.size());
}

void doubles(benchmark::State& state, const BenchScene& s) {
  const std::vector<DoubleEdge> edges = double_boundary(s);
  for (auto _ : state) keep(form_factor(edges, s.receiver.normal));
  count_edges(state, edges.size());
}

// Reads every coordinate of every corner of every piece, as integers, so that no addition delays the reading.
std::uint64_t read_all(const Scene& scene) {
  std::uint64_t bits = 0;
  for (const Piece& piece : scene.pieces()) {
    for (const std::uint32_t corner : scene.corners(piece)) {
      const Vec3& v = scene.vertices()[corner];
      bits ^= std::bit_cast<std::uint64_t>(v.x) ^ std::bit_cast<std::uint64_t>(v.y) ^ std::bit_cast<std::uint64_t>(v.z);
    }
  }
  return bits;
}

void limit(benchmark::State& state, const BenchScene& s) {
  const std::vector<DoubleEdge> edges = double_boundary(s);
  for (auto _ : state) {
    keep(read_all(s.scene));
    keep(form_factor(edges, s.receiver.normal));
  }
  count_edges(state, edges.size());
}

}  // namespace

void add_contour() {
  add_for_every_scene("contour/terms", terms);
  for (const long bits : {96L, 128L, 256L}) {
    add_for_every_scene("contour/arb" + std::to_string(bits),
                        [bits](benchmark::State& state, const BenchScene& s) { balls(state, s, bits); });
  }
  add_for_every_scene("contour/double", doubles);
  add_for_every_scene("limit", limit);
}

}  // namespace exactff::bench
