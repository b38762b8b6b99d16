#!/usr/bin/env bash
# Times view factors from patch to patch on one thread: processor seconds of whole runs of `exactff matrix`, medians.
# Usage: time_view_factors.sh [RUNS] (3), after validation/test.sh has built everything. EXACTFF_BUILD names another
# build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
runs=${1:-3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

cat > plate.obj <<'OBJ'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 0 1 1
v 1 1 1
v 1 0 1
v 0.25 0.25 0.5
v 0.75 0.25 0.5
v 0.75 0.75 0.5
v 0.25 0.75 0.5
g below
f 1 2 3 4
g above
f 5 6 7 8
g plate
f 9 10 11 12
OBJ
"$build/exactff_generate" cube-room --n 1 -o room.obj
"$build/exactff_generate" cube-room --n 4 -o cube.obj
"$build/exactff_generate" three-cube-room --n 8 -o cubes.obj

walls() { # MOVED: x y z of each corner of each face of a floor plan of straight walls, 3 m high; moved by up to this much
  awk -v moved="$1" '
    function unit() { state = (state * 16807) % 2147483647; return state / 2147483647 }
    function corner(x, y, z) {
      print "v", x + moved * (2 * unit() - 1), y + moved * (2 * unit() - 1), z + moved * (2 * unit() - 1)
      ++corners
    }
    function face(name, count,   i) {
      printf "g %s\nf", name
      for (i = count - 1; i >= 0; --i) printf " %d", corners - i
      print ""
    }
    function rectangle(name, x, y, to_x, to_y,   up) { # floor and ceiling
      for (up = 0; up < 2; ++up) {
        corner(x, y, 3 * up)
        if (up) { corner(x, to_y, 3); corner(to_x, to_y, 3); corner(to_x, y, 3) }
        else { corner(to_x, y, 0); corner(to_x, to_y, 0); corner(x, to_y, 0) }
        face((up ? "ceiling" : "floor") name, 4)
      }
    }
    BEGIN { CONVFMT = OFMT = "%.17g"; state = 7 }
    NF == 4 { rectangle(NR, $1, $2, $3, $4) }
    NF == 2 { ++n; x[n] = $1; y[n] = $2 }
    END {
      for (i = 1; i <= n; ++i) {
        k = i % n + 1
        corner(x[i], y[i], 0); corner(x[i], y[i], 3); corner(x[k], y[k], 3); corner(x[k], y[k], 0)
        face("wall" i, 4)
      }
    }'
}
box_room() { printf '%s\n' '0 0 4 5' '0 0' '4 0' '4 5' '0 5' | walls "$1"; }
zone() { printf '%s\n' '0 0 12 6' '6 6 12 12' '0 0' '12 0' '12 12' '6 12' '6 6' '0 6' | walls "$1"; }

TIMEFORMAT='%U'
sum_of() { # COLUMN: of the pairs in factors.csv
  awk -F, -v c="$1" '!/^#/ && !(($2 "," $1) in seen) { seen[$1 "," $2]; sum += $c } END { print sum + 0 }' factors.csv
}

row() { # TEXT SCENE OPTION...: a row of the table
  local text=$1 run
  for ((run = 0; run < runs; ++run)); do
    { time "$build/exactff" matrix "${@:2}" --threads 1 --force -o factors.csv > log 2>&1 || [ $? -eq 3 ]; } 2>> times
  done
  printf '| %s | %s | %s | %s |\n' "$text" "$(sum_of 11)" "$(sum_of 12)" "$(sort -n times | sed -n "$(((runs + 1) / 2))p")"
  rm times
}

echo '| scene, accuracy, claim | cells | of these event cells | seconds |'
echo '|---|---|---|---|'
row 'plate between squares, 1e-10, certified' plate.obj --from below --to above --accuracy 1e-10 --certify
row 'room with a tilted cube, 12 patches, 1e-6, certified' room.obj --certify
row 'the same, estimated' room.obj
row '102 patches, the cube tilted, 1e-6, certified' cube.obj --certify
row 'the same, estimated' cube.obj
row '402 patches, three cubes, 1e-6, estimated' cubes.obj
for moved in 0 1e-12 1e-9 1e-6 1e-3; do
  box_room "$moved" > moved.obj
  row "box room of 6 faces, corners moved by $moved, 1e-3, estimated" moved.obj --accuracy 1e-3
  row 'the same with backs and the sky' moved.obj --accuracy 1e-3 --backs --to all,sky
done
for moved in 0 1e-12 1e-9 1e-5; do
  zone "$moved" > moved.obj
  row "L-shaped zone of 10 faces, corners moved by $moved, 1e-3, estimated" moved.obj --accuracy 1e-3
  row 'the same with backs and the sky' moved.obj --accuracy 1e-3 --backs --to all,sky
done
for accuracy in 1e-4 1e-5; do row "the last one, $accuracy, estimated" moved.obj --accuracy "$accuracy"; done
