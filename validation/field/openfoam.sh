#!/usr/bin/env bash
# openfoam.sh [--quick]: holds viewFactorsGen of OpenFOAM to the certified view factors of `exactff matrix`. Installs
# Debian's OpenFOAM. Writes openfoam.csv to build/field/openfoam; with --quick, at most 10 faces along an edge, to
# build/field/openfoam_quick. An interrupted run continues; remove the folder to measure anew. EXACTFF_BUILD names
# another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
cd "$top"
validation/setup.sh openfoam python3-numpy
[ -x "$build/exactff" ] || validation/build.sh "$build" -DEXACTFF_TESTS=OFF -DEXACTFF_QUICK_BUILD=ON
folder=build/field/openfoam
[ "${1:-}" != --quick ] || folder=build/field/openfoam_quick
mkdir -p "$folder"
# Debian's packages belong to Debian's Python, whatever else is installed.
exec /usr/bin/python3 -B validation/field/openfoam.py "$build/exactff" "$folder" "$@"
