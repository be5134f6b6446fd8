# SPDX-License-Identifier: MIT
# The Khronos validator finds no error in an output that its input did not have.
. "$ROOT/tests/support/cli.sh"

for input in quad.obj mirrored_cube.obj head.obj quad_ascii.ply quad_le.ply quad_be.ply quad_wedge.ply \
	plates.gltf plates.glb; do
	scene "$input gives valid glTF in every form"
	cp "$data"/*.png "$data"/*.mtl "$data"/*.bin .
	mkdir out
	for words in "out/a.glb" "out/b.gltf" "--buffers=embed out/c.gltf" "--bitangents out/d.glb" \
		"--images=embed out/e.gltf" "--images=copy out/f.gltf" "--buffers=copy out/g.gltf" \
		"--method=lengyel out/h.glb" "--method=area --normals=flat out/i.glb"; do
		# shellcheck disable=SC2086
		run "$data/$input" $words
		exits 0
		# shellcheck disable=SC2086
		set -- $words
		shift $(($# - 1))
		printf '%s\t%s\n' "$PWD/$1" "$data/$input" >>pairs
	done
	valid --pairs pairs
done

scene "a buffer without bytes does not become a BIN chunk of zeros"
gltf "$data/plates.gltf" bare 'delete g.buffers[0].uri, delete g.images, delete g.textures;
	g.materials = g.materials.map(() => ({}))'
run bare.gltf bare.glb
exits 5
says "/buffers/0"
only bare.gltf
run bare.gltf copy.gltf
exits 0
same bare.gltf copy.gltf
# nothing lies in this one
echo '{"asset":{"version":"2.0"},"buffers":[{"byteLength":4}]}' >empty.gltf
run empty.gltf empty.glb
exits 0
valid empty.glb empty.gltf

done_testing
