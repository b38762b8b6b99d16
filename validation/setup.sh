#!/usr/bin/env bash
# setup.sh [PACKAGE...]: installs the Debian 12 packages that exactff is built from, and those named, as root or with
# sudo. Does nothing if they are already installed.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libcgal-dev libboost-dev libgmp-dev libmpfr-dev libflint-dev libflint-arb-dev  # exact geometry, certified contour
  libembree-dev                                                                  # shadow rays
  libopenexr-dev libpng-dev                                                      # images
  libjemalloc-dev                                                                # the program's allocator
  libeigen3-dev                                                                  # linear systems
  libcli11-dev nlohmann-json3-dev gnuplot-nox                                    # program and report
  pybind11-dev python3-dev python3-numpy                                         # the package for Python
  libgtest-dev patch pkgconf                                                     # tests
  "$@"
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ "${#missing[@]}" -gt 0 ] || exit 0

echo "Installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "These packages need root or sudo: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update --quiet
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends "${missing[@]}"
