#!/usr/bin/env bash
# All tests. Installs packages, builds with warnings as errors, and ends with the summary of ctest.
#
#   test.sh               the whole suite on the optimised build
#   test.sh --sanitizers  instead, a part of the suite under AddressSanitizer and UndefinedBehaviorSanitizer, with GCC
#                         and with Clang, and a short fuzzing run in the Clang build
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"

test_optimised() {
  validation/setup.sh libboost-mpi-dev libopenmpi-dev openmpi-bin \
    chromium chromium-driver python3-selenium  # tests of a build option and of the reports in a browser
  validation/build.sh build -DEXACTFF_TESTS=ON -DEXACTFF_WERROR=ON
  ctest --test-dir build --output-on-failure --parallel 2
}

# EXACTFF_QUICK_BUILD saves time here. The optimised build still compiles every source by itself.
test_sanitized() {
  validation/setup.sh
  validation/build.sh build/sanitize -DEXACTFF_TESTS=ON -DEXACTFF_WERROR=ON -DEXACTFF_SANITIZE=ON \
    -DEXACTFF_QUICK_BUILD=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
  ctest --test-dir build/sanitize --output-on-failure --parallel 2
  validation/fuzz.sh 30  # builds build/clang
  ctest --test-dir build/clang --output-on-failure --parallel 2
}

case "$*" in
  "") test_optimised ;;
  --sanitizers) test_sanitized ;;
  *) echo "usage: test.sh [--sanitizers]" >&2; exit 2 ;;
esac
