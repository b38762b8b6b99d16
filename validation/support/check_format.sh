#!/usr/bin/env bash
# All C++ sources have the layout of .clang-format. Usage: check_format.sh CLANG-FORMAT TOP-FOLDER
# Leaves out what pip leaves in src/outside/python. Exit code 77 if the program is not of version 14.
set -euo pipefail
format=$1
cd "$2"
"$format" --version | grep -q 'version 14\.' || exit 77
find src include validation -name _skbuild -prune -o -name '*.h' -print0 -o -name '*.cpp' -print0 | xargs -0 "$format" --dry-run --Werror
