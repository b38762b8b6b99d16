#!/usr/bin/env bash
# Looks for data races: thread_sanitizer.sh [TEST-FILTER]
#
# Builds build/thread with ThreadSanitizer, in which functions are not cloned for processors (the choice among clones runs
# before the sanitizer does), and runs the tests that use threads: truth, study, methods, and whatever is documented as
# safe to share. Ends with 66 where there is a race. No report is suppressed; none had to be. EXACTFF_BUILD names
# another build folder.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
build=${EXACTFF_BUILD:-build/thread}

validation/setup.sh
validation/build.sh "$build" -DEXACTFF_SANITIZE_THREADS=ON -DEXACTFF_WERROR=ON -DEXACTFF_QUICK_BUILD=ON \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"

# The kernel may lay out the address space in a way that the sanitizer cannot shadow.
TSAN_OPTIONS="halt_on_error=0 exitcode=66 second_deadlock_stack=1" \
  setarch "$(uname -m)" --addr-no-randomize "$build/thread_tests" --gtest_filter="${1:-*}"
