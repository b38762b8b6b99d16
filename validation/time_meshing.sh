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
  # Exit code 3: some view factors are wider than the accuracy.
  time "$exactff" radiosity "$scene" --divide "$(awk "BEGIN { print 559.2 / $parts }")" --accuracy 1e-3 --budget 100 \
    -o "cells$parts.csv" > /dev/null 2>&1 || [[ $? == 3 ]]
  grep '^[^#]' "cells$parts.csv" | tail -n +2 | cut -d, -f1 | sort -u | wc -l
  time "$exactff" render "$scene" --radiosity "cells$parts.csv" "${camera[@]}" --double "$parts.npy" -o image.png \
    > /dev/null 2>&1
  /usr/bin/python3 - "$finest.npy" "$parts.npy" << 'PYTHON'
import sys, numpy
reference, picture = (numpy.load(file) for file in sys.argv[1:])
lit = (reference.max(axis=-1) > 0) & (reference[..., 0] != 17)  # neither nothing nor the lamp, whose light is given
errors = numpy.abs(picture - reference)[lit].max(axis=1) / reference[lit].max()
print("errors over the brightest pixel: RMS {:.2g} %, 99 % {:.2g} %, worst {:.2g} %".format(
    *(100 * e for e in (numpy.sqrt((errors**2).mean()), numpy.quantile(errors, 0.99), errors.max()))))
PYTHON
done
