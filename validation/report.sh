#!/usr/bin/env bash
# The main job: builds the program and compares Tampieri's ray-sampled adaptive algorithm, and every other method, with
# the exact form factors on the Cornell box. Ends with the path of a report to open in a browser. After an interruption,
# the next run continues where it stopped; a finished report is made anew. Further arguments go to `exactff compare`.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
validation/setup.sh
validation/build_shared.sh -- exactff_program

# The program may have changed since a finished report was made, so --resume would be wrong for that.
existing=--force
if [[ -e build/report.part ]]; then existing=--resume; fi
build/exactff compare data/scenes/cornell_box.obj --on floor --grid 32x32 --source light $existing -o build/report "$@"
echo "Open $top/build/report/report.html in a browser."
