# SPDX-License-Identifier: MIT
# Every damaged file of data/damaged is refused with the exit code, the place and the reason that stand
# in damaged.tsv: file, exit code, how the message begins, words of the reason. Exit code 0: what is
# wrong is left out, with a finding.
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

scene "what a file refers to in vain never comes to mean what is added"
python3 - <<'PY'
import base64, json, struct
data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<6f", 0, 0, 1, 0, 0, 1) + struct.pack("<9f", *[0, 0, 1] * 3)
views = [(0, 36), (36, 24), (60, 36)]
triangle = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2}}
def write(name, hidden=triangle, **more):
	json.dump({"asset": {"version": "2.0"}, "meshes": [{"primitives": [triangle]}, {"primitives": hidden if isinstance(hidden, list) else [hidden]}],
		"nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0,
		"accessors": [{"bufferView": i, "type": t, "componentType": 5126, "count": 3} for i, t in enumerate(["VEC3", "VEC2", "VEC3"])] +
			[{"type": "VEC3", "componentType": 5126, "count": 3}],
		"bufferViews": [{"buffer": 0, "byteOffset": o, "byteLength": n} for o, n in views],
		"buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
		| more, open(name, "w"))
def packed(view, **more):
	return {"attributes": {"POSITION": 3} | more,
		"extensions": {"KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 0}}}}
write("attribute.gltf", {"attributes": {"POSITION": 0, "NORMAL": 4}})
write("target.gltf", {"attributes": {"POSITION": 0}, "targets": [{"POSITION": 4}]})
write("skin.gltf", skins=[{"joints": [0]}, {"joints": [0], "inverseBindMatrices": 4}])
write("sampler.gltf", animations=[{"channels": [], "samplers": [{"input": 4, "output": 0}]}])
write("image.gltf", images=[{"bufferView": 3, "mimeType": "image/png"}])
write("shared.gltf", [packed(1), packed(2, NORMAL=4)], extensionsUsed=["KHR_draco_mesh_compression"])
write("far.gltf", {"attributes": {"POSITION": 0, "NORMAL": 40}})
# mirrored triangles over one edge: two vertices are copied, so that what is there moves
data = struct.pack("<12f", 0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 0, 0) + struct.pack("<8f", 0, 0, 0, 1, 1, 0, 1, 0) + struct.pack("<12f", *[0, 0, 1] * 4)
views = [(0, 48), (48, 32), (80, 48), (128, 12)]
data += struct.pack("<6H", 0, 2, 1, 0, 1, 3)
triangle = triangle | {"indices": 3}
write("split.gltf", {"attributes": {"POSITION": 0}}, skins=[{"joints": [0], "inverseBindMatrices": 4}],
	accessors=[{"bufferView": i, "type": t, "componentType": 5126, "count": 4} for i, t in enumerate(["VEC3", "VEC2", "VEC3"])] +
		[{"bufferView": 3, "type": "SCALAR", "componentType": 5123, "count": 6}])
PY
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
