#!/usr/bin/env bash
# What the compiler cannot check about the storeys of src/ (src/README.md). The compiler refuses an include of a private
# header upward. This script checks the rest:
#   - a public header belongs to a room, and so to a storey, as well;
#   - the rooms of a storey include each other in one direction;
#   - some rooms must not know others, since their agreement is evidence only if they share nothing;
#   - only the kernel calls Arb; public headers name no library.
# Usage: check_modules.sh TOP-FOLDER
set -euo pipefail
cd "$1"

storeys=(foundation scenes solver rivals products reports outside)

# The room of a public header that is not named after it. Where a header serves several rooms of a storey, the lowest.
declare -A home=(
  [enclosure]=kernel [geometry]=kernel [jobs]=kernel [error]=text [settings]=text [version]=text
  [scene_files]=formats [receiver]=receivers [exact]=visibility [region]=exact [view]=whole_view [testing]=check
)

# Pairs of rooms of which the first must not include the second, not even through others.
apart=("adaptive visibility" "adaptive contour" "view_factors whole_view" "whole_view view_factors")

failures=0
complain() {
  echo "$1"
  failures=$((failures + 1))
}

declare -A level=()  # of each room: the number of its storey
for i in "${!storeys[@]}"; do
  for folder in src/"${storeys[$i]}"/*/; do
    folder=${folder%/}
    level[${folder##*/}]=$i
  done
done

# set_room VARIABLE FILE: of src/reports/study/run.cpp, study/run.h and exactff/study.h: study
set_room() {
  local name=${2#src/*/}
  name=${name#include/}
  if [ "${name%%/*}" != exactff ]; then
    printf -v "$1" %s "${name%%/*}"
  else
    name=${name##*/}
    name=${name%.h}
    printf -v "$1" %s "${home[$name]:-$name}"
  fi
}

edges=$(mktemp)
trap 'rm -f "$edges"' EXIT
while IFS=: read -r file included; do
  set_room from "$file"
  set_room to "$included"
  [ -n "${level[$from]:-}" ] || complain "$file belongs to no room"
  [ -n "${level[$to]:-}" ] || complain "$file includes $included, which belongs to no room"
  [ -n "${level[$from]:-}" ] && [ -n "${level[$to]:-}" ] && [ "$from" != "$to" ] || continue
  [ "${level[$to]}" -le "${level[$from]}" ] ||
    complain "$file includes $included, and the storey ${storeys[${level[$from]}]} is below ${storeys[${level[$to]}]}"
  echo "$from $to" >> "$edges"
done < <(grep -rHoE --exclude-dir=_skbuild '^#include "[a-z_]+/[a-z0-9_]+' src include | sed 's/#include "//')

tsort "$edges" > /dev/null 2> "$edges.loop" || complain "rooms include each other in a circle: $(sed -n 's/^tsort: \([a-z_]*\)$/\1/p' "$edges.loop" | xargs)"
rm -f "$edges.loop"

# reach ROOM: all rooms whose headers its sources include, also through headers of others.
reach() {
  local seen=" $1 " before=""
  while [ "$seen" != "$before" ]; do
    before=$seen
    while read -r from to; do
      [[ "$seen" == *" $from "* && "$seen" != *" $to "* ]] && seen+="$to "
    done < "$edges"
  done
  echo "$seen"
}
sort -u -o "$edges" "$edges"
for pair in "${apart[@]}"; do
  read -r one other <<< "$pair"
  [[ "$(reach "$one")" != *" $other "* ]] || complain "$one must not know $other"
done

while read -r line; do
  complain "a public header names a library: $line"
done < <(grep -rnE --exclude-dir=_skbuild --include='*.h' '\b(CGAL|gmp|gmpxx|mpfr|flint|arb_|embree|Imf|png_|CLI)\b' include || true)

while read -r line; do
  complain "only the kernel may call Arb: $line"
done < <(grep -rnE --exclude-dir=_skbuild '#include <(arb|arf|mag|acb|flint|fmpz)|\b(arb|arf|mag|acb|fmpz)_[a-z]' src include |
         grep -vE '^src/(foundation/kernel|cmake)/|^src/outside/cli/main.cpp:[0-9]+:#include' || true)  # the program's allocator, for FLINT

[ "$failures" -eq 0 ] || exit 1
echo "includes point one way"
