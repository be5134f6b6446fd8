#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/amalgamation.sh BUILD: nmtan.c for s390x (64 bits) and powerpc (32 bits), whose bytes are big-endian,
# by qemu, and for Windows, by MinGW and wine, which needs no display: the digest of the golden meshes is the library's.
# Installs the compilers, qemu-user and wine64 where apt-get can.
set -u
cd "$(dirname "$0")/../.." || exit 1
one=build/amalgamation
NMTAN_LEVEL=-O1 bash tests/run --only=test_amalgamation "$1" || exit 1
packages=()
for pair in s390x-linux-gnu-gcc:gcc-s390x-linux-gnu powerpc-linux-gnu-gcc:gcc-powerpc-linux-gnu qemu-s390x:qemu-user \
	x86_64-w64-mingw32-gcc:gcc-mingw-w64-x86-64 /usr/lib/wine/wine64:wine64; do
	command -v "${pair%%:*}" >/dev/null || packages+=("${pair#*:}")
done
[ ${#packages[@]} = 0 ] ||
	DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${packages[@]}" \
	>/dev/null 2>&1 || { echo "amalgamation.sh: cannot install ${packages[*]}, nothing to run"; exit 0; }
make -s amalgamation "$1/libnmtan.a" || exit 1
work=$(mktemp -d)
export WINEPREFIX=$work/wine WINEDEBUG=-all
trap '/usr/lib/wine/wineserver64 -k; rm -rf "$work"' EXIT
mapfile -t goldens < <(find data/golden -name '*.nmtg' | LC_ALL=C sort)

# run RUNNER COMMAND...: builds digest.c, and runs it.
run() {
	local runner=$1
	shift
	"$@" -w -DNMTAN_SUMS -I$one tests/api/digest.c "$source" -o "$work/digest.exe" -lm || return
	$runner "$work/digest.exe" "${goldens[@]}" 2>"$work/said" || { cat "$work/said" >&2; return 1; }
}
source=$1/libnmtan.a
expected=$(run env gcc -pthread)
source=$one/nmtan.c bad=0
for build in "qemu-s390x s390x-linux-gnu-gcc -O2 -static" "qemu-ppc powerpc-linux-gnu-gcc -O2 -static" \
	"/usr/lib/wine/wine64 x86_64-w64-mingw32-gcc -O2 -static"; do
	runner=${build%% *}
	# shellcheck disable=SC2086
	actual=$(run $runner ${build#* } | tr -d '\r') || bad=1
	[ "$actual" = "$expected" ] || { echo "${build#* }: $actual, not $expected"; bad=1; }
done
[ $bad = 0 ] && echo "amalgamation.sh: $expected everywhere"
exit $bad
