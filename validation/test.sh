#!/usr/bin/env bash
# All tests: first a part of the suite under AddressSanitizer and UndefinedBehaviorSanitizer, with GCC and with Clang, and
# a short fuzzing run in the latter build; then the whole suite on the optimised build. Warnings are errors in all three.
# The first two builds take less time by EXACTFF_QUICK_BUILD; the third compiles every source for itself.
# Ends with ctest's own summary.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
validation/setup.sh libboost-mpi-dev libopenmpi-dev openmpi-bin \
  chromium chromium-driver python3-selenium  # an option of the build, and the reports in a browser: both tested

validation/build.sh build/sanitize -DEXACTFF_TESTS=ON -DEXACTFF_WERROR=ON -DEXACTFF_SANITIZE=ON -DEXACTFF_QUICK_BUILD=ON \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
ctest --test-dir build/sanitize --output-on-failure --parallel 2

validation/fuzz.sh 30  # builds build/clang
ctest --test-dir build/clang --output-on-failure --parallel 2

validation/build.sh build -DEXACTFF_TESTS=ON -DEXACTFF_WERROR=ON
ctest --test-dir build --output-on-failure --parallel 2
