#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/formats.sh BUILD_DIR...: every public model of ../shared to every output format, with the
# options that change what is written. No crash, no hang; what is written as glTF has no error in the
# Khronos validator that the input did not have; what is written as PLY is read again. Documents with a
# buffer that is nowhere are left out: a GLB shows zeros where they have nothing to judge. --images=none over
# OBJ and PLY, because a glTF made from a glTF keeps its images.
set -u
cd "$(dirname "$0")/../.." || exit 1
ROOT=$PWD
passed=0 failed=0
shared=$ROOT/../shared
[ -d "$shared" ] || { echo "formats.sh: ../shared is not here, nothing to run"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export ASAN_OPTIONS=exitcode=99

bad() {
	echo "FAILED $1"
	failed=$((failed + 1))
}

# One way to write every model: LABEL ENDING OPTIONS...
way() {
	local label=$1 ending=$2 input number=0 code
	shift 2
	rm -rf "$work/o" && mkdir "$work/o"
	: >"$work/pairs"
	while IFS= read -r input; do
		case $label:$input in *"no images"*:*.gl* | *draco*:*.[opd]*) continue ;; esac
		number=$((number + 1))
		mkdir "$work/o/$number"
		timeout 60 "$nmtan" -q "$@" "$input" "$work/o/$number/o.$ending" >"$work/said" 2>&1
		code=$?
		case $code in
		0) printf '%s\t%s\n' "$work/o/$number/o.$ending" "$input" >>"$work/pairs" ;;
		2 | 3 | 5) ;;
		*) bad "$label: $input: exit code $code: $(grep -m1 -E 'ERROR|runtime error' "$work/said")" ;;
		esac
	done <"$work/inputs"
	if [ "$ending" = ply ]; then
		while IFS=$'\t' read -r output input; do
			"$nmtan" -q --check --fail-on=never "$output" >"$work/said" 2>&1 ||
				bad "$label: $input: its PLY cannot be read: $(tail -1 "$work/said")"
		done <"$work/pairs"
	elif ! node tests/support/answer.mjs validate --pairs "$work/pairs" >"$work/said"; then
		cat "$work/said"
		bad "$label: new errors in the validator"
	fi
	passed=$((passed + $(wc -l <"$work/pairs")))
	echo "$label: $(wc -l <"$work/pairs") of $number written"
}

find "$shared/models" "$shared/corpus" -type f \( -name '*.obj' -o -name '*.ply' -o -name '*.drc' \
	-o -name '*.gltf' -o -name '*.glb' \) | sort | while IFS= read -r input; do
	case $input in
	*.gltf)
		placed=$(node tests/support/answer.mjs gltf "$input" '(g.buffers ?? []).every((b) => b.uri)' 2>&1)
		[ "$placed" = false ] || printf '%s\n' "$input"
		;;
	*) printf '%s\n' "$input" ;;
	esac
done >"$work/inputs"
for build in "$@"; do
	nmtan=$ROOT/$build/nmtan
	way "$build glb" glb
	way "$build gltf" gltf --only=all
	way "$build gltf, replaced, bitangents" gltf --only=all --existing=replace --bitangents
	way "$build gltf, embedded" gltf --only=all --buffers=embed --images=embed
	way "$build gltf, images copied" gltf --images=copy
	way "$build glb, no images, smooth normals" glb --only=all --images=none --normals=smooth
	way "$build glb, flat normals, verified" glb --only=all --normals=flat --verify
	way "$build glb, draco, verified" glb --only=all --existing=replace --draco=edgebreaker --verify
	way "$build gltf, draco off, short, verified" gltf --existing=replace --draco=off --precision=short --verify
	way "$build glb, linked buffers, verified" glb --existing=replace --buffers=link --verify
	way "$build glb, lengyel" glb --only=all --existing=replace --method=lengyel
	way "$build glb, area" glb --only=all --existing=replace --method=area
	way "$build glb, robust" glb --only=all --existing=replace --method=robust
	way "$build ply" ply --only=all
	way "$build ply, bitangents" ply --only=all --bitangents
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
