// Both engines: the certified value end to end, and the visible boundary with Eq. (4) in double over it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/scenes.h"
#include "bench/subjects.h"
#include "bench/visible_region.h"
#include "scene/shaft_tree.h"

namespace exactff::bench {

namespace {

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
}

}  // namespace exactff::bench
