# SPDX-License-Identifier: MIT
# Every damaged file of data/damaged is refused with the exit code, the place and the reason that stand
# in damaged.tsv: file, exit code, how the message begins, words of the reason. Exit code 0: what is
# wrong is left out, with a finding.
# Leaks count.
. "$ROOT/tests/support/cli.sh"

while IFS=$'\t' read -r file code place reason; do
	case $file in "" | "#"*) continue ;; esac
	if [ "$code" = 0 ]; then
		scene "$file is converted with a finding at $place"
	else
		scene "$file is refused at $place"
	fi
	cp -r "$data/damaged/." in
	rm -rf in/make.py in/__pycache__
	(cd in && exec "$NMTAN" -v --only=all "$file" ../out.glb) >"$WORK/out.txt" 2>"$WORK/err.txt" </dev/null
	status=$?
	exits "$code"
	says "nmtan: $place"
	says "$reason"
	if [ "$code" = 0 ]; then only in out.glb; else only in; fi
done <"$ROOT/tests/cli/damaged.tsv"

scene "every damaged file is in the table"
for file in "$data"/damaged/*.obj "$data"/damaged/*.ply "$data"/damaged/*.glb "$data"/damaged/*.gltf; do
	grep -q "^${file##*/}	" "$ROOT/tests/cli/damaged.tsv" || wrong "${file##*/} is not in damaged.tsv"
done

scene "each fault of a glTF is told at its place, each spelling of JSON is kept, materials and scenes mean what they should"
python3 "$ROOT/tests/support/gltf_refused.py" "$NMTAN" >"$WORK/err.txt" 2>&1 || wrong "gltf_refused.py"

scene "an index that is out of range, of a mesh that has tangents and a normal map"
cp "$data"/plates.* "$data/bumps.png" .
run -q --only=all plates.gltf kept.gltf
gltf kept.gltf bad 'bytes[0].writeUInt16LE(6000, at(g.meshes[0].primitives[0].indices, 4))'
run -q --existing=replace bad.gltf out.glb
exits 3
says "index 4 is 6000"
# if they stay, nobody needs it
run -q bad.gltf out.glb
exits 0
exists out.glb

scene "a buffer that nobody needs and that has no length is linked from elsewhere"
cp "$data"/plates.* "$data/bumps.png" .
cp plates.bin extra.bin
python3 -c 'import json
g = json.load(open("plates.gltf"))
g["buffers"].append({"uri": "extra.bin"})
json.dump(g, open("odd.gltf", "w"))'
mkdir out
run -q --only=all odd.gltf out/odd.gltf
exits 0
is "$(value out/odd.gltf 'r["buffers"][1]["uri"]')" ../extra.bin
run -q --outside=yes out/odd.gltf out/again.glb
exits 0

scene "a glTF whose tangents are kept and whose .bin is not there is an error, whatever is asked"
run -q "$data/mirrored_cube.obj" kept.gltf
run -q --only=all "$data/plates.gltf" many.gltf
rm -f kept.bin many.bin
for name in kept many; do
	for options in "o.gltf" "o.glb" "--buffers=link o.gltf" "--only=all o.glb" "--report=r.json o.gltf" "--existing=replace o.gltf" "--check"; do
		run $name.gltf $options
		exits 2
		says "$name.bin"
		[ ! -e o.gltf ] && [ ! -e o.glb ] || wrong "$options: there is an output"
		rm -f o.gltf o.glb
	done
done

scene "what a file refers to in vain never comes to mean what is added"
# accessor 3 has no bytes
base='const xyz = [0, 0, 0, 1, 0, 0, 0, 1, 0], up = [0, 0, 1, 0, 0, 1, 0, 0, 1];
	const attributes = {POSITION: add("VEC3", 5126, xyz), TEXCOORD_0: add("VEC2", 5126, [0, 0, 1, 0, 0, 1]),
		NORMAL: add("VEC3", 5126, up)};
	g.accessors.push({type: "VEC3", componentType: 5126, count: 3});
	g.meshes = [{primitives: [{attributes}]}, {primitives: [{attributes}]}];
	g.nodes = [{mesh: 0}];
	const hide = (primitive) => { g.meshes[1].primitives = [primitive]; };
	const packed = (bufferView, more) => ({attributes: {POSITION: 3, ...more},
		extensions: {KHR_draco_mesh_compression: {bufferView, attributes: {POSITION: 0}}}});'
while IFS='|' read -r name statements; do
	gltf new $name "$base" "$statements"
done <<'LIST'
attribute|hide({attributes: {POSITION: 0, NORMAL: 4}})
target|hide({attributes: {POSITION: 0}, targets: [{POSITION: 4}]})
skin|g.skins = [{joints: [0]}, {joints: [0], inverseBindMatrices: 4}]
sampler|g.animations = [{channels: [], samplers: [{input: 4, output: 0}]}]
image|g.images = [{bufferView: 3, mimeType: "image/png"}]
shared|g.meshes[1].primitives = [packed(1), packed(2, {NORMAL: 4})]; g.extensionsUsed = ["KHR_draco_mesh_compression"]
far|hide({attributes: {POSITION: 0, NORMAL: 40}})
LIST
# mirrored triangles over one edge: two vertices are copied, so that what is there moves
gltf new split 'const attributes = {POSITION: add("VEC3", 5126, [0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 0, 0]),
		TEXCOORD_0: add("VEC2", 5126, [0, 0, 0, 1, 1, 0, 1, 0]),
		NORMAL: add("VEC3", 5126, [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1])};
	const indices = add("SCALAR", 5123, [0, 2, 1, 0, 1, 3]);
	g.meshes = [{primitives: [{attributes, indices}]}, {primitives: [{attributes: {POSITION: 0}}]}];
	g.nodes = [{mesh: 0}];
	g.skins = [{joints: [0], inverseBindMatrices: 4}]'
while read -r name place what; do
	run --only=all "$name.gltf" out.glb
	exits 3
	says "$name.gltf: $place: refers to $what"
	[ ! -e out.glb ] || wrong "$name: there is an output"
done <<'LIST'
attribute /meshes/1/primitives/0/attributes accessors[4], there are 4
target /meshes/1/primitives/0/targets/0 accessors[4], there are 4
skin /skins/1/inverseBindMatrices accessors[4], there are 4
sampler /animations/0/samplers/0/input accessors[4], there are 4
image /images/0/bufferView bufferViews[3], there are 3
shared /meshes/1/primitives/1/attributes accessors[4], there are 4
split /skins/0/inverseBindMatrices accessors[4], there are 4
LIST
run --only=all far.gltf out.glb
exits 0
is "$(gltf out.glb '[g.meshes[1].primitives[0].attributes.NORMAL, g.accessors.length]')" "[40,5]"

done_testing
