#!/usr/bin/env bash
# Times the exact form factor on generated scenes: median wall time of whole runs of `exactff point`, including reading
# the scene, and peak memory. Usage: time_exact.sh [RUNS], after validation/test.sh has built everything. EXACTFF_BUILD
# names another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
runs=${1:-5}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

printf '%-10s %8s %10s %10s   %s\n' family n 'median s' 'memory MB' 'form factor'
for spec in 'soup 1000' 'karkanis 1000' 'blinds 1000' 'mesh 1000' 'soup 10000' 'soup 100000' 'mesh 100000'; do
  read -r family n <<< "$spec"
  "$build/exactff_generate" "$family" --n "$n" -o "$folder/scene.obj"
  for ((run = 0; run < runs; ++run)); do
    /usr/bin/env bash -c 'TIMEFORMAT=%R; time "$0" point "$1" --at 0 0 0 --normal 0 0 1 --source source --plain > "$2"' \
      "$build/exactff" "$folder/scene.obj" "$folder/value" 2>> "$folder/times"
  done
  median=$(sort -n "$folder/times" | sed -n "$(((runs + 1) / 2))p")
  rm "$folder/times"
  # The peak memory of one more run, as the kernel counts it.
  "$build/exactff" point "$folder/scene.obj" --at 0 0 0 --normal 0 0 1 --source source --plain > /dev/null &
  pid=$!
  peak=0
  while [ -r "/proc/$pid/status" ]; do
    now=$(awk '/VmHWM/ { print $2 }' "/proc/$pid/status" 2> /dev/null || true)
    [ -n "$now" ] && peak=$now
    sleep 0.02
  done
  wait "$pid"
  printf '%-10s %8s %10s %10s   %s\n' "$family" "$n" "$median" "$((peak / 1024))" "$(cat "$folder/value")"
done
