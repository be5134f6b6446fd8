# SPDX-License-Identifier: MIT
# --check judges, writes nothing, and fails for the right reason only.
. "$ROOT/tests/support/cli.sh"

scene "a sound mesh passes and nothing is written"
run --check --only=needed "$data/quad.obj" "$data/quad_le.ply"
exits 0
says "quad.obj: checked, 1 mesh, no findings"
says "quad_le.ply: checked, 1 mesh, no findings"
only
run --check "$data/plates.gltf"
says "plates.gltf: checked, 3 primitives, 1 error, 4 infos"

scene "findings at or above --fail-on make the exit code 6"
cp "$data/mirrored_cube.obj" .
run --check mirrored_cube.obj
prints "warning   MTL_MISSING"
prints "mirrored_cube.mtl"
exits 0
run --check --fail-on=warning mirrored_cube.obj
exits 6
run --check --fail-on=never mirrored_cube.obj
exits 0
run --fail-on=warning mirrored_cube.obj out.glb
exits 6
exists out.glb
run mirrored_cube.obj out.glb
exits 0

scene "standard input can be judged"
"$NMTAN" --check - <"$data/quad.obj" 2>"$WORK/err.txt"
is $? 0

scene "an input that cannot be read counts more than findings"
cp "$data/mirrored_cube.obj" .
run --check --fail-on=info mirrored_cube.obj nothing.obj
exits 2

# Optimizers leave such primitives behind: accessors of 0 elements, at some byte of a view of 0 bytes.
scene "elements that are not there lie in no bytes"
gltf new empty 'add("SCALAR", 5121, [0, 0, 0, 0]);
	const none = (byteOffset, componentType, type) => ({bufferView: 0, byteOffset, componentType, type, count: 0});
	g.accessors = [none(0, 5126, "VEC3"), none(12, 5126, "VEC2"), none(20, 5123, "SCALAR")];
	g.bufferViews = [{buffer: 0, byteLength: 0, byteStride: 20}];
	g.meshes = [{primitives: [{attributes: {POSITION: 0, TEXCOORD_0: 1}, indices: 2}]}];
	g.nodes = [{mesh: 0}]'
run --check --report=empty.html empty.gltf
exits 0
says "empty.gltf: checked"
run --only=all --existing=replace --verify empty.gltf empty.glb
exits 0
says "skipped 1 primitive (no faces)"

scene "a run that ends with 6 says how many of many files fail, with -q too, and a report without an ending what it may be"
cp "$data/plates.glb" one.glb
cp one.glb two.glb
cp "$data/quad.obj" fine.obj
run -q --check one.glb fine.obj two.glb
exits 6
says "nmtan: 3 of 3 done, 2 with findings that fail the run"
run --check -q fine.obj fine.obj
exits 0
silent
run -d out --fail-on=warning --existing=keep fine.obj one.glb two.glb
exits 0
says "nmtan: 3 of 3 done; 3 got tangents"
run --check --report=findings fine.obj
exits 1
says "cannot tell the report's format from the name 'findings': use --report-format, or an ending: .txt .json .sarif .xml .csv .md .html, or a slash for a folder of pages"
for ending in txt json sarif xml csv md html; do
	run -q --check --report=r.$ending fine.obj
	exists r.$ending
done

scene "a file whose folder is not there is refused before anything is done"
cp "$data/quad.obj" a.obj
for words in --report=no/r.html --manifest=no/m --depfile=no/d --report=a.obj/r.json; do
	option=${words#*=}
	run $words a.obj out.glb
	exits 2
	says "$option: cannot write: there is no folder \"${option%/*}\""
	only a.obj
done
run --check --report=/no/r.json a.obj
exits 2
run -q -d made --report=made/r.json a.obj # it is made before
exits 0
exists made/r.json

scene "a report that exists is refused by --no-clobber before anything is done"
cp "$data/quad.obj" a.obj
echo >r.txt
run --no-clobber --report=r.txt a.obj out.glb
exits 2
only a.obj r.txt

done_testing
