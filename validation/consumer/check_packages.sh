#!/usr/bin/env bash
# check_packages.sh BUILD-FOLDER PYTHON: makes the Debian package for Python of the build, and checks that Debian's Python
# finds what it holds, and that it depends on every library that it needs; checks the dependencies of the library's package.
set -euo pipefail

build=$1
python=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "FAILED: $1" >&2
  exit 1
}

cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work" -D CPACK_COMPONENTS_ALL=python > "$work/log" 2>&1 ||
  { cat "$work/log" >&2; fail "cpack"; }
package=$(echo "$work"/python3-exactff_*.deb)
dpkg-deb --extract "$package" "$work/root"
packages=$work/root/usr/lib/python3/dist-packages
[ -z "$(find "$work/root/usr" -name '*.py' -not -path "$packages/*" -not -path '*/examples/*')" ] ||
  fail "files are where Debian's Python does not look"
PYTHONPATH=$packages "$python" -B -c "import exactff; assert exactff.__file__.startswith('$packages')"

depends=$(dpkg-deb --field "$package" Depends)
module=$(echo "$packages"/exactff/_exactff*.so)
needed=$(objdump -p "$module" | sed -n 's/^ *NEEDED *//p')
files=()
while read -r name _ file _; do
  [[ $'\n'$needed$'\n' != *$'\n'"$name"$'\n'* ]] || files+=("*$(readlink -f "$file" | sed 's|^/usr||')")
done < <(ldd "$module")
[ "${#files[@]}" -gt 8 ] || fail "the libraries of the module were not found: ${files[*]}"
for owner in $(dpkg-query --search "${files[@]}" | sed 's/:.*//' | sort -u); do
  [[ ", $depends," == *", $owner"[\ ,]* ]] || fail "no dependency on $owner: $depends"
done
[[ $depends == *python3-numpy* ]] || fail "no dependency on python3-numpy: $depends"
echo "the package for Python: $depends"

# Compiling with the library needs the packages of what it was built with, in these versions.
depends=$(sed -n 's/^set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "\(.*\)")$/\1/p' "$build/CPackConfig.cmake")
printf 'Source: exactff\n\nPackage: exactff\nArchitecture: any\n' > "$work/control"
dpkg-checkbuilddeps -d "$depends" -c "" "$work/control" || fail "the package of the library depends on what is not installed: $depends"
# cached NAME: a path that CMake has found
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
files=("$(cached embree_DIR)/embree-config.cmake")
for name in GMP MPFR FLINT ARB; do
  file=$(cached "EXACTFF_${name}_LIBRARY")
  [ -z "$file" ] || files+=("$file")
done
[ "${#files[@]}" -ge 4 ] || fail "these are not the libraries of the build: ${files[*]}"
for owner in $(dpkg-query --search "${files[@]/#\//*/}" | sed 's/:.*//' | sort -u); do
  [[ ", $depends," == *", $owner"[\ ,]* ]] || fail "no dependency on $owner: $depends"
done
echo "the package of the library: $depends"
