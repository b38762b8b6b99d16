// The peak memory of one certified value, in a separate process: the scene, then the evaluation.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "bench/scenes.h"
#include "bench/subjects.h"

namespace exactff::bench {

namespace {

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

void add_memory() { add_maker_for_every_scene("memory", memory); }

}  // namespace exactff::bench
