# SPDX-License-Identifier: MIT
# Public models and the validator's own corpus, where they lie beside the tree (../shared): whatever the
# Khronos validator accepts, and every OBJ and PLY, converts to output in which it finds no new error.
# Nothing crashes, valid or not.
. "$ROOT/tests/support/cli.sh"
shared=$ROOT/../shared
cd "$WORK" || exit 1

scene "public models convert to valid glTF"
if [ ! -d "$shared" ]; then
	skip_case "../shared is not here"
	done_testing
	exit
fi

# convert INPUT OUTPUT: exit codes 3 and 5 are kept for the list of what was refused.
refused=$WORK/refused
: >"$refused"
# glTF whose buffers all have bytes to bring along, where these are not on the web.
embeddable=$(find "$shared/models" "$shared/corpus" -type f -name '*.gltf' -print0 | python3 -c 'import json, sys
for name in sys.stdin.buffer.read().split(b"\0")[:-1]:
	try:
		if all("uri" in b for b in json.load(open(name, encoding="utf-8-sig")).get("buffers", [])):
			sys.stdout.buffer.write(name + b"\n")
	except (ValueError, TypeError, AttributeError):
		pass')
number=0
while IFS= read -r input; do
	number=$((number + 1))
	case $input in *.gltf) ending=gltf ;; *) ending=glb ;; esac
	mkdir "o$number"
	run --only=all "$input" "o$number/o.$ending"
	case $status in
	0) printf '%s\t%s\n' "$PWD/o$number/o.$ending" "$input" >>pairs ;;
	3 | 5 | 2) printf '%s\t%s\t%s\n' "$status" "$input" "$(tail -1 "$WORK/err.txt")" >>"$refused" ;;
	*) wrong "$input: exit code $status" ;;
	esac
	# Into the other container, where every buffer has bytes to bring along; tests/soak/formats.sh does so under sanitizers.
	if [ "$status" = 0 ] && [ $ending = gltf ] && [[ $BUILD != *sanitize ]] && [[ $'\n'$embeddable$'\n' == *$'\n'"$input"$'\n'* ]]; then
		run --only=all "$input" "o$number/o.glb"
		case $status in
		0) printf '%s\t%s\n' "$PWD/o$number/o.glb" "$input" >>pairs ;;
		2 | 5) ;; # a .bin that is not there, or on the web, could be linked but not embedded
		*) wrong "$input: exit code $status into a GLB" ;;
		esac
	fi
done < <(find "$shared/models" "$shared/corpus" -type f \( -name '*.obj' -o -name '*.ply' -o -name '*.gltf' -o -name '*.glb' \) | sort)
[ "$number" -gt 100 ] || wrong "only $number files found"
valid --pairs pairs

scene "Draco's own models have as many faces and points as others say"
for row in car:1744:1856 bunny_gltf:69451:34834 cube_att:12:24; do
	IFS=: read -r name faces points <<<"$row"
	run -q --check --fail-on=never --report=r.json "$shared/models/drc/$name.drc"
	is "$name $(value r.json '[(m["faces"], m["vertices"]["before"]) for m in r["files"][0]["meshes"]]')" "$name [($faces, $points)]"
done

scene "what is refused has a place"
[ -s "$refused" ] || wrong "nothing is refused"
is "$(grep -E '\.gl(tf|b)	' "$refused" | grep -vE '	nmtan: [^	]*\.gl(tf|b): (/|at byte |[a-z ]*, expected an object)' | head -3)" ""

scene "what is refused is invalid, compressed or has no triangles"
if [ -f "$ROOT/build/node/node_modules/gltf-validator/package.json" ]; then
	grep -E '\.(gltf|glb)	' "$refused" | grep -v '^5' | cut -f2 >suspects
	while IFS= read -r input; do
		# A file the validator accepts without an error must not be refused as invalid.
		! ask answer.mjs validate "$input" >/dev/null 2>&1 ||
			wrong "refused although valid: $(grep -F "	$input	" "$refused" | cut -f3)"
	done <suspects
	# Infinite coordinates, lines alone, and points.
	is "$(grep -E '\.(obj|ply)	' "$refused" | cut -f2 | sed 's,.*/,,' | tr '\n' ' ')" \
		"inf_nan.obj test_lines.obj float_inf_point_cloud.ply "
else
	skip_case "gltf-validator is not installed (no network?)"
fi

done_testing
