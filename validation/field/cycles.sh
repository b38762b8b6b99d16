#!/usr/bin/env bash
# cycles.sh [--bounces] [--quick]: holds Cycles, the path tracer of Blender, to the exact images of `exactff render`.
# Installs Debian's Blender and OpenImageIO. Writes cycles.csv and maps of the errors to build/field/cycles; with
# --bounces, cycles_bounces.csv to build/field/cycles_bounces: images of all light, gathered from ever smaller cells,
# beside Cycles with many bounces. With --quick, smaller images and fewer samples, to a folder NAME_quick. An interrupted
# run continues; remove the folder to measure anew. EXACTFF_BUILD names another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
cd "$top"
validation/setup.sh blender python3-openimageio
[ -x "$build/exactff" ] || validation/build.sh "$build" -DEXACTFF_TESTS=OFF -DEXACTFF_QUICK_BUILD=ON
name=cycles
if [ "${1:-}" = --bounces ]; then
  name=cycles_bounces
  shift
fi
folder=build/field/$name
[ "${1:-}" != --quick ] || folder+=_quick
mkdir -p "$folder"
# Debian's packages belong to Debian's Python, whatever else is installed.
exec /usr/bin/python3 -B "validation/field/$name.py" "$build/exactff" "$folder" "$@"
