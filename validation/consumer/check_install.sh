#!/usr/bin/env bash
# check_install.sh BUILD-FOLDER COMPILER VERSION [PYTHON]: installs the build into a temporary folder, moves that elsewhere, checks
# what is in it, and builds and runs other people's projects against it: through find_package, pkg-config, as a
# folder of a larger project (configured only; it would build the library again), with GoogleTest, and from PYTHON.
set -euo pipefail

build=$1
export CXX=$2
version=$3
python=${4:-}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CMAKE_GENERATOR=Ninja

fail() {
  echo "FAILED: $1" >&2
  exit 1
}

# quietly TEXT COMMAND...: what the command prints is shown only if it fails.
quietly() {
  echo "$1"
  "${@:2}" > "$work/log" 2>&1 || { cat "$work/log" >&2; fail "$1"; }
}

prefix=$work/moved
quietly "installing" env DESTDIR="$work/stage" cmake --install "$build" --prefix /opt/first
mv "$work/stage/opt/first" "$prefix"
[ -z "$(find "$work/stage" -type f)" ] || fail "files were installed outside the prefix: $(find "$work/stage" -type f)"

examples=share/exactff/examples
for file in bin/exactff include/exactff/exact.h include/exactff/version.h share/man/man1/exactff.1 \
  share/bash-completion/completions/exactff share/doc/exactff/LICENSE \
  $examples/scenes/{cornell_box,blinds_room}.{obj,mtl} $examples/project/{CMakeLists.txt,main.cpp,room.obj}; do
  [ -s "$prefix/$file" ] || fail "$file is not installed"
done
programs=$(find "$prefix" -type f -perm /111 ! -name '*.so*' -printf '%P\n')
[ "$programs" = bin/exactff ] || fail "programs other than exactff are installed: $programs"
# The name of the top folder alone may be a part of others.
! grep -rIl --fixed-strings --regexp="$top/"{src,include,data,validation} --regexp="$build" "$prefix" || fail "these files name the folder that they were built in"

quietly "running the program" "$prefix/bin/exactff" point "$prefix/$examples/scenes/cornell_box.obj" \
  --at 278 0 279.6 --normal 0 1 0 --on floor --source light
quietly "reading the completion" bash -n "$prefix/share/bash-completion/completions/exactff"
for command in $("$prefix/bin/exactff" help | sed '1,/^Subcommands:/d' | awk '{ print $1 }'); do
  grep -q "^\.SH exactff $command\$" "$prefix/share/man/man1/exactff.1" || fail "the manual page lacks $command"
done
if command -v groff > /dev/null; then
  quietly "reading the manual page" groff -man -Tutf8 -ww -z "$prefix/share/man/man1/exactff.1"
  [ ! -s "$work/log" ] || { cat "$work/log"; fail "the manual page has faults"; }
fi

if [ -n "$python" ]; then
  package=$(find "$prefix" -path '*/exactff/__init__.py')
  [ -s "$prefix/$examples/python/cornell_map.py" ] || fail "the examples for Python are not installed"
  quietly "importing the Python package" env PYTHONPATH="${package%/exactff/__init__.py}" "$python" -B -c \
    'import sys, exactff; print(exactff.Scene.read(sys.argv[1]).form_factor([278, 0, 279.6], [0, 1, 0], on="floor"))' \
    "$prefix/$examples/scenes/cornell_box.obj"
  grep -q "certified" "$work/log" || fail "the installed Python package computes nothing"
fi

# Libraries that the build has found outside the system's folders
read -r others <<< "$(sed -n 's/^CMAKE_PREFIX_PATH:[A-Z]*=//p' "$build/CMakeCache.txt" | tr ';' ':')"
export CMAKE_PREFIX_PATH=$prefix${others:+:$others}${CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH}
quietly "find_package: configuring the installed example" cmake -S "$prefix/$examples/project" -B "$work/app"
quietly "find_package: building" cmake --build "$work/app"
quietly "find_package: running" "$work/app/consumer" "$prefix/$examples/project/room.obj"
grep "^exactff $version: " "$work/log" || fail "the headers are not those of $version"
mkdir "$work/older"
printf 'cmake_minimum_required(VERSION 3.25)\nproject(older LANGUAGES CXX)\nfind_package(exactff 0.0 REQUIRED)\n' \
  > "$work/older/CMakeLists.txt"
! cmake -S "$work/older" -B "$work/older" > "$work/log" 2>&1 || fail "find_package takes version $version for 0.0"
grep -q "exactff-config.cmake, version: $version" "$work/log" || fail "find_package did not see version $version"

export PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name exactff.pc)")
read -ra flags <<< "$(pkg-config --cflags --libs exactff)"
for flag in "${flags[@]}"; do
  [[ $flag != -L* ]] || flags+=("-Wl,-rpath,${flag#-L}")
done
quietly "pkg-config: building" "$CXX" -std=c++20 "$here/app/main.cpp" -o "$work/by_pkg_config" "${flags[@]}"
quietly "pkg-config: running" "$work/by_pkg_config" "$here/app/room.obj"
block() { awk -v start="\`\`\`$1" '$0 == "```" && on { exit } on; $0 == start { on = 1 }' "$top/include/README.md"; }  # the first one
block cpp > "$work/page.cpp"
quietly "pkg-config: building the program on the page of C++" "$CXX" -std=c++20 "$work/page.cpp" -o "$work/page" "${flags[@]}"
printed=$(cd "$top" && "$work/page")
[ "$printed" = "$(block text)" ] || fail "the program on the page of C++ prints $printed"
[ "$(pkg-config --modversion exactff)" = "$version" ] || fail "pkg-config names another version than $version"

# Who uses the library is linked with what the build found: Embree 3 or 4, FLINT 2 with Arb or FLINT 3.
linked() { objdump -p "$1" | sed -nE 's/^ *NEEDED +(lib(flint|arb|embree).*)/\1/p' | sort; }
for user in "$work/app/consumer" "$work/by_pkg_config"; do
  others=$(comm -23 <(linked "$user") <(linked "$prefix/bin/exactff"))
  [ -z "$others" ] || fail "$user is linked with other libraries than the program: $others"
done

quietly "add_subdirectory: configuring" cmake -S "$here/app" -B "$work/subdirectory" -DEXACTFF_SOURCE="$top"
! grep -q '^EXACTFF_TESTS:BOOL=ON' "$work/subdirectory/CMakeCache.txt" || fail "a larger project would get the tests"

if [ -f "$here/guard/CMakeLists.txt" ]; then
  export PATH=$prefix/bin:$PATH
  quietly "guard: configuring" cmake -S "$here/guard" -B "$work/guard"
  quietly "guard: building" cmake --build "$work/guard"
  quietly "guard: testing" ctest --test-dir "$work/guard" --output-on-failure
fi
echo "the installation serves other projects"
