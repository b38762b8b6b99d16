#!/usr/bin/env bash
# wheel.sh [FOLDER]: makes the wheel for Python in FOLDER (default: build/wheel), with the libraries that it needs inside,
# and computes a value with it in a fresh virtual environment. Takes as long as a build of the library; with
# EXACTFF_BUILT=FOLDER in the environment, takes the module of that build.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(realpath -m "${1:-$top/build/wheel}")
python=${PYTHON:-/usr/bin/python3}
if [ -n "${EXACTFF_BUILT:-}" ]; then
  EXACTFF_BUILT=$(realpath "$EXACTFF_BUILT")
  export EXACTFF_BUILT
fi
cd "$top"
validation/setup.sh python3-setuptools python3-wheel python3-skbuild python3-venv patchelf

work=$(mktemp -d)
trap 'rm -rf "$work" "$top"/src/outside/python/{_skbuild,build,exactff.egg-info}' EXIT
"$python" -m venv --system-site-packages "$work/venv"
"$work/venv/bin/pip" wheel --no-build-isolation --no-deps --no-index --wheel-dir "$work" ./src/outside/python
"$python" src/outside/python/bundle.py "$work"/exactff-*.whl "$folder"
"$work/venv/bin/pip" install --no-deps --no-index --find-links "$folder" exactff
cd /
"$work/venv/bin/python" "$top/validation/python/try_wheel.py" "$top/data/scenes/cornell_box.obj"
ls "$folder"
