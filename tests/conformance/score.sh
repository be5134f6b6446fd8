#!/bin/sh
# SPDX-License-Identifier: MIT
#
# score.sh DIR [DIALECT]: compares DIR/NAME.glb (or .gltf), what your program made of NAME, with expected/NAME.glb.
# DIALECT: published, or sorted for programs that complete the edge sort. Needs nmtan in PATH, or $NMTAN. Exit 1: some
# failed, or there was nothing to compare.
dir=$1 dialect=${2:-published} failed=0 passed=0
here=$(dirname "$0")
for expected in "$here"/expected/*.glb; do
	name=$(basename "$expected" .glb)
	case $name in *.sorted) continue ;; esac
	[ "$dialect" = sorted ] && [ -f "$here/expected/$name.sorted.glb" ] && expected=$here/expected/$name.sorted.glb
	yours=$dir/$name.glb
	[ -f "$yours" ] || yours=$dir/$name.gltf
	[ -f "$yours" ] || { echo "NONE  $name" && continue; }
	said=$("${NMTAN:-nmtan}" --check --diff --fail-on=never "$expected" "$yours" 2>&1)
	# nothing changed, or all triangles are there, with their texture coordinates, and no tangent is another one
	if printf '%s' "$said" | grep -q ' 0 of 1 meshes changed' ||
		{ printf '%s' "$said" | grep -q ' triangles \([0-9]*\), \1 of them in place, 0 corners with other' &&
			printf '%s' "$said" | grep -q '^ *0 of [1-9][0-9]* tangents turned, .* degrees at most, 0 with w'; }; then
		echo "PASS  $name"
		passed=$((passed + 1))
	else
		echo "FAIL  $name"
		printf '%s\n' "$said" | sed -n '/ triangles \|tangents\|nmtan:/s/^ */      /p'
		failed=$((failed + 1))
	fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ] && [ $passed -gt 0 ]
