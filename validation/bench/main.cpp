// exactff_bench: accepts Google Benchmark's options, above all --benchmark_filter=REGEX.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>

#include "bench/scenes.h"

int main(int argc, char** argv) try {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  exactff::bench::add_engines();
  exactff::bench::add_rays();
  exactff::bench::add_view();
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 2;  // 0: the filter matches nothing
} catch (const std::exception& error) {
  std::fprintf(stderr, "exactff_bench: %s\n", error.what());
  return 4;
}
