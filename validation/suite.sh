#!/usr/bin/env bash
# suite.sh [--write]: recomputes data/suite, the answers by both engines and a second opinion, and fails if a byte of
# them or of a verdict on published values changes. With --write, the new ones replace the old ones.
# EXACTFF_BUILD names another build folder. Needs Debian's python3-mpmath.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${EXACTFF_BUILD:-$top/build}
new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT
/usr/bin/python3 -B "$top/validation/suite.py" "$build/exactff" "$new"
if [ "${1:-}" = --write ]; then
  rm -rf "$top/data/suite/answers"
  cp -r "$new/answers" "$new/published.csv" "$top/data/suite/"
fi
diff -r "$new/answers" "$top/data/suite/answers"
diff "$new/published.csv" "$top/data/suite/published.csv"
EXACTFF_TEST_SCALE=4 "$build/oracle_tests" --gtest_brief=1 --gtest_filter='Suite.*'
echo "data/suite is unchanged"
