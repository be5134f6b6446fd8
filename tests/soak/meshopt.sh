#!/bin/bash
# SPDX-License-Identifier: MIT
# meshopt.sh BUILD: gltfpack packs every .gltf and .glb below the folders of NT_CORPUS (../shared/models/gltf unless it
# says others) in ten ways. All views are decoded as npm's decoder does; what nmtan makes of a file has what the file has,
# bit for bit, in all corners, right frames, and no error in the Khronos validator that the file has not; a repair settles.
nmtan=$PWD/$1/nmtan views=$PWD/$1/tests/unit/ext/test_meshopt answer=$PWD/tests/support/answer.mjs
gltfpack=$PWD/build/node/node_modules/gltfpack/cli.js
folders=${NT_CORPUS:-../shared/models/gltf}
[ -f "$gltfpack" ] || { echo "gltfpack is not installed"; exit 0; }
t=$(mktemp -d)
trap 'rm -rf "$t"' EXIT
files=0 failed=0 before=0 after=0

fault() {
	failed=$((failed + 1))
	echo "$file, $words: $1"
}

while IFS= read -r file; do
	for words in "-c" "-cc" "-c -ce khr" "-cc -ce khr" "-c -vi" "-c -noq" "-cc -vpf -vtf -vnf" "-c -vn 10" "-cf" \
		"-cf -ce khr"; do
		rm -rf "$t/w" && mkdir "$t/w"
		case $words in -cf*) in=$t/w/in.gltf ;; *) in=$t/w/in.glb ;; esac
		# shellcheck disable=SC2086
		node "$gltfpack" -i "$file" -o "$in" -tr $words >/dev/null 2>&1
		[ -f "$in" ] || continue
		files=$((files + 1))
		node "$answer" meshopt views "$t/views" "$in" >/dev/null && "$views" "$t/views" >"$t/said" ||
			fault "$(tail -1 "$t/said")"
		out=$t/w/out.${in##*.}
		"$nmtan" -q --verify --only=all --existing=replace --outside=yes "$in" "$out" 2>"$t/said" ||
			{ fault "$(cat "$t/said")"; continue; }
		node "$answer" meshopt same "$in" "$out" >"$t/said" || fault "$(head -1 "$t/said")"
		counts=$(node "$answer" frames "$out")
		[[ $counts =~ \ (unit|w|mixed|wrong)\ [1-9] ]] && fault "$counts"
		node "$answer" validate "$out" "$in" >"$t/said" || fault "$(head -1 "$t/said")"
		"$nmtan" -q --existing=repair --only=all --outside=yes "$out" "$t/w/one.glb" 2>/dev/null
		"$nmtan" -q --existing=repair --only=all --outside=yes "$t/w/one.glb" "$t/w/two.glb" 2>/dev/null
		cmp -s "$t/w/one.glb" "$t/w/two.glb" || fault "a second repair differs"
		before=$((before + $(stat -c %s "$in"))) after=$((after + $(stat -c %s "$out")))
	done
done < <(find $folders -type f \( -iname '*.gltf' -o -iname '*.glb' \) | sort)
echo "$files files, $before bytes, $after with tangents, $failed faults"
[ "$failed" = 0 ]
