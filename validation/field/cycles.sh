#!/usr/bin/env bash
# cycles.sh [--quick]: holds Cycles, the path tracer of Blender, to the exact images of `exactff render`. Installs
# Debian's Blender and OpenImageIO. Writes cycles.csv and maps of the errors to build/field/cycles; with --quick,
# smaller images and fewer samples, to build/field/cycles_quick. An interrupted run continues; remove the folder to
# measure anew. EXACTFF_BUILD names another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
cd "$top"
validation/setup.sh blender python3-openimageio
[ -x "$build/exactff" ] || validation/build.sh "$build" -DEXACTFF_TESTS=OFF -DEXACTFF_QUICK_BUILD=ON
folder=build/field/cycles
[ "${1:-}" != --quick ] || folder=build/field/cycles_quick
mkdir -p "$folder"
# Debian's packages belong to Debian's Python, whatever else is installed.
exec /usr/bin/python3 validation/field/cycles.py "$build/exactff" "$folder" "$@"
