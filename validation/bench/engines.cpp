// Both engines: the certified value end to end, and the visible boundary alone.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <string>
#include <utility>

#include "bench/scenes.h"
#include "exact/source_planes.h"
#include "visibility/visible_boundary.h"

namespace exactff::bench {

namespace {

void certified(benchmark::State& state, const BenchScene& s, Engine engine) {
  FormFactor result;
  for (auto _ : state) {
    exact_form_factor(s.scene, s.receiver, s.source, {.engine = engine}, result);
    keep(result.value);
  }
  if (result.status == Status::kNotCertified) state.SkipWithError("the value is not certified");
  state.counters["value"] = result.value;
}

void visible(benchmark::State& state, const BenchScene& s, Engine engine) {
  visibility::EdgeWorkspace workspace;
  const visibility::View view(s.scene, s.receiver);
  std::size_t planes_seen = 0;
  for (auto _ : state) {
    for (const visibility::SourcePlane& plane : ExactSourceInside::planes(s.source).planes) {
      planes_seen += find_visible_boundary(view, plane, {.engine = engine}, workspace).record.candidates > 0 ? 1U : 0U;
    }
  }
  keep(planes_seen);
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
  add_maker_for_every_scene("memory", memory);
}

}  // namespace exactff::bench
