#!/usr/bin/env bash
# Includes point one way: each module may include only the modules listed beside it. Public headers name no library
# that solves geometry or arithmetic for us. Usage: check_modules.sh SOURCE-FOLDER
set -euo pipefail
cd "$1"

declare -A allowed=(
  [kernel]="kernel"
  [text]="text kernel"
  [scene]="scene text kernel"
  [visibility]="visibility scene kernel"
  [contour]="contour visibility kernel"
  [exact]="exact contour visibility scene kernel"
  [sampled]="sampled scene kernel"
  [methods]="methods sampled exact scene text kernel"
  [models]="models methods scene text kernel"
  [study]="study scene text kernel"
  [experiments]="experiments study models methods scene text kernel"
  [check]="check study scene text kernel"
  [stress]="stress study scene text kernel"
  [truth]="truth study scene text kernel"
  [cli]="cli experiments check stress truth study scene text"
)

failures=0
complain() {
  echo "$1"
  failures=$((failures + 1))
}

modules=" ${!allowed[*]} "
for module in "${!allowed[@]}"; do
  while IFS=: read -r file included; do
    [[ $modules == *" $included "* ]] || continue
    [[ " ${allowed[$module]} " == *" $included "* ]] || complain "$file includes $included/, which $module must not know"
  done < <(grep -rHoE '^#include "[a-z_]+/' "src/$module" | sed -E 's/#include "([a-z_]+)\//\1/')
done

while read -r line; do
  complain "a public header names a library: $line"
done < <(grep -rnE --include='*.h' '\b(CGAL|gmp|gmpxx|mpfr|flint|arb_|embree|CLI)\b' include || true)

[ "$failures" -eq 0 ] || exit 1
echo "includes point one way"
