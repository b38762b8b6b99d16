#!/usr/bin/env bash
# check_setup.sh SETUP: runs setup.sh on systems that are made up: a file that names the system, and an apt of our own that
# says what it offers. Checks which packages are asked for, and what is said on a system that is not known.
set -euo pipefail

setup=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "FAILED: $1" >&2
  cat "$work/calls" "$work/log" >&2
  exit 1
}

# Offered is what `lists` names, after `apt-get update` what `archive` names; installed is what `installed` names. The
# table of versions is longer than a pipe holds, so that a reader that ends early is noticed.
mkdir "$work/bin"
cat > "$work/bin/dpkg-query" << 'END'
#!/bin/bash
grep -qx "${*: -1}" "$FAKE/installed" && echo installed
END
cat > "$work/bin/apt-cache" << 'END'
#!/bin/bash
case "$1 $(grep -cx "$2" "$FAKE/lists")" in
  "madison 1") echo " $2 | 1.0 | http://example.org main" ;;
  "policy 1") printf '%s:\n  Installed: (none)\n  Candidate: 1.0\n  Version table:\n%100000s\n' "$2" "" || exit 100 ;;
  "policy 0") [[ $2 != libflint* ]] || printf '%s:\n  Installed: (none)\n  Candidate: (none)\n' "$2" ;;
esac
END
cat > "$work/bin/apt-get" << 'END'
#!/bin/bash
echo "apt-get $*" >> "$FAKE/calls"
if [ "$1" = update ]; then cp "$FAKE/archive" "$FAKE/lists"; fi
END
printf '#!/bin/bash\nexec "$@"\n' > "$work/bin/sudo"
chmod +x "$work"/bin/*
export FAKE=$work

# on SYSTEM VERSION OFFERED INSTALLED [ARGUMENT...]: of packages besides those that every known system has.
on() {
  printf 'ID=%s\nVERSION_ID="%s"\nPATH=/nowhere\n' "$1" "$2" > "$work/os-release"
  common=$(sed -n '/^packages=(/,/^)/p' "$setup" | sed '1d; $d; s/#.*//' | xargs -n 1)
  printf '%s\n' "$common" ${3//,/ } > "$work/archive"
  printf '%s\n' ${4//,/ } > "$work/installed"
  [ "$4" != all ] || echo "$common" > "$work/installed"
  : > "$work/calls"
  status=0
  PATH=$work/bin:$PATH EXACTFF_OS_RELEASE=$work/os-release "$setup" "${@:5}" > "$work/log" 2>&1 || status=$?
  installs=$(sed -n 's/^apt-get install //p' "$work/calls")
}
asks_for() { [[ " $installs " == *" $1 "* ]]; }

: > "$work/lists"
on debian 12 libflint-arb-dev "" extra
[ "$status" = 0 ] || fail "fails on Debian 12"
for package in libflint-dev libflint-arb-dev libembree-dev libcgal-dev extra; do
  asks_for "$package" || fail "does not install $package on Debian 12"
done
grep -q '^apt-get update' "$work/calls" || fail "does not ask for the lists of packages"

for system in "debian 13" "ubuntu 24.04"; do
  : > "$work/lists"
  on ${system} chromium "" extra --if-offered chromium chromium-driver
  [ "$status" = 0 ] || fail "fails on $system"
  ! asks_for libflint-arb-dev || fail "installs Arb on $system, which does not offer it"
  asks_for libflint-dev && asks_for extra || fail "does not install what $system has"
  asks_for chromium && ! asks_for chromium-driver || fail "takes no notice of what is offered on $system"
done

on debian 13 "" all
[ "$status" = 0 ] && [ ! -s "$work/calls" ] || fail "has something to do where everything is installed"
: > "$work/lists"
on debian 12 libflint-arb-dev all
asks_for libflint-arb-dev || fail "does not see that Arb is missing on a system without lists"
[ "${installs##*--no-install-recommends }" = libflint-arb-dev ] || fail "installs more than Arb"

on fedora 41 "" ""
[ "$status" = 1 ] && [ ! -s "$work/calls" ] || fail "does not refuse a system that it does not know"
for line in "FLINT  *3, .* 2\.9 with Arb 2\.23" "Embree  *4, or 3\.13" "CGAL  *5\.5 to 6" "CMAKE_PREFIX_PATH" "fedora 41"; do
  grep -q "$line" "$work/log" || fail "does not say on an unknown system: $line"
done
EXACTFF_SETUP=no on fedora 41 "" ""
[ "$status" = 0 ] && [ ! -s "$work/log" ] || fail "does something with EXACTFF_SETUP=no"
echo "setup.sh asks for what is offered, and refuses systems that it does not know"
