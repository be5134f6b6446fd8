#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/needed.sh BUILD_DIR...: a GLB of 200 MB and one hundred primitives, one or none of which needs
# tangents: what is read (test_needed.c), and how long the tool takes beside cp, best of five; printed only.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
NT_HUNDRED_MB=200 "$build/tests/unit/pipeline/test_needed" >"$work/said" 2>&1
code=$?
grep 'bytes touched' "$work/said"

# best COMMAND...: milliseconds
best() {
	local run begin end least=999999
	for run in 1 2 3 4 5; do
		rm -f "$work/out.glb"
		begin=$(date +%s%N)
		"$@" || return 1
		end=$(date +%s%N)
		[ $(((end - begin) / 1000000)) -ge $least ] || least=$(((end - begin) / 1000000))
	done
	echo "$least"
}
for which in one none; do
	python3 tests/support/gltf_hundred.py "$work/in.glb" 200 $which >/dev/null
	cp "$work/in.glb" "$work/out.glb"
	echo "$which needed: cp $(best cp --reflink=never "$work/in.glb" "$work/out.glb") ms," \
		"nmtan $(best "$build/nmtan" -q "$work/in.glb" "$work/out.glb") ms"
done
[ $code = 0 ] && echo "1 passed, 0 failed" || { cat "$work/said"; echo "0 passed, 1 failed"; }
exit $code
