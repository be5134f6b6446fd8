#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/conformance.sh BUILD_DIR...: the answers of the conformance kit against mikktspace.c as published, which
# lies in the folder that $MIKKTSPACE names; the card in three.js, right and with each mistake, and in Babylon.js; and
# what other programs that are here score: build/conformance-results.md. ($GLTFPACK, $BLENDER and $ASSIMP name theirs.)
set -u
cd "$(dirname "$0")/../.." || exit 1
status=0 build=$1
if [ -f "${MIKKTSPACE:-.}/mikktspace.c" ]; then
	python3 -B tests/conformance/reference.py "$MIKKTSPACE" || status=1
else
	echo "conformance.sh: \$MIKKTSPACE names no folder that has mikktspace.c, nothing was compared"
fi
make -s conformance build/clients/node_modules/three/package.json build/node/node_modules/gltf-validator/package.json
babylon=build/babylon/node_modules
[ -d $babylon/babylonjs-loaders ] || npm install --prefix build/babylon --no-save --ignore-scripts --no-audit --no-fund \
	--loglevel=error babylonjs@9.35.0 babylonjs-loaders@9.28.0 >/dev/null || babylon=
node tests/conformance/card.mjs build/conformance/card.glb build build/conformance.png $babylon >build/conformance-card.txt ||
	status=1
cat build/conformance-card.txt

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
page=build/conformance-results.md
kit=build/conformance
{
	printf '# The conformance kit\n\n'
	grep ', as it is' build/conformance-card.txt | sed 's/.*/The card in &./'
	printf '\n![the card in three.js](conformance.png) '
	[ -z "$babylon" ] || printf '![the card in Babylon.js](conformance-babylon.png)'
	printf '\n\n| program | published | sorted | fails (published) |\n|---|---|---|---|\n'
} >$page

# peer NAME COMMAND: runs it with $out, and appends a row.
peer() {
	out=$work/$1
	mkdir "$out"
	eval "$2" >"$work/log" 2>&1 || true
	local dialect scores=()
	for dialect in published sorted; do
		NMTAN=$PWD/$build/nmtan sh $kit/score.sh "$out" $dialect >"$work/$dialect"
		scores+=("$(tail -1 "$work/$dialect")")
	done
	echo "| \`$2\` | ${scores[0]} | ${scores[1]} | $(sed -n 's/^FAIL  //p' "$work/published" | paste -sd, | sed 's/,/, /g; s/..*$/& /')|" >>$page
}
each='for f in $kit/[!c]*.glb; do'
peer nmtan "$build/nmtan -q -d \$out $kit/[!c]*.glb"
peer nmtan_sorted "$build/nmtan -q --method=mikktspace-sorted -d \$out $kit/[!c]*.glb"
for name in mikktspace three three-lengyel meshoptimizer meshoptimizer-compatible; do
	peer $name "node tests/conformance/peers.mjs $name build/clients/node_modules \$kit \$out"
done
if gltfpack=$(command -v "${GLTFPACK:-gltfpack}"); then
	peer gltfpack "$each $gltfpack -noq -kn -km -kv -gt -i \$f -o \$out/\${f##*/}; done"
fi
if blender=$(command -v "${BLENDER:-blender}"); then
	peer blender "$blender -b --factory-startup --python tests/conformance/blender.py -- \$kit \$out"
fi
if assimp=$(command -v "${ASSIMP:-assimp}"); then
	peer assimp "for f in \$kit/*.obj; do $assimp export \$f \$out/\$(basename \$f .obj).glb -fglb2 -cts; done"
fi
cat $page
grep -q '/nmtan -q -d .*` | 12 passed, 0 failed | 11 passed, 1 failed | |$' $page || status=1
grep -q '=mikktspace-sorted .*` | 11 passed, 1 failed | 12 passed, 0 failed | unfinished_sort |$' $page || status=1
[ $status = 0 ] && echo "1 passed, 0 failed"
exit $status
