#!/usr/bin/env bash
# bench.sh [--quick]: builds and runs the benchmarks, then prints the tables of validation/measurements.md. Times are CPU
# times: medians of repetitions in random order within one run. The results are kept as JSON in build/results. Google
# Benchmark warns about a debug build: this is about Debian's package, not about exactff. After test.sh, only the
# benchmarks are compiled. Takes five minutes on an idle machine; with --quick (fewer repetitions, no scene of a million
# triangles) two.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
folder=build
repetitions=7
seconds=0.1  # a repetition, at least
quick=false
case "${1:-}" in
  --quick) quick=true repetitions=3 seconds=0.05 ;;
  '') ;;
  *) echo "usage: bench.sh [--quick]" >&2; exit 2 ;;
esac

validation/setup.sh libbenchmark-dev
validation/build_shared.sh -DEXACTFF_BENCH=ON -- exactff_bench

# measure NAME FILTER [OPTION...]: one run, into NAME.json; its printed output, which repeats that, goes into NAME.log.
measure() {
  echo "measuring $1" >&2
  "$folder/exactff_bench" --benchmark_filter="$2" --benchmark_out="$folder/results/$1.json" \
    --benchmark_repetitions="$repetitions" --benchmark_min_time="$seconds" --benchmark_enable_random_interleaving=true \
    --benchmark_report_aggregates_only=true "${@:3}" \
    > "$folder/results/$1.log" 2>&1 || { tail "$folder/results/$1.log" >&2; exit 1; }
  # The coefficient of variation of a count of 0 is written as NaN, which JSON does not allow.
  sed -i -E 's/: -?NaN(,?)$/: null\1/' "$folder/results/$1.json"
}

rm -rf "$folder/results"
mkdir -p "$folder/results"
measure ratios '^(visible|certified|rays)/.*/1000$'
measure view '^view/' --benchmark_repetitions=3
measure growth '^certified/edges/.*/(100|10000)$' --benchmark_repetitions=3
if ! $quick; then
  measure million '^certified/edges/sparse/1000000$' --benchmark_repetitions=1
  measure memory '^memory/sparse/1000000/' --benchmark_repetitions=1
fi
python3 -B validation/bench/tables.py "$folder"/results/*.json
