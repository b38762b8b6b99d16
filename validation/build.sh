#!/usr/bin/env bash
# build.sh FOLDER [CMAKE-OPTION...]: configures and builds with 2 jobs. A second call builds only what has changed.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$1
shift

# A folder that was configured for another copy of the sources would build that copy.
if [ -f "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$top" "$folder/CMakeCache.txt"; then
  rm -rf "$folder"
fi
generator=()
[ -f "$folder/CMakeCache.txt" ] || generator=(-G Ninja)
cmake -S "$top" -B "$folder" "${generator[@]}" "$@"
cmake --build "$folder" --parallel 2
