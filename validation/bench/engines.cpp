// Both engines: the certified value end to end, and the visible boundary with Eq. (4) in double over it.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "adaptive/sub_patch.h"
#include "bench/double_contour.h"
#include "bench/scenes.h"
#include "bench/subjects.h"
#include "exact/source_planes.h"
#include "scene/shaft_tree.h"
#include "visibility/visible_boundary.h"

namespace exactff::bench {

namespace {

using adaptive::operator+;
using adaptive::operator*;

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

void certified(benchmark::State& state, const BenchScene& s, Engine engine) {
  FormFactor result;
  for (auto _ : state) {
    exact_form_factor(s.scene, s.receiver, s.source, {.engine = engine}, result);
    keep(result.value);
  }
  if (result.status == Status::kNotCertified) state.SkipWithError("the value is not certified");
  const PlaneRecord& plane = result.planes.front();
  state.counters["value"] = result.value;
  state.counters["bits"] = result.precision_bits;
  state.counters["candidates"] = static_cast<double>(plane.candidates);
  state.counters["edges"] = static_cast<double>(plane.edges);
  state.counters["pairs"] = static_cast<double>(plane.pairs);
  state.counters["undecided_pairs"] = static_cast<double>(plane.undecided_pairs);
}

void visible(benchmark::State& state, const BenchScene& s, Engine engine) {
  double value = 0.0;
  for (auto _ : state) {
    value = double_form_factor(s, engine);
    keep(value);
  }
  state.counters["value"] = value;
  // The double contour has only rounding errors; a larger error would mean that something else was measured.
  if (std::abs(value - s.value()) > 1e-9) state.SkipWithError("the double contour is off");
}

Box box_of(const Scene& scene, const Piece& piece) {
  Box box{scene.vertices()[scene.corners(piece).front()], {}};
  box.high = box.low;
  for (const std::uint32_t corner : scene.corners(piece)) {
    const Vec3& p = scene.vertices()[corner];
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

// The bounding-volume tree: the exact method builds it once per scene, as ray tracing builds its structure.
void tree(benchmark::State& state, const BenchScene& s) {
  for (auto _ : state) {
    std::vector<Box> boxes;
    for (const Piece& piece : s.scene.pieces()) boxes.push_back(box_of(s.scene, piece));
    ShaftTree made(boxes);
    keep(made);
  }
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

// A lower limit for the time of any exact method: Eq. (4) in double over the visible edges, plus one read of every
// occluder.
void limit(benchmark::State& state, const BenchScene& s) {
  std::vector<DoubleEdge> edges;
  find_double_boundary(s, Engine::kEdges, edges);
  for (auto _ : state) {
    keep(read_all(s.scene));
    keep(form_factor(edges, s.receiver.normal));
  }
}

// The peak memory of one certified value, in a separate process: the scene, then the evaluation.
double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts in KiB
}

void memory(benchmark::State& state, const std::function<generate::PlainScene()>& make) {
  for (auto _ : state) {
    const BenchScene s(make());
    state.counters["scene_mib"] = peak_mib();
    keep(exact_form_factor(s.scene, s.receiver, s.source));
    state.counters["peak_mib"] = peak_mib();
  }
}

}  // namespace

void add_engines() {
  for (const auto& [engine, name] : {std::pair{Engine::kEdges, "edges"}, std::pair{Engine::kBoolean, "boolean"}}) {
    const auto with = [engine = engine](auto run) {
      return [run, engine](benchmark::State& state, const BenchScene& s) { run(state, s, engine); };
    };
    add_for_every_scene(std::string("certified/") + name, with(certified));
    add_for_every_scene(std::string("visible/") + name, with(visible));
  }
  add_for_every_scene("tree", tree);
  add_for_every_scene("limit", limit);
}

void add_memory() { add_maker_for_every_scene("memory", memory); }

}  // namespace exactff::bench
