# SPDX-License-Identifier: MIT
# Tangents as integers, in new documents and in place of others; test_layouts.sh has them in every layout of a glTF.
. "$ROOT/tests/support/cli.sh"
mkdir -p "$WORK/layouts"
python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/layouts" || exit 1

scene "new documents have them too"
for precision in short byte; do
	for output in $precision.gltf $precision.glb; do
		run --precision=$precision --verify -v "$ROOT/data/head.obj" $output
		exits 0
		says "rounded tangents by"
		says "TAN_QUANTIZED"
		is '[[["KHR_mesh_quantization"],["KHR_mesh_quantization"]],true]' "$(gltf $output \
			'[[g.extensionsUsed, g.extensionsRequired], g.accessors[g.meshes[0].primitives[0].attributes.TANGENT].normalized]')"
		valid $output
	done
done

scene "tangents of the same kind are replaced in place"
run --precision=short "$ROOT/data/plates.gltf" once.glb
exits 0
run --precision=short --existing=replace once.glb twice.glb
exits 0
is "$(wc -c <once.glb)" "$(wc -c <twice.glb)"

# Bytes of buffer 0 in use, each view padded to 4, and those that are there.
in_use='[g.accessors.flatMap((a) => [a.bufferView, a.sparse?.indices.bufferView, a.sparse?.values.bufferView]).
	concat(g.meshes[0].primitives.map((p) => p.extensions?.KHR_draco_mesh_compression?.bufferView)).
	filter((v, i, all) => v !== undefined && all.indexOf(v) === i).
	reduce((sum, v) => sum + (g.bufferViews[v].byteLength + 3 & ~3), 0), g.buffers[0].byteLength + 3 & ~3]'

scene "tangents of another kind take the place of the old ones, and no byte is left of these"
run --existing=replace "$WORK/layouts/tangents_separate.gltf" float.glb
exits 0
for input in separate short sparse tail; do
	for precision in float short byte; do
		[ $input$precision != tailfloat ] || continue # they stay where they are, and so do the bytes behind them
		run --existing=replace --precision=$precision "$WORK/layouts/tangents_$input.gltf" out.glb
		exits 0
		# the same accessors and views, as many bytes as each row now has less
		is "$(gltf out.glb '[g.accessors.length, g.meshes[0].primitives[0].attributes.TANGENT < 8]')" "[9,true]"
		rows=$(gltf out.glb 'g.accessors[g.meshes[0].primitives[0].attributes.TANGENT].count')
		width=$(case $precision in float) echo 16 ;; short) echo 8 ;; byte) echo 4 ;; esac)
		is "$(gltf out.glb g.buffers[0].byteLength)" \
			"$(($(gltf float.glb g.buffers[0].byteLength) - rows * (16 - width)))"
		bytes=$(gltf out.glb "$in_use")
		[ "${bytes%,*}" = "[${bytes#*,}" ] || [ "${bytes%,*}]" = "[${bytes#*,}" ] || wrong "$input, $precision: $bytes"
	done
done

scene "compressing and decompressing leaves no byte behind"
for method in sequential edgebreaker; do
	run --draco=$method "$WORK/layouts/plain.gltf" packed.glb
	exits 0
	bytes=$(gltf packed.glb "$in_use")
	[ "${bytes%,*}]" = "[${bytes#*,}" ] || wrong "$method: $bytes"
	run --draco=off --existing=replace packed.glb plain.glb
	exits 0
	bytes=$(gltf plain.glb "$in_use")
	[ "${bytes%,*}]" = "[${bytes#*,}" ] || wrong "$method and off: $bytes"
	valid packed.glb
	valid plain.glb
done

scene "a PLY has floats"
run --precision=byte "$ROOT/data/head.obj" out.ply
exits 1
says "precision"
only

scene "a view that reaches into the old tangents without using them ends where they ended"
run "$ROOT/data/plates.gltf" old.gltf
exits 0
# the indices before the first TANGENT, whose view gets two of its vertices and all but two
for bytes in 56 120; do
	gltf old.gltf reaching 'const v = g.bufferViews;
		if (v[11].byteOffset + 24 !== v[12].byteOffset || g.meshes[0].primitives[0].attributes.TANGENT !== 12)
			throw "old.gltf is laid out otherwise";' "v[11].byteLength = $bytes"
	for precision in float short byte; do
		run --existing=replace --precision=$precision --verify reaching.gltf new.gltf
		exits 0
		valid new.gltf
		is "$(gltf new.gltf 'rows(11)')" "$(gltf old.gltf 'rows(11)')"
		is "$(gltf new.gltf 'rows(8)')" "$(gltf old.gltf 'rows(8)')"
	done
done

done_testing
