#!/usr/bin/env bash
# calculix.sh [--quick]: holds the cavity radiation of CalculiX to the certified view factors of `exactff matrix`.
# Installs Debian's CalculiX. Writes calculix.csv to build/field/calculix; with --quick, at most 10 faces along an
# edge, to build/field/calculix_quick. An interrupted run continues; remove the folder to measure anew. EXACTFF_BUILD
# names another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
cd "$top"
validation/setup.sh calculix-ccx python3-numpy
[ -x "$build/exactff" ] || validation/build.sh "$build" -DEXACTFF_TESTS=OFF -DEXACTFF_QUICK_BUILD=ON
folder=build/field/calculix
[ "${1:-}" != --quick ] || folder=build/field/calculix_quick
mkdir -p "$folder"
# Debian's packages belong to Debian's Python, whatever else is installed.
exec /usr/bin/python3 -B validation/field/calculix.py "$build/exactff" "$folder" "$@"
