# SPDX-License-Identifier: MIT
# --verify on glTF made from glTF: a fault of the input is not ours. test_layouts.sh has every way to store one read back.
. "$ROOT/tests/support/cli.sh"
mkdir -p "$WORK/layouts"
python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/layouts" || exit 1

scene "indices that are some of another's: the last that gets new ones is alone with the bytes of all"
gltf "$WORK/layouts/plain.gltf" parts 'const [p] = g.meshes[0].primitives, whole = g.accessors[p.indices];
	for (const [begin, count] of [[30, 300], [90, 390]])
		g.meshes[0].primitives.push({...p,
			indices: g.accessors.push({...whole, byteOffset: 2 * begin, count}) - 1});
	whole.count = 600'
for options in --draco=keep --weld --draco=sequential; do
	run --existing=replace --verify $options parts.gltf out.glb
	exits 0
	says_not NOT_VERIFIED
done

scene "tangents of morph targets are read back too"
for options in --morph=bake --morph=keep --precision=byte --draco=sequential; do
	run --verify "$options" "$ROOT/data/morph.gltf" out.glb
	exits 0
done

# tinygltf wants inverseBindMatrices in skins, glTF does not.
scene "what tinygltf refuses is a finding, and the output is written"
gltf "$WORK/layouts/plain.gltf" plain 'g.skins = [{joints: [0]}]'
for options in --draco=keep --draco=edgebreaker --buffers=link; do
	run --verify $options plain.gltf out.glb
	exits 0
	says "warning: tinygltf refuses the output: "
	says "inverseBindMatrices"
	says "[NOT_VERIFIED]"
	exists out.glb
done
run --verify --fail-on=warning plain.gltf out.gltf
exits 6
run --verify "$WORK/layouts/plain.gltf" out.gltf
exits 0
says_not NOT_VERIFIED

scene "what nmtan itself cannot read again is a fault of its own, and does not appear"
for output in out.gltf out.glb; do
	for options in --verify --existing=keep\ --verify --draco=sequential\ --verify; do
		rm -f $output
		NT_CALLS_SPOIL=1 run_under_calls $options "$WORK/layouts/plain.gltf" $output
		exits 4
		says "the output cannot be read back: "
		[ ! -e $output ] || wrong "$options $output is there"
	done
done

scene "a buffer that nobody uses and that the run may not look for is none of nmtan's faults"
gltf "$WORK/layouts/plain.gltf" outside 'g.buffers.push({byteLength: 4})'
sed -i 's/{"byteLength": *4}/{"byteLength":4,"uri":"..\/nowhere.bin"}/' outside.gltf
run --verify outside.gltf out.gltf
exits 0
says "[NOT_VERIFIED]"

scene "a data URI that tinygltf cannot read is no name of a file"
mkdir -p data:application
printf 1234 >data:application/gltf-buffer,AAAA
echo '{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "data:application/gltf-buffer,AAAA"}]}' >data.gltf
run --verify data.gltf out.gltf
exits 0
says "[NOT_VERIFIED]"

scene "tangents that are kept without texture coordinates are none that a solve has to give"
run "$WORK/layouts/plain.gltf" solved.gltf
gltf solved.gltf bare 'for (const m of g.meshes) for (const p of m.primitives) {
	const rows_of_normals = rows(p.attributes.NORMAL); /* along the normals: all have to be mended */
	p.attributes = {POSITION: p.attributes.POSITION, NORMAL: p.attributes.NORMAL,
		TANGENT: add("VEC4", 5126, rows_of_normals.flatMap((n) => [...n, 1]))}; }'
for options in --existing=keep --existing=repair --draco=sequential --precision=short; do
	run --only=all --verify $options bare.gltf out.glb
	exits 0
	says_not NOT_VERIFIED
	is "$(gltf out.glb 'g.meshes.every((m) => m.primitives.every((p) => "TANGENT" in p.attributes))')" true
done

# glTF wants a byte at least, and a word what a buffer without a URI is. tinygltf looks for the first byte of none in a
# .glb, and refuses an empty .bin, or none.
scene "a buffer of no bytes is a fault of the input"
python3 - <<'END'
import struct
for name, buffers in ("empty", b'{"byteLength": 0}'), ("nowhere", b'{"byteLength": 4}, {"byteLength": 4}'), \
		("unnamed", b'{"byteLength": 4}, {"byteLength": 4, "extensions": {}}'):
    text = b'{"asset": {"version": "2.0"}, "buffers": [%s]}' % buffers
    text += b" " * (-len(text) % 4)
    with open(name + ".glb", "wb") as file:
        file.write(struct.pack("<4s4I", b"glTF", 2, 20 + len(text) + 12, len(text), 0x4e4f534a) + text +
                   struct.pack("<I4sI", 4, b"BIN\0", 0))
END
for input in empty nowhere unnamed; do
	run --verify $input.glb $input.gltf
	exits 0
	says "[NOT_VERIFIED]"
	exists $input.gltf
done
run --verify empty.glb out.glb
exits 0
says "[NOT_VERIFIED]"

scene "a buffer that stands for packed views needs no bytes"
gltf "$WORK/layouts/plain.gltf" views 'g.extensionsUsed = ["EXT_meshopt_compression"];
	g.buffers.push({byteLength: 4, extensions: {EXT_meshopt_compression: {fallback: true}}})'
run --verify views.gltf out.gltf
exits 0
says_not NOT_VERIFIED

# A block has all elements of its accessors, whatever these say besides. Bytes of "DRACO" and the version as an index: 68
# of 4, and 2.
scene "an accessor in a block is not sparse in the output"
run "$data/quad.obj" quad.gltf
run --only=all --existing=replace --draco=sequential quad.gltf block.gltf
exits 0
for index_offset in none 0 5; do
	gltf block.gltf sparse "const offset = '$index_offset';" 'const p = g.meshes[0].primitives[0];
		const view = p.extensions.KHR_draco_mesh_compression.bufferView;
		if (offset !== "none")
			g.accessors[p.attributes.POSITION].sparse = { count: 1, values: { bufferView: view },
				indices: { bufferView: view, componentType: 5121, byteOffset: +offset } }'
	for draco in keep off; do
		run --verify --only=all --existing=replace --draco=$draco sparse.gltf $draco.$index_offset.glb
		exits 0
		says_not NOT_VERIFIED
		cmp -s $draco.none.glb $draco.$index_offset.glb || wrong "--draco=$draco, $index_offset: it is"
	done
done

scene "positions beside a block are the input's, whose bounds are no fault of ours"
run -q "$data/mirrored_cube.obj" plain.gltf
run -q --draco=sequential --existing=replace plain.gltf packed.gltf
gltf packed.gltf beside 'const p = g.meshes[0].primitives[0];
	delete p.extensions.KHR_draco_mesh_compression.attributes.POSITION; g.accessors[p.attributes.POSITION].max = [9, 9, 9]'
for choice in keep off; do
	run -q --verify --existing=replace --only=all --draco=$choice beside.gltf o.gltf
	exits 0
done

scene "tangents that are kept have the bounds that the exporter rounded"
run -q "$data/quad.obj" kept.gltf
# (17, 6, 6) / 19 in six digits, which no float is
gltf kept.gltf rounded 'const p = g.meshes[0].primitives[0], a = g.accessors[p.attributes.TANGENT];
	a.min = a.max = [.894737, .315789, .315789, 1];
	delete p.attributes.TEXCOORD_0'
for words in --existing=replace --existing=repair --uv=1; do
	run -q --verify --only=all $words rounded.gltf o.gltf
	exits 0
done

scene "a fan of one triangle has as many corners as vertices, in another order"
run "$data/quad.obj" quad.gltf
gltf quad.gltf fan 'const p = g.meshes[0].primitives[0];
	p.mode = 6;
	delete p.attributes.TANGENT;
	g.accessors[p.indices].count = 3'
run --verify --only=all fan.gltf out.glb
exits 0
says_not NOT_VERIFIED

scene "an extension of a buffer view that nobody needs is no fault"
gltf "$data/morph.gltf" views 'for (const view of g.bufferViews) view.extensions = {VENDOR_view: {}}'
run --verify views.gltf out.glb
exits 0
says_not NOT_VERIFIED

done_testing
