#!/usr/bin/env bash
# The mutation check: plants known faults, one at a time, in a copy of the sources, and checks that the test suite
# detects each. A fault is a patch in validation/mutation. The patch says what it breaks and what a user would see.
#
#   mutation.sh [NAME...]          all faults, or those named
#   mutation.sh --count [NAME...]  runs the whole suite for each, to count the tests that fail
#   mutation.sh --check            only checks that every patch still applies (a test of the suite)
#
# Prints a line for each fault and exits with 1 if one survives, does not apply or does not compile. The copy and its
# build stay in build/mutation (EXACTFF_MUTATION_FOLDER names another place), so that a second run builds little.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
patches=$top/validation/mutation
folder=${EXACTFF_MUTATION_FOLDER:-$top/build/mutation}
source=$folder/source
build=$folder/build
log=$folder/log
test_seconds=300   # a test that takes longer hangs
suite_seconds=900  # and so does a suite

# apply FAULT FOLDER [OPTION...]: applies the patch without fuzz; only line numbers may have changed.
apply() {
  patch --silent --strip=1 --fuzz=0 --no-backup-if-mismatch --force --directory="$2" "${@:3}" < "$patches/$1.patch"
}

names_of_all() {
  local file
  for file in "$patches"/*.patch; do
    file=${file##*/}
    echo "${file%.patch}"
  done
}

# The test that detected the fault when it was planted before, by the table in mutation/README.md; without its parameter.
known_test() {
  sed -nE "s/^\| \`$1\` \|.*\| \`([^\`]+)\`.*\|$/\1/p" "$patches/README.md"
}

check() {
  local name failures=0
  complain() {
    echo "$1"
    failures=$((failures + 1))
  }
  command -v patch > /dev/null || { echo "the program 'patch' is missing; validation/setup.sh installs it" >&2; exit 1; }
  while read -r name; do
    complain "$name does not say what it breaks and what a user sees"
  done < <({ grep -L '^Breaks: ' "$patches"/*.patch; grep -L '^A user sees: ' "$patches"/*.patch; } | sort -u)
  while read -r name; do
    complain "$name is not in the table of mutation/README.md, so the whole suite would run to detect it"
  done < <(comm -23 <(names_of_all | sort) <(sed -nE 's/^\| `([^`]+)` \|.*\| `[^`]+`.*\|$/\1/p' "$patches/README.md" | sort))
  for name in $(names_of_all); do
    apply "$name" "$top" --dry-run && continue
    complain "$name.patch no longer applies: write it again for the present sources, as 'diff -u' from a/ to b/"
  done
  [ "$failures" -eq 0 ] || exit 1
  echo "every patch applies and is in the table"
}

# Compares contents: a file gets a new time only if it differs from what the last build saw.
copy_sources() {
  local file
  mkdir -p "$source"
  while IFS= read -r -d '' file; do
    [ -e "$top/$file" ] || rm "$source/$file"
  done < <(cd "$source" && find . -type f -print0)
  while IFS= read -r -d '' file; do
    cmp --silent "$top/$file" "$source/$file" && continue
    mkdir -p "$source/$(dirname "$file")"
    cp "$top/$file" "$source/$file"
  done < <(cd "$top" && find CMakeLists.txt README.md LICENSE src include validation data -type f -print0)
}

configure() {
  # With a shared library, a fault in it costs one link. Faults are planted in sources of the library and the program.
  local options=(-DEXACTFF_TESTS=ON -DEXACTFF_QUICK_BUILD=TESTS -DCMAKE_BUILD_TYPE=Release
    -DBUILD_SHARED_LIBS=ON -DCMAKE_LINK_DEPENDS_NO_SHARED=ON)
  ! command -v ccache > /dev/null || options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  [ -f "$build/CMakeCache.txt" ] || options+=(-G Ninja)
  cmake -S "$source" -B "$build" "${options[@]}"
}

# compile LOG [TARGET...]
compile() {
  cmake --build "$build" --parallel 2 ${2:+--target "${@:2}"} > "$1" 2>&1
}

# suite LOG [OPTION...]: leaves out the check of the patches, which fails while one is planted, and the layout of the
# sources, since a fault is to be detected by what it does.
suite() {
  rm -rf "$build/Testing"  # otherwise ctest starts with the tests that failed last
  timeout "$suite_seconds" ctest --test-dir "$build" --parallel 2 --timeout "$test_seconds" \
    --exclude-regex '^(Mutation|Sources)\.' "${@:2}" > "$1" 2>&1
}

# The first test that failed, from ctest's lines " 3/634 Test   #3: Suite.Name ....***Failed  0.1 sec".
first_failure() {
  sed -nE '/\*\*\*/ { s/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: ([^ ]+).*\*\*\*(Timeout)?.*/\1 \2/p; q }' "$1" |
    sed -E 's/ Timeout$/ (hangs)/; s/ $//'
}

# The result for the planted fault, as text for the table. Returns 1 unless the fault was detected.
verdict() {
  local name=$1 known status=0
  compile "$log/$name.build" exactff exactff_program || { echo "DOES NOT COMPILE, see $log/$name.build"; return 1; }
  if ! compile "$log/$name.build"; then
    # CMake asks each test program for its tests. If the fault makes a program die there, it counts as detected.
    grep -q '^ *Error running test executable' "$log/$name.build" && { echo "a test program dies before its first test"; return 0; }
    echo "TESTS DO NOT BUILD, see $log/$name.build"
    return 1
  fi
  known=$(known_test "$name")
  [ "$count" = no ] && [ -n "$known" ] && { suite "$log/$name.test" --tests-regex "^$known" || status=$?; }
  [ "$status" -ne 0 ] || suite "$log/$name.test" "${suite_options[@]}" || status=$?
  case $status in
    0) echo "SURVIVES"; return 1 ;;
    124) echo "suite hangs after $(first_failure "$log/$name.test")" ;;
    *) caught_by "$log/$name.test" || { echo "CTEST FAILED, see $log/$name.test"; return 1; } ;;
  esac
}

caught_by() {
  local first
  first=$(first_failure "$1")
  [ -n "$first" ] || return 1
  if [ "$count" = yes ]; then
    first+=", $(grep -c '\*\*\*' "$1") in all"
  fi
  echo "$first"
}

# Plants one fault, prints its line, removes the fault.
try_fault() {
  local name=$1 start=$SECONDS text caught=0
  if ! apply "$name" "$source" --dry-run > "$log/$name.patch" 2>&1; then
    printf '%-28s %-78s %4s\n' "$name" "DOES NOT APPLY" -
    return 1
  fi
  apply "$name" "$source"
  text=$(verdict "$name") || caught=1
  apply "$name" "$source" --reverse || { echo "$name cannot be taken out of $source" >&2; exit 1; }
  printf '%-28s %-78s %4d\n' "$name" "$text" $((SECONDS - start))
  printf '    %s\n' "$(sed -n 's/^Breaks: //p' "$patches/$name.patch")"
  return $caught
}

count=no
suite_options=(--stop-on-failure)

prove_sound() {
  local start=$SECONDS
  compile "$log/sound.build" || { tail -20 "$log/sound.build" >&2; exit 1; }
  echo "Sound sources: built in $((SECONDS - start)) s"
  start=$SECONDS
  suite "$log/sound.test" || { echo "the suite fails before any fault is planted:" >&2; tail -20 "$log/sound.test" >&2; exit 1; }
  echo "Sound sources: every test passes, $((SECONDS - start)) s"
  echo
}

try_faults() {
  local name start=$SECONDS missed=()
  printf '%-28s %-78s %4s\n' fault 'caught by' s
  for name in "$@"; do
    try_fault "$name" || missed+=("$name")
  done
  echo
  echo "$# faults, $(($# - ${#missed[@]})) caught, in $((SECONDS - start)) s"
  [ "${#missed[@]}" -eq 0 ] || { echo "not caught: ${missed[*]}" >&2; exit 1; }
}

main() {
  case ${1:-} in
    --check)
      check
      exit
      ;;
    --count)
      count=yes
      suite_options=()
      shift
      ;;
  esac
  local name names=("$@")
  [ "${#names[@]}" -gt 0 ] || mapfile -t names < <(names_of_all)
  for name in "${names[@]}"; do
    [ -f "$patches/$name.patch" ] || { echo "there is no fault '$name'; the faults are: $(names_of_all | xargs)" >&2; exit 2; }
  done

  "$top/validation/setup.sh" patch
  mkdir -p "$log"
  copy_sources
  configure > "$log/configure" 2>&1 || { tail -20 "$log/configure" >&2; exit 1; }
  prove_sound
  try_faults "${names[@]}"
}

main "$@"
exit
