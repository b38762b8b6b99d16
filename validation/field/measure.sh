#!/usr/bin/env bash
# measure.sh PROGRAM [--quick]: holds another program to our values, and writes PROGRAM.csv to build/field/PROGRAM.
#   cycles          the path tracer of Blender: direct light, beside exact images of `exactff render`; with maps of the errors
#   cycles_bounces  the same: all light, beside images that are gathered from ever smaller cells
#   openfoam        viewFactorsGen, beside certified view factors of `exactff matrix`
#   calculix        cavity radiation, likewise
#   suite           the questions of data/suite: our methods for points, POV-Ray, OpenFOAM, CalculiX
# Installs Debian's package of the program. With --quick: fewer samples or faces, to build/field/PROGRAM_quick. An
# interrupted run continues; remove the folder to measure anew. EXACTFF_BUILD names another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
cd "$top"
case "${1:-}" in
  cycles | cycles_bounces) validation/setup.sh blender python3-openimageio ;;
  openfoam) validation/setup.sh openfoam python3-numpy ;;
  calculix) validation/setup.sh calculix-ccx python3-numpy ;;
  suite) validation/setup.sh openfoam calculix-ccx povray python3-numpy ;;
  *) echo "usage: measure.sh cycles|cycles_bounces|openfoam|calculix|suite [--quick]" >&2; exit 2 ;;
esac
[ -x "$build/exactff" ] || validation/build.sh "$build" -DEXACTFF_TESTS=OFF -DEXACTFF_QUICK_BUILD=ON
folder=build/field/$1
[ "${2:-}" != --quick ] || folder+=_quick
mkdir -p "$folder"
# Debian's packages belong to Debian's Python, whatever else is installed.
export PYTHONPATH=$build/python
exec /usr/bin/python3 -B "validation/field/$1.py" "$build/exactff" "$folder" "${@:2}"
