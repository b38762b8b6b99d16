#!/usr/bin/env bash
# The main job: builds the program and compares Tampieri's ray-sampled adaptive algorithm with the exact form factors
# on the Cornell box, on one thread so that times mean something. Ends with the path of a report to open in a browser.
# Further arguments go to `exactff compare`.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
validation/setup.sh
validation/build.sh build -DEXACTFF_TESTS=OFF

build/exactff compare data/scenes/cornell_box.obj --on floor --grid 32x32 --source light --threads 1 -o build/report "$@"
echo "Open $top/build/report/report.html in a browser."
