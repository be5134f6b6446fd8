# SPDX-License-Identifier: MIT
# Plain glTF compressed by --draco, however it stores its vertices. The judges are the Khronos validator for the
# JSON and Draco for the blocks, when the output is read again.
# Leaks count.
. "$ROOT/tests/support/cli.sh"
mkdir -p "$WORK/layouts" "$WORK/outputs"
python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/layouts" || exit 1

compressed() {
	gltf "$1" 'g.meshes.flatMap((m) => m.primitives).filter((p) =>
		p.extensions?.KHR_draco_mesh_compression && p.indices !== undefined).length'
}

for input in "$WORK"/layouts/*.gl*; do
	name=${input##*/}
	scene "$name is compressed where its vertices are its own"
	case $name in
	# vertices of several primitives, strips, sparse accessors, tangents that are no floats
	tangents_s[hp]* | shared* | sparse* | strip* | twin* | two_ranges* | instanced*) expected=0 ;;
	tangents_one_view*) expected=2 ;;
	*) expected=1 ;;
	esac
	case $name in
	shared* | twin* | two_ranges* | instanced*) reason="it shares vertices with other primitives" ;;
	strip*) reason="it is a strip or a fan" ;;
	sparse* | *_sparse*) reason="an attribute is sparse or compressed" ;;
	*) reason="it has tangents that are no floats" ;;
	esac
	for method in sequential edgebreaker; do
		run --existing=replace --draco=$method --verify "$input" $method.glb
		exits 0
		is "$(compressed $method.glb)" $expected
		if [ $expected = 0 ]; then
			says "warning: the primitive is written without Draco compression: $reason [DRACO_PLAIN]"
			# its tangents are those of its own values
			run --existing=replace --draco=off "$input" off.glb
			same $method.glb off.glb
		else
			says_not DRACO_PLAIN
		fi
		# the same triangles and vertices that agree with what the file says of itself
		run --existing=replace --draco=off $method.glb plain.glb
		exits 0
		says "$(case $name in strip*) echo 28 ;; instanced_turned*) echo 864 ;; instanced*) echo 648 ;; *one_view* | *_unindexed*) echo 432 ;; *) echo 216 ;; esac) triangles"
		is "$(compressed plain.glb)" 0
		cp $method.glb "$WORK/outputs/$name.$method.glb"
		printf '%s\t%s\n' "$WORK/outputs/$name.$method.glb" "$input" >>"$WORK/pairs"
	done
done

scene "the validator finds no error in them that the input did not have"
valid --pairs "$WORK/pairs"

scene "morph targets keep the order of the vertices"
run --draco=edgebreaker "$WORK/layouts/plain.gltf" packed.glb
exits 0
is "$(compressed packed.glb)" 1
run "$WORK/layouts/plain.gltf" plain.glb
moves='g.meshes[0].primitives[0].targets.map((t) => rows(t.POSITION))'
is "$(gltf packed.glb "$moves")" "$(gltf plain.glb "$moves")"

scene "targets add to what a decoder has of the tangents"
for choice in sequential edgebreaker; do
	run --draco=$choice --verify "$WORK/layouts/plain.gltf" packed.glb
	exits 0
	# valid tangents stay as they are decoded; what leads from them to those of the targets is made again
	run --existing=repair --draco=off packed.glb plain.glb
	exits 0
	turns='g.meshes[0].primitives[0].targets.map((t) => rows(t.TANGENT))'
	is "$(gltf packed.glb "$turns")" "$(gltf plain.glb "$turns")"
done

scene "copies that made normals append, and those where tangents differ, are read back in blocks"
gltf "$WORK/layouts/plain.gltf" still 'delete g.meshes[0].primitives[0].targets; delete g.meshes[0].weights'
for draco in sequential edgebreaker; do
	for normals in replace-flat replace-angle:30; do
		run --only=all --existing=replace --normals=$normals --draco=$draco --verify still.gltf packed.glb
		exits 0
		says_not DRACO_SEQUENTIAL
		says "where tangents differ"
		says "where made normals differ"
	done
	# an id that two attributes of a block have is not that of the new one
	gltf packed.glb doubled 'const ids = g.meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.attributes;
		ids.NORMAL = ids.POSITION'
	run --only=all --existing=replace --normals=replace-flat --verify doubled.gltf again.glb
	exits 0
done

scene "normals of any length are directions in a block"
gltf "$WORK/layouts/plain.gltf" long 'const p = g.meshes[0].primitives[0]; delete p.targets; delete g.meshes[0].weights;
	bytes[0].writeFloatLE(1e30, at(p.attributes.NORMAL, 0) + 8)'
for draco in sequential edgebreaker; do
	run --only=all --existing=replace --draco=$draco --verify long.gltf packed.glb
	exits 0
done

scene "edgebreaker keeps a face between -0 and 0, which are not one position"
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'v 1 1 0' 'v -0 0 0' 'vn 0 0 1' 'vt 0 0' 'vt 1 0' 'vt 0 1' 'vt 1 1' 'vt .2 .1' \
	'f 1/1/1 2/2/1 3/3/1' 'f 3/3/1 2/2/1 4/4/1' 'f 1/1/1 5/5/1 4/4/1' >zeros.obj
run -q zeros.obj zeros.glb
run --only=all --existing=replace --draco=edgebreaker --verify zeros.glb packed.glb
exits 0
says "3 triangles"
says_not DRACO_SEQUENTIAL

scene "made normals and bitangents are floats in a block, whatever the accessors were that they replace"
gltf "$data/quantized.gltf" integers 'const a = g.meshes[0].primitives[0].attributes;
	a._BITANGENT = g.accessors.push({ ...g.accessors[a.NORMAL] }) - 1'
for draco in sequential edgebreaker; do
	for input in "$data/quantized.gltf" integers.gltf; do
		run --only=all --existing=replace --normals=replace-smooth --bitangents --draco=$draco --verify "$input" packed.glb
		exits 0
		run --existing=replace --draco=off packed.glb plain.glb
		exits 0
		is "$(gltf plain.glb '["NORMAL", "_BITANGENT"].map((name) =>
			g.accessors[g.meshes[0].primitives[0].attributes[name]].componentType).join()')" 5126,5126
	done
done

scene "a compressed primitive that becomes plain without being told so is a finding"
run --draco=sequential "$WORK/layouts/plain.gltf" packed.glb
exits 0
run --existing=replace packed.glb kept.glb
exits 0
says_not DRACO
run --existing=replace --draco=off packed.glb off.glb
exits 0
says_not DRACO
# a second primitive over the same positions, with tangents of its own
gltf packed.glb two 'const p = structuredClone(g.meshes[0].primitives[0]);
	delete p.targets;
	g.meshes[0].primitives.push(p)'
run --existing=replace --fail-on=warning two.gltf two.glb
exits 6
says "mesh \"sheet\", primitive 1"
says "it shares vertices with other primitives [DRACO_PLAIN]"
is "$(compressed two.glb)" 0

scene "primitives with different blocks that name the same accessors keep their own vertices"
gltf "$WORK/layouts/plain.gltf" one 'delete g.meshes[0].primitives[0].targets'
gltf one.gltf other 'const n = g.meshes[0].primitives[0].attributes.TEXCOORD_0, a = g.accessors[n]; /* its mirror image */
	const b = bytes[g.bufferViews[a.bufferView].buffer];
	for (let i = 0; i < a.count; i++)
		b.writeFloatLE(1 - b.readFloatLE(at(n, i)), at(n, i))'
run --draco=sequential one.gltf one.glb
exits 0
run --draco=sequential other.gltf other.glb
exits 0
gltf one.glb three 'const other = open("other.glb"), [p] = g.meshes[0].primitives, [q] = other.g.meshes[0].primitives;
	const block = q.extensions.KHR_draco_mesh_compression, view = other.g.bufferViews[block.bufferView];
	q.attributes = p.attributes;
	q.indices = p.indices;
	block.bufferView = g.bufferViews.push({...view, buffer: 1}) - 1;
	bytes[g.buffers.push({}) - 1] = other.bytes[0];
	g.meshes[0].primitives.push(q, structuredClone(q)); /* the third shares with the second all there is */'
gltf three.gltf unlisted 'delete g.extensionsUsed, delete g.extensionsRequired; /* blocks are read without */'
row='[rows(p.attributes.POSITION), rows(p.attributes.TEXCOORD_0), rows(p.attributes.TANGENT), rows(p.indices)]'
run --existing=replace --draco=off --verify one.glb one_plain.glb
run --existing=replace --draco=off --verify other.glb other_plain.glb
for three in "off three" "keep three" "off unlisted" "keep unlisted"; do
	choice=${three% *}
	run --existing=replace --draco=$choice --verify "${three#* }.gltf" three.glb
	exits 0
	[ $choice = off ] || { run --draco=off --existing=replace three.glb three.glb.glb; mv three.glb.glb three.glb; }
	is "$(gltf three.glb "g.meshes[0].primitives.slice(0, 1).map((p) => $row)")" \
		"$(gltf one_plain.glb "g.meshes[0].primitives.map((p) => $row)")"
	for k in 1 2; do
		is "$(gltf three.glb "g.meshes[0].primitives.slice($k, $k + 1).map((p) => $row)")" \
			"$(gltf other_plain.glb "g.meshes[0].primitives.map((p) => $row)")"
	done
	is "$(gltf three.glb 'new Set(g.meshes[0].primitives.map((p) => p.attributes.TEXCOORD_0)).size')" 2
done
# what a block has and its primitive has not is nobody's
gltf one.glb more 'const block = g.meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.attributes;
	block._MORE = block.NORMAL' || wrong
for choice in keep off; do
	run --existing=replace --draco=$choice more.gltf more.glb
	exits 0
	[ $choice = off ] || { run --draco=off --existing=replace more.glb plain.glb; mv plain.glb more.glb; }
	is "$(gltf more.glb "g.meshes[0].primitives.map((p) => $row)")" "$(gltf one_plain.glb "g.meshes[0].primitives.map((p) => $row)")"
done

scene "an id that its block has not is told, whoever else has the same block and accessors"
gltf "$WORK/layouts/plain.gltf" one 'delete g.meshes[0].primitives[0].targets'
run -q --draco=sequential one.gltf one.glb
gltf one.glb ids 'const [p] = g.meshes[0].primitives, plain = open("one.gltf");
	p.attributes.TEXCOORD_0 = add("VEC2", 5126, plain.rows(plain.g.meshes[0].primitives[0].attributes.TEXCOORD_0).flat());
	const other = structuredClone(p);
	other.extensions.KHR_draco_mesh_compression.attributes.TEXCOORD_0 = 99;
	g.meshes[0].primitives.push(other)'
run --existing=replace ids.gltf out.glb
exits 3
says "primitive 1, material \"bumpy\": TEXCOORD_0 has the id 99, which the compressed data does not"

scene "a .drc has integers of any width as positions, and as texture coordinates that are fractions of the most"
python3 - <<'END'
import struct
def block(name, attributes):
    # version 2.2, one triangle, not compressed, and attributes of one decoder, each as it is
    data = b"DRACO" + bytes([2, 2, 1, 0, 0, 0, 1, 3, 1, 0, 1, 2, 1, len(attributes)])
    for number, (kind, of, normalized, rows) in enumerate(attributes):
        data += bytes([kind, of, len(rows[0]), normalized, number])
    data += bytes(len(attributes))
    for kind, of, normalized, rows in attributes:
        data += b"".join(struct.pack("<%d%s" % (len(row), " bBhHiI"[of]), *row) for row in rows)
    with open(name, "wb") as file:
        file.write(data)
for of in range(1, 7):
    most = 2 ** (8 * (1, 1, 2, 2, 4, 4)[of - 1] - of % 2) - 1
    least = -3 if of % 2 else 5
    block("%d.drc" % of, [(0, of, 0, [(0, 0, 0), (least, 100, 0), (0, 7, 1)]), (3, of, 1, [(0, 0), (most, 0), (0, most)])])
END
for of in 1 2 3 4 5 6; do
	run -q --normals=smooth $of.drc out.gltf
	exits 0
	is "$(gltf out.gltf 'rows(g.meshes[0].primitives[0].attributes.POSITION)')" \
		"[[0,0,0],[$((of % 2 ? -3 : 5)),100,0],[0,7,1]]"
	is "$(gltf out.gltf 'rows(g.meshes[0].primitives[0].attributes.TEXCOORD_0)')" "[[0,1],[1,1],[0,0]]"
done

scene "a compressed primitive that gets no tangents is judged by the triangles of its block"
run -q --raw "$data/quad.obj" plain.glb
run -q --only=all --existing=replace --draco=sequential plain.glb packed.glb
gltf packed.glb bare 'const p = g.meshes[0].primitives[0];
	for (const of of [p, p.extensions.KHR_draco_mesh_compression]) {
		delete of.attributes.TEXCOORD_0;
		delete of.attributes.TANGENT;
	}'
run --only=all --report=report.json bare.gltf out.glb
exits 0
exists report.json
grep -q POS_DEGENERATE report.json && wrong "its triangles have no area"

# Encoders leave the bounds of what they were given, and decoders give something else.
scene "bounds are those of what a decoder will see"
run -q "$data/head.obj" head.glb
run -q --only=all --existing=replace --draco=edgebreaker --draco-bits=7,7,7,12 head.glb packed.glb
gltf packed.glb stale 'const p = g.meshes[0].primitives[0].attributes, of = (name) => g.accessors[p[name]];
	Object.assign(of("NORMAL"), {min: [-1, -1, -1], max: [1, 1, 1]});
	Object.assign(of("TANGENT"), {min: [-2, -2, -2, -2], max: [2, 2, 2, 2]});
	for (const bound of [of("POSITION").min, of("POSITION").max]) bound[1] = Math.fround(1.001 * bound[1] + 0.001)'
bounds='Object.values(g.meshes[0].primitives[0].attributes).map((i) => g.accessors[i]).map((a) => [a.min, a.max])'
for choice in off keep sequential; do
	run --only=all --existing=replace --draco=$choice --verify stale.gltf $choice.glb
	exits 0
done
is "$(gltf keep.glb "$bounds.slice(0, 1)")" "$(gltf off.glb "$bounds.slice(0, 1)")"
is "$(gltf keep.glb "$bounds.flat().filter((b) => b?.length > 2 && b.every((x) => Math.abs(x) === 2)).length")" 0
valid off.glb
run --only=all --existing=replace --draco=off --precision=byte --verify stale.gltf bytes.glb
exits 0
valid bytes.glb

scene "--precision does not reach into a block, and what asks for it is refused"
run --draco=edgebreaker --draco-bits=14,12,12,16 "$WORK/layouts/plain.gltf" packed.glb
exits 0
for precision in float short byte; do
	run --draco=edgebreaker --precision=$precision "$WORK/layouts/plain.gltf" again.glb
	exits 1
	says "/meshes/0/primitives/0: --precision does not reach tangents that Draco compresses: --draco-bits says how many"
	run --precision=$precision --existing=replace packed.glb again.glb
	exits 1
	[ ! -e again.glb ] || wrong "there is an output"
done
run --precision=short --existing=replace --draco=off packed.glb again.glb
exits 0
is "$(gltf again.glb 'g.accessors[g.meshes[0].primitives[0].attributes.TANGENT].componentType')" 5122
run --precision=short packed.glb kept.glb
exits 0
same packed.glb kept.glb

scene "primitives that stay keep their blocks byte for byte"
# changed.py IN OUT STATEMENTS: the document g of a .glb and its chunk b after them
cat >changed.py <<'END'
import json, struct, sys
data = open(sys.argv[1], "rb").read()
size = struct.unpack_from("<I", data, 12)[0]
g, b = json.loads(data[20:20 + size]), data[28 + size:]
def block(p):
    v = g["bufferViews"][p["extensions"]["KHR_draco_mesh_compression"]["bufferView"]]
    return b[v.get("byteOffset", 0):v.get("byteOffset", 0) + v["byteLength"]]
exec(sys.argv[3])
END
size() { stat -c %s "$1"; }
printf '%s\n' "v 0 0 0" "v 1 0 0" "v 0 1 0" "v 1 1 1" "vt 0 0" "vt 1 0" "vt 0 1" "vt 1 1" "o a" "f 1/1 2/2 3/3" "f 2/2 4/4 3/3" \
	"o b" "f 2/1 1/2 3/3" "f 3/3 1/2 4/4" >two.obj
run two.obj two.glb
for method in edgebreaker sequential; do
	run --existing=replace --only=all --draco=$method two.glb both.glb
	exits 0
	# the second has a material that needs tangents, the first has none
	python3 changed.py both.glb x 'g["materials"] = [{"normalTexture": {"index": 0}}]; g["textures"] = [{"source": 0}]
g["images"] = [{"uri": "n.png"}]
for m, p in enumerate(m["primitives"][0] for m in g["meshes"]):
    p.pop("material", None)
    if m: p["material"] = 0
text = json.dumps(g).encode(); text += b" " * (-len(text) % 4)
open("mixed.glb", "wb").write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(b)) + struct.pack("<II", len(text), 0x4E4F534A) + text
    + struct.pack("<II", len(b), 0x004E4942) + b)'
	run --existing=replace --draco-bits=14,12,12,20 --verify mixed.glb out.glb
	exits 0
	for file in mixed out; do
		python3 changed.py $file.glb x 'open(sys.argv[1] + ".first", "wb").write(block(g["meshes"][0]["primitives"][0]))
open(sys.argv[1] + ".second", "wb").write(block(g["meshes"][1]["primitives"][0]))'
	done
	same mixed.glb.first out.glb.first
	# a second run leaves nothing of the first one's blocks, and changes nothing unless it takes another order
	run --existing=replace --only=all --draco=$method both.glb again.glb
	[ $method = edgebreaker ] || same both.glb again.glb
	[ "$(size again.glb)" -lt $(($(size both.glb) + 100)) ] || wrong "it is larger"
	run --existing=replace --only=all --draco=off both.glb off.glb
	is "$(gltf off.glb 'g.buffers[0].byteLength')" $((10 * (12 + 12 + 8 + 16) + 2 * 12)) # views that are left share them
	# repair that repairs nothing, and a second run with what is there, change nothing
	for words in --existing=keep --existing=repair; do
		run $words out.glb again.glb
		same out.glb again.glb
	done
done

scene "blocks are decoded on several threads: the bytes, and what is wrong and where, do not depend on how many"
for method in sequential edgebreaker; do
	run -q --only=all --existing=replace --draco=$method "$data/plates.glb" three.glb
	exits 0
	# nine primitives, each with a block of its own; in another file those of two are damaged
	gltf three.glb nine 'const three = g.meshes[0].primitives, block = (p) => p.extensions.KHR_draco_mesh_compression;
		const copy = (list, i) => list.push(structuredClone(list[i])) - 1, size = bytes[0].length;
		for (let k = 1; k < 3; k++)
			for (const p of structuredClone(three.slice(0, 3))) {
				for (const name in p.attributes)
					p.attributes[name] = copy(g.accessors, p.attributes[name]);
				p.indices = copy(g.accessors, p.indices);
				block(p).bufferView = copy(g.bufferViews, block(p).bufferView);
				const view = g.bufferViews[block(p).bufferView];
				view.byteOffset = (view.byteOffset ?? 0) + k * size;
				three.push(p);
			}
		bytes[0] = Buffer.concat([bytes[0], bytes[0], bytes[0]])'
	views=$(gltf nine.gltf '[7, 4].map((i) => g.meshes[0].primitives[i].extensions.KHR_draco_mesh_compression.bufferView)')
	gltf nine.gltf damaged "for (const view of $views)" 'bytes[0].fill(0, g.bufferViews[view].byteOffset, g.bufferViews[view].byteOffset + 5)'
	is "$(compressed nine.gltf)" 9
	for choice in keep off; do
		for threads in 1 2 8; do
			run -q --only=all --threads=$threads --existing=replace --draco=$choice nine.gltf $threads.glb
			exits 0
			same 1.glb $threads.glb
		done
	done
	for threads in 1 2 8; do
		run -q --only=all --threads=$threads --existing=replace damaged.gltf out.glb
		exits 3
		says "/bufferViews/$(tr -d '[]' <<<"${views#*,}"): mesh \"plates\", primitive 4, material \"plain\": not Draco data"
	done
done

scene "an extension that is listed and not used stays listed, with any number of threads"
sed '1,/{/s/{/{"extensionsUsed": ["KHR_draco_mesh_compression"],/' "$data/morph.gltf" >morph.gltf
for threads in 1 2 8; do
	run -q --threads=$threads morph.gltf $threads.glb
	exits 0
	same 1.glb $threads.glb
done


scene "blocks are encoded on several threads: each is that of the primitive alone, whoever stands beside it"
# grids of unlike sizes; the third shares its vertices with a copy that has other triangles, which both are plain then
for n in 3 40 2 12; do
	grid_obj $n >grid.obj
	run -q --images=none grid.obj grid_$n.glb
done
gltf new grids 'g.meshes = [3, 40, 2, 12].map((n) => {
		const grid = open(`grid_${n}.glb`), views = g.bufferViews.length, rows = g.accessors.length, size = bytes[0].length;
		g.bufferViews.push(...grid.g.bufferViews.map((v) => ({...v, byteOffset: (v.byteOffset ?? 0) + size})));
		g.accessors.push(...grid.g.accessors.map((a) => ({...a, bufferView: a.bufferView + views})));
		const [p] = grid.g.meshes[0].primitives;
		for (const name in p.attributes)
			p.attributes[name] += rows;
		p.indices += rows;
		delete p.material;
		const indices = g.accessors.push({...g.accessors[p.indices], count: 6}) - 1;
		bytes[0] = Buffer.concat([bytes[0], grid.bytes[0]]);
		return {primitives: n === 2 ? [p, {...p, indices}] : [p]};
	})'
# The bytes of each block, or "plain".
blocks() {
	gltf "$1" 'g.meshes.flatMap((m) => m.primitives).map((p) => {
		const v = g.bufferViews[p.extensions?.KHR_draco_mesh_compression?.bufferView], at = v?.byteOffset ?? 0;
		return v ? bytes[0].toString("hex", at, at + v.byteLength) : "plain";
	}).join("\n")'
}
for method in sequential edgebreaker; do
	for n in 3 40 12; do
		run -q --only=all --existing=replace --draco=$method grid_$n.glb alone_$n.glb
	done
	for threads in 1 2 8; do
		run -q --threads=$threads --only=all --existing=replace --draco=$method --verify grids.gltf $threads.glb
		exits 0
		same 1.glb $threads.glb
	done
	is "$(blocks 8.glb)" "$(blocks alone_3.glb; blocks alone_40.glb; echo plain; echo plain; blocks alone_12.glb)"
done

scene "where nothing is to be repaired blocks stay as they are"
run --draco=edgebreaker --only=all --existing=replace "$data/plates.glb" packed.glb
exits 0
for draco in keep off edgebreaker; do
	run --only=all --existing=repair --draco=$draco --verify packed.glb $draco.glb
	exits 0
	says "3 primitives"
done
same packed.glb keep.glb
is "$(compressed off.glb)" 0
cmp -s packed.glb edgebreaker.glb && wrong "what was asked for was not done"
# the third has no tangents any more and gets some; the others keep their blocks
gltf packed.glb two 'const p = g.meshes[0].primitives[2];
	delete p.attributes.TANGENT;
	delete p.extensions.KHR_draco_mesh_compression.attributes.TANGENT'
run --only=all --existing=repair --verify two.gltf three.glb
exits 0
says "3 primitives"
is "$(compressed three.glb)" 3
is "$(blocks three.glb | head -2)" "$(blocks packed.glb | head -2)"
[ "$(blocks three.glb | tail -1)" != "$(blocks packed.glb | tail -1)" ] || wrong "the third has its old block"

scene "indices that are an attribute elsewhere stay"
grid_obj 3 >grid.obj
run -q --images=none grid.obj grid_3.glb
gltf grid_3.glb corners 'const [p] = g.meshes[0].primitives, corners = rows(p.indices).flat();
	const other = {attributes: {_CORNER: p.indices}}; /* the same triangles, one vertex for each corner */
	for (const name in p.attributes) {
		const all = rows(p.attributes[name]), {type, min, max} = g.accessors[p.attributes[name]];
		other.attributes[name] = add(type, 5126, corners.flatMap((v) => all[v]), {min, max});
	}
	delete p.material;
	g.meshes.push({primitives: [other]})'
run --only=all --existing=replace --draco=sequential corners.gltf out.glb
exits 0
says "mesh 0, primitive 0: warning: the primitive is written without Draco compression: its indices are shared"
is "$(gltf out.glb 'rows(g.meshes[1].primitives[0].attributes._CORNER)')" \
	"$(gltf corners.gltf 'rows(g.meshes[1].primitives[0].attributes._CORNER)')"

scene "indices of a block that claim to be sparse, too, are the block's where they are written plain"
run -q --only=all --draco=edgebreaker "$data/plates.gltf" block.gltf
gltf block.gltf sparse 'g.accessors[g.meshes[0].primitives[0].indices].sparse =
		{count: 1, indices: {bufferView: 0, componentType: 5121}, values: {bufferView: 0}};
	g.bufferViews[0].byteLength = 8'
run -q --only=all --existing=replace --draco=off block.gltf plain.glb
run --only=all --existing=replace --draco=off --verify sparse.gltf out.glb
exits 0
is "$(gltf out.glb 'rows(g.meshes[0].primitives[0].indices)')" "$(gltf plain.glb 'rows(g.meshes[0].primitives[0].indices)')"
is "$(gltf out.glb 'g.accessors[g.meshes[0].primitives[0].indices].sparse')" undefined

# A patch of small triangles in a corner of a large one: steps of 0.001 in space and 0.0003 in the texture. 14 and 12
# bits have cells of 0.0006 and 0.00024 there.
grains_obj() {
	awk 'function jitter() { seed = (seed * 421 + 1663) % 7875; return seed / 7875 - 0.5 } BEGIN {
		for (j = 0; j <= 20; j++) for (i = 0; i <= 20; i++) {
			printf "v %.6f %.6f %.6f\n", 0.001 * (i + 0.6 * jitter()), 0.001 * (j + 0.6 * jitter()), 0.0005 * jitter()
			printf "vt %.6f %.6f\n", 0.0003 * (i + 0.6 * jitter()), 0.0003 * (j + 0.6 * jitter())
		}
		print "v 1 1 0\nv 10 1 0\nv 1 10 0\nvt 0.1 0.1\nvt 1 0.1\nvt 0.1 1\nf 442/442 443/443 444/444"
		for (j = 0; j < 20; j++) for (i = 1; i <= 20; i++) {
			a = 21 * j + i; b = a + 21
			printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, b + 1, b + 1, a, a, b + 1, b + 1, b, b
		}
	}'
}
# Findings of --check about the tangents of a file.
faults() {
	run --check "$@"
	grep -o 'TAN_[A-Z_]*' "$WORK/out.txt" | grep -v TAN_UNUSED
}

scene "tangents are those of what a decoder has: triangles that quantization turns over, normals that it tilts"
grains_obj >grains.obj
run -q --normals=smooth grains.obj grains.glb
exits 0
is "$(faults grains.glb)" ""
for method in sequential edgebreaker; do
	for bits in 14,12,12,12 16,5,14,16; do
		run --only=all --existing=replace --draco=$method --draco-bits=$bits --verify grains.glb $method.glb
		exits 0
		is "$(faults $method.glb)" ""
	done
done
# nothing is left to repair, and what is in the block stays where it is
run --only=all --existing=replace --draco=sequential grains.glb once.glb
run --only=all --existing=repair once.glb twice.glb
same once.glb twice.glb
# of tangents that were valid, those of triangles that turn over are not any more; directions are not judged here
run --only=all --existing=repair --draco=sequential grains.glb mended.glb
exits 0
is "$(faults mended.glb | grep -v DIRECTION)" ""

scene "tangents lie across normals that are made and quantized, in a new block and in one that has none"
grains_obj >grains.obj
run -q --normals=smooth grains.obj grains.glb
run -q --only=all --existing=replace --draco=sequential --draco-bits=16,12,14,16 grains.glb packed.glb
for name in grains packed; do
	gltf $name.glb $name 'const [p] = g.meshes[0].primitives;
		for (const gone of ["NORMAL", "TANGENT"]) {
			delete p.attributes[gone];
			delete p.extensions?.KHR_draco_mesh_compression.attributes[gone];
		}'
	choice=$([ $name = packed ] && echo keep || echo sequential)
	run --only=all --normals=smooth --draco=$choice --draco-bits=16,5,14,16 --verify $name.gltf $name.made.glb
	exits 0
	is "$(compressed $name.made.glb)" 1
	is "$(gltf $name.made.glb '"NORMAL" in g.meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.attributes')" true
	is "$(faults $name.made.glb)" ""
done

scene "--across=mesh: borders of primitives meet in what a decoder has, and their tangents are those of one surface"
# the large triangle and half of the patch, and the other half
grains_obj | awk '/^f 442/ {print "usemtl a"} /^f 211\// && !cut++ {print "usemtl b"} {print}' >two.obj
run -q --normals=smooth --across=mesh two.obj two.glb
meet='[["POSITION"], ["POSITION", "NORMAL", "TEXCOORD_0", "TANGENT"]].map((names) => {
	const [a, b] = g.meshes[0].primitives.map((p) => {
		const all = names.map((name) => rows(p.attributes[name]));
		return new Set(all[0].map((_, v) => all.map((attribute) => attribute[v].join()).join()));
	});
	return [...a].filter((key) => b.has(key)).length;
}).join()'
is "$(gltf two.glb "$meet")" 21,21
for method in sequential edgebreaker; do
	run --across=mesh --only=all --existing=replace --draco=$method --verify two.glb $method.glb
	exits 0
	is "$(compressed $method.glb)" 2
	is "$(faults $method.glb)" ""
	run --across=mesh --only=all --existing=replace --draco=off $method.glb plain_$method.glb
	is "$(gltf plain_$method.glb "$meet")" 21,21
done
# a third primitive has the vertices of the second, which both are plain then: no border moves
gltf two.glb three 'const all = g.meshes[0].primitives, p = structuredClone(all[1]);
	p.indices = g.accessors.push({...g.accessors[p.indices], count: 6}) - 1;
	all.push(p)'
for choice in off sequential; do
	run --across=mesh --only=all --existing=replace --draco=$choice three.gltf $choice.glb
	exits 0
done
is "$(compressed sequential.glb)" 1
second='rows(g.meshes[0].primitives[1].attributes.TANGENT)'
is "$(gltf sequential.glb "$second")" "$(gltf off.glb "$second")"

scene "what cannot be compressed for its unused vertices is solved for its own values"
# without the last triangle one vertex is unused, and morph targets count it
gltf "$WORK/layouts/plain.gltf" unused 'g.accessors[g.meshes[0].primitives[0].indices].count -= 6'
run --existing=replace --draco=off unused.gltf off.glb
run --existing=replace --draco=edgebreaker --draco-bits=6,4,6,12 unused.gltf out.glb
exits 0
says "no face uses some of its vertices, whose order matters [DRACO_PLAIN]"
same out.glb off.glb

# Writes NAME.gltf: the primitive of a .glb without TANGENT and with other texture coordinates, which are not compressed
# and on no grid: those of FROM.glb moved by up to 0.00005, as the attribute SET. The value that the first one gets may
# be given, too.
with_texcoords() {
	gltf "$1" "$2" "const set = '$4', first = '${5-}', other = open('$3');" '
		const [p] = g.meshes[0].primitives, old = other.rows(other.g.meshes[0].primitives[0].attributes.TEXCOORD_0).flat();
		let seed = 1;
		const texcoords = old.slice(0, 2 * g.accessors[p.attributes.POSITION].count).map((x) => {
			seed = (seed * 421 + 1663) % 7875;
			return x + 0.0001 * (seed / 7875 - 0.5);
		});
		if (first)
			texcoords[0] = Number(first);
		for (const gone of ["TANGENT", set]) {
			delete p.attributes[gone];
			delete p.extensions?.KHR_draco_mesh_compression.attributes[gone];
		}
		p.attributes[set] = add("VEC2", 5126, texcoords)'
}

scene "what is beside a block is not quantized, nor is it for the solve"
grains_obj >grains.obj
run -q --normals=smooth grains.obj grains.glb
run -q --only=all --existing=replace --draco=sequential grains.glb packed.glb
run -q --only=all --existing=replace --draco=off packed.glb plain.glb
with_texcoords packed.glb beside plain.glb TEXCOORD_0
run --only=all --draco=keep beside.gltf keep.glb
exits 0
is "$(gltf keep.glb 'Object.keys(g.meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.attributes).sort()')" '["NORMAL","POSITION","TANGENT"]'
is "$(faults keep.glb)" ""
run --only=all --draco=sequential beside.gltf out.glb
exits 0
same keep.glb out.glb

scene "a primitive that is refused for an attribute which no tangents need is solved for its own values"
grains_obj >grains.obj
run -q --normals=smooth grains.obj grains.glb
with_texcoords grains.glb nan grains.glb TEXCOORD_1 NaN
run --only=all --draco=off nan.gltf off.glb
exits 0
for method in sequential edgebreaker; do
	run --only=all --draco=$method nan.gltf out.glb
	exits 0
	says "Draco does not give it back [DRACO_PLAIN]"
	same out.glb off.glb
done

scene "--across=mesh: where Draco refuses a primitive, all are solved for the values of the input, and borders of the others meet"
# the large triangle and half of the patch, and two quarters; the first has the NaN
grains_obj | awk '/^f 442/ {print "usemtl a"} /^f 211\// && !b++ {print "usemtl b"} /^f 316\// && !c++ {print "usemtl c"} {print}' >three.obj
run -q --normals=smooth --across=mesh three.obj three.glb
with_texcoords three.glb nan three.glb TEXCOORD_1 NaN
run --across=mesh --only=all --existing=replace --draco=off nan.gltf off.glb
exits 0
first='rows(g.meshes[0].primitives[0].attributes.TANGENT)'
for method in sequential edgebreaker; do
	run --across=mesh --only=all --existing=replace --draco=$method --verify nan.gltf $method.glb
	exits 0
	is "$(compressed $method.glb)" 2
	is "$(gltf $method.glb "$first")" "$(gltf off.glb "$first")"
	run --only=all --existing=replace --draco=off $method.glb plain.glb
	is "$(gltf plain.glb "${meet/primitives.map/primitives.slice(1).map}" | cut -d, -f1)" 21
done

scene "--across=mesh: integers are on no grid, and need none"
# 1/1024 of the patch, which the large triangle is left out of
grains_obj | awk '/^v / {$2 *= 1024; $3 *= 1024; $4 *= 1024} /^f 442/ {print "usemtl a"; next}
	/^f 211\// && !cut++ {print "usemtl b"} {print}' >two.obj
run -q --normals=smooth two.obj two.glb
gltf two.glb two 'g.extensionsUsed = g.extensionsRequired = ["KHR_mesh_quantization"];
	for (const p of g.meshes[0].primitives) {
		const a = g.accessors[p.attributes.POSITION], round = (x) => Math.round(1024 * x);
		const data = Buffer.alloc(8 * a.count);
		rows(p.attributes.POSITION).forEach((row, i) => row.forEach((x, k) => data.writeInt16LE(round(x), 8 * i + 2 * k)));
		a.bufferView = g.bufferViews.push({buffer: 0, byteOffset: bytes[0].length, byteLength: data.length, byteStride: 8}) - 1;
		delete a.byteOffset;
		a.componentType = 5122;
		for (const bound of ["min", "max"])
			a[bound] = a[bound].map(round);
		bytes[0] = Buffer.concat([bytes[0], data]);
	}'
for method in sequential edgebreaker; do
	run --across=mesh --only=all --existing=replace --draco=$method --draco-bits=14,12,4,12 --verify two.gltf $method.glb
	exits 0
	is "$(compressed $method.glb)" 2
	is "$(faults $method.glb --across=mesh)" ""
done

scene "only a glTF made from a glTF is compressed"
run --draco=edgebreaker "$data/quad.obj" quad.glb
exits 1
says "--draco=edgebreaker compresses glTF that is made from glTF: convert to .glb without it, and then that with --existing=replace --only=all and it"
run --draco=sequential "$data/plates.glb" plates.ply
exits 1
says "--draco=sequential compresses glTF, not PLY"
only
run "$data/quad.obj" quad.glb
run --draco=edgebreaker quad.glb out.glb
exits 0
says "nothing compressed, as no primitive got tangents: --existing=replace --only=all"
is "$(compressed out.glb)" 0
run --draco=edgebreaker --existing=replace --only=all quad.glb out.glb
exits 0
says_not "nothing compressed"
is "$(compressed out.glb)" 1
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvt 1 0\nvt 0 1\nf 1/1 2/3 3/2\nf 4/1 5/2 6/4\n' >soup.obj
run soup.obj soup.glb
run --draco=edgebreaker --existing=replace --only=all soup.glb out.glb
says "1 primitive, 2 triangles, 6 vertices, Draco makes 4 vertices of 6,"
is "$(gltf out.glb 'g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count')" 4
run --draco=sequential --existing=replace --only=all soup.glb out.glb
says_not "Draco makes"
run --existing=replace quad.glb out.glb
says "0 of 1 primitives, skipped 1 primitive (no material of it uses tangents), --only=all makes new tangents for all"
run --existing=replace --only=all quad.glb out.glb
says "1 primitive, 2 triangles"

scene "a block that is edgebreaker's stays so: faces that its grid has made flat go, or a finding says why not"
# one triangle is 1e-7 high: the first encoder keeps it, its grid brings two corners together, and a second one would drop it
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'v 1 1 0' 'v 1 1.0000001 0' 'v 0 2 0' 'vt 0 0' 'vt 1 0' 'vt 0 1' 'vt 1 1' 'vt 0 2' \
	'vn 0 0 1' 'f 1/1/1 2/2/1 3/3/1' 'f 2/2/1 4/4/1 3/3/1' 'f 4/4/1 5/4/1 3/3/1' 'f 3/3/1 5/4/1 6/5/1' >flat.obj
run flat.obj flat.glb
run --only=all --existing=replace --draco=edgebreaker --verify -v flat.glb one.glb
exits 0
says_not DRACO_SEQUENTIAL
indices='g.accessors[g.meshes[0].primitives[0].indices].count'
is "$(gltf one.glb "$indices")" 12
# behind "DRACO" and the version a block says its method: 0 sequential, 1 edgebreaker
method() { python3 -c 'import sys; d = open(sys.argv[1], "rb").read(); print(d[d.index(b"DRACO") + 8])' "$1"; }
run --only=all --existing=replace --verify -v one.glb two.glb
exits 0
says_not DRACO_
says "4 triangles, 6 vertices, Draco makes 5 vertices of 6, Draco leaves out 1 triangle without area in its grid,"
is "$(gltf two.glb "$indices") $(method two.glb)" "9 1"
run --only=all --existing=replace --verify -v two.glb three.glb
is "$(gltf three.glb "$indices") $(method three.glb)" "9 1"
# joints may move the corners of such a face apart
python3 - one.glb joints.glb <<'END'
import json, struct, sys
d = open(sys.argv[1], 'rb').read()
size, = struct.unpack_from('<I', d, 12)
g, rest = json.loads(d[20:20 + size]), d[20 + size:]
count = g['accessors'][g['meshes'][0]['primitives'][0]['attributes']['POSITION']]['count']
data = rest[8:8 + struct.unpack_from('<I', rest)[0]]
g['bufferViews'].append({'buffer': 0, 'byteOffset': len(data), 'byteLength': 4 * count})
data += bytes(4 * count)
g['buffers'][0]['byteLength'] = len(data)
g['accessors'].append({'bufferView': len(g['bufferViews']) - 1, 'componentType': 5121, 'type': 'VEC4', 'count': count})
g['meshes'][0]['primitives'][0]['attributes']['JOINTS_0'] = len(g['accessors']) - 1
text = json.dumps(g).encode()
text += b' ' * (-len(text) % 4)
open(sys.argv[2], 'wb').write(struct.pack('<4sIIII', b'glTF', 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
                              struct.pack('<II', len(data), 0x004E4942) + data)
END
run --only=all --existing=replace --verify -v joints.glb four.glb
exits 0
says "attributes that are not in the block need its order [DRACO_SEQUENTIAL]"
is "$(gltf four.glb "$indices") $(method four.glb)" "12 0"
# who asks for edgebreaker, of a file with a face that is flat, keeps the face
sed 's/1.0000001/1/' flat.obj >area.obj
run area.obj area.glb
run --only=all --existing=replace --draco=edgebreaker --verify -v area.glb five.glb
exits 0
says "edgebreaker would drop 1 of its faces, which have no area in the block's grid [DRACO_SEQUENTIAL]"
is "$(gltf five.glb "$indices") $(method five.glb)" "12 0"

done_testing
