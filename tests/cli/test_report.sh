# SPDX-License-Identifier: MIT
# The report: valid against its schema, equal to an independent count, honest about what is old and new.
# Leaks count.
. "$ROOT/tests/support/cli.sh"
report=$ROOT/tests/report

# The numbers of count.py as the report's first mesh has them.
counts_of() {
	value "$1" '" ".join(map(str, [m[k][n] for m in r["files"][0]["meshes"][:1] for k, names in (
		("triangles", ("normal", "mirrored", "degenerate")),
		("edges", ("all", "boundary", "non_manifold", "inconsistent_winding", "mirror"))) for n in names] +
		[sum(r["files"][0]["meshes"][0]["islands_by_kind"].values())]))'
}

scene "reports of our own meshes are valid and the counts are those of an independent script"
for name in mirrored_cube head quad; do
	run --check --report=$name.json "$data/$name.obj"
	exits 0
	validates report $name.json
	is "$(counts_of $name.json)" "$(python3 "$report/count.py" "$data/$name.obj")"
done

scene "counts of difficult public meshes are those of the independent script"
models=$ROOT/../shared/models/obj
if [ -d "$models" ]; then
	for name in tangeract crangeract spot cube cube_att; do
		run --check --fail-on=never --report=$name.json "$models/$name.obj"
		exits 0
		validates report $name.json
		read -ra told <<<"$(counts_of $name.json)"
		read -ra counted <<<"$(python3 "$report/count.py" "$models/$name.obj")"
		# flipped triangles make no mirror edges in the report, and have one to three each; it names no needles
		flipped=$(value $name.json 'sum(f["count"] for f in r["files"][0]["findings"] if f["code"] == "UV_FLIPPED_TRIANGLE")')
		less=$((counted[7] - told[7]))
		[ $less -ge "$flipped" ] && [ $less -le $((3 * counted[1])) ] && told[7]=${counted[7]}
		is "$name ${told[*]}" "$name ${counted[*]}"
	done
else
	skip_case "../shared is not here"
fi

scene "every public model gives a valid report"
if [ -d "$ROOT/../shared/models" ]; then
	most=9999999k # -1G would be empty files alone: find rounds up
	[[ $BUILD != *sanitize* ]] || most=200k
	find "$ROOT/../shared/models" -size -$most \( -name '*.obj' -o -name '*.ply' -o -name '*.gltf' -o -name '*.glb' \) |
		sort >names
	xargs "$NMTAN" -q --check --report=all.json --outside=yes <names >/dev/null 2>&1
	validates report all.json
	is "$(value all.json 'len(r["files"])')" "$(wc -l <names)"
else
	skip_case "../shared is not here"
fi

scene "a quiet run prints the report whose format was asked for, and nothing else"
"$NMTAN" --check -q --report-format=json "$data/quad.obj" >r.json 2>err || wrong "exit code $?"
is "$(cat err)" ""
validates report r.json
"$NMTAN" --check -q "$data/quad.obj" >out 2>&1 || wrong "exit code $?"
is "$(cat out)" ""

scene "the known traps are caught"
if [ -d "$ROOT/../shared/models" ]; then
	models=$ROOT/../shared/models
	run --check "$models/obj/triangle_with_degenerate_tex_coords.obj"
	prints "UV_UNMAPPED  the mesh is not unwrapped: 1 triangle has no area in UV space"
	for name in rancid_geometry obliterated; do
		run --check "$models/obj/$name.obj"
		prints "MESH_NON_MANIFOLD_EDGE"
	done
	multi=$models/gltf/MultiUVTest/glTF/MultiUVTest.gltf
	run --check "$multi"
	prints "TAN_UNUSED"
	prints "TAN_SIGN_MISMATCH  6 triangles"
	prints "TAN_DIRECTION_MISMATCH  18 corners"
	exits 0
	run --check --uv=1 "$multi" # the set they were made for
	! grep -q "TAN_SIGN\|TAN_DIRECTION" ../out.txt || wrong "found what is not there"
	run --check --fail-on=info "$models/gltf/pbr_sphere/glTF/sphere.gltf"
	prints "NMAP_NOT_UNIT"
	prints "Lengyel's sums: 99 % of the corners are within 1 degrees of MikkTSpace"
	exits 6
	run --check --fail-on=info --check-maps=off --ignore=TAN_MADE_BY "$models/gltf/pbr_sphere/glTF/sphere.gltf"
	exits 0
	run --check "$models/gltf/SheenCloth/glTF/SheenCloth.gltf" # scales v by -30
	exits 0
	prints "they were made without the texture transform"
else
	skip_case "../shared is not here"
fi

scene "the same input gives the same bytes, wherever it lies"
run --check --ignore=TAN_UNUSED --report=a.json -j1 "$data/head.obj" # whose command has the path
cp "$data/head.obj" .
run --check --ignore=TAN_UNUSED --report=b.json -j2 "$PWD/head.obj"
cmp -s <(sed 's,"file":"[^"]*head.obj",,' a.json) <(sed 's,"file":"[^"]*head.obj",,' b.json) || wrong "they differ"
! grep -qF "$PWD" b.json || wrong "an absolute path"

scene "a degenerate face of an OBJ is named by line and numbers, and told once"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 2 0\n\n# f\nf 1/1 \\\n 2/2 3/3\n' >d.obj
run --check --report=r.json d.obj
is "$(value r.json '[(f["code"], [(s["line"], s["source"]) for s in f["spots"]]) for f in r["files"][0]["findings"]
	if f["code"][:3] == "UV_"]')" "[('UV_UNMAPPED', [(9, '1/1 2/2 3/3')])]"
text='v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 2 0\nf 1/1 2/2\nf 1/1 2/2 3/3\n' # two corners are no face
for end in '\n' '\r' '\r\n'; do
	printf "${text//'\n'/$end}" >d.obj
	run --check --report=r.json d.obj
	is "$(value r.json '[s["line"] for f in r["files"][0]["findings"]
		for s in f["spots"] if f["code"] == "UV_UNMAPPED"]')" "[8]"
done

# of 200 corners as many as fit are told, and that there are more
{ printf 'v %d 0 0\n' {0..99}; printf 'v %d 1 0\n' {99..0}; printf 'vt 0 0\nf'; printf ' %d/1' {1..200}; echo; } >d.obj
run --check --report=r.json d.obj
is "$(value r.json '[(len(s["source"]), s["source"][-12:]) for f in r["files"][0]["findings"] for s in f["spots"]][:1]')" "[(507, '/1 102/1 ...')]"

# A triangle whose texture coordinates are on a line: with --severity=UV_UNMAPPED=error one error, of line 7.
flat() {
	printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nf 1/1/1 2/2/1 3/1/1\n'
}
strict="--check --severity=UV_UNMAPPED=error,TAN_REPAIRED=off,TAN_UNUSED=off"

scene "lines are those of compilers, and GitHub's commands are escaped: % and ends of lines, in names commas and colons, too"
flat >'a,b%c:d.obj'
echo 'f 1 2 3' >bad.obj
run $strict --report-format=lines 'a,b%c:d.obj' bad.obj
exits 3
is "$(cat ../out.txt)" 'a,b%c:d.obj:7: error: UV_UNMAPPED: the mesh is not unwrapped: 1 triangle has no area in UV space. Unwrap the mesh (Blender: UV > Smart UV Project).
bad.obj:1: error: face refers to "v" number 1, but the file has 0'
run $strict --report-format=github 'a,b%c:d.obj' bad.obj
is "$(cat ../out.txt)" '::error file=a%2Cb%25c%3Ad.obj,line=7,title=UV_UNMAPPED::the mesh is not unwrapped: 1 triangle has no area in UV space%0AUnwrap the mesh (Blender: UV > Smart UV Project).
::error file=bad.obj,line=1,title=not judged::face refers to "v" number 1, but the file has 0'
# why a file is not judged comes with its place in every format
printf '{"asset":{"version":"1.0"}}' >old.gltf
while IFS=: read -r format file text; do
	run $strict --report-format=$format $file
	prints "$text"
done <<'END'
text:bad.obj:bad.obj: not judged: line 1: face refers to "v" number 1, but the file has 0
markdown:bad.obj:| bad.obj | not judged: line 1: face
junit:bad.obj:message="line 1: face
csv:bad.obj:but the file has 0",1,,,,,,,,
lines:old.gltf:old.gltf: error: /asset/version: glTF version "1.0", expected 2.0
sarif:old.gltf:{"text": "/asset/version: glTF version
END
cp 'a,b%c:d.obj' $'e\r\nf.obj'
run --check --report-format=github --severity=UV_UNMAPPED=warning --path-prefix=art $'e\r\nf.obj'
exits 0
prints '::warning file=art/e%0D%0Af.obj,line=7,title=UV_UNMAPPED::the mesh'
{ sed 's/^f/usemtl 5%\nf/' 'a,b%c:d.obj'; } >m.obj # of the sentence % alone
run --check --report-format=github m.obj
prints '::warning file=m.obj,line=7,title=MATERIAL_UNKNOWN::material is defined by no material library: 5%25'
run --check --report-format=lines --report=log.txt m.obj
grep -q '^m.obj:7: warning: MATERIAL_UNKNOWN: ' log.txt || wrong "not written to a file"
run --check --report-format=github "$data/plates.gltf" # no lines, several meshes
grep -qE '^::error file=[^,]*plates.gltf,title=TAN_[A-Z_]*::.*, in mesh' ../out.txt || wrong "no mesh is named"
cp "$data"/{plates.gltf,plates.bin,bumps.png} .
run --check --min-severity=error --report-format=github plates.gltf # the command that repairs it
is "$(sed 's/.*%0A//' ../out.txt)" "Make them: nmtan --fix plates.gltf plates-repaired.gltf"
run --check --min-severity=error --report-format=lines plates.gltf
is "$(sed 's/.*texture, [^.]*\. //' ../out.txt)" "Make them: nmtan --fix plates.gltf plates-repaired.gltf"
gltf plates.gltf one 'g.meshes[0].primitives = [g.meshes[0].primitives[2]]'
for format in junit sarif; do # of one mesh, too
	run --check --min-severity=error --report-format=$format one.gltf
	prints "Make them: nmtan --fix one.gltf one-repaired.gltf"
	prints "/meshes/0/primitives/0"
	prints 'mesh '
done

# Two libraries, in a folder below; the second line of the first is empty.
scene "what a material library says is found at its lines, in every format"
mkdir in
printf 'mtllib mtl/a.mtl\nmtllib mtl/b.mtl\n' >in/m.obj
sed '1,/^o /{/^mtllib/d}; /^f /i usemtl wood' "$data/quad.obj" >>in/m.obj
mkdir in/mtl
printf 'newmtl wood\n\ndecal rough.png\nmap_Kd gone.png\n' >in/mtl/a.mtl
printf 'newmtl wood2\nd 1\n' >in/mtl/b.mtl
while IFS='|' read -r format lost missing; do
	run -q --check --report=- --report-format="$format" in/m.obj
	prints "$lost"
	prints "$missing"
done <<'END'
text|in material "wood", line 3 of in/mtl/a.mtl|in material "wood", line 4 of in/mtl/a.mtl
lines|in/mtl/a.mtl:3: warning: MATERIAL_LOST: |in/mtl/a.mtl:4: warning: IMAGE_MISSING: image cannot be read: gone.png (looked for beside a.mtl and m.obj), in material "wood"
github|::warning file=in/mtl/a.mtl,line=3,title=MATERIAL_LOST::|::warning file=in/mtl/a.mtl,line=4,title=IMAGE_MISSING::
markdown|material "wood", line 3 of in/mtl/a.mtl|material "wood", line 4 of in/mtl/a.mtl
sarif|"uri": "in/mtl/a.mtl"}, "region": {"startLine": 3}}, "logicalLocations": [{"name": "material \"wood\""|"uri": "in/mtl/a.mtl"}, "region": {"startLine": 4}}
junit|MTL: decal, in material &quot;wood&quot;, line 3 of in/mtl/a.mtl|gone.png (looked for beside a.mtl and m.obj), in material &quot;wood&quot;, line 4 of in/mtl/a.mtl
csv|"in/mtl/a.mtl","material ""wood""",MATERIAL_LOST,warning,1,"1 property of a material is not carried over: MTL: decal",3,|gone.png (looked for beside a.mtl and m.obj)",4,
html|"where":"material \"wood\", line 3 of in/mtl/a.mtl"|"where":"material \"wood\", line 4 of in/mtl/a.mtl"
END

scene "a quiet run that fails by what it found says what"
flat >m.obj
for words in "$strict -q m.obj" "$strict -q --report=r.json m.obj" "$strict --report=r.json m.obj" \
	"-q --severity=UV_UNMAPPED=error --fail-on=error m.obj m.glb"; do
	run $words
	exits 6
	says "nmtan: m.obj: error: the mesh is not unwrapped: 1 triangle has no area in UV space [UV_UNMAPPED]"
done
run $strict -q --report-format=text m.obj # which says it
exits 6
[ ! -s ../err.txt ] || wrong "said twice"
run --check -q m.obj
exits 0
silent
sed 's/^vt 1 0/vt 1 0\nvt 0 1/; s,3/1/1,3/3/1,' m.obj >sound.obj
run $strict -q --diff sound.obj m.obj
exits 6
says "nmtan: m.obj: error: the mesh is not unwrapped"

scene "exit codes follow the report, what is ignored and what is reweighed"
cp "$data/head.obj" .
run --check --fail-on=info head.obj
exits 6
prints "UV_MIRROR_SEAM"
run --check --fail-on=warning --severity=UV_MIRROR_SEAM=warning head.obj
exits 6
run --check --fail-on=warning --severity=UV_MIRROR_SEAM=warning --ignore=UV_MIRROR_SEAM head.obj
exits 0
run --check --severity=UV_MIRROR_SEAM=error head.obj
exits 6
run --check --severity=NORMALS_MADE=error,NORMALS_MADE=info --fail-on=warning head.obj
exits 0
for word in UV_MIRROR 'UV_MIRROR*X'; do
	for option in ignore severity explain; do
		run --check "--$option=$word$([ $option != severity ] || echo =error)" head.obj
		exits 1
		says "--$option: '$word' is no code"
	done
done
run --explain=UV_MIROR_SEAM
exits 1
says "did you mean UV_MIRROR_SEAM?"
run --explain=uv_miror_seam
exits 1
says "did you mean UV_MIRROR_SEAM?"
for words in "--ignore=uv_*,[NT]* --ignore=mtl_missing" "--severity=Uv_*=off,[NT]*=off --severity=MTL_MISSING=off"; do
	run --check --fail-on=info $words head.obj
	exits 0
done
run --check --baseline=none.json head.obj
exits 2
says "--baseline: there is no file 'none.json'; to make it: nmtan --check --report=none.json INPUT..."
run --check --baseline=no/none.json head.obj
exits 2
says "--baseline: there is no file 'no/none.json', and no folder for it"
says_not "to make it"
for name in none "it's one"; do # the command runs as it stands
	run --check --baseline="$name" head.obj
	command=$(sed -n 's/.*to make it: nmtan \(.*\) INPUT.*/\1/p' "$WORK/err.txt")
	eval "run $command head.obj"
	exits 0
	run --check --fail-on=info --baseline="$name" head.obj
	exits 0
done
run -q --check --fail-on=never --report=none.json head.obj
run -q --check --fail-on=info --baseline=none.json head.obj
exits 0
run --check --fail-on=info --ignore='UV_*,[NT]*,MTL_MISSING' head.obj # also NORMALS_MADE, TAN_NO_UV
exits 0
run --check --severity='UV_MIRROR_*=error' head.obj
exits 6
run --check --severity='*=error,UV_*=off,NORMALS_MADE=info,TAN_UNUSED=info' --ignore=MTL_MISSING head.obj
exits 0
run --check --severity='UV_*=off,UV_MIRROR_SEAM=error' head.obj # the last one counts
exits 6
run --check --severity='UV_MIRROR_SEAM=error' --ignore='UV_*' head.obj # but not against --ignore
exits 0
run --check --severity=UV_MIRROR_SEAM=bad head.obj
exits 1
run --check --report=r.xyz head.obj
exits 1

scene "a baseline leaves only what is new"
cp "$data/head.obj" .
run --check --report=old.json head.obj
run --check --fail-on=info --baseline=old.json --report=new.json head.obj
exits 0
is "$(value new.json '[r["totals"][k] for k in ("errors", "warnings", "infos")]')" "[0, 0, 0]"
validates report new.json
run --check --fail-on=info --baseline=old.json "$data/mirrored_cube.obj"
exits 6
cp head.obj copy.obj # of another name, while the old one is there: by positions
run --check --fail-on=info --baseline=old.json head.obj copy.obj
exits 0
echo '{}' >broken.json
run --check --baseline=broken.json head.obj
exits 3
says "broken.json"

scene "what the baseline knows is counted, and not printed as new"
flat >m.obj
echo 'usemtl none' | cat - m.obj >n.obj && mv n.obj m.obj
run $strict -q --fail-on=never --report=old.json m.obj
is "$(value old.json '[(f["code"], f["severity"]) for f in r["files"][0]["findings"]][:2]')" \
	"[('UV_UNMAPPED', 'error'), ('MATERIAL_UNKNOWN', 'warning')]"
run $strict --baseline=old.json m.obj
exits 0
prints "Nothing new: 1 known error, 1 known warning"
! grep -q "UV_UNMAPPED\|MATERIAL_UNKNOWN" ../out.txt || wrong "what is known is in the text"
run $strict --baseline=old.json --report=r.md m.obj
says_not "MATERIAL_UNKNOWN"
grep -q '^Nothing new: 1 known error, 1 known warning$' r.md || wrong "$(cat r.md)"
! grep -q "UV_UNMAPPED\|MATERIAL_UNKNOWN\|severity" r.md || wrong "what is known is in Markdown"
for format in lines github; do
	run $strict --baseline=old.json --report-format=$format m.obj
	exits 0
	[ ! -s ../out.txt ] || wrong "$(cat ../out.txt)"
	says "nothing new, 2 known,"
done
run -q --severity=UV_UNMAPPED=error --fail-on=error --baseline=old.json m.obj m.glb
exits 0
sed 's/usemtl none/usemtl other/' m.obj >n.obj && mv n.obj m.obj
run $strict --baseline=old.json --max-issues=1 m.obj # what is left out is new
prints "MATERIAL_UNKNOWN"
! grep -q " more: " ../out.txt || wrong "what is known counts as left out"
run $strict --baseline=old.json --report=r.json m.obj
says "other [MATERIAL_UNKNOWN]"

# Two squares of side 1 that cover 0.8 x 0.8 of the tiles 1001 and 1002, the second mirrored: 64 and 32 pixels a tile give
# 51.2 and 25.6 texels per unit. With one image for both, the second lies on the first.
scene "UDIM: islands in different tiles share no texels, and have the density of their own tile"
python3 "$ROOT/tests/support/images.py" write n.1001.png 64 64 '(128, 128, 255)'
python3 "$ROOT/tests/support/images.py" write n.1002.png 32 32 '(128, 128, 255)'
{
	printf '%s\n' "mtllib m.mtl" "usemtl m" "vn 0 0 1"
	printf 'v %s 0\n' '0 0' '1 0' '1 1' '0 1' '3 0' '4 0' '4 1' '3 1'
	printf 'vt %s\n' '.1 .1' '.9 .1' '.9 .9' '.1 .9' '1.9 .1' '1.1 .1' '1.1 .9' '1.9 .9'
	printf '%s\n' 'f 1/1/1 2/2/1 3/3/1 4/4/1' 'f 5/5/1 6/6/1 7/7/1 8/8/1'
} >m.obj
while IFS='|' read -r name density codes; do
	printf 'newmtl m\nnorm %s\n' "$name" >m.mtl
	run -q --check --ignore='NMAP_*,MATERIAL_*' --report=r.json m.obj
	is "$name $(value r.json '[round(i["texel_density"]["median"], 3) for i in r["files"][0]["meshes"][0]["islands"]]')" "$name $density"
	is "$name $(value r.json '[f["code"] for f in r["files"][0]["findings"]]')" "$name $codes"
done <<'END'
n.<UDIM>.png|[51.2, 25.6]|['UV_MIRROR_LONE']
n.1001.png|[51.2, 51.2]|['UV_MIRROR_OVERLAP']
END

scene "images in a view are measured, moved by the edit or not"
run -q --check --report=r.json "$data/plates.glb"
run -q --only=all --report=w.json "$data/plates.glb" out.glb
exits 0
is "$(value w.json '[m.get("texture_size") for m in r["files"][0]["meshes"]]')" \
	"$(value r.json '[m.get("texture_size") for m in r["files"][0]["meshes"]]')"

scene "transforms that tangents cannot serve are told"
python3 -c 'import json, sys
d = json.load(open(sys.argv[1]))
d["animations"] = [{"samplers": [], "channels": [{"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer":
	{"pointer": "/materials/%d/normalTexture/extensions/KHR_texture_transform/rotation" % i}}}} for i in range(len(d["materials"]))]}]
json.dump(d, open("animated.gltf", "w"))' "$data/transformed.gltf"
run -q --check --report=r.json --outside=yes animated.gltf
is "$(value r.json '"TAN_UV_TRANSFORM_ANIMATED" in json.dumps(r)')" True

scene "a buffer that is not there is a finding of every report, with its place"
echo '{"asset": {"version": "2.0"}, "buffers": [{"uri": "no.bin", "byteLength": 12}]}' >lost.gltf
for format in json sarif lines junit csv markdown html; do
	run -q --check --report=r --report-format=$format lost.gltf
	exits 2
	grep -q BUFFER_MISSING r || wrong "not in $format"
done
run -q --check --report=r.lines --report-format=lines lost.gltf
is "$(wc -l <r.lines)" 1
run -q --check --report=r.xml lost.gltf
is "$(grep -c '<failure\|<error' r.xml) $(grep -o 'failures="[0-9]*" errors="[0-9]*"' r.xml | sort -u)" '1 failures="1" errors="0"'
run -q --check --report=r.xml --fail-on=never lost.gltf
is "$(grep -c '<failure\|<error' r.xml) $(grep -o 'failures="[0-9]*" errors="[0-9]*"' r.xml | sort -u)" '1 failures="0" errors="1"'
run --check lost.gltf
prints 'error     BUFFER_MISSING  buffer cannot be opened: cannot open "no.bin": No such file or directory'
run -q --report=r.json lost.gltf lost.glb
exits 2
validates report r.json
is "$(value r.json '[(f["code"], f["place"]["pointer"]) for f in r["files"][0]["findings"]], r["totals"]["errors"], r["files"][0]["failure"] is not None')" \
	"([('BUFFER_MISSING', '/buffers/0')], 1, True)"
run -q --check --report=r.sarif lost.gltf
is "$(value r.sarif '[x["ruleId"] for x in r["runs"][0]["results"]], r["runs"][0]["invocations"][0]["executionSuccessful"]')" "(['BUFFER_MISSING'], False)"

scene "the report never replaces an input"
cp "$data/quad.obj" q.obj
run --check --report=q.obj --report-format=json q.obj
exits 2
same q.obj "$data/quad.obj"

scene "a mesh called <script> and one with control characters stay text"
printf 'o <script>alert(1)</script>\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 2 0\nf 1/1 2/2 3/3\n' >s.obj
printf 'o a\033[31mb\377"\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 2 0\nf 4/4 5/5 6/6\n' >>s.obj
run --check --report=r.json s.obj
validates report r.json
is "$(value r.json 'r["files"][0]["meshes"][0]["name"]')" "<script>alert(1)</script>"
run --check s.obj
! grep -q "$(printf '\033')" ../out.txt || wrong "an escape sequence in the text"

nasty() { # an OBJ whose object has this name, and a triangle without UV area
	printf 'o %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 2 0\nf 1/1 2/2 3/3\n' "$1"
}

scene "SARIF has a result per finding, with lines, pointers and fingerprints"
run --check --fail-on=never --report=r.sarif "$data/mirrored_cube.obj" "$data/plates.gltf"
exits 0
run --check --fail-on=never --report=r.json "$data/mirrored_cube.obj" "$data/plates.gltf"
is "$(python3 "$report/sarif.py" r.sarif)" "$(value r.json 'sum(len(f["findings"]) for f in r["files"])')"
is "$(value r.sarif '({l["fullyQualifiedName"] for x in r["runs"][0]["results"] for p in x["locations"]
	for l in p.get("logicalLocations", []) if "fullyQualifiedName" in l} ==
	{"/meshes/0/primitives/0", "/meshes/0/primitives/2"})')" \
	"True"
run --check --fail-on=never --severity=UV_MIRROR_SEAM=warning --min-severity=warning --report=r.sarif "$data/plates.gltf"
is "$(value r.sarif 'sorted({x["level"] for x in r["runs"][0]["results"]})')" "['error', 'warning']"
nasty 'a"b\\<c>' >'odd name?.obj'
run --check --report=r.sarif 'odd name?.obj' nothing.obj
exits 2
python3 "$report/sarif.py" r.sarif >/dev/null || wrong "not valid"
is "$(value r.sarif 'r["runs"][0]["invocations"][0]["executionSuccessful"]')" False
is "$(value r.sarif 'r["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]')" \
	"odd%20name%3F.obj"

scene "SARIF is what the official schema says"
official=$ROOT/build/node/node_modules/@microsoft/jest-sarif/lib/schemas/sarif-2.1.0-rtm.5.json
if [ -f "$official" ]; then
	nasty 'a"b\\<c>' >'odd name?.obj'
	run -q --check --report=old.json 'odd name?.obj'
	run -q --check --fail-on=never --baseline=old.json --report=r.sarif "$data/plates.gltf" 'odd name?.obj' nothing.obj
	python3 "$report/schema.py" "$official" r.sarif || wrong "$(python3 "$report/schema.py" "$official" r.sarif)"
	for wrong in 's/"level": "error"/"level": "bad"/' 's,odd%20,odd ,' 's,man:nmtan,a page of nmtan,' \
		's/"text": /"words": /'; do
		sed "$wrong" r.sarif >wrong.sarif
		! python3 "$report/schema.py" "$official" wrong.sarif >/dev/null || wrong "the schema takes it: $wrong"
	done
else
	skip_case "the schema is not installed (no network?)"
fi

scene "JUnit has a case for each file, which fails where the run fails"
run --check --severity=UV_MIRROR_SEAM=warning --fail-on=warning --report=r.xml "$data/head.obj" "$data/quad.obj"
exits 6
is "$(python3 -c 'import sys, xml.etree.ElementTree as x
t = x.parse(sys.argv[1]).getroot()
print([(s.get("tests"), s.get("failures"), s.get("errors")) for s in (t, t[0])], [(c.get("name").split("/")[-1], c.find("failure").get("type")
	if c.find("failure") is not None else None) for c in t[0]])' r.xml)" \
	"[('2', '1', '0'), ('2', '1', '0')] [('head.obj', 'UV_MIRROR_SEAM'), ('quad.obj', None)]"
run --check --fail-on=never --report=r.xml "$data/head.obj" nothing.obj
grep -q 'tests="2" failures="0" errors="1"' r.xml || wrong "no error for a file that is not there"
grep -q "UV_MIRROR_SEAM: " r.xml || wrong "what fails nothing is not told"
run --check --report=r.xml "$data/head.obj"
exits 0
! grep -q "<failure" r.xml || wrong "a failure although the run passes"

scene "JUnit, CSV, Markdown and SARIF survive names made to break them"
# the last ones: U+FFFE, U+FFFF, CSI as one character, a name that is turned around
nasty "$(printf '=1+1,"<script>&]]>|`x`\033[31m\377\357\277\276\357\277\277\302\233\342\200\256')" >n.obj
for format in xml csv md sarif; do
	run --check --report=r.$format n.obj
	exits 0
done
for format in lines github; do
	run --check --report-format=$format n.obj
	exits 0
	! LC_ALL=C grep -qP '\x1b|\xc2\x9b|\xe2\x80\xae|\xef\xbf[\xbe\xbf]' ../out.txt || wrong "$format shows what turns or ends a line"
done
python3 "$report/sarif.py" r.sarif >/dev/null || wrong "SARIF is not valid"
python3 -c 'import sys, xml.etree.ElementTree as x; x.parse(sys.argv[1])' r.xml || wrong "XML is not well formed"
python3 -c 'import csv, sys
rows = list(csv.reader(open(sys.argv[1], newline="", encoding="utf-8", errors="replace")))
assert {len(r) for r in rows} == {15}, rows
assert not any(c[:1] in tuple("=+@") for r in rows for c in r), rows' r.csv ||
	wrong "CSV is broken"
nasty "$(printf 'a"\033[31m\342\200\256b')" >u.obj
for format in csv md xml; do
	run --check --report=r.$format u.obj
	! LC_ALL=C grep -q "$(printf '\033\|\342\200\256')" r.$format || wrong "r.$format has bytes that a terminal obeys"
done
grep -qF 'a""\x1b[31m\xe2\x80\xaeb' r.csv || wrong "$(cat r.csv)"
! grep -qE '<script|[^\\]\|`' r.md || wrong "markup in Markdown"
for file in r.xml r.md ../out.txt ../err.txt; do
	! LC_ALL=C grep -qP '\xc2\x9b|\xe2\x80\xae|\xef\xbf[\xbe\xbf]' $file || wrong "$file shows what turns or ends a line"
done

# Columns 2 to 4 of the table in nmtan-report(5).
scene "a prop, a scan and an OBJ without materials have the findings that the manual says, or less"
sed -n '/^ *prop  *scan/,/^\.ft/p' "$ROOT/man/nmtan-report.5" >profiles
sed '/^vt/d; s|/[0-9]*/|//|g' "$data/head.obj" >scan.obj
cp "$data/head.obj" plain.obj
run -q "$data/transformed.gltf" prop.glb
column=2
for name in prop.glb scan.obj plain.obj; do
	run -q --check --fail-on=never --report=r.json $name
	value r.json '"\n".join(f["code"] + " " + f["severity"] for f in r["files"][0]["findings"])' >found
	[ -s found ] || wrong "$name: nothing is found"
	while read -r code severity; do
		case $severity,$(awk -v c="$code" -v n=$column '$1 == c { print $n }' profiles) in
		info,info | *,error | info,warning | warning,warning) ;;
		*) wrong "$name: $severity $code" ;;
		esac
	done <found
	column=$((column + 1))
done

scene "--list-codes names every code of the schema"
run --list-codes
exits 0
cut -d' ' -f1 ../out.txt | sort >listed
value "$data/nmtan-report.schema.json" '"\n".join(sorted(r["$defs"]["code"]["enum"]))' >known
LC_ALL=C sort -c known
diff <(LC_ALL=C sort listed) known >/dev/null || wrong "the lists differ"

scene "a report of megabytes is written in pieces, and is one document"
awk 'BEGIN { for (i = 1; i <= 3000; i++) printf "o m%d\nv 0 0 0\nv %d 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf -3/-3 -2/-2 -1/-1\nf -3/-3 -3/-2 -1/-1\n", i, i }' >many.obj
for name in many.json many.html many.sarif; do run --check --max-issues=0 --report=$name --fail-on=never many.obj; done
is "$(value many.json 'len(r["files"][0]["meshes"]), sum(f["code"] == "POS_DEGENERATE_TRIANGLE" for f in r["files"][0]["findings"])')" "(3000, 3000)"
is "$(value many.html 'sum(f["code"] == "POS_DEGENERATE_TRIANGLE" for f in r["files"][0]["findings"])')" 3000
is "$(value many.sarif 'len(r["runs"][0]["results"])')" 5000

done_testing
