# SPDX-License-Identifier: MIT
#
# What the sweeps run: every reader and writer, --verify, --in-place, many inputs, every report format, as lines
# "name | files | what sweep.py is told | arguments". Sourced with $NMTAN, $BUILD, $ROOT and $WORK set.
#
#   sweep_all KIND... -- STRIDE    every case with faults of every kind, "memory", "memory onwards", "EIO" and so on,
#                                  "shorten" for an input that becomes empty; bad runs on standard output, then one
#                                  line for each kind: tried and bad
. "$ROOT/tests/support/manifold.sh"

make_inputs() {
	mkdir -p "$WORK/in" && cd "$WORK/in" || return 1
	cp "$ROOT"/data/mirrored_cube.* "$ROOT"/data/bumps.png "$ROOT"/data/quad.obj "$ROOT"/data/quad_wedge.ply \
		"$ROOT"/data/plates.* "$ROOT"/data/morph.gltf "$ROOT"/data/skin.gltf "$ROOT"/data/quantized.gltf \
		"$ROOT"/data/sparse.gltf .
	python3 "$ROOT/tests/support/inputs.py" gltf_long_windows 20 windows.glb 12 || return 1
	printf 'quad.obj\nplates.glb\n' >list
	manifold_gltf manifold || return 1
	"$NMTAN" -q --update=content plates.gltf current.gltf || return 1
	make_images &&
	"$NMTAN" -q --draco=sequential plates.gltf draco.glb && "$NMTAN" -q --draco=edgebreaker morph.gltf edge.gltf &&
		"$NMTAN" -q morph.gltf morph.glb && "$BUILD/tests/faults/make_meshopt" meshopt.glb
}

# An OBJ with one image of each decoder: TGA, TIFF, a height map in PNG, JPEG.
make_images() {
	local write="python3 $ROOT/tests/support/images.py write"
	$write a.tga 4 4 '(x, y, 3)' && $write b.tif 4 4 '(x, y, 4)' && $write c.png 4 4 'x * y' &&
		$write m.tga 8 2 '(x, x, x)' && cp "$ROOT/data/grey.jpg" d.jpg || return 1
	printf '%s\n' "newmtl a" "map_Kd a.tga" "map_Ke -clamp on b.tif" "norm c.png" "newmtl b" "bump -s -1 1 -clamp on d.jpg" \
		"map_d c.png" "map_Pr c.png" "map_Pm m.tga" "Pc 1" "Ps 1" "aniso 1" "Ni 2" "map_ao m.tga" >images.mtl
	printf '%s\n' "mtllib images.mtl" "v 0 0 0" "v 1 0 0" "v 0 1 0" "#MRGB ff010203ff040506" "vt 0 0" "vt 1 0" "vt 0 1" "usemtl a" \
		"f 1/1 2/2 3/3" "usemtl b" "f 3/3 2/2 1/1" >images.obj
	# and one of libtiff's with a JPEG, for which see test_memory.sh
	python3 "$ROOT/tests/support/images.py" jpegtif d.jpg e.tif && printf '%s\n' "newmtl a" "norm e.tif" >jpeg.mtl &&
		sed 's/images.mtl/jpeg.mtl/; s/usemtl b/usemtl a/' images.obj >jpeg.obj
}

images="images.obj images.mtl a.tga b.tif c.png d.jpg m.tga"
cube="mirrored_cube.obj mirrored_cube.mtl bumps.png"
plates="plates.gltf plates.bin bumps.png"
cases() {
	cat <<-END
		obj | $cube || mirrored_cube.obj o.gltf
		obj, --verify | $cube || --verify --images=embed mirrored_cube.obj o.glb
		obj, --images=copy | $cube | many | --images=copy -d out mirrored_cube.obj
		images | $images || --images=embed images.obj o.glb
		images beside | $images || images.obj o.gltf
		ply | quad_wedge.ply || quad_wedge.ply o.ply
		ply to gltf | quad_wedge.ply || quad_wedge.ply o.gltf
		glb | plates.glb || --verify plates.glb o.glb
		gltf | $plates || --images=embed plates.gltf o.glb
		gltf, links | $plates || --buffers=link plates.gltf o.gltf
		morphs | morph.gltf || --verify morph.gltf o.gltf
		morphs again | morph.glb || --existing=repair morph.glb o.glb
		windows | windows.glb || --only=all windows.glb o.glb
		across | windows.glb || --across=mesh --only=all --verify windows.glb o.glb
		sparse | sparse.gltf || sparse.gltf o.glb
		quantized | quantized.gltf || --precision=short quantized.gltf o.glb
		extensions | manifold.gltf manifold.bin || --only=all manifold.gltf o.gltf
		skin, draco out | skin.gltf || --draco=sequential skin.gltf o.glb
		edgebreaker out | plates.glb || --threads=2 --draco=edgebreaker --bitangents plates.glb o.glb
		draco | draco.glb bumps.png || --threads=2 --existing=replace --verify draco.glb o.gltf
		edgebreaker | edge.gltf || --existing=replace --verify edge.gltf o.glb
		meshopt | meshopt.glb bumps.png || --verify meshopt.glb o.glb
		in place | $plates || --in-place plates.gltf
		many | $cube quad.obj plates.glb | many | -d out mirrored_cube.obj quad.obj plates.glb
		update | $cube quad.obj | many | --update -d out mirrored_cube.obj quad.obj
		update, in place | $plates || --update --in-place plates.gltf
		update, by content | $plates current.gltf current.bin .nmtan-record || -q --update=content plates.gltf current.gltf
		depfile and manifest | $cube | report=m.jsonl | --depfile=d --manifest=m.jsonl mirrored_cube.obj o.glb
		a bound of memory | quad.obj $plates | many | --jobs=2 --memory=1M -d out quad.obj plates.gltf
		a list | list quad.obj plates.glb | many | --fail-fast -d out --files-from=list
		a folder | quad.obj plates.glb | many | -r -d out --keep-tree=. --exclude=x .
		difference | $cube quad.obj | many | --check --diff mirrored_cube.obj quad.obj
		difference as a page | $cube quad.obj | many report=r.html | --check --diff --report=r.html mirrored_cube.obj quad.obj
		verdict | $cube || --fail-on=info mirrored_cube.obj o.glb
		a folder of pages | $cube quad.obj | many report=pages/ | --check --report=pages/ mirrored_cube.obj quad.obj
		convert and report | $cube | report=r.html | --report=r.html mirrored_cube.obj o.glb
	END
	for format in text json html sarif csv markdown junit lines github; do
		echo "$format | $cube | report=r | --check --report=r --report-format=$format mirrored_cube.obj"
	done
}

# "the input that becomes empty | files | what sweep.py is told | arguments"
shorten_cases() {
	cat <<-END
		mirrored_cube.obj | $cube || --images=embed mirrored_cube.obj o.glb
		mirrored_cube.obj | $cube || --check mirrored_cube.obj
		mirrored_cube.obj | $cube | report=r.html | --check --report=r.html mirrored_cube.obj
		quad_wedge.ply | quad_wedge.ply || quad_wedge.ply o.ply
		plates.bin | $plates || --images=copy plates.gltf o.gltf
		plates.gltf | $plates || plates.gltf o.gltf
		plates.bin | $plates || --verify plates.gltf o.glb
		plates.glb | plates.glb || --in-place plates.glb
		edge.gltf | edge.gltf || --existing=replace edge.gltf o.glb
		plates.glb | plates.glb quad.obj | many | -d out plates.glb quad.obj
	END
}

sweep() {
	BUILD=$BUILD NMTAN=$NMTAN WORK=$WORK command python3 -B "$ROOT/tests/faults/sweep.py" "$@"
}

sweep_all() {
	local kinds=()
	while [ "$1" != -- ]; do kinds+=("$1"); shift; done
	for kind in "${kinds[@]}"; do
		{ [ "$kind" = shorten ] && shorten_cases || cases; } | sweep "$kind" "$2" || return 1
	done
}
