# SPDX-License-Identifier: MIT
# Plain glTF compressed by --draco, however it stores its vertices. The judges are the Khronos validator for the
# JSON and Draco for the blocks, when the output is read again.
. "$ROOT/tests/support/cli.sh"
mkdir -p "$WORK/layouts" "$WORK/outputs"
PYTHONDONTWRITEBYTECODE=1 python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/layouts" || exit 1

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
	*) expected=1 ;;
	esac
	for method in sequential edgebreaker; do
		run --existing=replace --draco=$method "$input" $method.glb
		exits 0
		is "$(compressed $method.glb)" $expected
		# the same triangles and vertices that agree with what the file says of itself
		run --existing=replace --draco=off $method.glb plain.glb
		exits 0
		says "$(case $name in strip*) echo 28 ;; instanced.*) echo 648 ;; instanced*) echo 864 ;; *) echo 216 ;; esac) triangles"
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

scene "only a glTF made from a glTF is compressed"
run --draco=edgebreaker "$data/quad.obj" quad.glb
exits 1
says "--draco=edgebreaker compresses only glTF that is made from glTF"
run --draco=sequential "$data/plates.glb" plates.ply
exits 1
only

done_testing
