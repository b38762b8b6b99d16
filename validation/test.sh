#!/usr/bin/env bash
# All tests. Installs packages, builds with warnings as errors, and ends with the summary of ctest.
#
#   test.sh               the suite on the optimised build, by GCC, without the fuzz targets' corpora
#   test.sh --sanitizers  instead, a part of the suite under AddressSanitizer and UndefinedBehaviorSanitizer, built by
#                         Clang, and a short fuzzing run in that build
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"

test_optimised() {
  validation/setup.sh libboost-mpi-dev libopenmpi-dev openmpi-bin \
    python3-selenium clang-format python3-pytest python3-mpmath python3-tqdm python3-matplotlib mypy python3-venv \
    python3-setuptools python3-wheel patchelf --if-offered chromium chromium-driver python3-openimageio python3-meshio python3-vtk9
  # These are for tests of a build option, of reports, of the layout, of images, of the package for Python, and of files
  # for ParaView. A test without its program is left out: Ubuntu has no package of Chromium.
  validation/build_shared.sh
  ctest --test-dir build --output-on-failure --parallel 3  # some tests wait for a browser, for MPI or for a signal
}

test_sanitized() {
  validation/fuzz.sh 6  # builds build/clang; each target begins with its corpus
  ctest --test-dir build/clang --output-on-failure --parallel 2
}

case "$*" in
  "") test_optimised ;;
  --sanitizers) test_sanitized ;;
  *) echo "usage: test.sh [--sanitizers]" >&2; exit 2 ;;
esac
