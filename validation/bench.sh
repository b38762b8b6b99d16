#!/usr/bin/env bash
# bench.sh [--quick]: builds and runs the benchmarks, then prints the tables of validation/measurements.md. Times are CPU
# times: medians of repetitions in random order within one run. The results are kept as JSON in build/results. Google
# Benchmark warns about a debug build: this is about Debian's package, not about exactff. After test.sh, only the
# benchmarks are compiled. Takes about ten minutes on an idle machine; with --quick (smaller scenes, fewer repetitions)
# less than two.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
folder=build
scenes=(sparse blinds mesh dense deep tiles lattice near)
sizes=(100 1000 10000 100000)
repetitions=7
seconds=0.1  # a repetition, at least
quick=false
case "${1:-}" in
  --quick) quick=true sizes=(100 1000 10000) repetitions=3 seconds=0.05 ;;
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

# largest SCENE
largest() { if [ "$1" = sparse ] && ! $quick; then echo 1000000; else echo "${sizes[-1]}"; fi }

rm -rf "$folder/results"
mkdir -p "$folder/results"
measure ratios '^(visible|certified|tree|limit|rays)/.*/1000$'
measure cornell '^cornell/'
measure view "^view/.*/($(IFS='|'; echo "${sizes[*]:1}")|[1-9]00|1600)\$" --benchmark_repetitions=3
measure covers '^covers/' --benchmark_repetitions=3
for scene in "${scenes[@]}"; do
  measure "growth_$scene" "^certified/edges/$scene/($(IFS='|'; echo "${sizes[*]}"))\$" --benchmark_repetitions=3
  measure "memory_$scene" "^memory/$scene/$(largest "$scene")/" --benchmark_repetitions=1
done
if ! $quick; then
  measure growth_million '^certified/edges/sparse/1000000$' --benchmark_repetitions=1
  measure growth_boolean '^certified/boolean/.*/(100|1000|10000)$' --benchmark_repetitions=3
fi
python3 -B validation/bench/tables.py "$folder"/results/*.json
