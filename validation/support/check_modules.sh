#!/usr/bin/env bash
# Includes point one way: each module may include only the modules listed beside it. A public header belongs to a module
# as well. Public headers name no library that solves geometry or arithmetic for us. Only the kernel calls Arb.
# Usage: check_modules.sh TOP-FOLDER
set -euo pipefail
cd "$1"

declare -A allowed=(
  [kernel]=""
  [text]="kernel"
  [scene]="text kernel"
  [formats]="scene text kernel"
  [receivers]="scene text kernel"
  [visibility]="receivers scene kernel"
  [contour]="visibility kernel"
  [exact]="contour visibility receivers scene text kernel"
  [whole_view]="exact contour visibility receivers scene text kernel"
  [light]="whole_view exact receivers scene text kernel"
  [view_factors]="exact visibility receivers scene work text kernel"
  [matrix]="jobs view_factors whole_view visibility scene work text kernel"
  [radiosity]="matrix view_factors scene text kernel"
  [diagnosis]="exact receivers scene text kernel"
  [sampled]="receivers scene kernel"
  [methods]="sampled exact receivers scene text kernel"
  [models]="receivers scene text kernel"
  [work]="text kernel"
  [jobs]="work text kernel"
  [page]="work text kernel"
  [pixels]="receivers scene text kernel"
  [vtk]="receivers scene work text kernel"
  [study]="jobs methods sampled exact receivers scene work text kernel"
  [experiments]="study models methods matrix view_factors whole_view exact page work text kernel"
  [render]="jobs pixels light methods exact receivers scene work text kernel"
  [flags]="report pixels study models formats receivers exact scene text kernel"
  [report]="render experiments vtk study methods sampled exact page work text kernel"
  [stress]="sampled exact receivers scene page work text kernel"
  [truth]="jobs pixels vtk light exact receivers scene work text kernel"
  [check]="pixels matrix view_factors exact page work text kernel"
  [batch]="methods exact receivers scene work text kernel"
  [python]=""  # and all public headers
  [cli]="flags work text"  # and all public headers
)

# The module of a public header that is not named after it.
declare -A home=(
  [enclosure]=kernel [geometry]=kernel [progress]=kernel [error]=text [summary]=scene [settings]=text [version]=text [quantity]=light [obj]=formats [scene_files]=formats
  [receiver]=receivers [record]=visibility [adaptive]=sampled [view]=whole_view [view_regions]=whole_view [visibility_svg]=report [testing]=check [team]=jobs
)

failures=0
complain() {
  echo "$1"
  failures=$((failures + 1))
}

set_module() {  # VARIABLE FILE: src/reports/study/run.cpp, include/exactff/study.h: study
  local name=${2#*/}
  if [ "${name%%/*}" != exactff ]; then
    printf -v "$1" %s "${name%%/*}"
  else
    name=${name##*/}
    name=${name%.h}
    printf -v "$1" %s "${home[$name]:-$name}"
  fi
}

while IFS=: read -r file included; do
  set_module from "$file"
  set_module to "src/$included"
  [ -n "${allowed[$from]+known}" ] || complain "$file belongs to no module of the table"
  [ -n "${allowed[$to]+known}" ] || continue  # of the tests
  { [ "$from" = cli ] || [ "$from" = python ]; } && [ "${included%%/*}" = exactff ] && continue
  [ "$from" = "$to" ] || [[ " ${allowed[$from]:-} " == *" $to "* ]] ||
    complain "$file includes $included, and $from must not know $to"
done < <(grep -rHoE --exclude-dir=_skbuild '^#include "[a-z_]+/[a-z_]+' src include | sed 's/#include "//')

while read -r line; do
  complain "a public header names a library: $line"
done < <(grep -rnE --exclude-dir=_skbuild --include='*.h' '\b(CGAL|gmp|gmpxx|mpfr|flint|arb_|embree|Imf|png_|CLI)\b' include || true)

while read -r line; do
  complain "only src/foundation/kernel may call Arb: $line"
done < <(grep -rnE --exclude-dir=_skbuild '#include <(arb|arf|mag|acb|flint|fmpz)|\b(arb|arf|mag|acb|fmpz)_[a-z]' src include |
         grep -vE '^src/(kernel|cmake)/|^src/outside/cli/memory.cpp:[0-9]+:#include' || true)  # the program's allocator, for FLINT

[ "$failures" -eq 0 ] || exit 1
echo "includes point one way"
