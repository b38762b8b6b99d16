#!/usr/bin/env bash
# Looks for data races: thread_sanitizer.sh [TEST-FILTER]
#
# Builds build/thread with ThreadSanitizer and runs the tests that use threads: truth, study, methods, and everything
# that is documented as safe to share. In this build, functions are not cloned for processors, because the choice among
# the clones runs before the sanitizer does. Exits with 66 if there is a race. No report is suppressed; none had to be.
# EXACTFF_BUILD names another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
build=${EXACTFF_BUILD:-build/thread}

validation/setup.sh
validation/build.sh "$build" -DEXACTFF_SANITIZE_THREADS=ON -DEXACTFF_WERROR=ON -DEXACTFF_QUICK_BUILD=ON \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"

# The kernel may choose a layout of the address space that the sanitizer cannot shadow.
TSAN_OPTIONS="halt_on_error=0 exitcode=66 second_deadlock_stack=1" \
  setarch "$(uname -m)" --addr-no-randomize "$build/thread_tests" --gtest_filter="${1:-*}"
