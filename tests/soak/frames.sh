#!/bin/bash
# SPDX-License-Identifier: MIT
# frames.sh BUILD: every OBJ and PLY with texture coordinates below the folders of NT_CORPUS (data and ../shared/models unless it
# says others) becomes GLB. Each is read by frames.mjs, which knows nothing of nmtan, must pass --check without a
# finding about tangents that a conversion could have avoided, and must stay as it is, byte for byte, when it is
# converted again with --existing=keep and repair.
nmtan=$1/nmtan
folders=${NT_CORPUS:-data ../shared/models}
t=$(mktemp -d)
trap 'rm -rf "$t"' EXIT
files=0 failed=0 total=
avoidable='TAN_(ZERO|NON_UNIT|NOT_FINITE|NOT_ORTHOGONAL|PARALLEL_NORMAL|BAD_W|SIGN_MISMATCH|MIXED_W_TRIANGLE|MIRROR_SHARED_VERTEX|DIRECTION_MISMATCH|EXISTING_BAD)'

fault() {
	failed=$((failed + 1))
	echo "$1: $2"
}

while IFS= read -r file; do
	"$nmtan" -q --images=none --existing=replace --only=all "$file" "$t/o.glb" >/dev/null 2>&1 || continue
	counts=$(node tests/support/answer.mjs frames "$t/o.glb") || { fault "$file" "cannot be read back"; continue; }
	[[ $counts == "corners 0 "* ]] && continue
	files=$((files + 1))
	total+=$counts$'\n'
	[[ $counts =~ \ (degree|lean|unit|w|mixed|wrong)\ [1-9] ]] && fault "$file" "$counts"
	"$nmtan" --check -q --fail-on=never --report="$t/r.json" "$t/o.glb" >/dev/null 2>&1
	found=$(python3 - "$t/r.json" "$avoidable" <<-'PYTHON'
		import json, re, sys
		found = [i for file in json.load(open(sys.argv[1]))["files"] for i in file["findings"]]
		print(*sorted({i["code"] for i in found if i["severity"] in ("warning", "error") and re.fullmatch(sys.argv[2], i["code"])}))
	PYTHON
	)
	# MikkTSpace of quads is not that of their triangles, which is what the output is
	! grep -qE '^f( +[^ ]+){4}' "$file" || found=${found//TAN_DIRECTION_MISMATCH/}
	[ -z "${found// /}" ] || fault "$file" "--check of the output: $found"
	for existing in keep repair; do
		"$nmtan" -q --existing=$existing --only=all "$t/o.glb" "$t/again.glb" >/dev/null 2>&1
		cmp -s "$t/o.glb" "$t/again.glb" || fault "$file" "--existing=$existing changes the output"
	done
done < <(find $folders -type f \( -iname '*.obj' -o -iname '*.ply' \) | sort)

awk '{ for (i = 1; i < NF; i += 2) { if (!($i in sum)) name[++n] = $i; sum[$i] += $(i + 1) } }
	END { for (i = 1; i <= n; i++) printf "%s %d%s", name[i], sum[name[i]], i < n ? ", " : "\n" }' <<<"$total"
echo "$files files, $failed faults"
[ "$failed" = 0 ]
