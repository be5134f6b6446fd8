#!/bin/bash
# SPDX-License-Identifier: MIT
# decoders.sh BUILD: every glTF below the folders of NT_CORPUS (data and ../shared/models unless it says others) is
# converted as it is, by each method of Draco and plain. draco3d and npm's meshoptimizer decode what comes of it
# (decoders.mjs), the Khronos validator finds no error that the input does not have, --verify agrees, and a second
# --existing=repair changes no byte.
nmtan=$1/nmtan
modules=$PWD/build/decoders
folders=${NT_CORPUS:-data ../shared/models}
t=$(mktemp -d)
trap 'rm -rf "$t"' EXIT
mkdir -p $modules
cp tests/soak/package.json tests/soak/package-lock.json $modules
[ -d $modules/node_modules/draco3d ] || (cd $modules && npm ci --no-audit --no-fund) >"$t/npm" 2>&1 || {
	cat "$t/npm"
	echo "1 passed, 0 failed, 1 skipped (npm has no packages)"
	exit 0
}
files=0 failed=0

fault() {
	failed=$((failed + 1))
	echo "$1: $2"
}

while IFS= read -r file; do
	"$nmtan" -q --only=all --existing=repair "$file" "$t/kept.glb" >/dev/null 2>&1 || continue
	files=$((files + 1))
	"$nmtan" -q --only=all --existing=repair "$t/kept.glb" "$t/again.glb" >/dev/null 2>&1
	cmp -s "$t/kept.glb" "$t/again.glb" || fault "$file" "a second repair changes the output"
	for choice in keep off sequential edgebreaker; do
		"$nmtan" -q --only=all --existing=replace --verify --draco=$choice "$file" "$t/$choice.glb" >"$t/said" 2>&1 ||
			fault "$file" "--draco=$choice: $(tail -1 "$t/said")"
	done
	node tests/soak/decoders.mjs $modules tangents "$t/kept.glb" >"$t/said" || fault "$file" "$(head -3 "$t/said")"
	node tests/soak/decoders.mjs $modules all "$t"/{keep,off,sequential,edgebreaker}.glb >"$t/said" ||
		fault "$file" "$(head -3 "$t/said")"
	for output in kept keep off sequential edgebreaker; do
		printf '%s\t%s\n' "$t/$output.glb" "$file"
	done >"$t/pairs"
	node tests/support/answer.mjs validate --pairs "$t/pairs" >"$t/said" || fault "$file" "$(head -3 "$t/said")"
done < <(find $folders -type f \( -iname '*.gltf' -o -iname '*.glb' \) | sort)
echo "$((files - failed)) passed, $failed failed"
[ $failed = 0 ]
