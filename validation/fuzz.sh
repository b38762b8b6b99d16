#!/usr/bin/env bash
# Fuzzes every reader, the exact solver and the whole program.
#
#   fuzz.sh [SECONDS]  for each target, default 60
#
# Builds build/clang: Clang, AddressSanitizer, UndefinedBehaviorSanitizer and libFuzzer. EXACTFF_BUILD names another
# build folder. Each target starts from data/fuzz/TARGET and a fresh working corpus; fuzz_solver, fuzz_view and
# fuzz_factors share one. Two targets run at a time. Ends with a summary; the exit code is 1 if there is a finding. A
# finding of fuzz_solver is shrunk to a case that becomes a test when it is moved into data/regression.
#
# For the whole program there is no libFuzzer target: fuzz_program generates its own cases and keeps one of each kind of
# finding. EXACTFF_SEED, default 1, numbers them.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
seconds=${1:-60}
build=${EXACTFF_BUILD:-build/clang}
work=$build/fuzzing
findings=$build/findings

validation/setup.sh clang llvm
version=$(clang -dumpversion)
validation/setup.sh "libclang-rt-${version%%.*}-dev"  # the sanitizers
validation/build.sh "$build" -DCMAKE_CXX_COMPILER=clang++ -DEXACTFF_FUZZ=ON -DEXACTFF_WERROR=ON -DEXACTFF_QUICK_BUILD=ON \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"

rm -rf "$work"
mkdir -p "$work/temporary" "$findings"

run() {
  local target=$1 corpus=$1
  case "$target" in view | factors) corpus=solver ;; esac
  local corpora=("$work/$1" "data/fuzz/$corpus") options=(-max_total_time="$seconds" -max_len=4096 -timeout=60
    -rss_limit_mb=2048 -report_slow_units=60 -print_final_stats=1 -artifact_prefix="$findings/$1-")
  mkdir "$work/$target"
  rm -f "$findings/$target"-*
  TMPDIR=$work/temporary "$build/fuzz_$target" "${options[@]}" "${corpora[@]}" > "$work/$target.log" 2>&1 ||
    touch "$work/$target.failed"
}
export -f run
export seconds build work findings

targets=(solver view factors obj gltf ply stl off view3d receivers exr check)
run_program() {
  mkdir "$work/program"
  rm -rf "$findings"/program-*
  "$build/fuzz_program" --seconds "$seconds" --seed "${EXACTFF_SEED:-1}" --keep "$findings" > "$work/program.log" 2>&1 ||
    touch "$work/program.failed"
}
export -f run_program

echo "Fuzzing for $seconds s each: program ${targets[*]}"
printf '%s\n' program "${targets[@]}" | xargs -P 2 -I TARGET bash -c 'if [ TARGET = program ]; then run_program; else run TARGET; fi'

replay() {
  local target=$1 file
  for file in "$findings/$target"-*; do
    [ -e "$file" ] || continue
    echo "  replay: $build/fuzz_$target $file"
    [ "$target" != solver ] || "$build/exactff_minimise" -o "$findings" "$file" || true
  done
}

status=0
printf '%-14s %10s %10s %10s   %s\n' target runs coverage corpus result
for target in "${targets[@]}"; do
  log=$work/$target.log
  runs=$(awk '/^stat::number_of_executed_units/ { print $2 }' "$log")
  coverage=$(grep -o 'cov: [0-9]*' "$log" | tail -n 1 | cut -d ' ' -f 2 || true)
  result=clean
  [ ! -e "$work/$target.failed" ] || result="FINDING: see $log"
  printf '%-14s %10s %10s %10s   %s\n' "$target" "${runs:-?}" "${coverage:-?}" "$(ls "$work/$target" | wc -l)" "$result"
  if [ -e "$work/$target.failed" ]; then
    status=1
    replay "$target"
  fi
done
result=clean
if [ -e "$work/program.failed" ]; then
  result="FINDING: see $work/program.log"
  status=1
fi
printf '%-14s %10s %10s %10s   %s\n' program "$(awk '/cases of seed/ { print $1 }' "$work/program.log")" - - "$result"
grep -A 4 FINDING "$work/program.log" || true
exit "$status"
