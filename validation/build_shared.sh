#!/usr/bin/env bash
# build_shared.sh [CMAKE-OPTION...] [-- TARGET...]: the build of report.sh, test.sh and bench.sh, in build/. They share its
# options, and so each uses what another has compiled. EXACTFF_QUICK_BUILD compiles sources together;
# validation/README.md tells how every source is compiled by itself.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top"
validation/build.sh build -DEXACTFF_TESTS=ON -DEXACTFF_WERROR=ON -DEXACTFF_QUICK_BUILD=ON "$@"
