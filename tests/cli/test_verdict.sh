# SPDX-License-Identifier: MIT
# One verdict: whichever way it is asked for, the same mesh gets the same findings and the same exit code.
. "$ROOT/tests/support/cli.sh"

# Codes and counts of a JSON report, one to a line; $2: severities that count.
findings() {
	value "$1" '"\n".join("%(severity)s %(code)s %(count)s" % f for f in r["files"][0]["findings"] if f["severity"] in
		'"'${2:-error warning info}'"')' | sort
}

# A square whose right half is a mirrored copy moved by $1 tiles along u; its folded place is $2 more.
halves() {
	printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvn 0 0 1\n'
	printf 'vt %s %s\n' .1 .1  .4 .1  .4 .4  .1 .4
	awk -v move="$1" '{ print "vt", $1 + move, $2 }' <<<$'.4 .1\n.1 .1\n.1 .4\n.4 .4'
	printf 'f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/1 5/6/1 6/7/1 3/8/1\n'
}

scene "--fail-on judges a conversion, with a report and without"
halves 0.5 >m.obj
run -q --fail-on=info m.obj a.glb
exits 6
says "info: island 1 (2 triangles) is mirrored and shares no texels"
run -q --fail-on=info --report=r.json m.obj b.glb
exits 6
same a.glb b.glb
run --fail-on=info m.obj c.glb
exits 6
says "info: island 1 (2 triangles) is mirrored and shares no texels"
run -q --fail-on=warning m.obj d.glb
exits 0
run -q m.obj e.glb
exits 0

scene "a flipped triangle is told with its UV set, and is an info where no texture uses that"
awk 'BEGIN { print "vn 0 0 1"
	for (y = 0; y < 6; y++) for (x = 0; x < 6; x++) {
		print "v", x, y, 0
		print "vt", x == 5 && y == 0 ? "0.85 0.15" : x / 5 " " y / 5
	}
	for (y = 0; y < 5; y++) for (x = 1; x < 6; x++) {
		a = 6 * y + x
		printf "f %d/%d/1 %d/%d/1 %d/%d/1\nf %d/%d/1 %d/%d/1 %d/%d/1\n", a, a, a + 1, a + 1, a + 7, a + 7,
			a, a, a + 7, a + 7, a + 6, a + 6
	} }' >grid.obj
run -q grid.obj grid.gltf
while IFS='|' read -r severity uses material; do
	gltf grid.gltf one 'Object.assign(g, {materials: ['"$material"'], textures: [{}]});
		const a = g.meshes[0].primitives[0].attributes; a.TEXCOORD_1 = a.TEXCOORD_0; delete a.TANGENT'
	run --check --uv=0 --fail-on=never one.gltf --report=one.json
	is "$material $(value one.json '[(f["severity"], f["message"]) for f in r["files"][0]["findings"] if "FLIPPED" in f["code"]]')" \
		"$material [('$severity', '1 triangle is flipped: 2 % of the area of 50, in UV set 0${uses:+, which no texture uses}')]"
done <<-'END'
	info|none|{}
	info|none|{extras: {ownTexture: {index: 0}}}
	info||{pbrMetallicRoughness: {baseColorTexture: {index: 0}}}
	warning||{normalTexture: {index: 0}}
	info|none|{normalTexture: {index: 0, texCoord: 1}}
	warning||{normalTexture: {index: 0, texCoord: 1}, emissiveTexture: {index: 0}}
	info|none|{occlusionTexture: {index: 0, extensions: {KHR_texture_transform: {texCoord: 1}}}}
	info||{occlusionTexture: {index: 0, texCoord: 1, extensions: {KHR_texture_transform: {texCoord: 0}}}}
	info||{extensions: {KHR_materials_sheen: {sheenColorTexture: {index: 0}}}}
	warning||{extensions: {KHR_materials_anisotropy: {anisotropyStrength: 1}}}
END

# A map of bumps, their green times $2: as DirectX has it by default, -1: as glTF has it.
green_down() {
	python3 "$ROOT/tests/support/images.py" write "$1" 128 128 '(lambda u, v: (lambda r: tuple(round(127.5 + 127.5 * c / r) for c in (u, v * ('"${2-1}"'), 1.5)))(
		math.hypot(u, v, 1.5)) if u * u + v * v < 0.8 else (128, 128, 255))(x % 32 / 16 - 1, y % 32 / 16 - 1)'
}

# in/: materials that lose something, wrong tangents and none, morph targets, quantized and compressed ones.
faulty_inputs() {
	mkdir in up
	cp "$data"/{mirrored_cube.obj,plates.gltf,plates.bin,transformed.gltf,morph.gltf,quantized.gltf,quad_wedge.ply} in
	printf 'newmtl bumps\nnorm green.png\nmap_Kd ../up/up.png\nmap_Ks gone.png\nmap_Ke wood.tga\ndecal d.png\n' >in/mirrored_cube.mtl
	green_down in/green.png
	cp "$data/bumps.png" up/up.png
	cp "$data/colour.jpg" in/wood.tga
	sed '/^v[nt]/d; s|/[0-9/]*||g' "$data/head.obj" >in/scan.obj
	run -q --only=all --normals=flat in/plates.gltf kept.gltf
	gltf kept.gltf in/kept 'const p = g.meshes[0].primitives[0].attributes.TANGENT, w = v => at(p, v) + 12;
		for (let v = 0; v < 3; v++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(w(v)), w(v));
		bytes[0].writeFloatLE(NaN, at(p, 1));
		g.images = [{uri: "../up/up.png"}, {uri: "green.png"}]; g.textures = [{source: 1}, {source: 0}]'
	run -q --draco=edgebreaker --only=all in/plates.gltf in/packed.glb
	rm kept.*
}

# Findings of each file; of no glTF where $2 is empty; without the codes $3.
found() {
	value "$1" '"\n".join("%s: %s %s %s %s" % (f["file"], x["severity"], x["code"], x["count"], x["message"]) for f in r["files"]
		if "'"$2"'" or ".gl" not in f["file"] for x in f["findings"] if x["code"] not in "'"${3:-}"'")'
}

# Each option of help but those that ask for something else than a run, or for other words about it. Inputs: of in/ all,
# its glTF, or what the words name. w: it says how to write; without it a glTF is judged as it is, unless -d says where to.
scene "a check with the options of a conversion finds what that finds, and writes nothing"
faulty_inputs
printf '%s\n' in/*.gltf >names
run -q --check --fail-on=never --report=old.json in/kept.gltf in/scan.obj
mv old.json old
row=0
while IFS='|' read -r words inputs writes; do
	case $inputs in
	all) inputs=$(echo in/*.obj in/*.gltf in/*.glb in/*.ply) ;;
	glTF) inputs=$(echo in/*.gltf in/*.glb) ;;
	esac
	where="-d out" conversion=$words
	case $words in
	--output=* | --in-place | --directory* | --keep-tree*) where= ;;
	--update*) conversion= ;; # with which there is no report
	esac
	name=${words%%[ =]*}
	echo "${name#--}" >>../told
	# all but each fifth are asked of one build
	[[ $BUILD != *sanitize* ]] || ((row++ % 5 == 0)) || continue
	cp -R in kept
	"$NMTAN" --check -q $words --fail-on=never $where --report=checked.json $inputs 2>../err.txt || wrong "--check $words: $?"
	"$NMTAN" --check -q $words --fail-on=never --report=alone.json $inputs 2>../err.txt || wrong "--check $words: $?"
	is "$words: $(diff -r in kept) $(echo *)" "$words:  alone.json checked.json in kept names old up"
	"$NMTAN" -q $conversion --fail-on=never $where --report=converted.json $inputs 2>../err.txt || wrong "$words: $?"
	cmp -s checked.json converted.json ||
		is "$words: $(found checked.json all)" "$words: $(found converted.json all)"
	placed="IMAGE_MISSING LINK_LEAVES" # depend on where the output is
	is "$words: $(found alone.json "$writes" "$placed")" "$words: $(found converted.json "$writes" "$placed")"
	rm -rf ./*.json in out out.glb rec dep
	mv kept in
done <<'END'
--only=all|all
--existing=keep|all|w
--existing=repair|all|w
--existing=replace|all|w
--method=area|all|w
--raw|all|w
--normals=replace-smooth|all|w
--across=mesh|all
--quads=pairs|all
--transform=keep|all
--uv=0|all
--outside=yes|all
--outside=no|all
--directory=out|all|w
--keep-tree=in -d out|all|w
--files-from=names|
--recursive in|
--include=*.gltf -r in|
--exclude=*.obj -r in|
--fail-fast|all
--jobs=1|all
--memory=1G|all
--update|all|w
--record=rec|all|w
--write-if-changed|all|w
--depfile=dep|all|w
--output=out.glb|in/kept.gltf|w
--output-format=gltf|all|w
--output-format=ply|all|w
--in-place|glTF|w
--buffers=link|all|w
--buffers=copy|all|w
--images=link|all|w
--images=copy|all|w
--images=embed|all|w
--textures=keep|all|w
--textures=png|all|w
--texture-path=up|all
--base-color=up/up.png|in/mirrored_cube.obj
--normal-map=in/green.png|in/mirrored_cube.obj
--metallic-roughness=up/up.png|in/mirrored_cube.obj
--occlusion=up/up.png|in/mirrored_cube.obj
--emissive=up/up.png|in/mirrored_cube.obj
--bump=height|all|w
--bump-height=0.1|all|w
--flip-green=on|all|w
--flip-green=auto|all|w
--draco=off|all|w
--draco=edgebreaker|glTF|w
--draco-bits=9,9,9,12 --draco=sequential|glTF|w
--morph=drop|all|w
--precision=byte|glTF|w
--meshopt=off|all|w
--weld|glTF|w
--origin=keep|all
--bitangents|all|w
--no-clobber|all|w
--sync|all|w
--verify|glTF|w
--dry-run|all|w
--check-maps=off|all
--ignore=UV_*|all
--severity=TAN_*=error|all
--baseline=old|all
--path-prefix=art|all
--min-severity=warning|all
--max-issues=1|all
--max-triangles=1M|all
--max-pixels=1G|all
--max-memory=1000T|all
--max-seconds=600|all
--threads=1|all
--manifest=/dev/null|all
END
other="check completion diff explain fail-on fix help list-codes progress quiet report report-format timing verbose version"
is "$(sort -u ../told | tr '\n' ' ')" "$("$NMTAN" --help | sed -n 's/^ \{2,6\}\(-[a-zA-Z], \)*--\([a-z-]*\).*/\2/p' | sort |
	grep -vxF "$(tr ' ' '\n' <<<$other)" | tr '\n' ' ')"

scene "a glTF that is not to be written is judged as it is"
cp "$data"/plates.{gltf,bin} .
for words in "" --only=all --across=mesh --threads=1; do
	run -q --check $words plates.gltf
	exits 6
	says TAN_MISSING_REQUIRED
done
for words in --existing=keep --output-format=gltf "-d out" "-o out.glb" --in-place; do
	run -q --check $words plates.gltf
	exits 0
done
run --check -o out.glb plates.gltf other.gltf
exits 1
says "--output names the output of one input"

scene "what a material loses is a warning of the check, too"
cp "$data/quad.obj" .
sed -i '1i mtllib m.mtl' quad.obj
sed -i '/^f /i usemtl m' quad.obj
printf 'newmtl m\nmap_Kd gone.png\ndecal rough.png\nmap_Kd -t .5 0 gone.png\n' >m.mtl
run --check --fail-on=warning quad.obj
exits 6
for text in "IMAGE_MISSING" "MTL: decal" "MTL: -t of map_Kd"; do
	prints "$text"
done

# A folder is no image, and Git LFS's pointer is not the file; what lies outside is not looked at, and told where it matters.
scene "a glTF's image that is not there is a warning, whether the file is checked, copied, linked or embedded"
gltf "$data/plates.gltf" q 'g.images = ["gone.png", "folder.png", "pointer.png", "there.png", "../up.png"].map(uri => ({uri}));
	g.textures = [{source: 0}]; g.materials = [{normalTexture: {index: 0}}];
	for (const m of g.meshes) for (const p of m.primitives) p.material = 0'
mkdir folder.png out
echo "version https://git-lfs.github.com/spec/v1" >pointer.png
cp "$data/bumps.png" there.png
printf '%s\n' '"folder.png": cannot read: Is a directory' "\"pointer.png\": Git LFS's pointer to the file, not the file itself: git lfs pull brings it" \
	'cannot open "gone.png": No such file or directory' >../three
{ cat ../three && echo 'the URI "../up.png" leaves the folder of the file (refused without --outside=yes)'; } >../four
while IFS='|' read -r words expected; do
	run -q --fail-on=warning --report=../r.json $words q.gltf
	exits 6
	says "gone.png"
	value ../r.json '"\n".join(x["message"][len("image cannot be read: "):] for x in r["files"][0]["findings"]
		if (x["code"], x["severity"], x["place"]["pointer"][:8]) == ("IMAGE_MISSING", "warning", "/images/"))' | sort >../told
	is "$words: $(cat ../told)" "$words: $(cat "../$expected")"
done <<'END'
--check|four
-o out.glb|four
-o out/out.gltf|four
-o out.gltf|three
-o out.gltf --existing=drop|three
-o out.gltf --images=copy|three
-o out/out.gltf --images=link|three
--check -o out.gltf|three
END
gltf q.gltf whole 'g.images = [{uri: "there.png"}]'
for words in --check "-o out.glb" "-o out.gltf"; do
	run -q --fail-on=warning --ignore=TAN_*,NMAP_* $words whole.gltf
	exits 0
done

scene "a primitive without the set that --uv names is told with the sets that it has, and stays as it is"
told='--uv asks for set 3; sets of the mesh: 0, 1'
run -q --only=all "$data/multi_uv.gltf" has.gltf
gltf has.gltf bad 'const p = g.meshes[0].primitives[0].attributes.TANGENT;
	for (let k = 0; k < 3; k++) bytes[0].writeFloatLE(0, at(p, 0) + 4 * k)'
for words in --existing=replace --existing=repair "--existing=repair --only=all" --fix; do
	run --uv=3 $words bad.gltf out.gltf
	exits 0
	says "warning: there are no texture coordinates to make tangents by: $told [TAN_NO_UV]"
	same bad.gltf out.gltf
	run -q --check --fail-on=warning --uv=3 $words bad.gltf
	[ "$words" = --fix ] || exits 6
	rm -f out.*
done
run --check --uv=3 "$data/multi_uv.gltf"
exits 6
prints "error     TAN_NO_UV  there are no texture coordinates to make tangents by: $told"
run --uv=1 --existing=replace bad.gltf out.gltf
exits 0
says_not TAN_NO_UV
for file in quad.obj quad_le.ply; do
	run --uv=1 "$data/$file" out.glb
	exits 1
	says "--uv=1 is for glTF: an OBJ, PLY or Draco file has one set of texture coordinates, 0"
	run -q --uv=0 "$data/$file" out.glb
	exits 0
done

scene "a check that judges a conversion says so, in its verdict and in JSON"
cp "$data"/{plates.gltf,plates.bin,bumps.png} .
while IFS='|' read -r words verdict conversion; do
	run -q --check --report=../r.json --fail-on=never $words plates.gltf
	is "$words: $(value ../r.json '(lambda f: "%s|%s" % (f["verdict"][:len("'"$verdict"'")], f["conversion"]))(r["files"][0])')" \
		"$words: $verdict|$conversion"
done <<'END'
--existing=replace|After conversion with --existing=replace: Ready to use|--existing=replace
-d out|After conversion: Ready to use|
--threads=1|Convert with nmtan: |None
END

scene "a mesh without texture coordinates is a finding"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >bare.obj
run --check --fail-on=warning bare.obj
exits 0
prints "info      TAN_NO_UV"
run --check --only=needed bare.obj
exits 0
run bare.obj out.glb
exits 0
says "skipped 1 primitive (no texture coordinates)"
says_not "error"
run -q --fail-on=info bare.obj out.glb
exits 6
gltf new needy 'g.meshes = [{primitives: [{material: 0, attributes: {POSITION: add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 0, 1, 0]),
	NORMAL: add("VEC3", 5126, [0, 0, 1, 0, 0, 1, 0, 0, 1])}}]}];
	g.materials = [{normalTexture: {index: 0}}]; g.textures = [{}]; g.nodes = [{mesh: 0}]'
run --check needy.gltf
exits 6
prints "error     TAN_NO_UV"
is "$(grep -c TAN_MISSING_REQUIRED "$WORK/out.txt")" 0 # nothing makes them
run --fail-on=error needy.gltf out.glb
exits 6
says "error: there are no texture coordinates"
run needy.gltf out.glb # what succeeds has no errors
exits 0
says "warning: there are no texture coordinates"
says_not "error"
printf 'o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\no two\nf 1 2 3\n' >half.obj
run --check half.obj
exits 0
prints "info      UV_MISSING"
# Faces without vt beside others: not that their texture coordinates are on a line; the same count in a conversion.
for faces in 'f 1/1 2/2 3/3\nf 2/1 5/4 4/2\n\nf 2 5 6 4\n' 'vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 2/1/1 5/4/1 4/2/1\nf 2//1 5//1 6//1 4//1\n'; do
	printf "v %s 0\n" '0 0' '1 0' '0 1' '1 1' '2 0' '2 1' >some.obj
	printf "vt %s\n" '0 0' '1 0' '0 1' '.5 0' >>some.obj
	printf "$faces" >>some.obj
	run --check --report=r.json some.obj
	exits 0
	is "$(value r.json '[(f["code"], f["severity"], f["count"], f["spots"][0]["line"] > 13) for f in r["files"][0]["findings"] if f["code"][:3] == "UV_"]')" \
		"[('UV_MISSING', 'info', 2, True), ('UV_DEGENERATE_TRIANGLE', 'info', 1, False)]"
	run --manifest=m.json some.obj out.glb
	is "$(value m.json '[r["findings"].get(c) for c in ("UV_MISSING", "UV_DEGENERATE_TRIANGLE")]')" "[2, 1]"
done

# The triangle's v are so near to 1 that 1 - v turns it over: w follows what is stored, and so does its judge.
scene "a conversion and the check of its output agree"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 1e-9\nvt .5 -1e-9\nf 1/1/1 2/2/1 3/3/1\n' >thin.obj
for in in thin.obj "$data/mirrored_cube.obj"; do
	run -q --report=made.json "$in" out.glb
	run -q --check --fail-on=never --report=back.json out.glb
	is "$(findings made.json "error warning" | grep " TAN_")" "$(findings back.json "error warning" | grep " TAN_")"
done
for in in obliterated.obj rancid_geometry.obj; do
	[ -f "$ROOT/../shared/models/obj/$in" ] || continue
	run -q --report=made.json "$ROOT/../shared/models/obj/$in" out.glb
	run -q --check --fail-on=never --report=back.json out.glb
	is "$(findings made.json "error warning" | grep " TAN_")" "$(findings back.json "error warning" | grep " TAN_")"
done

# The command of each finding is another one for a glTF; where the image is missing there is none for the OBJ.
scene "a check has the findings of maps and unused tangents that a check of the output has, whatever the maps become"
python3 "$ROOT/tests/support/images.py" write grey.png 16 16 "x * 16"
cp grey.png given.png
green_down down.png
printf '%s\n' 'mtllib m.mtl' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'vt 0 0' 'vt 1 0' 'vt 0 1' 'vn 0 0 1' 'usemtl m' 'f 1/1/1 2/2/1 3/3/1' \
	'usemtl n' 'f 1/1/1 2/2/1 3/3/1' 'o b' 'usemtl c' 'f 1/1/1 2/2/1 3/3/1' >m.obj
codes() { value $1 '" ".join(sorted({f["code"] for f in r["files"][0]["findings"] if f["code"][:4] in ("NMAP", "TAN_")}))'; }
while IFS='|' read -r one two options expected; do
	printf 'newmtl m\n%s\nnewmtl n\n%s\nnewmtl c\n' "$one" "$two" >m.mtl
	[ -n "$two" ] || sed '/usemtl [nc]/d' m.obj >one.obj
	[ -z "$two" ] || cp m.obj one.obj
	run -q --check --fail-on=never --report=checked.json $options one.obj
	run -q $options one.obj out.glb
	exits 0
	run -q --check --fail-on=never --report=back.json out.glb
	is "$one|$two|$options: $(codes checked.json)" "$one|$two|$options: $expected"
	is "$one|$two|$options: $(codes back.json)" "$one|$two|$options: $expected"
	case $expected in
	*HEIGHTS*)
		eval "run $(value checked.json '[f["repair"] for f in r["files"][0]["findings"] if f["code"] == "NMAP_HEIGHTS"][0][6:]')"
		exits 0
		run -q --check --fail-on=never --report=back.json one.glb
		is "$one|$two|$options: $(value back.json '[f["code"] for f in r["files"][0]["findings"] if f["code"] == "NMAP_HEIGHTS"]')" "$one|$two|$options: []"
		;;
	esac
done <<'END'
map_Bump grey.png||--bump=normal|NMAP_HEIGHTS
norm grey.png||--bump=normal|NMAP_HEIGHTS
norm grey.png||--bump=height|NMAP_HEIGHTS
map_Bump grey.png||--bump=auto|
map_Bump grey.png||--bump=height|
map_Bump grey.png||--bump=ignore|TAN_UNUSED
map_Bump down.png||--bump=ignore|TAN_UNUSED
map_Bump down.png||--images=none|TAN_UNUSED
map_Bump down.png||--bump=normal|NMAP_GREEN_DOWN
map_Bump gone.png||--bump=normal|TAN_UNUSED
map_Bump gone.png||--images=link|
map_Kd grey.png||--bump=ignore|TAN_UNUSED
map_Kd grey.png||--only=needed|
map_Kd grey.png||--bump=ignore --normal-map=given.png|NMAP_HEIGHTS
map_Kd down.png||--normal-map=given.png|
map_Kd down.png|norm down.png||NMAP_GREEN_DOWN TAN_UNUSED
map_Bump grey.png|norm grey.png|--bump=height|NMAP_HEIGHTS TAN_UNUSED
END
run -q --check --report=r.json -o out.ply one.obj # no map is in it
is "$(codes r.json)" ""
# the same of a glTF, which has tangents only if asked
gltf "$data/plates.gltf" g 'g.images = [{uri: "grey.png"}]; g.textures = [{source: 0}]'
cp "$data/plates.bin" .
for options in --only=all "--only=all --bump=height" "--only=all --existing=replace" --only=needed; do
	run -q --check --fail-on=never --report=checked.json $options -o out.gltf g.gltf
	run -q $options g.gltf out.gltf
	run -q --check --fail-on=never --report=back.json out.gltf
	is "$options: $(codes checked.json)" "$options: $(codes back.json)"
done

scene "a mirrored half that was moved by a whole tile lies on the other half"
for tiles in 0 1 -2; do
	halves $tiles >m.obj
	run --check --fail-on=warning m.obj
	exits 0
	prints "UV_MIRROR_OVERLAP"
done
halves 0.5 >m.obj
run --check --fail-on=warning m.obj
exits 0
prints "UV_MIRROR_LONE"

# Forty pairs of triangles with a mirror seam each.
many() {
	printf '%s\n' "vn 0 0 1" "vt 0 0" "vt 1 0" "vt .5 1"
	for i in $(seq 0 2 78); do
		printf 'v %s 0\n' "$i 0" "$((i + 1)) 0" "$i.5 1" "$i.5 -1"
		echo "f -4/1/1 -3/2/1 -2/3/1"
		echo "f -3/2/1 -4/1/1 -1/3/1"
	done
}

scene "seams have numbers in the order in which they are listed: those that show, then long ones"
{
	echo "vn 0 0 1"
	printf 'vt %s\n' "0 0" "1 0" "1 1" "0 1" ".4 .6" ".6 .4" ".3 .7" ".7 .3"
	# one edge whose sides differ in texels; one that shows; a strip of two edges that shows
	printf 'v %s\n' "0 0 0" "1 0 0" ".5 1 0" ".5 -1 0" "9 0 0" "10 0 0" "9.5 1 0" "9.5 -1 0"
	echo "f 1/5/1 2/6/1 3/3/1"
	echo "f 2/8/1 1/7/1 4/3/1"
	echo "f 5/1/1 6/2/1 7/3/1"
	echo "f 6/2/1 5/1/1 8/3/1"
	printf 'v %s\n' "0 9 0" "1 9 0" "2 9 0" "0 10 0" "1 10 0" "2 10 0" "0 8 0" "1 8 0" "2 8 0"
	echo "f 9/1/1 10/2/1 13/3/1 12/4/1"
	echo "f 10/2/1 11/1/1 14/4/1 13/3/1"
	echo "f 10/2/1 9/1/1 15/4/1 16/3/1"
	echo "f 11/1/1 10/2/1 16/3/1 17/4/1"
} >ranked.obj
run --check --fail-on=never --max-issues=0 --report=r.json ranked.obj
is "$(grep -o 'seam [0-9]*,' "$WORK/out.txt" | tr -d '\n')" "$(seq -f 'seam %g,' 0 $(($(grep -c 'seam [0-9]*,' "$WORK/out.txt") - 1)) | tr -d '\n')"
is "$(value r.json '(lambda s: s == sorted(s, reverse=True) and len(s) > 2)([(x["unhidden_edges"], x["edge_count"]) for x in r["files"][0]["meshes"][0]["seams"]])')" True

scene "every seam is a finding of its own; people read ten findings, some of each code"
many >many.obj
run -q --check --report=r.json --fail-on=never many.obj
is "$(findings r.json)" "info TAN_UNUSED 1
info UV_MIRROR_OVERLAP 40
$(for i in $(seq 40); do echo info UV_MIRROR_SEAM 1; done)"
run --check --fail-on=never many.obj
is "$(grep -c '^  info .*UV_MIRROR_SEAM' ../out.txt) $(grep -c '^  info .*UV_MIRROR_OVERLAP' ../out.txt)" "8 1"
prints "and 32 more: 32 UV_MIRROR_SEAM; --max-issues=0 shows all"
run --check --fail-on=never --report=r.md many.obj
is "$(grep -c '^| info .*UV_MIRROR_SEAM' r.md)" 8
grep -q "^And 32 more: 32 UV_MIRROR_SEAM.$" r.md || wrong "no word of what is left out"
run --check --fail-on=never --max-issues=0 many.obj
is "$(grep -c '^  info .*UV_MIRROR_SEAM' ../out.txt)" 40
run --check --fail-on=never --max-issues=0 --report=r.md many.obj
is "$(grep -c '^| info .*UV_MIRROR_SEAM' r.md)" 40

scene "--min-severity leaves out what is below, in every format"
many >many.obj
options="--check --severity=UV_MIRROR_OVERLAP=error --min-severity"
for format in json csv md html txt xml sarif; do
	run $options=info --max-issues=0 --report=all.$format many.obj
	exits 6
	run $options=warning --report=r.$format many.obj
	exits 6
	is "$format $(grep -o 'a seam of 1 edge' all.$format | wc -l) $(grep -c 'a seam of 1 edge' r.$format)" "$format 40 0"
	grep -q "40 islands have mirrored" r.$format || wrong "$format has no error"
done
run --check --min-severity=error --fail-on=error many.obj # what is not reported does not count
exits 0
prints "0 errors, 0 warnings, 0 infos"
run --min-severity=error many.obj many.glb
exits 1
says "--min-severity needs --report, --check or --fail-on"
run --check --min-severity=never many.obj
exits 1

# A mesh whose findings have the same fingerprints, at other positions.
moved() {
	awk '$1 == "v" { $2 += 0.25 } 1' "$1"
}

scene "a baseline of one file waives nothing in another, but where both have the same positions"
halves 0.5 >one.obj
moved one.obj >two.obj
cp one.obj copy.obj
run -q --check --fail-on=never --report=one.json one.obj
run --check --fail-on=info --baseline=one.json one.obj
exits 0
run --check --fail-on=info --baseline=one.json ./one.obj
exits 0
run --check --fail-on=info --baseline=one.json two.obj
exits 6
run --check --fail-on=info --baseline=one.json copy.obj
exits 0

# The names of a report's files.
names() {
	value "$1" '" ".join(f["file"] for f in r["files"])'
}

scene "two files of one name are two, wherever they are named from"
mkdir -p a/b run
halves 0.5 >a/m.obj
moved a/m.obj >a/b/m.obj
run -q --check --fail-on=never --report=r.json "$PWD/a/m.obj" a/b/m.obj
is "$(names r.json)" "a/m.obj a/b/m.obj"
run -q --check --fail-on=never --path-prefix=art --report=r.json "$PWD/a/m.obj" a/b/../m.obj
is "$(names r.json)" "art/a/m.obj art/a/m.obj"
cd run || exit
run -q --check --fail-on=never --report=r.json "$PWD/../a/m.obj" ../a/b/m.obj
is "$(names r.json)" "m.obj b/m.obj"
run -q --check --fail-on=never --report=r.sarif --path-prefix='my art/' "$PWD/../a/m.obj" ../a/b/m.obj
is "$(value r.sarif '" ".join(sorted({x["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
	for x in r["runs"][0]["results"]}))')" "my%20art/b/m.obj my%20art/m.obj"
# those of compilers open the files, whatever the other inputs are
for file in ../a/m.obj "$PWD/../a/m.obj"; do
	run -q --check --report-format=lines "$file"
	is "$(sed 's/:.*//' ../../out.txt | sort -u)" "$file"
done
run -q --check --report-format=github ../a/m.obj ../a/b/m.obj gone/../gone.obj
is "$(sed 's/.*file=\([^,]*\),.*/\1/' ../../out.txt | sort -u | tr '\n' ' ')" "../a/b/m.obj ../a/m.obj gone.obj "
run -q --check --report-format=lines --path-prefix=art ../a/m.obj
is "$(sed 's/:.*//' ../../out.txt | sort -u)" "art/m.obj"
run -q --check --fail-on=never --report=one.json ../a/m.obj
run --check --fail-on=info --baseline=one.json ../a/m.obj ../a/b/m.obj
exits 6
says_not "m.obj and"
cd ..
run -q --check --fail-on=never --path-prefix=art --report=one.json a/m.obj
run --check --fail-on=info --baseline=one.json --path-prefix=art a/m.obj
exits 0
run --check --fail-on=info --baseline=one.json --path-prefix=art a/m.obj a/b/m.obj
exits 6
run --path-prefix=art a/m.obj a.glb
exits 1
says "--path-prefix needs --report or --check"

scene "objects and files that were renamed have no new findings"
{ echo o head; halves 0.5; } >old.obj
run -q --check --fail-on=never --report=old.json old.obj
sed 's/^o .*/o Head.001/' old.obj >renamed
grep -v '^o ' old.obj >dropped
moved renamed >moved
for name in renamed dropped moved; do
	run --check --diff --report=r.json old.obj $name
	is "$name $(value r.json '[len(r[k]) > 0 for k in ("new_findings", "gone_findings")]')" \
		"$name $([ $name = moved ] && echo '[True, True]' || echo '[False, False]')"
	cp old.obj kept
	cp $name old.obj
	run --check --fail-on=info --baseline=old.json old.obj
	exits $([ $name = moved ] && echo 6 || echo 0)
	mv old.obj new.obj
	run --check --fail-on=info --baseline=old.json new.obj
	exits $([ $name = moved ] && echo 6 || echo 0)
	mv kept old.obj
done
# what was there once excuses one of two
{ cat old.obj; echo o two; grep "^f " old.obj; } >twice.obj
run --check --fail-on=info --baseline=old.json twice.obj
exits 6

scene "points and lines are not counted as triangles"
gltf new points 'g.meshes = [{primitives: [{mode: 0, attributes: {POSITION: add("VEC3", 5126, Array(9).fill(0))}}]}];
	g.nodes = [{mesh: 0}]'
run -v points.gltf out.glb
exits 0
says "skipped (points or lines)"
says_not "triangle"

scene "the nearest option is offered"
for pair in --repot:--report --chek:--check --weld-vertices:--weld --uv-set:--uv --format:--output-format --thread:--threads --failon:--fail-on --sevreity:--severity; do
	run "${pair%:*}" a b
	exits 1
	says "did you mean ${pair#*:}?"
done
run --frobnicate a b
exits 1
says_not "did you mean"

scene "-o names the output"
cp "$data/quad.obj" .
run -q -o a.glb quad.obj
exits 0
run -q quad.obj -ob.glb
exits 0
same a.glb b.glb
run quad.obj c.glb -o d.glb
exits 1
says "'c.glb' is one name too many"
run -o a.glb -d . quad.obj
exits 1
says "--output and --directory"

scene "formats that are not read are named, with what to export instead"
printf 'Kaydara FBX Binary  \0' >a.bin
printf 'solid x\nendsolid\n' >b.stl
printf '<?xml version="1.0"?><COLLADA/>' >c.dae
printf '#usda 1.0\n' >d.usda
echo >g.usdc
printf 'b3dm\1\0\0\0' >e.tile
printf 'i3dm\1\0\0\0' >f.tile
for pair in a.bin:FBX b.stl:STL c.dae:COLLADA d.usda:USD g.usdc:USD "e.tile:a tile of 3D Tiles" "f.tile:a tile of 3D Tiles"; do
	run "${pair%:*}" out.glb
	exits 5
	says "${pair#*:} is not read"
	grep -q "glTF\|GLB" "$WORK/err.txt" || wrong "it says nothing to bring instead"
done
# A normal-mapped square with tangents, m.gltf.
mapped() {
	printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n' >square.obj
	run -q square.obj square.gltf
	gltf square.gltf m 'Object.assign(g, {images: [{uri: "n.png"}], textures: [{source: 0}], materials: [{normalTexture: {index: 0}}]});
		g.meshes[0].primitives[0].material = 0'
	python3 "$ROOT/tests/support/images.py" write n.png 32 32 "(128, 128 + x, 255)"
}

scene "the first sentence: ready, or what is to be done again, the first step first"
mapped
said() { value r.json 'r["files"][0]["verdict"]'; }
run --check -q --report=r.json --fail-on=never m.gltf
is "$(said)" "Ready to use"
gltf m.gltf none 'delete g.meshes[0].primitives[0].attributes.TANGENT'
run --check -q --report=r.json none.gltf
is "$(said): $(value r.json '[f["message"] for f in r["files"][0]["findings"] if f["code"] == "TAN_MISSING_REQUIRED"]')" \
	"Ready to use: [\"there are no tangents, which clients make from the normal texture's coordinates\"]"
run --existing=drop m.gltf out.gltf
says "skipped 1 primitive (has tangents), a material uses the tangents of 1 primitive, which stay, "
run --existing=drop none.gltf out.gltf
says_not "which stay"
echo 'f 1 2 3' >bad.obj
run --check -q --report=r.json bad.obj
is "$(said)" 'Not judged: line 1: face refers to "v" number 1, but the file has 0'
gltf m.gltf worse 'const a = g.meshes[0].primitives[0].attributes; bytes[0].writeFloatLE(0, at(a.TANGENT, 0) + 12); bytes[0].writeFloatLE(NaN, at(a.TEXCOORD_0, 0))'
run --check -q --report=r.json --fail-on=never worse.gltf
is "$(said | cut -d';' -f1)" "Export again: 1 vertex has texture coordinates that are not finite"
green_down n.png
gltf m.gltf bad 'const n = g.meshes[0].primitives[0].attributes.TANGENT; bytes[0].writeFloatLE(0, at(n, 0) + 12)'
run --check -q --report=r.json --fail-on=never bad.gltf
is "$(said)" "Convert with nmtan: 1 tangent has a w that is neither 1 nor -1; and 1 more: nmtan --fix bad.gltf bad-repaired.gltf"
# what the command does not repair is not counted beside it
run -q "$data/mirrored_cube.obj" cube.glb
gltf cube.glb turned 'const n = g.meshes[0].primitives[0].attributes.TANGENT;
	for (let i = 0; i < g.accessors[n].count; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12)'
run --check -q --report=r.json --fail-on=never turned.gltf
is "$(value r.json '[f["code"] for f in r["files"][0]["findings"] if f["severity"] != "info"]')" "['TAN_SIGN_MISMATCH', 'UV_HARD_EDGE']"
is "$(said)" "Convert with nmtan: 20 triangles have a bitangent that runs the wrong way: 100 % of 20, the convention is inverted: nmtan --fix turned.gltf turned-repaired.gltf"
run --check -q --report=r.json --fail-on=never --severity=TAN_BAD_W=warning bad.gltf
is "$(said | cut -d: -f1-2)" "Convert with nmtan: normal map whose green points down"
run --check -q --report=made.json --fail-on=never --existing=replace bad.gltf
is "$(value made.json 'r["files"][0]["verdict"]' | cut -d: -f1-3)" "After conversion with --existing=replace: Repair with nmtan: normal map whose green points down"
run --check -q --report-format=text --fail-on=never --severity=TAN_BAD_W=warning bad.gltf
is "$(sed -n 2p "$WORK/out.txt")" "  $(said)"
run --check -q --report-format=markdown --fail-on=never --severity=TAN_BAD_W=warning bad.gltf
grep -q '^Convert with nmtan: normal map whose' "$WORK/out.txt" || wrong "Markdown does not say it"
run --check -q --report=known.json --baseline=r.json --fail-on=never bad.gltf
is "$(value known.json 'r["files"][0]["verdict"]')" "Nothing new: 1 known error, 1 known warning"

scene "--fix repairs what is wrong and leaves the rest; what it did is said; a second run changes nothing"
mapped
green_down n.png
# three squares over one map, the second of which has w = 0 and the third tangents of another direction: no fault for certain
gltf m.gltf three 'const p = g.meshes[0].primitives[0], a = p.attributes, v = rows(a.TANGENT);
	p.attributes = {...a, TANGENT: add("VEC4", 5126, v.flat(), {})};
	for (const change of [t => [t[0], t[1], t[2], 0], t => [t[1], t[0], t[2], t[3]]])
		g.meshes[0].primitives.push({...p, attributes: {...a, TANGENT: add("VEC4", 5126, v.map(change).flat(), {})}})'
run --fix --manifest=m.json three.gltf fixed.gltf
exits 0
says "fixed NMAP_GREEN_DOWN in 1 normal map, TAN_BAD_W in 1 primitive"
says "1 of 3 primitives"
is "$(value m.json 'r["fixed"]')" "{'NMAP_GREEN_DOWN': 1, 'TAN_BAD_W': 1}"
is "$(gltf fixed.gltf '[1, 2].map(i => rows(g.meshes[0].primitives[i].attributes.TANGENT)[0])')" "$(gltf three.gltf '(t => [t(0), t(2)])(i => rows(g.meshes[0].primitives[i].attributes.TANGENT)[0])')"
run -q --check --report=r.json --fail-on=never fixed.gltf
is "$(value r.json 'sorted({f["code"] for f in r["files"][0]["findings"] if f["severity"] != "info"})')" "['TAN_DIRECTION_MISMATCH']"
run --fix --manifest=m.json fixed.gltf again.gltf
says "nothing that --fix repairs"
is "$(value m.json 'r["fixed"]')" "{}"
run --fix "$data/quad.obj" quad.glb
says ", the input has nothing that --fix repairs, "
run --fix quad.glb again.glb
says ", the input has nothing that --fix repairs, "
same fixed.gltf again.gltf
# what the user calls an info is left; an info alone is no reason
run --fix --ignore=NMAP_GREEN_DOWN --severity=TAN_BAD_W=info three.gltf left.gltf
says "nothing that --fix repairs"
for options in "--check three.gltf" "--existing=keep three.gltf a.glb" "--flip-green=on three.gltf a.glb"; do
	run --fix $options
	exits 1
done
says "--fix turns the maps that need it"

# Inverted w and a map whose green points down cancel, if all that is over the map, and all maps of that, agree.
scene "w and green that are both inverted are shown right: one finding, left by --fix; in anything mixed both are repaired"
mapped
green_down down.png
green_down up.png -1
green_down mixed.png "1 if x < 64 else -1"
green_down down.webp
cp down.png another.png
python3 - <<'END'
import struct
open("map.ktx2", "wb").write(b"\xabKTX 20\xbb\r\n\x1a\n" + struct.pack("<9I", 0, 1, 4, 4, 0, 0, 1, 1, 0) + bytes(64))
END
while IFS='|' read -r name edit found fixed; do
	gltf m.gltf pair "g.images = [{uri: 'down.png'}, {uri: 'up.png'}]; g.textures = [{source: 0}, {source: 1}];
		const p = g.meshes[0].primitives[0], a = p.attributes, v = rows(a.TANGENT);
		const square = (change, material) => ({...p, material, attributes: {...a, TANGENT: add('VEC4', 5126, v.map(change).flat(), {})}});
		const inverted = t => [t[0], t[1], t[2], -t[3]], right = t => t, zero = t => [0, 0, 0, -t[3]];
		g.materials.push(structuredClone(g.materials[0]));
		g.meshes[0].primitives = [square(inverted, 0), square(inverted, 1)]; $edit"
	run --check -q --report=r.json --fail-on=never pair.gltf
	is "$name: $(value r.json '" ".join("%s=%s" % (f["code"], f["count"]) for f in sorted(r["files"][0]["findings"], key=lambda f: f["code"]) if f["severity"] != "info" or f["code"] == "TAN_GREEN_PAIR")')" "$name: $found"
	run --fix pair.gltf fixed.gltf
	exits 0
	says "$fixed"
	[[ $edit = *map.ktx2* ]] || says_not "[TAN_"
	[ "$fixed" != "nothing that --fix repairs" ] || same pair.gltf fixed.gltf
	[[ $name != "another fault over a map"* ]] || is "$name: $(grep -c 'TAN_KEPT_SIGN' "$WORK/err.txt")" "$name: 2"
	run --check -q --report=r.json --fail-on=never fixed.gltf
	is "$name: $(value r.json '[f["code"] for f in r["files"][0]["findings"] if "--fix" in (f["repair"] or "") and f["severity"] != "info"]')" "$name: []"
	run --fix fixed.gltf again.gltf
	says "nothing that --fix repairs"
	same fixed.gltf again.gltf
done <<'END'
two materials over one map|;|TAN_GREEN_PAIR=2|nothing that --fix repairs
a map of each, both down|g.materials[1].normalTexture.index = 1; g.images[1].uri = 'down.png'|TAN_GREEN_PAIR=2|nothing that --fix repairs
a map of each, one up|g.materials[1].normalTexture.index = 1|TAN_GREEN_PAIR=1 TAN_SIGN_MISMATCH=2|fixed TAN_SIGN_MISMATCH in 1 primitive
one map, and w of one mesh is right|g.meshes[0].primitives[1] = square(right, 1)|NMAP_GREEN_DOWN=1 TAN_SIGN_MISMATCH=2|fixed NMAP_GREEN_DOWN in 1 normal map, TAN_SIGN_MISMATCH in 1 primitive
one map, and one mesh has no tangents|delete g.meshes[0].primitives[1].attributes.TANGENT|NMAP_GREEN_DOWN=1 TAN_SIGN_MISMATCH=2|fixed NMAP_GREEN_DOWN in 1 normal map, TAN_SIGN_MISMATCH in 1 primitive
a mixed map|g.images[0].uri = 'mixed.png'|TAN_SIGN_MISMATCH=2 TAN_SIGN_MISMATCH=2|fixed TAN_SIGN_MISMATCH in 2 primitives
a map whose green points up|g.images[0].uri = 'up.png'|TAN_SIGN_MISMATCH=2 TAN_SIGN_MISMATCH=2|fixed TAN_SIGN_MISMATCH in 2 primitives
a clearcoat map that points up|g.materials[0].extensions = {KHR_materials_clearcoat: {clearcoatFactor: 1, clearcoatNormalTexture: {index: 1}}}; g.extensionsUsed = ['KHR_materials_clearcoat']; g.meshes[0].primitives.pop()|NMAP_GREEN_DOWN=1 TAN_SIGN_MISMATCH=2|fixed NMAP_GREEN_DOWN in 1 normal map, TAN_SIGN_MISMATCH in 1 primitive
WebP, which is not turned|g.images[0].uri = 'down.webp'|TAN_GREEN_PAIR=2|nothing that --fix repairs
WebP, and another fault|g.images[0].uri = 'down.webp'; g.meshes[0].primitives[1] = square(zero, 1)|TAN_GREEN_PAIR=2 TAN_ZERO=4|fixed TAN_ZERO in 1 primitive
beside it a map that is turned|g.materials[1].normalTexture.index = 1; g.images[1].uri = 'another.png'; g.meshes[0].primitives[1] = square(right, 1)|NMAP_GREEN_DOWN=1 TAN_GREEN_PAIR=1|fixed NMAP_GREEN_DOWN in 1 normal map
a mesh over the map that is not unwrapped|Object.assign(g.meshes[0].primitives[1].attributes, {TEXCOORD_0: add('VEC2', 5126, Array(8).fill(0), {})})|TAN_GREEN_PAIR=2 UV_UNMAPPED=2|nothing that --fix repairs
one geometry over two maps, of which one is up|const z = square((t, i) => i ? inverted(t) : zero(t), 0); g.meshes[0].primitives = [z, {...z, material: 1}]; g.materials[1].normalTexture.index = 1|TAN_GREEN_PAIR=1 TAN_SIGN_MISMATCH=2 TAN_ZERO=1 TAN_ZERO=1|fixed TAN_SIGN_MISMATCH in 1 primitive, TAN_ZERO in 2 primitives
another fault over a map that is not decoded|g.images[0].uri = 'map.ktx2'; g.extensionsUsed = ['KHR_texture_basisu']; g.textures[0] = {extensions: {KHR_texture_basisu: {source: 0}}}; g.meshes[0].primitives[1] = square(zero, 1)|TAN_SIGN_MISMATCH=2 TAN_SIGN_MISMATCH=2 TAN_ZERO=4|fixed TAN_ZERO in 1 primitive
another fault over a map for two of one geometry|const d = square((t, i) => i ? inverted(t) : [2 * t[0], 2 * t[1], 2 * t[2], -t[3]], 0); g.meshes[0].primitives = [d, {...d}]; g.images[0].uri = 'map.ktx2'; g.extensionsUsed = ['KHR_texture_basisu']; g.textures[0] = {extensions: {KHR_texture_basisu: {source: 0}}}|TAN_NON_UNIT=1 TAN_SIGN_MISMATCH=2|fixed TAN_NON_UNIT in 2 primitives
another fault in one of them|g.meshes[0].primitives[1] = square(zero, 1)|TAN_GREEN_PAIR=2 TAN_ZERO=4|fixed TAN_ZERO in 1 primitive
a map that is not decoded|g.images[0].uri = 'map.ktx2'; g.extensionsUsed = ['KHR_texture_basisu']; g.textures[0] = {extensions: {KHR_texture_basisu: {source: 0}}}|TAN_SIGN_MISMATCH=2 TAN_SIGN_MISMATCH=2|nothing that --fix repairs
END
run --check pair.gltf
prints "which cannot be decoded here, the two cancel"
prints "nmtan --existing=replace pair.gltf pair-repaired.gltf"

scene "a conversion that changes one half of the pair warns and names the other; a plain one is silent"
mapped
green_down n.png
gltf m.gltf pair 'const n = g.meshes[0].primitives[0].attributes.TANGENT; for (let i = 0; i < 4; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12)'
run pair.gltf out.glb
says_not "warning"
for options in --existing=replace --existing=repair; do
	run $options pair.gltf out.glb
	says "[TAN_GREEN_PAIR]: nmtan $options --flip-green=auto pair.gltf out.glb"
done
run --flip-green=auto pair.gltf out.glb
says "[TAN_GREEN_PAIR]: nmtan --existing=repair --flip-green=auto pair.gltf out.glb"
run --existing=repair --flip-green=auto pair.gltf out.glb
says_not "warning"
run --check --fail-on=warning out.glb
exits 0
run --check-maps=off pair.gltf out.glb
says "which was not examined, the two cancel [TAN_KEPT_SIGN]: nmtan --fix pair.gltf out.glb"

scene "seams that show come first, and lengths and places are those of the world"
cp "$data/mirrored_cube.obj" .
run -q mirrored_cube.obj c.gltf
gltf c.gltf big 'g.nodes[0].scale = [100, 100, 100]; g.nodes[0].translation = [5, 0, 0]'
run --check -q --report=c.json --fail-on=never c.gltf
run --check -q --report=big.json --fail-on=never big.gltf
is "$(value big.json 'r["files"][0]["meshes"][0]["seams"][0]["length"]')" "$(value c.json '100 * r["files"][0]["meshes"][0]["seams"][0]["length"]')"
run --check --fail-on=never c.gltf
grep -q 'UV_MIRROR_SEAM.*visible on [0-9]* edges\?: tangents up to [0-9.]* degrees apart' "$WORK/out.txt" || wrong "$(grep UV_MIRROR "$WORK/out.txt")"

scene "wrong tangents that are kept are told with the command that repairs them, and counted of many, with -q too"
mapped
gltf m.gltf wrong 'const n = g.meshes[0].primitives[0].attributes.TANGENT; for (let i = 0; i < 4; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12)'
run wrong.gltf out.glb
exits 0
says "[TAN_KEPT_SIGN]: nmtan --fix wrong.gltf out.glb"
run --fix wrong.gltf out.glb
says "fixed TAN_SIGN_MISMATCH in 1 primitive"
says_not "TAN_KEPT_SIGN"
for quiet in "" -q; do
	run $quiet -d out square.obj m.gltf wrong.gltf
	exits 0
	says "nmtan: 3 of 3 done; 1 got tangents, 2 unchanged, 1 keeps wrong tangents"
done
# which a record does not forget, until they are mended
run --update=content -d kept square.obj m.gltf wrong.gltf
says "1 keeps wrong tangents"
for quiet in "" -q "--update=content" -v; do
	touch wrong.gltf kept/wrong.gltf
	run --update=content $quiet -d kept square.obj m.gltf wrong.gltf
	exits 0
	says "nmtan: 3 of 3 done, 3 of them up to date; 1 keeps wrong tangents"
done
validates --lines record kept/.nmtan-record
for quiet in "" -q; do
	run $quiet --update -d kept wrong.gltf
	says "nmtan: wrong.gltf -> kept/wrong.gltf: up to date, keeps wrong tangents"
	run $quiet --update -d kept m.gltf
	says_not "wrong"
done
for quiet in "" -q; do
	run $quiet --update --fix -d kept square.obj m.gltf wrong.gltf
	says_not "wrong tangents"
done
run -q --report=r.json -d out square.obj wrong.gltf
says "nmtan: 2 of 2 done; 1 got tangents, 1 unchanged, 1 keeps wrong tangents"
run -q --fix -d out square.obj m.gltf wrong.gltf
silent
# one file is told, in a quiet run too, and beside a report
for quiet in "" -q; do
	run $quiet wrong.gltf out.glb
	says "warning: 2 triangles keep tangents whose bitangent runs the wrong way: 100 % of 2 [TAN_KEPT_SIGN]: nmtan --fix wrong.gltf out.glb"
	run $quiet --report=r.json wrong.gltf out.glb
	says "warning: 2 triangles have a bitangent that runs the wrong way: 100 % of 2, the convention is inverted [TAN_SIGN_MISMATCH]: nmtan --fix wrong.gltf out.glb"
	run $quiet --ignore=TAN_KEPT_SIGN,TAN_SIGN_MISMATCH wrong.gltf out.glb
	says_not "TAN_"
	run $quiet --report=- wrong.gltf out.glb # which says it
	says_not "TAN_SIGN_MISMATCH"
done
run -q m.gltf out.glb
silent
gltf m.gltf zero 'bytes[0].fill(0, at(g.meshes[0].primitives[0].attributes.TANGENT, 0), at(g.meshes[0].primitives[0].attributes.TANGENT, 0) + 12)'
run -q zero.gltf out.glb
says "[TAN_EXISTING_BAD]: nmtan --fix zero.gltf out.glb"
run -q --report=r.json zero.gltf out.glb
is "$(value r.json '[(f["code"], f["count"]) for f in r["files"][0]["findings"] if f["severity"] != "info"]')" "[('TAN_ZERO', 1)]"
is "$(wc -l <"$WORK/err.txt")" 1
run -d out zero.gltf m.gltf
says "1 keeps wrong tangents"
# what --check calls an error, a conversion tells, with the same count: T reversed, corners of two signs, and of a PLY
tangents() { gltf m.gltf "$1" 'const n = g.meshes[0].primitives[0].attributes.TANGENT, b = bytes[0];
	for (let i = 0; i < 4; i++) for (let k = 0; k < 4; k++) { const o = at(n, i) + 4 * k, x = b.readFloatLE(o); b.writeFloatLE('"$2"', o); }'; }
tangents reversed 'k < 3 ? -x : x'
tangents mixed 'k == 3 && i == 1 ? -x : x'
tangents corner 'k == 3 && i == 0 ? -x : x'
ply() { # $1: T and w, $2: faces
	printf 'ply\nformat ascii 1.0\nelement vertex 4\n'
	printf 'property float %s\n' x y z nx ny nz s t tx ty tz tw
	printf 'element face %d\nproperty list uchar int vertex_indices\nend_header\n' $(($(wc -l <<<$2)))
	printf "%s $1\n" '0 0 0 0 0 1 0 0' '1 0 0 0 0 1 1 0' '1 1 0 0 0 1 1 1' '0 1 0 0 0 1 0 1'
	printf '%s\n' "$2"
}
ply '1 0 0 -1' '4 0 1 2 3' >quad.ply
ply '1 0 0 -1' $'3 0 1 2\n3 0 2 3' >triangles.ply
ply '-1 0 0 1' '4 0 1 2 3' >reversed.ply
ply '0 0 0 1' '4 0 1 2 3' >zero.ply
ply '1 0 0 1' '4 0 1 2 3' >right.ply
while IFS='|' read -r input count kept checked; do
	run --check --fail-on=never $input
	for code in $checked; do
		grep -q "$code *$count " "$WORK/out.txt" || wrong "$input: $code of $count"
	done
	for output in out.glb out.ply; do
		# a glTF that no material lights has nothing wrong
		[[ "$input $output $kept" != *.ply\ out.glb\ triangle* ]] || continue
		run -q $input $output
		exits 0
		says "warning: $count $kept"
		says "]: nmtan --fix $input $output"
	done
done <<'END'
reversed.gltf|2|triangles keep tangents whose bitangent runs the wrong way: 100 % of 2 [TAN_KEPT_SIGN]|TAN_SIGN_MISMATCH
mixed.gltf|1|triangle keeps tangents whose bitangent runs the wrong way: corners with different w [TAN_KEPT_SIGN]|TAN_MIXED_W_TRIANGLE
corner.gltf|2|triangles keep tangents whose bitangent runs the wrong way: corners with different w [TAN_KEPT_SIGN]|TAN_MIXED_W_TRIANGLE
quad.ply|2|triangles keep tangents whose bitangent runs the wrong way: 100 % of 2 [TAN_KEPT_SIGN]|TAN_SIGN_MISMATCH
triangles.ply|2|triangles keep tangents whose bitangent runs the wrong way: 100 % of 2 [TAN_KEPT_SIGN]|TAN_SIGN_MISMATCH
reversed.ply|2|triangles keep tangents whose bitangent runs the wrong way: 100 % of 2 [TAN_KEPT_SIGN]|TAN_SIGN_MISMATCH
zero.ply|4|tangents that were kept are invalid [TAN_EXISTING_BAD]|TAN_ZERO
END
run -v m.gltf out.gltf
says "skipped (has tangents), 2 triangles"
run -q right.ply out.glb
silent
run -q quad.ply out.glb
silent
green_down n.png -1
run -q --normal-map=n.png quad.ply out.glb
says "[TAN_KEPT_SIGN]: nmtan --normal-map=n.png --fix quad.ply out.glb"
# a folded quad has the sign of its larger half, in a PLY that nmtan wrote
ply '' '4 0 1 2 3' | grep -v 't[xyzw]$' | sed 's/1 0 0 0 0 1 1 0 /1 0 0 0 0 1 1 1 /; s/1 1 0 0 0 1 1 1 /1 1 0 0 0 1 1 0 /' >fold.ply
run fold.ply folded.ply
says UV_FOLDED_QUAD
run -q folded.ply out.ply
silent
run --check --fail-on=error folded.ply
exits 0
run --fix folded.ply out.ply
says "nothing that --fix repairs"
run -q -d out reversed.gltf m.gltf mixed.gltf quad.ply zero.ply right.ply
says "6 unchanged, 4 keep wrong tangents"
# reversed on nearly all triangles: what averaging hides goes with them, and what the solve gives anyway stays
sed '1i mtllib m.mtl' "$data/head.obj" | sed '0,/^f /s//usemtl m\nf /' >head.obj
printf 'newmtl m\nnorm n.png\n' >m.mtl
green_down n.png -1
run -q head.obj head.gltf
gltf head.gltf backwards 'const n = g.meshes[0].primitives[0].attributes.TANGENT, b = bytes[0];
	for (let i = 0; i < g.accessors[n].count; i++) for (let k = 0; k < 3; k++) b.writeFloatLE(-b.readFloatLE(at(n, i) + 4 * k), at(n, i) + 4 * k)'
run --fix backwards.gltf fixed.gltf
says "repaired the tangents of 2016 corners"
run --check --fail-on=never fixed.gltf
is "$(grep -c TAN_ "$WORK/out.txt")" 0
run --fix head.gltf same.gltf
same head.gltf same.gltf

scene "a run that fails says it with the command, of kept tangents too, whatever it fails for"
mapped
gltf m.gltf wrong 'const [p] = g.meshes[0].primitives, n = p.attributes.TANGENT; g.meshes[0].primitives.push({...p, material: undefined});
	for (let i = 0; i < 4; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12)'
for options in "" -q "--severity=TAN_SIGN_MISMATCH=warning,TAN_UNUSED=error" "-q --severity=TAN_SIGN_MISMATCH=warning,TAN_UNUSED=error"; do
	run --fail-on=error $options wrong.gltf out.glb
	exits 6
	is "$options $(grep -c "\[TAN_SIGN_MISMATCH\]: nmtan --fix wrong.gltf out.glb" "$WORK/err.txt")" "$options 1"
done
run --check -q wrong.gltf
exits 6
says "[TAN_SIGN_MISMATCH]: nmtan --fix wrong.gltf wrong-repaired.gltf"

scene "a command that is right under a condition is named with it, and no verdict names it beside one that has none"
mapped
# the tangents of another direction are a warning, the zero ones an error
gltf m.gltf turned 'const n = g.meshes[0].primitives[0].attributes.TANGENT; for (let i = 0; i < 4; i++) { bytes[0].writeFloatLE(0, at(n, i)); bytes[0].writeFloatLE(1, at(n, i) + 4); }'
run --check -q --report=r.json --fail-on=warning turned.gltf
exits 6
says "[TAN_DIRECTION_MISMATCH]; if the map was baked with MikkTSpace: nmtan --existing=replace turned.gltf turned-repaired.gltf"
is "$(value r.json 'r["files"][0]["verdict"].split("degrees; ")[-1]')" "if the map was baked with MikkTSpace: nmtan --existing=replace turned.gltf turned-repaired.gltf"
gltf turned.gltf both 'const p = g.meshes[0].primitives[0]; g.meshes[0].primitives.push({...p, attributes: {...p.attributes, TANGENT: add("VEC4", 5126, Array(16).fill(0), {})}})'
run --check -q --report=r.json --report-format=json --fail-on=never both.gltf
is "$(value r.json 'r["files"][0]["verdict"].split(": ")[-1]')" "nmtan --fix both.gltf both-repaired.gltf"
run --check --fail-on=never both.gltf
prints "All commands in one, if their conditions hold: nmtan --existing=replace both.gltf both-repaired.gltf"
gltf m.gltf quads 'delete g.meshes[0].primitives[0].attributes.TANGENT; g.asset.generator = "Khronos glTF Blender I/O v4.2"'
run quads.gltf out.glb
says "[TAN_QUADS_LIKELY]; if the map was baked in the program that wrote the file: nmtan --quads=pairs quads.gltf out.glb"

scene "tangents that clients have to ignore, or cannot read, are told in every way, and replaced if that is asked for"
mapped
gltf m.gltf bare 'delete g.meshes[0].primitives[0].attributes.NORMAL'
gltf m.gltf vec3 'const n = g.meshes[0].primitives[0].attributes.TANGENT; g.accessors[n].type = "VEC3"'
gltf vec3.gltf no_uv 'delete g.meshes[0].primitives[0].attributes.TEXCOORD_0'
while IFS='|' read -r file options code tangents; do
	run $options --fail-on=never $file.gltf $([[ $options = --check ]] || echo out.gltf)
	exits 0
	is "$file $options $(cat "$WORK/out.txt" "$WORK/err.txt" | grep -c "$code")" "$file $options $([ -n "$code" ] && echo 1 || cat "$WORK/out.txt" "$WORK/err.txt" | wc -l)"
	[[ $options = --check ]] && continue
	is "$file $options $(gltf out.gltf '(a => a.TANGENT >= 0 && a.NORMAL >= 0 ? rows(a.TANGENT)[0] + " " + rows(a.NORMAL)[0] : "none")(g.meshes[0].primitives[0].attributes)')" \
		"$file $options $tangents"
done <<'END'
bare|--check|^  warning   TAN_NO_NORMAL|
bare||TAN_NO_NORMAL|none
bare|--existing=replace|TAN_NO_NORMAL|none
bare|--normals=flat||1,0,0,1 0,0,1
vec3|--check|^  error     TAN_ACCESSOR|
vec3|--existing=keep|TAN_ACCESSOR|1,0,0 0,0,1
vec3|--existing=replace||1,0,0,1 0,0,1
vec3|--existing=repair||1,0,0,1 0,0,1
vec3|--fix|fixed TAN_ACCESSOR|1,0,0,1 0,0,1
no_uv|--check|Compute the tangents. nmtan cannot do it here|
vec3|--check|Compute the tangents: nmtan --fix vec3.gltf|
no_uv|--existing=replace|TAN_ACCESSOR|1,0,0 0,0,1
no_uv|--existing=repair|TAN_ACCESSOR|1,0,0 0,0,1
no_uv|--fix|the input has nothing that --fix repairs|1,0,0 0,0,1
END

scene "a remedy of what --fix mends names a command, or says that nmtan cannot"
mapped
gltf m.gltf flat 'const p = g.meshes[0].primitives[0]; p.attributes.TANGENT = add("VEC4", 5126, Array(16).fill(0), {}); delete p.attributes.NORMAL;
	g.meshes[0].primitives.push({...p, attributes: {...p.attributes, NORMAL: add("VEC3", 5126, Array(4).fill([0, 0, 1]).flat(), {})}})'
run --check --report=r.json --fail-on=never flat.gltf
is "$(value r.json 'sorted(f["repair"] for f in r["files"][0]["findings"] if f["code"] == "TAN_ZERO")')" \
	"['nmtan --fix flat.gltf flat-repaired.gltf', 'nmtan --normals=smooth flat.gltf flat-repaired.gltf']"
run --check --fail-on=never flat.gltf
for options in --fix --normals=smooth; do
	prints "Compute the tangents again: nmtan $options flat.gltf flat-repaired.gltf"
	run -q $options flat.gltf out.gltf
	run --check -q --report=r.json --fail-on=never out.gltf
	is "$options $(value r.json 'len([f for f in r["files"][0]["findings"] if f["code"] == "TAN_ZERO"])')" "$options 1"
	run --check --fail-on=never flat.gltf
done
gltf flat.gltf bare 'for (const p of g.meshes[0].primitives) { delete p.attributes.NORMAL; delete p.attributes.TEXCOORD_0; }'
run --check --fail-on=never bare.gltf
prints "Compute the tangents again. nmtan cannot do it here."

scene "a missing file is named by the verdict, and where it was looked for"
mkdir -p lib tex
{ printf 'mtllib lib/m.mtl\nusemtl m\n'; cat "$data/quad.obj"; } >quad.obj
printf 'newmtl m\nmap_Kd tex/gone.png\n' >lib/m.mtl
for options in "" "--texture-path=tex"; do
	run --check -q --report=r.json $options quad.obj
	is "$options $(value r.json 'r["files"][0]["verdict"]')" \
		"$options A file is missing: image cannot be read: tex/gone.png (looked for beside m.mtl and quad.obj${options:+, and in --texture-path})"
done
# names of files are as they are, not as URIs
sed 's|lib/m.mtl|a b/m.mtl|' quad.obj >"q x.obj"
mkdir "a b" out
printf 'newmtl m\nmap_Kd C:/art/my wood%%20.png\n' >"a b/m.mtl"
cp "$data/bumps.png" "a b/my wood%20.png"
run --images=link "q x.obj" out/o.gltf
says 'a b/m.mtl:2: material "m": warning: image was found elsewhere: C:/art/my wood%20.png is my wood%20.png [IMAGE_ELSEWHERE]'
says 'reference leaves the folder of the output: my wood%20.png, as'
rm lib/m.mtl
run --check -q --report=r.json quad.obj
is "$(value r.json 'r["files"][0]["verdict"].split(";")[0]')" "A file is missing: material library cannot be read: lib/m.mtl: no such file"

scene "infos of what nmtan chose are told by a plain conversion, in one line each; others are for -v"
mapped
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' >m.obj
printf 'newmtl m\nmap_Bump n.png\n' >m.mtl
run m.obj m.glb
for code in NORMALS_MADE BUMP_AS_NORMAL MATERIAL_FIRST; do
	is "$code $(grep -c "info: .*\[$code\]$" "$WORK/err.txt")" "$code 1"
done
run -q m.obj m.glb
silent
run -q --fail-on=error m.obj m.glb
silent

scene "a file without triangles is not ready to use, and what --min-severity leaves out is counted"
mapped
gltf new points 'g.meshes = [{primitives: [{mode: 0, attributes: {POSITION: add("VEC3", 5126, Array(9).fill(0))}}]}]; g.nodes = [{mesh: 0}]'
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n' >points.ply
run --check -q --report=r.json points.gltf
is "$(value r.json 'r["files"][0]["verdict"]')" "Nothing to judge: there are no triangles"
# no glTF can be made of these
sed '1,/^end_header/d; s/^/v /' points.ply >points.obj
sed 's/^end_header/element face 0\nproperty list uchar int vertex_indices\nend_header/' points.ply >faces.ply
for words in "--check points.ply" "--check faces.ply" "--check points.obj" "points.ply o.glb" "points.obj o.glb"; do
	run $words
	is "$words: $status" "$words: 5"
	says "found no faces, expected a mesh"
done
run --check --output-format=ply points.ply
exits 0
gltf m.gltf turned 'const [p] = g.meshes[0].primitives, n = p.attributes.TANGENT; g.meshes[0].primitives.push({...p, material: undefined});
	for (let i = 0; i < 4; i++) { bytes[0].writeFloatLE(0, at(n, i)); bytes[0].writeFloatLE(1, at(n, i) + 4); }'
run --check --ignore=TAN_MADE_BY turned.gltf
says "1 warning, 2 infos,"
run --check --ignore=TAN_MADE_BY --min-severity=error turned.gltf
says "checked, 2 primitives, 3 findings below --min-severity,"
prints "turned.gltf: 0 errors, 0 warnings, 0 infos, 3 below --min-severity"
prints "Not shown by --min-severity: 1 warning"
run --check --ignore=TAN_MADE_BY --min-severity=warning turned.gltf
says "checked, 2 primitives, 1 warning, 2 findings below --min-severity,"
run --check --min-severity=error m.gltf
says ", no findings,"
prints "Ready to use"

scene "the summary counts the primitives of the glTF that was made"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\no a\nf 1/1/1 2/2/1 3/3/1\ng b\nusemtl x\nf 1/1/1 2/2/1 3/3/1\nusemtl y\nf 1/1/1 2/2/1 3/3/1\n' >many.obj
run many.obj many.gltf
says ": $(gltf many.gltf 'g.meshes.flatMap(m => m.primitives).length') primitives, 3 triangles"

scene "an option that changes nothing says so"
mapped
while IFS='|' read -r options input told; do
	run $options $input out.glb
	exits 0
	says "$told"
done <<'END'
--quads=pairs|square.obj|square.obj: warning: --quads=pairs changes nothing: it is for glTF; the faces of this file are solved as they are [TAN_QUADS_NONE]
--bump=height|m.gltf|, nothing that --bump=height converts,
--flip-green=on|square.gltf|, nothing that --flip-green turns,
--weld|m.gltf|, no vertices are equal,
--bitangents|m.gltf|nmtan: m.gltf: --bitangents changes nothing: the primitives have tangents; --existing=replace makes them new
--raw --across=mesh --quads=pairs --method=area --precision=short|m.gltf|nmtan: m.gltf: --method, --raw, --across=mesh, --quads=pairs, --precision change nothing: the primitives have tangents; --existing=replace makes them new
END
python3 "$ROOT/tests/support/images.py" write n.png 16 16 "x * 16"
for options in "--existing=replace --bitangents m.gltf" "--bitangents square.gltf" "--images=embed m.gltf"; do
	run $options out.glb
	says_not "tangents; --existing"
done
run --bump=height m.gltf out.glb
says_not "nothing that"
says "converted 1 normal map"

scene "wrong tangents that are kept in compressed primitives are told as those of plain ones"
mapped
for method in "" --draco=sequential --draco=edgebreaker; do
	run -q --existing=replace $method m.gltf packed.gltf
	gltf packed.gltf wrong 'g.materials[0].normalTexture.extensions = {KHR_texture_transform: {scale: [-1, 1]}}; (g.extensionsUsed ??= []).push("KHR_texture_transform")'
	for threads in 1 2; do
		run --threads=$threads wrong.gltf out.gltf
		says "warning: 2 triangles keep tangents whose bitangent runs the wrong way: 100 % of 2 [TAN_KEPT_SIGN]: nmtan --fix wrong.gltf out.gltf"
		same wrong.gltf out.gltf
	done
	run --fix wrong.gltf out.gltf
	says_not TAN_KEPT_SIGN
	run out.gltf again.gltf
	says_not TAN_KEPT_SIGN
	run packed.gltf again.gltf
	says_not TAN_
done

scene "a command that a message or a report names has the other options of the user, but for those that it replaces"
mapped
gltf m.gltf wrong 'const n = g.meshes[0].primitives[0].attributes.TANGENT; for (let i = 0; i < 4; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12)'
mkdir "a b"
while IFS='|' read -r options repeated; do
	eval "run $options wrong.gltf out.glb"
	exits 0
	says "[TAN_KEPT_SIGN]: nmtan $repeated--fix wrong.gltf out.glb"
	eval "run ${repeated}--fix wrong.gltf out.glb"
	exits 0
	says "fixed TAN_SIGN_MISMATCH in 1 primitive"
	eval "run --check --report=r.json --fail-on=never $options wrong.gltf"
	is "$options: $(value r.json 'r["files"][0]["verdict"].split(": ")[-1]')" "$options: nmtan $repeated--fix wrong.gltf wrong-repaired.gltf"
	is "$options: $(value r.json '"".join({f["repair"] for f in r["files"][0]["findings"] if f["code"] == "TAN_SIGN_MISMATCH"})')" \
		"$options: nmtan $repeated--fix wrong.gltf wrong-repaired.gltf"
done <<'END'
--draco=keep|
--weld --precision=short|--precision=short --weld |
--uv=0 --texture-path="a b"|--uv=0 '--texture-path=a b' |
--flip-green=auto --check-maps=on|
--existing=keep --verify --sync|
END

scene "a command names no output that is the input, however that is spelled, and --in-place has its own"
mapped
gltf m.gltf wrong 'const n = g.meshes[0].primitives[0].attributes.TANGENT; for (let i = 0; i < 4; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12)'
ln -s wrong.gltf link.gltf
while IFS='|' read -r operands command output; do
	run $operands
	says "[TAN_KEPT_SIGN]: $command"
	cp wrong.gltf kept
	command=${command#nmtan}
	run $command
	exits 0
	says "fixed TAN_SIGN_MISMATCH in 1 primitive"
	[ "$output" = wrong.gltf ] || same kept wrong.gltf
	[ -e "$output" ] || wrong "$command wrote no $output"
	mv kept wrong.gltf
	rm -f wrong-repaired.gltf
done <<'END'
wrong.gltf wrong.gltf|nmtan --fix wrong.gltf wrong-repaired.gltf|wrong-repaired.gltf
wrong.gltf ./wrong.gltf|nmtan --fix wrong.gltf wrong-repaired.gltf|wrong-repaired.gltf
wrong.gltf link.gltf|nmtan --fix wrong.gltf wrong-repaired.gltf|wrong-repaired.gltf
-d . --output-format=gltf wrong.gltf|nmtan --fix wrong.gltf wrong-repaired.gltf|wrong-repaired.gltf
--in-place wrong.gltf|nmtan --fix --in-place wrong.gltf|wrong.gltf
--in-place -d . wrong.gltf|nmtan --fix --in-place wrong.gltf|wrong.gltf
END

scene "wrong signs of a few slivers are a warning, of as few large triangles an error; a corner's vertex is one spot"
mapped
for size in 0.001 4; do
	python3 - $size >many.obj <<-'END'
		import sys
		size, n = float(sys.argv[1]), 32
		print("vn 0 0 1")
		for y in range(n + 1):
		    for x in range(n + 1):
		        print(f"v {x} {y} 0\nvt {x / n} {y / n}")
		i = lambda x, y: y * (n + 1) + x + 1
		for y in range(n):
		    for x in range(n):
		        print("f", *(f"{k}/{k}/1" for k in (i(x, y), i(x + 1, y), i(x + 1, y + 1), i(x, y + 1))))
		print(f"v 0 0 {size} v {size} 0 {size} v 0 {size} {size}".replace(" v", "\nv"))
		print("vt 0 0\nvt 1 0\nvt 0 1\nf -3/-3/1 -2/-2/1 -1/-1/1")
	END
	run -q many.obj many.gltf
	gltf many.gltf wrong 'Object.assign(g, {images: [{uri: "n.png"}], textures: [{source: 0}], materials: [{normalTexture: {index: 0}}]});
		const p = g.meshes[0].primitives[0], n = p.attributes.TANGENT, last = g.accessors[n].count - 1, b = bytes[0];
		p.material = 0;
		for (let v = last - 2; v <= last; v++) b.writeFloatLE(-b.readFloatLE(at(n, v) + 12), at(n, v) + 12);
		for (let c = 0; c < 3; c++) b.writeFloatLE([0, 1, 0][c], at(n, 200) + 4 * c)'
	run --check -q --report=r.json --fail-on=never wrong.gltf
	is "$size $(value r.json '[(f["severity"], f["count"]) for f in r["files"][0]["findings"] if f["code"] == "TAN_SIGN_MISMATCH"]')" \
		"$size [('$([ $size = 4 ] && echo error || echo warning)', 1)]"
	is "$(value r.json '[(f["count"], len(f["spots"])) for f in r["files"][0]["findings"] if f["code"] == "TAN_DIRECTION_MISMATCH"]')" "[(6, 1)]"
done

scene "what a conversion keeps and cannot read is not ready to use"
mapped
gltf square.gltf faulty 'delete g.meshes[0].primitives[0].material; bytes[0].writeUInt8(250, at(g.meshes[0].primitives[0].indices, 1))'
run --report=r.json faulty.gltf out.gltf
exits 0
says "warning: the geometry is faulty and was not judged"
is "$(value r.json '(lambda f: (f["verdict"][:57], f["totals"]["errors"]))(r["files"][0])')" \
	"('Export again: the geometry is faulty and was not judged: ', 1)"
run -q --fail-on=error faulty.gltf out.gltf
exits 6

scene "a fold is a warning where a material of the output needs tangents, an info where a glTF has none that does"
mapped
{
	for x in 0 1 2 3; do printf "v $x 0 0\nv $x 1 0\n"; done
	for u in 0 1 0.4 1.4; do printf "vt $u 0\nvt $u 1\n"; done
	printf 'vn 0 0 1\nf 1/1/1 3/3/1 4/4/1 2/2/1\nf 3/3/1 5/5/1 6/6/1 4/4/1\nf 5/5/1 7/7/1 8/8/1 6/6/1\n'
} >fold.obj
run -q fold.obj fold.gltf
run -q fold.obj fold.ply
printf 'newmtl m\nnorm n.png\n' >m.mtl
{ printf 'mtllib m.mtl\nusemtl m\n' && cat fold.obj; } >mapped.obj
gltf fold.gltf mapped 'Object.assign(g, {images: [{uri: "n.png"}], textures: [{source: 0}], materials: [{normalTexture: {index: 0}}]});
	g.meshes[0].primitives[0].material = 0'
for expected in fold.obj:info fold.gltf:info mapped.gltf:warning mapped.obj:warning '--output-format=ply fold.obj:warning' fold.ply:warning \
	'-o x.glb fold.ply:info'; do
	run --check -q --report=r.json --fail-on=never ${expected%:*}
	is "$expected $(value r.json '[f["severity"] for f in r["files"][0]["findings"] if f["code"] == "UV_MIXED_WINDING_ISLAND"]')" \
		"$expected ['${expected#*:}']"
done

# Runs the command that report r.json, or the last run's message, has for code $1, as it stands, and checks its output.
# If only a conversion finds the code ($2), a report of that command has to be without it, and the tangents are there.
repairs() {
	local command repaired
	command=$(value r.json 'next((f["repair"] or "" for f in r["files"][0]["findings"] if f["code"] == "'$1'"), "")')
	command=${command:-$(sed -n "s/.*\[$1\].*: nmtan /nmtan /p" "$WORK/err.txt")}
	[ -n "$command" ] || wrong "no $1 to repair"
	repaired=${command##* }
	eval "run ${command#nmtan }"
	exits 0
	run --check -q --report=r.json --fail-on=never "$repaired"
	is "$1 $(value r.json '[f["code"] for f in r["files"][0]["findings"] if f["code"] == "'$1'"]')" "$1 []"
	codes_repaired+=" $1"
	[ -n "${2-}" ] || return 0
	eval "run -q --report=r.json --fail-on=never ${command#nmtan }"
	is "$1 $(value r.json '[f["code"] for f in r["files"][0]["findings"] if f["code"] == "'$1'"]')" "$1 []"
	is "$1 $(gltf "$repaired" 'g.meshes[0].primitives[0].attributes.TANGENT >= 0')" "$1 true"
}

scene "what nmtan says that it repairs is gone after the command that it names"
mapped
codes_repaired=
green_down down.png
python3 "$ROOT/tests/support/images.py" write grey.png 16 16 "x * 16"
while IFS='|' read -r code edit conversion; do
	gltf m.gltf faulty "const p = g.meshes[0].primitives[0], a = p.attributes, n = a.TANGENT, b = bytes[0];
		const t = f => { for (let i = 0; i < 4; i++) f([0, 1, 2, 3].map(k => b.readFloatLE(at(n, i) + 4 * k)), i)
			.forEach((x, k) => b.writeFloatLE(x, at(n, i) + 4 * k)); };
		const uv = rows => rows.forEach((row, i) => row.forEach((x, k) => b.writeFloatLE(x, at(a.TEXCOORD_0, i) + 4 * k)));
		const beside = (uv) => g.meshes[0].primitives.push({...p, attributes: {NORMAL: a.NORMAL, TEXCOORD_0: add('VEC2', 5126, uv, {}),
			POSITION: add('VEC3', 5126, [1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0], {})}}); $edit"
	if [ -n "$conversion" ]; then
		run -q --report=r.json --fail-on=never $conversion faulty.gltf out.gltf
		run $conversion faulty.gltf out.gltf
	else
		run --check -q --report=r.json --fail-on=never faulty.gltf
		cp r.json all.json
		for other in $(value r.json '" ".join({f["code"] for f in r["files"][0]["findings"] if f["repair"]} - {"'$code'"})'); do
			repairs $other # whatever else it names for this file
			cp all.json r.json
		done
	fi
	repairs $code $conversion
done <<'END'
TAN_SIGN_MISMATCH|t(v => [v[0], v[1], v[2], -v[3]])
TAN_SIGN_MISMATCH|t(v => [v[0], v[1], v[2], -v[3]]), delete p.material
TAN_KEPT_SIGN|t(v => [v[0], v[1], v[2], -v[3]])|--existing=keep
TAN_MIRROR_SHARED_VERTEX|uv([[0, 0], [1, 0], [1, 1], [1, 0]])
TAN_MIRROR_SHARED_VERTEX|uv([[0, 0], [1, 0], [1, 1], [1, 0]]), delete a.TANGENT
TAN_MIRROR_SHARED_VERTEX|uv([[0, 0], [1, 0], [1, 1], [1, 0]]), delete p.material
TAN_MIXED_W_TRIANGLE|t((v, i) => [v[0], v[1], v[2], i ? v[3] : -v[3]])
TAN_DIRECTION_MISMATCH|t(v => [v[1], v[0], v[2], v[3]])
TAN_NOT_ORTHOGONAL|t(v => [0.6, 0, 0.8, v[3]])
TAN_PARALLEL_NORMAL|t(v => [0, 0, 1, v[3]])
TAN_ZERO|t(v => [0, 0, 0, 1])
TAN_EXISTING_BAD|t(v => [0, 0, 0, 1])|--existing=keep
TAN_QUANTIZED|delete a.TANGENT|--precision=byte
TAN_QUANTIZED|delete a.TANGENT, delete p.material|--precision=byte --only=all
TAN_QUADS_LIKELY|delete a.TANGENT, g.asset.generator = 'Khronos glTF Blender I/O v4.2'|--only=needed
TAN_QUADS_LIKELY|delete a.TANGENT, delete p.material, g.asset.generator = 'Khronos glTF Blender I/O v4.2'|--only=all
TAN_PRIMITIVE_BORDER|delete a.TANGENT, beside([1, 1, 2, .5, 2, -.5, 1, 0])
TAN_NOT_FINITE|t(v => [NaN, 0, 0, 1])
TAN_NON_UNIT|t(v => [2, 0, 0, v[3]])
TAN_NON_UNIT|t(v => [2, 0, 0, v[3]]), delete p.material
TAN_BAD_W|t(v => [1, 0, 0, 0])
TAN_MORPH_MISSING|p.targets = [{POSITION: a.POSITION}]
TAN_NO_NORMAL|delete a.NORMAL, delete a.TANGENT
TAN_UNUSED|delete p.material
TAN_UNUSED|delete p.material, p.targets = [{POSITION: a.POSITION, TANGENT: add('VEC3', 5126, Array(12).fill(0), {})}]
TAN_GREEN_PAIR|t(v => [v[0], v[1], v[2], -v[3]]), g.images[0].uri = 'down.png'
NMAP_HEIGHTS|g.images[0].uri = 'grey.png'
TAN_NO_NORMAL|delete a.NORMAL
TAN_ACCESSOR|g.accessors[n].type = 'VEC3'
TAN_ACCESSOR|g.accessors[n].count = 3
TAN_ACCESSOR|g.accessors[n].byteOffset = 1000
TAN_ACCESSOR|a.TANGENT = 99
TAN_MISSING_REQUIRED|delete a.TANGENT, delete a.NORMAL, g.materials = [{extensions: {KHR_materials_anisotropy: {anisotropyStrength: 0.5}}}], g.extensionsUsed = ['KHR_materials_anisotropy']
TAN_MISSING_REQUIRED|delete a.TANGENT, g.materials = [{extensions: {KHR_materials_anisotropy: {anisotropyStrength: 0.5}}}], g.extensionsUsed = ['KHR_materials_anisotropy']
END
green_down n.png
{ printf 'mtllib m.mtl\nusemtl m\n'; cat square.obj; } >m.obj
printf 'newmtl m\nnorm n.png\n' >m.mtl
run --check -q --report=r.json --fail-on=never m.obj
repairs NMAP_GREEN_DOWN
run --check -q --report=r.json --fail-on=never m.gltf
repairs NMAP_GREEN_DOWN
run -q --flip-green=auto m.gltf turned.gltf
run --check -q --report=r.json --fail-on=never turned.gltf
is "$(value r.json '[f["code"] for f in r["files"][0]["findings"] if f["code"] == "NMAP_GREEN_DOWN"]')" "[]"
# area weights differ from MikkTSpace's angles on a surface that bends
run -q --method=area "$data/head.obj" area.gltf
run --check -q --report=r.json --fail-on=never area.gltf
repairs TAN_MADE_BY
cp n.png square_n.png
run -q --report=r.json square.obj out.glb
repairs NMAP_BESIDE conversion
sed 's/^v \([01]\)/v 100000\1.03/' square.obj >far.obj
run -q --origin=keep --report=r.json far.obj out.glb
repairs POS_ROUNDED conversion
# all codes for which nmtan names a command
run --check -q --report=all.sarif --fail-on=never m.gltf
is "$(value all.sarif '" ".join(c["id"] for c in r["runs"][0]["tool"]["driver"]["rules"] if c["help"]["text"].endswith(" IN OUT"))' | tr ' ' '\n' | sort)" \
	"$(tr ' ' '\n' <<<"${codes_repaired# }" | sort -u)"

scene "--across=mesh judges kept tangents by the whole mesh, in a check of the file, of a conversion, and in that; a report changes no byte"
mapped
gltf m.gltf two 'const [p] = g.meshes[0].primitives, a = p.attributes; delete a.TANGENT;
	g.meshes[0].primitives.push({...p, attributes: {NORMAL: a.NORMAL, TEXCOORD_0: add("VEC2", 5126, [1, 1, 2, -1.5, 2, -2.5, 1, 0], {}),
		POSITION: add("VEC3", 5126, [1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0], {})}})'
run -q --across=mesh two.gltf whole.gltf
run -q two.gltf apart.gltf
gltf whole.gltf half 'delete g.meshes[0].primitives[1].attributes.TANGENT'
while IFS='|' read -r input options found; do
	for words in "--check" "--check -o out.glb" ""; do
		run -q $words --report=r.json --fail-on=never $options $input.gltf $([ -n "$words" ] || echo out.glb)
		is "$input $options, $words: $(value r.json 'len([f for f in r["files"][0]["findings"] if f["code"] in ("TAN_DIRECTION_MISMATCH", "TAN_MADE_BY")]) > 0')" "$input $options, $words: $found"
	done
	run -q $options $input.gltf again.glb
	same out.glb again.glb
done <<'END'
whole|--across=mesh|False
apart|--across=mesh|True
apart|--across=primitive|False
half|--across=mesh|False
half|--across=mesh --draco=edgebreaker|False
half|--across=mesh --existing=repair|False
END

scene "a command names the file as the user did, from a folder beside it, too"
cp "$data"/plates.{gltf,bin} "$data/bumps.png" .
mkdir -p sub/deep
cd sub/deep
for file in ../../plates.gltf "$PWD/../../plates.gltf"; do
	run --check --report=r.json "$file"
	exits 6
	command=$(value r.json '[x["repair"] for x in r["files"][0]["findings"] if x["code"] == "TAN_MISSING_REQUIRED" and x["repair"]][0]')
	eval "\"\$NMTAN\" -q ${command#nmtan}" || wrong "$command: $?"
done
cd ../..

scene "commands that differ are joined to one, and that does what each of them does"
mapped
green_down down.png
while IFS='|' read -r says options edit; do
	gltf m.gltf faulty "const p = g.meshes[0].primitives[0], a = p.attributes, n = a.TANGENT, b = bytes[0];
		const beside = uv => g.meshes[0].primitives.push({...p, attributes: {NORMAL: a.NORMAL, TEXCOORD_0: add('VEC2', 5126, uv, {}),
			POSITION: add('VEC3', 5126, [1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0], {})}}); $edit"
	run --check --fail-on=never faulty.gltf
	is "$options: $(sed -n "s/^  $says: //p" "$WORK/out.txt")" "$options: nmtan $options faulty.gltf faulty-repaired.gltf"
	is "$options: $(grep -c "^  All commands" "$WORK/out.txt")" "$options: $(grep -c All <<<$says)"
	run -q $options faulty.gltf faulty-repaired.gltf
	exits 0
	run --check --fail-on=never faulty-repaired.gltf
	is "$options: $(grep -c "nmtan " "$WORK/out.txt")" "$options: 0"
	rm faulty*
done <<'END'
All commands in one, those of infos too, if their conditions hold|--fix --across=mesh|b.fill(0, at(n, 0), at(n, 0) + 12); beside([1, 1, 2, .5, 2, -.5, 1, 0])
All commands in one, those of infos too, if their conditions hold|--existing=replace --across=mesh --flip-green=auto|[0, 1, 2, 3].forEach(i => { b.writeFloatLE(0, at(n, i)); b.writeFloatLE(1, at(n, i) + 4); }); g.images[0].uri = 'down.png'; beside([1, 1, 2, .5, 2, -.5, 1, 0])
All commands in one, if their conditions hold|--existing=replace --flip-green=auto|[0, 1, 2, 3].forEach(i => { b.writeFloatLE(0, at(n, i)); b.writeFloatLE(1, at(n, i) + 4); }); g.images[0].uri = 'down.png'
END

scene "texture coordinates are judged by the normal map that the output of an OBJ has, whichever stage found the fault"
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvt 1 0\nvt 0 1\nvn 0 0 1\n' >faults.obj
printf 'o %s\nusemtl m\nf %s\n' folded "1/1/1 2/2/1 3/3/1 4/4/1" unmapped "1/1/1 2/1/1 3/1/1" part "1/1/1 2/3/1 3/2/1" >>faults.obj
printf 'f 1//1 3//1 4//1\n' >>faults.obj
printf 'newmtl m\nnorm n.png\n' >m.mtl
for there in no yes; do
	[ $there = no ] || python3 "$ROOT/tests/support/images.py" write n.png 8 8 "(128, 100 + x, 255)"
	severity=$([ $there = no ] && echo info || echo warning)
	run -q --check --report=r.json --fail-on=never faults.obj
	is "$there: $(value r.json '" ".join(f["code"] for f in r["files"][0]["findings"] if f["severity"] == "'$severity'" and f["code"][:4] in ("UV_F", "UV_M", "UV_U"))' |
		tr ' ' '\n' | grep -v MIRROR | sort | tr '\n' ' ')" "$there: UV_FOLDED_QUAD UV_MISSING UV_MIXED_WINDING_ISLAND UV_UNMAPPED "
	for words in "" --report=r.json; do
		run $words --fail-on=never faults.obj out.glb
		is "$there $words: $(grep -o 'warning: .*\[UV_[A-Z_]*' "$WORK/err.txt" | sed 's/.*\[//' | sort | tr '\n' ' ')" \
			"$there $words: $([ $there = no ] || echo "UV_FOLDED_QUAD UV_MISSING ${words:+UV_MIXED_WINDING_ISLAND }UV_UNMAPPED ")"
	done
done

scene "the warnings of a report's checks are printed, as those of the stages are, a few of each code"
printf 'v %d 0 0\nv %d 1 0\nv %d 1 1\n' $(for i in $(seq 7); do echo $i $i $i; done) >many.obj
printf 'mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvn 1 0 0\n' >>many.obj
for i in $(seq 7); do printf 'o m%d\nusemtl m\nf %d/1/1 %d/2/1 %d/3/1\n' "$i" $((3 * i - 2)) $((3 * i - 1)) $((3 * i)); done >>many.obj
printf 'newmtl m\nnorm n.png\n' >m.mtl
python3 "$ROOT/tests/support/images.py" write n.png 8 8 "(128, 100 + x, 255)"
run -q many.obj many.glb
gltf many.glb tilted 'for (const m of g.meshes) { const a = m.primitives[0].attributes;
	a.TANGENT = add("VEC4", 5126, rows(a.TANGENT).map(t => [t[0], t[2], t[1], t[3]].map(x => x || 1e-3)).flat(), {}); }'
for words in "--check --report=r.txt tilted.gltf" "--report=r.txt tilted.gltf out.glb"; do
	run --fail-on=never --severity=TAN_*=warning $words
	exits 0
	said=$(grep -c 'warning: .*\[TAN_' "$WORK/err.txt")
	[ "$said" -ge 5 ] || wrong "$words: $said warnings"
	run -v --fail-on=never --severity=TAN_*=warning $words
	[ "$(grep -c 'warning: .*\[TAN_' "$WORK/err.txt")" -gt "$said" ] || wrong "$words: -v says no more"
	run -q --fail-on=never --severity=TAN_*=warning $words
	says_not TAN_DIRECTION
done
run --report=r.txt --fail-on=never --severity=TAN_*=warning tilted.gltf out.glb
says "nmtan: warning: and 2 more [TAN_"
gltf many.glb inverted 'for (const m of g.meshes) { const a = m.primitives[0].attributes;
	a.TANGENT = add("VEC4", 5126, rows(a.TANGENT).map(t => [t[0], t[1], t[2], -t[3]]).flat(), {}); }'
run inverted.gltf out.glb
is "$(grep -c 'warning: .*\[TAN_KEPT_SIGN\]' "$WORK/err.txt")" 6
says "nmtan: warning: and 2 more [TAN_KEPT_SIGN]; -v shows all"
run --normals=angle:40 inverted.gltf out.glb
says "[TAN_KEPT_SIGN]: nmtan --normals=angle:40 --fix inverted.gltf out.glb"
for words in "" --report=r.json; do
	run -q $words inverted.gltf out.glb
	is "$(wc -l <"$WORK/err.txt")" 1
	says " (more at 6 other places) [TAN_$([ -n "$words" ] && echo SIGN_MISMATCH || echo KEPT_SIGN)]: nmtan --fix inverted.gltf out.glb"
done

scene "options that come to nothing say so, --fix says what it leaves, and counts are of the primitives that are written"
mapped
for words in flat smooth angle:30; do
	run --normals=$words m.gltf out.glb
	says ", all have normals: --normals=replace-$words makes new ones, "
	run -q --normals=replace-$words m.gltf out.glb
	exits 0
	run --normals=$words square.obj out.glb
	says ", all have normals: --normals=replace-$words makes new ones, "
done
gltf m.gltf bare 'delete g.meshes[0].primitives[0].attributes.NORMAL'
run --normals=flat bare.gltf out.glb
says_not "all have normals"
# a height map: whose option is named, unless it is given
python3 "$ROOT/tests/support/images.py" write n.png 32 32 "8 * x"
run --fix m.gltf out.glb
says ", the input has nothing that --fix repairs, left NMAP_HEIGHTS (--bump=height repairs it), "
run --fix --bump=height m.gltf out.glb
says_not NMAP_HEIGHTS
says ", the input has nothing that --fix repairs, converted 1 normal map, "
run --check out.glb
! grep -q NMAP_HEIGHTS "$WORK/out.txt" || wrong "the heights are there"
# an object of two materials with texture coordinates, one without
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\no a\nusemtl x\nf 1/1/1 2/2/1 3/3/1\nusemtl y\nf 2/2/1 1/1/1 3/3/1\no b\n' >two.obj
printf 'usemtl x\nf 1//1 2//1 3//1\nusemtl y\nf 1//1 3//1 2//1\nusemtl z\nf 3//1 2//1 1//1\n' >>two.obj
run two.obj two.glb
is "$(gltf two.glb 'g.meshes.map(m => m.primitives.length)')" "[2,3]"
says "two.glb: 2 of 5 primitives, "
says ", skipped 3 primitives (no texture coordinates), "

scene "a command names the format that the check was asked for"
cp "$data/quad_wedge.ply" k.ply
for format in glb gltf ply; do
	run --check --output-format=$format --fail-on=never --normals=replace-flat --severity=TAN_UNUSED=warning --only=all k.ply
	command=$(sed -n 's/.*: nmtan \(--.*\)/\1/p' "$WORK/out.txt" | tail -1)
	[ $format = ply ] || [ "${command##*.}" = $format ] || wrong "$format: $command"
	[ -z "$command" ] || eval "\"\$NMTAN\" -q $command" || wrong "$format: $command: $?"
done

scene "UVs without area, or next to none, are no matter where there are neither tangents nor a texture that uses them"
printf '%s\n' "v 0 0 0" "v 1 0 0" "v 0 1 0" "v 1 1 0" "v 2 0 0" "v 2 1 0" \
	"vt 0 0" "vt 1 0" "vt 0 1" "vt .5 0" "vt 0 1000" "vt 1 1000" "vt 0 1000.001" \
	"f 1/1 2/2 3/3" "f 2/1 4/4 3/2" "f 2/5 5/6 6/7" >thin.obj
run -q --only=all thin.obj made.gltf
gltf made.gltf none 'delete g.meshes[0].primitives[0].attributes.TANGENT;'
gltf none.gltf painted 'g.images = [{uri: "data:image/png;base64,"}]; g.textures = [{source: 0}];
	g.materials = [{pbrMetallicRoughness: {baseColorTexture: {index: 0}}}]; g.meshes[0].primitives[0].material = 0;'
gltf made.gltf pair 'g.images = [{uri: "data:image/png;base64,"}]; g.textures = [{source: 0}];
	g.materials = [{pbrMetallicRoughness: {baseColorTexture: {index: 0}}}, {}]; const p = g.meshes[0].primitives;
	p[0].material = 0; p.push({...p[0], material: 1});'
for row in "made 2" "none 0" "painted 1" "pair 2"; do
	run --check --fail-on=never ${row% *}.gltf
	is "$row: $(grep -c "UV_\(NEAR_\)*DEGENERATE" "$WORK/out.txt")" "$row: ${row#* }"
done

done_testing
