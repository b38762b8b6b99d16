#!/usr/bin/env bash
# How good is one radiosity for each cell? Cuts the Cornell box into cells of 1/2, 1/4, ... of its longest side, and
# compares the picture that gathers their light by exact form factors with that of the finest cells. Prints the number
# of cells, the errors, and processor seconds of the radiosities and of the picture.
# Usage: time_meshing.sh [FINEST] (8), after validation/test.sh has built everything. EXACTFF_BUILD names another build
# folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
exactff=${EXACTFF_BUILD:-$top/build}/exactff
scene=$top/data/scenes/cornell_box.obj
finest=${1:-8}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

camera=(--eye 278 273 -800 --look 278 273 0 --fov 39.30764811610662 --size 64x64 --quantity radiosity)
TIMEFORMAT='%U s'
for ((parts = finest; parts > 1; parts /= 2)); do
  echo "--- cells of 1/$parts of the box"
  time "$exactff" radiosity "$scene" --divide "$(awk "BEGIN { print 559.2 / $parts }")" --accuracy 1e-3 --budget 100 \
    -o "cells$parts.csv" > /dev/null
  grep -cv '^#\|^patch' "cells$parts.csv"
  against=()
  if [[ -e finest.npy ]]; then against=(--against finest.npy); fi
  time "$exactff" render "$scene" --radiosity "cells$parts.csv" "${camera[@]}" "${against[@]}" --double "p$parts.npy" \
    -o "p$parts.png"
  if [[ ! -e finest.npy ]]; then mv "p$parts.npy" finest.npy; fi
done
