#!/usr/bin/env bash
# Computes a truth file of a million rows on the Cornell box in several ways: killed five times at random, on one
# thread, in four shards, and under MPI with one of four processes killed. Every way must give the bytes of an
# undisturbed run, and no row that was in the journal may be computed again. Prints what it measured.
# Usage: truth_at_scale.sh [SIDE [SEED]], SIDE x SIDE receivers (1000), after validation/test.sh has built everything.
# EXACTFF_BUILD names another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=${EXACTFF_BUILD:-$top/build}/exactff
side=${1:-1000}
RANDOM=${2:-1}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# Arrays, not functions: a function in the background runs in its own shell, and signals would reach only that shell.
truth=("$program" truth "$top/data/scenes/cornell_box.obj" --on floor --grid "${side}x$side")
mpi=(mpirun --oversubscribe -n 4 "${truth[@]}")
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

now_ms() { date +%s%3N; }
size_of() { stat -c %s "$1" 2> /dev/null || echo 0; }
rows_in() { # JOURNAL: rows of its blocks, the last of which may be torn
  grep -a '^# rows ' "$1" | sed -E 's/.*\+([0-9]+),.*/\1/' | awk '{ sum += $1 } END { print sum + 0 }'
}
require_same() {
  cmp whole.csv "$1" || { echo "FAILED: $1 differs from the undisturbed run"; exit 1; }
  [ ! -e "$1.part" ] && [ ! -e "$1.whole" ] || { echo "FAILED: files were left beside $1"; exit 1; }
}

echo "Undisturbed, all cores:"
start=$(now_ms)
"${truth[@]}" -o whole.csv > log &
pid=$!
peak=0
while [ -r "/proc/$pid/status" ]; do
  now=$(awk '/VmHWM/ { print $2 }' "/proc/$pid/status" 2> /dev/null || true)
  [ -n "$now" ] && peak=$now
  sleep 0.05
done
wait "$pid"
took=$(($(now_ms) - start))
sed 's/^/  /' log
echo "  $took ms in all, $((peak / 1024)) MB of memory, $(size_of whole.csv) bytes"

computing=$(sed -nE 's/^computed them in ([0-9.]+) s,.*/\1/p' log | awk '{ print int(1000 * $1) }')
computing=${computing:-$((took / 2))}

echo "Killed (SIGKILL) five times at random:"
for kill in 1 2 3 4 5; do
  before=$(size_of killed.csv.part)
  "${truth[@]}" -o killed.csv --resume > log 2>&1 &
  pid=$!
  while [ "$(size_of killed.csv.part)" -le "$before" ] && [ -d "/proc/$pid" ]; do sleep 0.01; done
  delay=$((RANDOM % (computing / 6)))
  sleep "$(printf '%d.%03d' $((delay / 1000)) $((delay % 1000)))"
  kill -9 "$pid" || { echo "FAILED: the run ended before it could be killed"; exit 1; }
  wait "$pid" 2> /dev/null || true
  echo "  $kill: $(rows_in killed.csv.part) rows in the journal"
done
"${truth[@]}" -o killed.csv --resume | sed 's/^/  /'
require_same killed.csv
echo "  the same bytes"

echo "One thread:"
"${truth[@]}" -o one.csv --threads 1 | sed -n 's/^computed/  computed/p'
require_same one.csv
echo "  the same bytes"
rm one.csv killed.csv

echo "Four shards, merged:"
for shard in 1 2 3 4; do "${truth[@]}" -o "shard.$shard.csv" --shard "$shard/4" > /dev/null; done
"$program" merge shard.3.csv shard.1.csv shard.4.csv shard.2.csv -o merged.csv | sed -n 's/^Truth file/  Truth file/p'
require_same merged.csv
echo "  the same bytes"
rm shard.* merged.csv

if [ ! -e "$(dirname "$program")/exactff_mpi.so" ] || ! command -v mpirun > /dev/null; then
  echo "MPI is not installed: skipping the rest."
  exit 0
fi

echo "Four processes under MPI:"
"${mpi[@]}" -o mpi.csv | sed -n 's/^computed/  computed/p'
require_same mpi.csv
echo "  the same bytes"

echo "Four processes under MPI, one killed:"
"${mpi[@]}" -o mpi_killed.csv > log 2>&1 &
pid=$!
while [ "$(size_of mpi_killed.csv.part)" -lt $(($(size_of whole.csv) / 10)) ]; do sleep 0.02; done
sleep "0.$((RANDOM % 900 + 100))"
rank=$((RANDOM % 4))
mapfile -t ranks < <(tr ' ' '\n' < "/proc/$pid/task/$pid/children" | sed '/^$/d')
before=$(rows_in mpi_killed.csv.part)
kill -9 "${ranks[$rank]}"
wait "$pid" && { echo "FAILED: mpirun reported success although a process was killed"; exit 1; }
after=$(rows_in mpi_killed.csv.part)
echo "  rank $rank killed with $before rows in the journal; $after when all had ended"
"${truth[@]}" -o mpi_killed.csv --resume > log
sed 's/^/  /' log
require_same mpi_killed.csv
computed=$(sed -nE 's/^computed ([0-9]+) rows? of them.*/\1/p' log)
[ "$((side * side - computed))" -ge "$before" ] || { echo "FAILED: finished rows were lost"; exit 1; }
echo "  the same bytes, nothing finished was lost"
