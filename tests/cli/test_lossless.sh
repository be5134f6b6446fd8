# SPDX-License-Identifier: MIT
# glTF from glTF changes tangents and nothing else. A reader that shares no code with nmtan compares the two files: see
# support/gltf_lossless.py; and test_layouts.sh, for who shares what.
. "$ROOT/tests/support/cli.sh"
mkdir -p "$WORK/layouts"
python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/layouts" || exit 1
lossless() {
	python3 "$ROOT/tests/support/gltf_lossless.py" "$@" >"$WORK/err.txt" 2>&1 || wrong "$2 is not lossless"
}

mkdir -p "$WORK/doubled"
python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/doubled" --doubled || exit 1

scene "a soup gets indices of the narrowest type, whether or not it gets tangents, and in each mode"
if [ -d "$ROOT/../shared/cases/unwelded" ]; then
	run --weld "$ROOT/../shared/cases/unwelded/soup.gltf" out.glb
	says "384 vertices, welded 384 vertices to 81"
fi
count='g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count'
type='g.meshes[0].primitives.map((p) => g.accessors[p.indices].componentType).join()'
for mode in 1 2 3 4 5 6; do
	gltf new soup "const mode = $mode;" 'const points = [0, 1, 2, 1, 2, 3, 2, 3, 0];
		const attributes = {POSITION: add("VEC3", 5126, points.flatMap((x) => [x, x * x, 0]), {min: [0, 0, 0], max: [3, 9, 0]}),
			_ID: add("SCALAR", 5126, points.map((x, i) => i === 8 ? 7 : x))};
		g.meshes = [{primitives: [{attributes, mode}]}]; g.nodes = [{mesh: 0}]; g.scenes = [{nodes: [0]}]; g.scene = 0'
	run --weld soup.gltf out.gltf
	exits 0
	# the last one is another by _ID alone
	is "$(gltf out.gltf "[$count, $type, g.meshes[0].primitives[0].mode].join()")" 5,5123,$mode
	lossless --welded soup.gltf out.gltf
	valid out.gltf
	run --weld out.gltf again.gltf
	says ", no vertices are equal"
	same out.gltf again.gltf
done
# 300 x 300 points and 70 000 indices of four bytes, of which two will do
gltf new wide 'const i = Array.from({length: 70000 * 3}, (_, k) => k);
	const attributes = {POSITION: add("VEC3", 5126, i.flatMap((k) => [k % 30000, k & 1, 0]), {min: [0, 0, 0], max: [29999, 1, 0]})};
	g.meshes = [{primitives: [{attributes, indices: add("SCALAR", 5125, i)}, {attributes}]}]; g.nodes = [{mesh: 0}]; g.scenes = [{nodes: [0]}]'
run --weld wide.gltf out.glb
is "$(gltf out.glb "[$count, $type, new Set(g.meshes[0].primitives.map((p) => p.indices)).size].join()")" 30000,5123,5123,2
lossless --welded wide.gltf out.glb
# points alone stay
gltf new points 'const attributes = {POSITION: add("VEC3", 5126, [0, 0, 0, 0, 0, 0], {min: [0, 0, 0], max: [0, 0, 0]})};
	g.meshes = [{primitives: [{attributes, mode: 0}]}]; g.nodes = [{mesh: 0}]'
run --weld points.gltf out.gltf
is "$(gltf out.gltf "$count")" 2

scene "Draco blocks and what an extension refers to: welded with what is compressed again, left alone with a word else"
soup=$WORK/layouts/unindexed.gltf
run "$soup" plain.glb
run --draco=sequential "$soup" packed.glb
vertices=$(gltf packed.glb "$count")
run --existing=replace --draco=off packed.glb loose.glb
run --existing=replace --weld --draco=off packed.glb welded.glb
exits 0
lossless --welded loose.glb welded.glb --tangents=loose.glb
run --existing=replace --weld --verify packed.glb again.glb
exits 0
is "$(gltf again.glb "$count")" "$(gltf welded.glb "$count")"
[ "$vertices" = 648 ] || [ "$vertices" = "$(gltf welded.glb "$count")" ] || wrong "the block has $vertices vertices"
valid again.glb
run --weld packed.glb left.glb
exits 0
says "1 primitive is not welded: Draco compresses it"
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvt 1 0\nf 1/1 2/3 3/2\nf 4/1 5/2 6/3\n' >soup.obj
run --weld soup.obj out.glb # whose vertices are those that its faces name
says ", --weld welds glTF made from glTF, "
same packed.glb left.glb
for extension in '{CESIUM_primitive_outline: {indices: 0}}' '{FB_ngon_encoding: {}}' '{EXT_mesh_features: {featureIds: [{featureCount: 648}]}}' \
	'{VENDOR_x: {of: g.accessors.push({componentType: 5126, type: "SCALAR", count: 648}) - 1}}'; do
	gltf plain.glb left "g.meshes[0].primitives[0].extensions = $extension; g.extensionsUsed = ['VENDOR_x']"
	run --weld left.gltf out.gltf
	exits 0
	says "[WELD_LEFT]"
	says_not "welded 648"
	is "$(gltf out.gltf "$count")" 648
done
# what was to be compressed and cannot be is welded once
for name in sparse tangents_short twin_accessors two_ranges shared_with_points; do
	for input in "$WORK/layouts/$name.gltf" "$WORK/doubled/$name.gltf"; do
		run --existing=replace --weld --verify "$input" out.glb
		exits 0
		number=$(grep -o ', welded .* to [0-9]*\|, no vertices are equal' "$WORK/err.txt")
		run --existing=replace --weld --draco=sequential --verify "$input" again.glb
		exits 0
		says "DRACO_PLAIN"
		says "$number"
	done
	same out.glb again.glb
	# tangents that rounding made equal, too
	run --existing=replace --weld --precision=byte --draco=edgebreaker "$input" again.glb
	run --existing=replace --weld --precision=byte again.glb out.glb
	says ", no vertices are equal"
done
# feature ids that have an attribute are an attribute like others
gltf plain.glb ids 'g.meshes[0].primitives[0].extensions = {EXT_mesh_features: {featureIds: [{featureCount: 648, attribute: 0}]}}'
run --weld ids.gltf out.gltf
says "welded 648"

scene "tangents of targets keep equal vertices apart if they stay, not if they are computed anew"
for row in "none 4" "0 5" "1 4" "2 5"; do
	gltf new quad "const target = '${row% *}';" 'const six = (rows) => [0, 1, 2, 0, 2, 3].flatMap((v) => rows[v]);
		const up = Array(4).fill([0, 0, 1]), corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
		const tangents = (n) => add("VEC3", 5126, six(up).map((x, i) => i < 3 && n === +target ? 1 : x));
		g.meshes = [{primitives: [{attributes: {NORMAL: add("VEC3", 5126, six(up)), TEXCOORD_0: add("VEC2", 5126, six(corners)),
			POSITION: add("VEC3", 5126, six(corners.map((c) => [...c, 0])), {min: [0, 0, 0], max: [1, 1, 0]})},
			targets: [{TANGENT: tangents(0)}, {TANGENT: tangents(1), POSITION: add("VEC3", 5126, six(up),
				{min: [0, 0, 1], max: [0, 0, 1]})}, {TANGENT: tangents(2)}]}]}]'
	run --weld --only=all --morph=bake quad.gltf out.glb
	exits 0
	says "welded 6 vertices to ${row#* }"
done

scene "a vertex that no corner uses has the tangent that a mesh alone would give it"
gltf "$WORK/layouts/plain.gltf" alone 'const [p] = g.meshes[0].primitives;
	p.attributes = {...p.attributes, NORMAL: add("VEC3", 5126, rows(p.attributes.NORMAL).flatMap((n, i) => [i, 30, 70]))};
	delete p.targets;
	g.accessors[p.indices].count = 3'
gltf alone.gltf pooled 'const [p] = g.meshes[0].primitives;
	g.meshes[0].primitives.push({...p, indices: g.accessors.push({...g.accessors[p.indices], byteOffset: 6}) - 1})'
for name in alone pooled; do
	run $name.gltf $name.glb
	exits 0
done
is "$(gltf alone.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT).slice(20, 40)')" \
	"$(gltf pooled.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT).slice(20, 40)')"

# A byte ends at 254: 255 restarts. Each square is mirrored across its middle, where it gets two copies.
scene "indices get a wider type if their own highest needs it, not that of another primitive"
for row in "251 5121,5121" "252 5121,5123" "253 5121,5123" "254 5123,5123"; do
	gltf new squares "const count = ${row% *};" 'const of = (value) => Array.from({length: count}, (_, v) => value(v)).flat();
		const quad = (v) => [v, v + 1, v + 3, v, v + 3, v + 2, v + 1, v + 4, v + 3, v + 1, v + 5, v + 4];
		const attributes = {NORMAL: add("VEC3", 5126, of(() => [0, 0, 1])),
			POSITION: add("VEC3", 5126, of((v) => [v % 6 < 2 ? v % 6 : v % 6 - 2, v % 6 < 2 ? 0 : 1, Math.floor(v / 6)])),
			TEXCOORD_0: add("VEC2", 5126, of((v) => [[0, 0], [1, 0], [0, 1], [1, 1], [0, 1], [0, 0]][v % 6]))};
		g.meshes = [{primitives: [0, 6].map((v) => ({attributes, indices: add("SCALAR", 5121, quad(v))}))}]'
	run --only=all squares.gltf out.glb
	exits 0
	is "$(gltf out.glb 'g.meshes[0].primitives.map((p) => g.accessors[p.indices].componentType).join()')" ${row#* }
done

scene "vertices that nothing in the file backs are not welded, whatever number it claims"
python3 - <<'END' >claims.gltf
import json
print(json.dumps({'asset': {'version': '2.0'}, 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}],
    'accessors': [{'componentType': 5126, 'count': 10**7, 'type': 'VEC3', 'min': [0] * 3, 'max': [0] * 3}]}))
END
run --weld claims.gltf out.gltf
exits 0
says "WELD_LEFT"
# whose numbers of elements, twice the same, would be refused if it were read
gltf "$WORK/layouts/unindexed.gltf" claims 'g.meshes[0].primitives[0].attributes._CLAIM = g.accessors.push({componentType: 5126, type: "SCALAR",
	count: 1e6, sparse: {count: 2, indices: {bufferView: 0, componentType: 5121}, values: {bufferView: 0}}}) - 1'
run --weld claims.gltf out.gltf
exits 0
says "its attributes differ in their number of elements"

scene "a document without buffers gets none for what is not welded"
echo '{"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0],
	"max": [0, 0, 0]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]}' >bare.gltf
run --weld bare.gltf out.glb
exits 0
is "$(gltf out.glb '"buffers" in g')" false

scene "other formats are refused, but for OBJ, whose faces say which vertices are one"
run --weld "$data/quad_ascii.ply" out.glb
exits 1
says "only glTF made from glTF is welded, not glb made from ply"
run --weld "$WORK/layouts/plain.gltf" out.ply
exits 1
run --weld "$data/quad.obj" out.glb
exits 0
run --weld --manifest=m "$soup" out.glb
grep -q '"weld_before":648,"weld_after":1[0-9]*' m || wrong "the manifest does not say what was welded: $(cat m)"

scene "tangents that replace integers have their type, unless --precision says another"
type='g.meshes[0].primitives.map(p => g.accessors[p.attributes.TANGENT].componentType).join()'
run --existing=replace "$WORK/layouts/tangents_short.gltf" out.glb
exits 0
is "$(gltf out.glb "$type")" "$(gltf "$WORK/layouts/tangents_short.gltf" "$type")"
run --existing=replace --precision=float "$WORK/layouts/tangents_short.gltf" float.glb
case $(gltf float.glb "$type") in *5122*) wrong "integers with --precision=float" ;; esac

scene "indices that several primitives share leave nothing behind when each gets its own, and bounds stay"
# a strip of three squares; the texture is mirrored behind the first in one primitive, behind the second in the other
python3 - in.gltf <<'END'
import base64, json, struct, sys
data, views, accessors = b'', [], []
def add(kind, type, values, **more):
    global data
    raw = struct.pack('<%d%s' % (len(values), kind), *values)
    views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(raw)})
    data += raw + bytes(-len(raw) % 4)
    accessors.append({'bufferView': len(views) - 1, 'componentType': 5126 if kind == 'f' else 5123, 'type': type,
                      'count': len(values) // {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3}[type], **more})
    return len(accessors) - 1
indices = add('H', 'SCALAR', sum([[i, i + 1, i + 5, i, i + 5, i + 4] for i in range(3)], []), min=[0], max=[7])
primitives = []
for us in ([0, 1, 0, -1], [0, 1, 2, 1]):
    points = [(x, y, 0) for y in (0, 1) for x in range(4)]
    primitives.append({'indices': indices, 'attributes': {
        'POSITION': add('f', 'VEC3', sum(map(list, points), []), min=[0, 0, 0], max=[3, 1, 0]),
        'NORMAL': add('f', 'VEC3', [0, 0, 1] * 8),
        'TEXCOORD_0': add('f', 'VEC2', sum([[us[x], 1 - y] for x, y, _ in points], []))}})
json.dump({'asset': {'version': '2.0'}, 'accessors': accessors, 'bufferViews': views, 'scenes': [{'nodes': [0, 1]}],
           'nodes': [{'mesh': 0}, {'mesh': 1}], 'meshes': [{'primitives': [p]} for p in primitives],
           'buffers': [{'byteLength': len(data),
                        'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]},
          open(sys.argv[1], 'w'))
END
for out in out.gltf out.glb; do
	run --only=all in.gltf $out
	exits 0
	is "$(gltf $out 'g.meshes.map(m => rows(m.primitives[0].indices).flat().reduce((a, b) => Math.max(a, b))).join()')" 9,9
	is "$(gltf $out '(() => { const used = g.meshes.flatMap(m => m.primitives.flatMap(p => [p.indices, ...Object.values(p.attributes)]));
		return g.accessors.filter((a, i) => !used.includes(i)).length + " " + g.bufferViews.filter((v, i) =>
		!g.accessors.some(a => a.bufferView == i)).length; })()')" "0 0"
	is "$(gltf $out 'JSON.stringify(g.accessors.filter(a => a.type == "SCALAR" && a.max).map(a => [a.min, a.max]))')" "[[[0],[9]]]"
	lossless in.gltf $out
done

scene "what shares bytes with tangents keeps its values, and what is wrong beside them does not matter"
for name in alias split fewer; do
	# split: a second triangle, whose texture is the mirror image
	gltf new $name "const count = '$name' === 'split' ? 4 : 3, few = '$name' === 'fewer';" '
		const points = [[0, 0, 0], [0, 1, 0], [1, 0, 0], [-1, 0, 0]].slice(0, count);
		const attributes = {POSITION: add("VEC3", 5126, points.flat()),
			NORMAL: add("VEC3", 5126, points.flatMap(() => [0, 0, 1])),
			TEXCOORD_0: add("VEC2", 5126, points.flatMap(([x, y]) => [Math.abs(x), y])),
			TANGENT: add("VEC4", 5126, points.flatMap(() => [5, 6, 7, 1]))};
		const indices = add("SCALAR", 5123, [0, 2, 1, 0, 1, 3].slice(0, 3 * count - 6));
		g.bufferViews[3].byteStride = 16;
		attributes._OTHER = g.accessors.push({...g.accessors[few ? 0 : 3], type: "VEC3", count: few ? 2 : count}) - 1;
		g.meshes = [{primitives: [{attributes, indices}]}]'
	run --only=all --existing=replace $name.gltf out.glb
	exits 0
	other='[...new Set(rows(g.meshes[0].primitives[0].attributes._OTHER).map(String))]'
	[ $name = fewer ] || is "$(gltf out.glb "$other")" '["5,6,7"]'
done

# alone.gltf: the file of instanced primitives with these of them.
only_primitives() {
	gltf "$WORK/layouts/instanced_turned.gltf" alone \
		"g.meshes[0].primitives = '$*'.split(' ').map((i) => g.meshes[0].primitives[i])"
}

scene "primitives with the same geometry are solved once and share their tangents"
run --timing "$WORK/layouts/plain.gltf" one.glb
exits 0
says_not "not solved again"
run --timing "$WORK/layouts/instanced.gltf" three.glb
exits 0
says "3 primitives (2 the same as others)"
says "not solved again: 2 primitives"
p='g.meshes[0].primitives'
is "$(gltf three.glb "new Set($p.map((p) => p.attributes.TANGENT)).size")" 1
is "$(gltf three.glb "new Set($p.map((p) => p.indices)).size")" 1
is "$(gltf three.glb "new Set($p.map((p) => p.targets[1].TANGENT)).size")" 1
is "$(gltf three.glb "rows($p[2].attributes.TANGENT)")" "$(gltf one.glb "rows($p[0].attributes.TANGENT)")"
# not a byte more than for one of them
is "$(gltf three.glb g.buffers[0].byteLength)" "$(gltf one.glb g.buffers[0].byteLength)"
# tangents that differ at every vertex have an accessor of their own; the rows are not copied for them
run --timing "$WORK/layouts/instanced_turned.gltf" four.glb
exits 0
says "not solved again: 2 primitives"
is "$(gltf four.glb "new Set($p.map((p) => p.attributes.TANGENT)).size")" 2
is "$(gltf four.glb "new Set($p.map((p) => p.attributes.POSITION)).size")" 2
is "$(gltf four.glb "g.accessors[$p[3].attributes.POSITION].count")" "$(gltf one.glb "g.accessors[$p[0].attributes.POSITION].count")"
# one at a time, by an independent split of the file
for primitive in 0 3; do
	only_primitives $primitive
	run alone.gltf alone.glb
	exits 0
	corners='rows(P.indices).map(([i]) => rows(P.attributes.TANGENT)[i])'
	is "$(gltf four.glb "${corners//P./$p[$primitive].}" | md5sum)" "$(gltf alone.glb "${corners//P./$p[0].}" | md5sum)"
done

scene "a compressed primitive that is there twice stays compressed, in one block"
only_primitives 0 1
run --draco=sequential alone.gltf packed.glb
exits 0
one_block='new Set(g.meshes[0].primitives.map((p) => p.extensions.KHR_draco_mesh_compression.bufferView)).size'
is "$(gltf packed.glb "$one_block")" 1
valid packed.glb
run --existing=replace packed.glb again.glb
exits 0
says "2 primitives (1 the same as others)"
is "$(gltf again.glb "$one_block")" 1
run --existing=replace --draco=off again.glb plain.glb
exits 0
run alone.gltf direct.glb
positions='rows(g.meshes[0].primitives[1].attributes.POSITION).length'
is "$(gltf plain.glb "$positions")" "$(gltf direct.glb "$positions")"
valid plain.glb

scene "a file in which nothing needs tangents is copied byte by byte"
for input in interleaved_gap.glb interleaved_u32.gltf; do
	run "$WORK/layouts/$input" once."${input##*.}"
	exits 0
	run once."${input##*.}" twice."${input##*.}"
	exits 0
	cmp -s once."${input##*.}" twice."${input##*.}" || wrong "$input: the copy differs"
done

scene "what is not edited is spelled as it was"
spelling() {
	python3 "$ROOT/tests/support/json_spelling.py" "$@" || wrong "json_spelling.py $*"
}
# the edits; where a first member goes, the next one comes closer
edits() {
	case $words in
	--draco*) spelling compare "$@" | grep -v " became " ;;
	*) spelling compare "$@" ;;
	esac
}
cp "$WORK"/layouts/{plain,three_buffers,sparse}* .
for words in plain three_buffers sparse "--draco=sequential plain"; do
	name=${words##* }
	# shellcheck disable=SC2086
	run --existing=replace $words.gltf straight.gltf
	exits 0
	edited=$(edits $name.gltf straight.gltf)
	case $edited in
	*"- /accessors/0/bufferView"* | *"+ /meshes/0/primitives/0/attributes/TANGENT"*) ;;
	*) wrong "$edited" ;;
	esac
	for seed in 1 2 3; do
		spelling respell $seed $name.gltf odd.gltf
		# shellcheck disable=SC2086
		run --existing=replace ${words%"$name"}odd.gltf odd_out.gltf
		exits 0
		is "$(edits odd.gltf odd_out.gltf)" "$edited"
		same straight.bin odd_out.bin
	done
done
# the JSON of a .glb ends without more than its padding, however often it is edited
run --existing=replace plain.gltf odd_out.glb
for precision in short float short; do
	run --existing=replace --precision=$precision odd_out.glb again.glb
	exits 0
	mv again.glb odd_out.glb
	is "$(python3 -c 'import struct; b = open("odd_out.glb", "rb").read()
t = b[20:20 + struct.unpack("<I", b[12:16])[0]]; print(len(t) - len(t.rstrip(b" ")) < 4)')" True
done
# what tinygltf's parser refuses in extras does not keep --verify from its work
sed 's/"extras": {}/"extras": {"n": 1e400, "n": [-1E+999]}/' plain.gltf >odd.gltf
run --verify --existing=replace odd.gltf odd_out.gltf
exits 0
says_not NOT_VERIFIED
grep -q '"extras": {"n": 1e400, "n": \[-1E+999\]}' odd_out.gltf || wrong "the extras changed"
# nor do integers that are spelled as reals, which tinygltf takes for others
sed -E 's/("(byteOffset|byteLength|count|bufferView|componentType|POSITION|NORMAL|material)": [0-9]+)/\1.0/; s/("byteLength": [0-9]+)0\.0/\1e+1/' \
	plain.gltf >odd.gltf
grep -q '"byteOffset": [1-9][0-9]*\.0' odd.gltf && grep -q "e+1" odd.gltf || wrong "nothing is spelled otherwise"
for output in odd_out.gltf odd_out.glb; do
	run --verify --existing=replace odd.gltf $output
	exits 0
	says_not NOT_VERIFIED
done

scene "links are kept right for the folder of the output"
mkdir -p "in dir" out/deep
cp "$WORK"/layouts/plain* "$WORK"/layouts/three* "in dir"
run --images=link --buffers=link "in dir/three_buffers.gltf" out/deep/t.gltf
exits 0
says "/buffers/2: warning: reference leaves the folder of the output: as --buffers=link asks [LINK_LEAVES]"
lossless "in dir/three_buffers.gltf" out/deep/t.gltf
grep -q '"uri": "../../in%20dir/three_buffers%202.bin"' out/deep/t.gltf || wrong "the untouched buffer is not linked"
run --existing=replace out/deep/t.gltf again.gltf
exits 0
run --existing=replace --buffers=embed out/deep/t.gltf again.gltf
exits 3
says "leaves the folder"
run --existing=replace --buffers=embed --outside=yes out/deep/t.gltf again.gltf
exits 0

scene "URIs that are not relative stay as they are"
mkdir out
for uri in : x:y.png C:/x.png http://h/x.png /x.png '#a:b' a/b:c; do
	sed "s|data:image/png[^\"]*|$uri|" "$WORK/layouts/plain.gltf" >plain.gltf
	cp "$WORK/layouts/plain 0.bin" .
	run --images=link plain.gltf out/o.glb
	exits 0
	case $uri in '#'* | a*) expected=../$uri ;; *) expected=$uri ;; esac
	is "$(gltf out/o.glb 'g.images[0].uri')" "$expected"
done

scene "buffers are linked, copied or embedded"
mkdir in out
cp "$WORK"/layouts/three* in
run --buffers=link in/three_buffers.gltf out/link.gltf
uris='g.buffers.map((b) => b.uri.slice(0, 40))'
links=$(gltf out/link.gltf "$uris")
linked=$(grep -o '\.\./in/' <<<"$links" | wc -l)
[ "$linked" -gt 0 ] || wrong "nothing is linked: $links"
# by default what would be outside is copied, and what is inside is linked
run in/three_buffers.gltf out/again.gltf
is "$(gltf out/again.gltf 'g.buffers.filter((b) => b.uri.includes("/")).length')" 0
lossless in/three_buffers.gltf out/again.gltf
mv in gone
run --check --fail-on=never out/again.gltf
exits 0
mv gone in
run in/three_buffers.gltf above.gltf
is "$(gltf above.gltf 'g.buffers.filter((b) => b.uri.startsWith("in/")).length')" "$linked"
says_not LINK_LEAVES
# what is not there is missed, needed or not
mkdir less && cp in/three_buffers* less && rm "less/three_buffers 2.bin"
run less/three_buffers.gltf out/again.gltf
exits 2
says '/buffers/2: error: buffer cannot be opened: cannot open "three_buffers%202.bin"'
run --buffers=copy in/three_buffers.gltf out/copy.gltf
exits 0
copies=$(gltf out/copy.gltf "$uris")
case $copies in *"../"* | *data:*) wrong "$copies" ;; esac
lossless in/three_buffers.gltf out/copy.gltf
rm out/link* out/again*
is "$(ls out | wc -l)" 4
run --buffers=embed in/three_buffers.gltf out/embed.gltf
exits 0
run --buffers=embed in/three_buffers.gltf out/old.gltf
same out/embed.gltf out/old.gltf
lossless in/three_buffers.gltf out/embed.gltf
# nothing to be done, but the folder is another
run --buffers=copy out/copy.gltf moved.gltf
exits 0
is "$(ls moved* | wc -l)" 4
mkdir away && mv moved* away
lossless out/copy.gltf away/moved.gltf
# what is there already stays
cp in/three_buffers* .
run --buffers=copy --existing=replace three_buffers.gltf here.gltf
exits 0
is "$(ls here* | wc -l)" $((4 - linked))

scene "a .glb made from several buffers is one file, or has files where they are asked for"
mkdir in out
cp "$WORK"/layouts/three* in
kinds='g.buffers.map((b) => b.uri === undefined ? "BIN" : b.uri.slice(0, 5) === "data:" ? "data" : b.uri)'
run --verify in/three_buffers.gltf out/one.glb
exits 0
is "$(gltf out/one.glb "$kinds")" '["BIN","data","data"]'
lossless in/three_buffers.gltf out/one.glb
valid out/one.glb
run --buffers=embed in/three_buffers.gltf out/embed.glb
exits 0
same out/one.glb out/embed.glb
is "$(ls out | wc -l)" 2
# new tangents and copied rows are in the first two, the third is untouched
run --verify --buffers=link in/three_buffers.gltf out/link.glb
exits 0
is "$(gltf out/link.glb "$kinds")" '["BIN","link.bin","../in/three_buffers%202.bin"]'
lossless in/three_buffers.gltf out/link.glb
valid out/link.glb
is "$(ls out | wc -l)" 4
run --verify --buffers=copy in/three_buffers.gltf out/copy.glb
exits 0
is "$(gltf out/copy.glb "$kinds")" '["BIN","copy.bin","copy-2.bin"]'
cmp -s out/copy-2.bin "in/three_buffers 2.bin" || wrong "the copy differs"
lossless in/three_buffers.gltf out/copy.glb
# nothing to be done: all of them can stay where they are
run --buffers=link out/one.glb plain.gltf
exits 0
run --buffers=link plain.gltf out/files.glb
exits 0
is "$(gltf out/files.glb "$kinds")" '["../plain.bin","data","data"]'
lossless plain.gltf out/files.glb
valid out/files.glb
# standard output has nothing beside it
"$NMTAN" --buffers=link --output-format=glb in/three_buffers.gltf - >stream.glb 2>"$WORK/err.txt" || wrong "fails"
is "$(gltf stream.glb "$kinds")" '["BIN","data","data"]'
is "$(ls)" "in
out
plain.bin
plain.gltf
stream.glb"

scene "sparse arrays of two accessors, and of a view whose user is unknown"
gltf "$WORK/layouts/sparse.gltf" shared 'const p = g.meshes[0].primitives[0], a = g.accessors[p.attributes.POSITION];
	delete p.targets;
	g.accessors.push(structuredClone(a));
	g.meshes[0].primitives.push({...p, attributes: {...p.attributes, POSITION: g.accessors.length - 1}});
	for (const part of ["indices", "values"]) g.bufferViews.push({...g.bufferViews[a.sparse[part].bufferView]})'
run --existing=replace --verify shared.gltf out.glb
exits 0
# of which it keeps the old ones: the buffer grows by these, and nothing else is to be said
python3 "$ROOT/tests/support/gltf_lossless.py" shared.gltf out.glb >said.txt 2>&1
is "$(cat said.txt)" "out.glb: buffers grew by 6624, expected at most 6264"

scene "the comparison of two outputs follows their references"
run --existing=replace "$WORK/layouts/plain.gltf" out.gltf
gltf out.gltf one ';'
gltf out.gltf moved 'const last = g.bufferViews.length - 1;
	g.bufferViews.reverse();
	for (const a of g.accessors)
		for (const x of [a, a.sparse?.indices, a.sparse?.values])
			if (x && "bufferView" in x) x.bufferView = last - x.bufferView'
gltf out.gltf other 'const a = g.meshes[0].primitives[0].attributes;
	[a.POSITION, a.NORMAL] = [a.NORMAL, a.POSITION]'
compare() { python3 "$ROOT/tests/support/gltf_lossless.py" --outputs one.gltf "$1" 2>&1 | cut -d: -f2; }
is "$(compare moved.gltf)" ""
is "$(compare other.gltf | grep values)" " /meshes/0/primitives/0/attributes/POSITION/values
 /meshes/0/primitives/0/attributes/NORMAL/values"

scene "indices may be sparse"
gltf "$WORK/layouts/plain.gltf" indices 'const p = g.meshes[0].primitives[0], a = g.accessors[p.indices];
	const [whole] = [rows(p.indices).flat()];
	const values = g.accessors[add("SCALAR", a.componentType, [whole[4], whole[5], whole[3]])];
	const indices = g.accessors[add("SCALAR", 5123, [3, 4, 5])];
	g.accessors.length -= 2;
	a.sparse = {count: 3, values: {bufferView: values.bufferView, byteOffset: values.byteOffset ?? 0},
		indices: {bufferView: indices.bufferView, byteOffset: indices.byteOffset ?? 0, componentType: 5123}}'
run --existing=replace --verify indices.gltf out.glb
exits 0
places() { gltf "$1" "((p) => [$2].map((c) => rows(p.attributes.POSITION)[rows(p.indices)[c][0]]))(g.meshes[0].primitives[0])"; }
is "$(places out.glb 3,4,5)" "$(places "$WORK/layouts/plain.gltf" 4,5,3)"

scene "a path that goes down and up again stays in its folder"
mkdir in
cp "$WORK"/layouts/plain* in
gltf in/plain.gltf in/image 'g.images = [{uri: "sub/../map.png"}]'
run --images=link --existing=replace in/image.gltf out.gltf
exits 0
says_not LINK_LEAVES
is "$(gltf out.gltf 'g.images[0].uri')" in/sub/../map.png

scene "the output takes no name of a file that the input refers to, read or not"
cp "$WORK"/layouts/plain* .
gltf plain.gltf image 'g.images = [{uri: "map.png"}]'
echo kept >map.png
run --output-format=glb --images=link --existing=replace image.gltf map.png
exits 2
says "it is the same file as the input"
is "$(<map.png)" kept

scene "tangents stay between others that two sparse accessors share"
gltf "$WORK/layouts/tangents_interleaved.gltf" shared 'const p = g.meshes[0].primitives[0], uv = p.attributes.TEXCOORD_0;
	const values = g.accessors[add("VEC2", 5126, [0.5, 0.5])], indices = g.accessors[add("SCALAR", 5123, [3])];
	g.accessors.length -= 2;
	g.accessors[uv].sparse = {count: 1, values: {bufferView: values.bufferView, byteOffset: values.byteOffset},
		indices: {bufferView: indices.bufferView, byteOffset: indices.byteOffset, componentType: 5123}};
	g.meshes[0].primitives.push({...p, attributes: {...p.attributes,
		TEXCOORD_0: g.accessors.push(structuredClone(g.accessors[uv])) - 1}})'
run --existing=replace --verify shared.gltf out.glb
exits 0
is "$(gltf out.glb 'g.bufferViews[g.accessors[g.meshes[0].primitives[1].attributes.TANGENT].bufferView].byteStride')" 68

scene "a first buffer without uri cannot become the BIN chunk"
sed 's/"uri": "[^"]*buffers%200.bin"/"extras": 1/' "$WORK/layouts/three_buffers.gltf" >nameless.gltf
cp "$WORK"/layouts/three* .
sed -i 's/"mode": 4/"mode": 0/; s/"material": 0/"material": 0, "mode": 0/' nameless.gltf
run nameless.gltf out.glb
exits 5
says "/buffers/0: no uri"
run nameless.gltf out.gltf
exits 0
# nor if tangents that stay cannot be read for want of it
run "$data/mirrored_cube.obj" kept.gltf
sed 's/"uri":"kept.bin",//' kept.gltf >nameless.gltf
run nameless.gltf out.glb
exits 5
says "/buffers/0: no uri"
# but one of which nobody has a byte: its are zeros
sed 's/"buffers": \[/&{"byteLength": 12},/; s/"buffer": 0/"buffer": 1/' "$WORK/layouts/plain.gltf" >spare.gltf
cp "$WORK"/layouts/plain*.bin .
run --existing=replace spare.gltf out.glb
exits 0
is "$(gltf out.glb 'g.buffers.map((b) => b.byteLength)[0]')" 12
lossless spare.gltf out.glb

scene "a glTF made from a glTF keeps its images"
run --images=none "$data/plates.gltf" out.gltf
exits 1
says "--images=none"
only

scene "data URIs are made while the text is written, whatever a name looks like, and in each text that is written"
cp "$data"/plates.* "$data/bumps.png" .
for name in plain 'data:application/octet-stream;base64,' 'data:application/gltf-buffer;base64,A'; do
	python3 -c 'import base64, json, sys
g = json.load(open("plates.gltf"))
view = g["bufferViews"][0]
part = open("plates.bin", "rb").read()[view.get("byteOffset", 0):][:view["byteLength"]]
g["buffers"].append({"byteLength": len(part), "uri": "data:application/gltf-buffer;base64," + base64.b64encode(part).decode()})
view.update(buffer=1, byteOffset=0)
g["asset"]["generator"] = sys.argv[1]
json.dump(g, open("in.gltf", "w"))' "$name"
	run --only=all --verify --buffers=embed in.gltf embedded.gltf
	exits 0
	is "$(value embedded.gltf '[r["asset"]["generator"]] + [b["uri"].split(",")[0] for b in r["buffers"]]')" \
		"['$name', 'data:application/octet-stream;base64', 'data:application/gltf-buffer;base64']"
	run --only=all --verify in.gltf linked.gltf
	run embedded.gltf a.glb
	run linked.gltf b.glb
	same a.glb b.glb
done
# a .bin that gets its name in two steps: the second run replaces the first one's
mkdir out
run --only=all --buffers=copy --verify in.gltf out/in.gltf
python3 -c 'data = bytearray(open("plates.bin", "rb").read()); data[144] ^= 1; open("plates.bin", "wb").write(data)'
run --only=all --buffers=copy --verify in.gltf out/in.gltf
exits 0
is "$(value out/in.gltf '[b["uri"].split(",")[0] for b in r["buffers"]]')" "['in.bin', 'data:application/gltf-buffer;base64']"

done_testing
