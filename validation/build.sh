#!/usr/bin/env bash
# build.sh FOLDER [CMAKE-OPTION...] [-- TARGET...]: configures and builds with 2 jobs, everything or these targets. A second
# call builds only what has changed.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$1
shift
options=()
while [ "$#" -gt 0 ] && [ "$1" != -- ]; do
  options+=("$1")
  shift
done
[ "$#" -eq 0 ] || shift

# A folder that was configured for another copy of the sources would build that copy.
if [ -f "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$top" "$folder/CMakeCache.txt"; then
  rm -rf "$folder"
fi
[ -f "$folder/CMakeCache.txt" ] || options+=(-G Ninja)
cmake -S "$top" -B "$folder" "${options[@]}"
cmake --build "$folder" --parallel 2 ${1:+--target "$@"}
