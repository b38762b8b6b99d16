#!/usr/bin/env bash
# packages.sh [FOLDER]: makes the Debian packages and the wheel for Python in FOLDER (default: build/packages), from a
# build of its own, and tries them on a machine without compiler and libraries: a fresh copy of this system, Debian or
# Ubuntu, with Python and NumPy alone, in a folder. As root, with its archive in reach.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=$(realpath -m "${1:-$top/build/packages}")
build=$top/build/package
cd "$top"
validation/setup.sh mmdebstrap
validation/build.sh "$build" -DEXACTFF_TESTS=OFF -DEXACTFF_QUICK_BUILD=ON -DCMAKE_INSTALL_PREFIX=/usr
mkdir -p "$folder"
(cd "$build" && cpack -G DEB -B "$folder" && rm -rf "$folder/_CPack_Packages")
EXACTFF_BUILT=$build validation/wheel.sh "$folder"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root
mmdebstrap --quiet --variant=minbase --include=python3-venv,python3-numpy "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root"
mkdir "$root/trial"
cp "$folder"/*.whl "$folder"/{exactff,python3-exactff}_*.deb validation/python/try_wheel.py data/scenes/cornell_box.* "$root/trial"
cp /etc/resolv.conf "$root/etc/"
cat > "$root/trial/try.sh" << 'END'
set -euo pipefail
cd /trial
if command -v c++ cmake; then exit 1; fi
python3 -m venv --system-site-packages venv
env -u PIP_FIND_LINKS venv/bin/pip install --no-index ./*.whl
venv/bin/python try_wheel.py cornell_box.obj

{ apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends ./*.deb; } > log 2>&1 ||
  { cat log >&2; exit 1; }
exactff point cornell_box.obj --at 200 0 400 --normal 0 1 0 --on floor --source light --plain
cd /
python3 -c 'import exactff, sys; print(exactff.__file__, exactff.Scene.read(sys.argv[1]))' /trial/cornell_box.obj
END
unshare --mount bash -c 'mount -t proc proc "$1/proc" && exec chroot "$1" bash /trial/try.sh' try "$root"
echo "the wheel and the Debian packages serve a machine without a compiler: $folder"
