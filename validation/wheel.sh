#!/usr/bin/env bash
# wheel.sh [FOLDER]: compiles the wheel for Python into FOLDER (default: build/wheel), installs it into a fresh virtual
# environment, and computes a value. Takes as long as a build of the library.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=${1:-$top/build/wheel}
python=${PYTHON:-/usr/bin/python3}
cd "$top"
validation/setup.sh python3-skbuild python3-venv

work=$(mktemp -d)
trap 'rm -rf "$work" "$top"/src/outside/python/{_skbuild,build,exactff.egg-info}' EXIT
"$python" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/pip" wheel --no-build-isolation --no-deps --no-index --wheel-dir "$folder" ./src/outside/python
"$work/venv/bin/pip" install --no-deps --no-index --find-links "$folder" exactff
cd /
"$work/venv/bin/python" - "$top/data/scenes/cornell_box.obj" <<'END'
import sys, exactff
f = exactff.Scene.read(sys.argv[1]).form_factor([200, 0, 400], [0, 1, 0], "light", on="floor")
assert f.value == 0.010822702782492406, f
print(exactff.__file__, f)
END
ls "$folder"
