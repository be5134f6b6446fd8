# SPDX-License-Identifier: MIT
# Tangents as integers, in every layout of a glTF and in new documents: valid, lossless but for TANGENT, and
# what is reported is what they cost.
. "$ROOT/tests/support/cli.sh"
mkdir -p "$WORK/layouts" "$WORK/outputs"
ln -s ../layouts "$WORK/outputs/layouts"
PYTHONDONTWRITEBYTECODE=1 python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/layouts" || exit 1

for precision in short byte; do
	for input in "$WORK"/layouts/*.gl*; do
		name=${input##*/}
		scene "--precision=$precision: $name keeps everything but tangents"
		run --existing=replace --precision=$precision "$input" out.gltf
		exits 0
		PYTHONDONTWRITEBYTECODE=1 python3 "$ROOT/tests/support/gltf_lossless.py" --quantized "$input" out.gltf \
			>"$WORK/err.txt" 2>&1 || wrong "$input is not lossless"
		mkdir -p "$WORK/outputs/$precision-$name" && cp -r . "$WORK/outputs/$precision-$name"
		printf '%s\t%s\n' "$WORK/outputs/$precision-$name/out.gltf" "$input" >>"$WORK/pairs"
	done
done

scene "the validator finds no error in them that the input did not have"
valid --pairs "$WORK/pairs"

scene "new documents have them too"
for precision in short byte; do
	for output in $precision.gltf $precision.glb; do
		run --precision=$precision --verify -v "$ROOT/data/head.obj" $output
		exits 0
		says "rounded tangents by"
		says "TAN_QUANTIZED"
		is '[[["KHR_mesh_quantization"],["KHR_mesh_quantization"]],true]' "$(gltf $output \
			'[[g.extensionsUsed, g.extensionsRequired], g.accessors[g.meshes[0].primitives[0].attributes.TANGENT].normalized]')"
	done
done

scene "the validator finds no error in new documents"
for precision in short byte; do
	for output in $precision.gltf $precision.glb; do
		run --precision=$precision "$ROOT/data/head.obj" $output
		exits 0
		valid $output
	done
done

scene "tangents of the same kind are replaced in place"
run --precision=short "$ROOT/data/plates.gltf" once.glb
exits 0
run --precision=short --existing=replace once.glb twice.glb
exits 0
is "$(wc -c <once.glb)" "$(wc -c <twice.glb)"

scene "a PLY has floats"
run --precision=byte "$ROOT/data/head.obj" out.ply
exits 1
says "precision"
only

done_testing
