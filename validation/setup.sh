#!/usr/bin/env bash
# setup.sh [PACKAGE...] [--if-offered PACKAGE...]: installs the packages that exactff is built from, and those named, with
# apt, as root or with sudo. Of the packages after --if-offered, only those that the system offers. Does nothing if all
# are installed. On a system that it does not know, it prints what is needed, and fails.
#
# With EXACTFF_SETUP=no in the environment it does nothing, for systems where everything is there, perhaps in folders of
# CMAKE_PREFIX_PATH.
set -euo pipefail

[ "${EXACTFF_SETUP:-}" != no ] || exit 0

packages=(
  g++ cmake ninja-build
  libcgal-dev libboost-dev libgmp-dev libmpfr-dev libflint-dev  # exact geometry, certified contour
  libembree-dev                                                 # shadow rays
  libopenexr-dev libpng-dev                                     # images
  libtinygltf-dev                                               # scenes in glTF
  libjemalloc-dev                                               # the program's allocator
  libeigen3-dev                                                 # linear systems
  libcli11-dev nlohmann-json3-dev libfmt-dev gnuplot-nox        # program and report
  pybind11-dev python3-dev python3-numpy                        # the package for Python
  libgtest-dev pkgconf                                          # tests
)
if_offered=(
  libflint-arb-dev  # Arb, which FLINT 3 contains
)

list=packages
for argument in "$@"; do
  case "$argument" in
    --if-offered) list=if_offered ;;
    *) declare -n chosen=$list; chosen+=("$argument") ;;
  esac
done

# In a shell of its own, because the file may set any variable.
system=$(bash -c '. "$1" && echo "$ID${VERSION_ID:+ $VERSION_ID}"' bash "${EXACTFF_OS_RELEASE:-/etc/os-release}" 2> /dev/null || true)
case "$system" in
  "debian 12" | "debian 13" | "ubuntu 24.04") ;;
  *)
    cat >&2 << 'END'
exactff is built from these, in these versions or newer ones:

  compiler           GCC 12 or Clang 14
  CMake, Ninja       3.25, 1.11
  CGAL               5.5 to 6
  Boost              1.74, the headers
  GMP, MPFR          6.2 with its C++ interface gmpxx, 4.2
  FLINT              3, which contains Arb, or 2.9 with Arb 2.23
  Embree             4, or 3.13
  OpenEXR, libpng    3.1, 1.6
  tinygltf           2.7, as a library
  Eigen, CLI11       3.4, 2.3
  nlohmann-json      3.11
  fmt                9
  jemalloc           5.3; not needed with -DEXACTFF_JEMALLOC=OFF
  gnuplot            5.4, a program that draws the figures of reports
  Python, NumPy      3.9, 1.24, with pybind11 2.10; not needed with -DEXACTFF_PYTHON=OFF
  GoogleTest         1.12, with the program pkgconf; not needed with -DEXACTFF_TESTS=OFF

CMake also looks for libraries in the folders of CMAKE_PREFIX_PATH.
END
    echo "setup.sh installs packages on Debian 12, Debian 13 and Ubuntu 24.04, not on this system (${system:-of unknown name})." \
      "Install what is listed above, then set EXACTFF_SETUP=no: all scripts work without it." >&2
    exit 1
    ;;
esac

# set_not_installed VARIABLE PACKAGE...
set_not_installed() {
  local -n result=$1
  result=()
  for package in "${@:2}"; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2> /dev/null | grep -qx installed || result+=("$package")
  done
}
# A name of another release has no candidate. `grep -q` would not do: it may end before apt-cache has written all, which
# pipefail takes for a failure.
is_offered() { [[ "$(LC_ALL=C apt-cache policy "$1")" == *"  Candidate: "[!\(]* ]]; }
# Not on a fresh system, which has no lists of packages.
knows_offers() { [ -n "$(apt-cache madison libflint-dev)" ]; }

set_not_installed missing "${packages[@]}"
wanted=()
set_not_installed wanted "${if_offered[@]}"
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
update() {
  if [ "${#as_root[@]}" -gt 0 ] && ! command -v sudo > /dev/null; then
    echo "These packages need root or sudo: ${missing[*]} ${wanted[*]}" >&2
    exit 1
  fi
  "${as_root[@]}" apt-get update --quiet
}
if [ "${#missing[@]}" -gt 0 ] || { [ "${#wanted[@]}" -gt 0 ] && ! knows_offers; }; then
  update
fi
for package in "${wanted[@]}"; do
  ! is_offered "$package" || missing+=("$package")
done
[ "${#missing[@]}" -gt 0 ] || exit 0

echo "Installing: ${missing[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends "${missing[@]}"
