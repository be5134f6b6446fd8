# SPDX-License-Identifier: MIT
# What some exporters write, against the letter of the formats, and others read.
. "$ROOT/tests/support/cli.sh"

# A PLY triangle whose texture coordinates have these names, and a line behind the format. No normals.
named_ply() {
	printf '%s\n' ply 'format ascii 1.0' "${3:-comment}" 'element vertex 3' 'property float x' 'property float y' \
		'property float z' "property float $1" "property float $2" 'element face 1' \
		'property list uchar int vertex_indices' end_header '0 0 0 0 0' '1 0 0 0.5 0' '0 1 0 0 0.25' '3 0 1 2'
}

scene "texture coordinates of a PLY have many names"
for names in 's t' 'u v' 'texture_u texture_v' 'texcoord_u texcoord_v' 'texture_s texture_t' 'tu tv' 'texcoord_0 texcoord_1'; do
	named_ply $names >n.ply
	run n.ply n.glb
	exits 0
	is "$names $(gltf n.glb 'rows(g.meshes[0].primitives[0].attributes.TEXCOORD_0).join(" ")')" "$names 0,1 0.5,1 0,0.75"
done

scene "a line of a PLY header that is no statement is passed over before the first element"
named_ply s t 'Created by Blender3D 2.48' >n.ply
run -v n.ply n.glb
exits 0
says 'n.ply:3: info: 1 statement was not used: lines of the header that are no statements'

scene "behind the first element it could be a misspelt property, and is refused"
named_ply s t | sed 's/property float y/propery float y/' >n.ply
run n.ply n.glb
exits 3
says 'n.ply:6: found "propery"'
only n.ply

scene "faces of a PLY may have more values than its header says, and tangents no tw"
named_ply s t | sed 's/^3 0 1 2$/3 0 1 2 6 0 0 1 0 0 1/' >n.ply
run -v n.ply n.glb
exits 0
says 'n.ply:16: warning: 1 part of the input is not in the output: values of faces beyond those that the header names (1) [REFERENCE_LOST]'
run -v n.ply again.ply
exits 0
says_not LOST
is "$(tail -1 again.ply)" '3 0 1 2 6 0 0 1 0 0 1'
named_ply s t | sed "s/property float t\$/&\nproperty float tx\nproperty float ty\nproperty float tz/; s/^[0-9.]* [0-9.]* [0-9.]* [0-9.]* [0-9.]*\$/& 0 1 0/" >n.ply
run -v n.ply t.ply
exits 0
says 'n.ply:10: info: 1 statement was not used: properties tx, ty and tz are no tangents without tw'
is "$(grep -c '^property float t[xyzw]' t.ply) $(sed -n '/^0 0 0/p' t.ply)" '4 0 0 0 0 0 0 0 1 1 0 0 1'

scene "groups of an OBJ without objects are meshes with names, and one surface"
# two halves, of which one is mirrored: their edge is a seam, and MikkTSpace averages across it as if there were no groups
halves() {
	printf '%s\n' 'v -1 0 0' 'v 0 0 0' 'v 1 0 0' 'v -1 1 0' 'v 0 1 0' 'v 1 1 0' 'vt 1 0' 'vt 0 0' 'vt 1 1' 'vt 0 1' \
		'vn 0 0 1' "$1" 'f 1/1/1 2/2/1 5/4/1' "$2" 'f 2/2/1 3/1/1 6/3/1' "$1" 'f 1/1/1 5/4/1 4/3/1' "$2" 'f 2/2/1 6/3/1 5/4/1'
}
halves 'g arm' 'g leg two' >g.obj
run --verify g.obj g.glb
exits 0
is "$(gltf g.glb 'g.meshes.map(m => m.name + " " + m.primitives.length).join() + " " + g.nodes.map(n => n.name + n.mesh).join() +
	" " + g.scenes[0].nodes')" "arm 1,leg two 1 arm0,leg two1 0,1"
is "$(gltf g.glb 'g.meshes.map(m => rows(m.primitives[0].attributes.TANGENT).map(t => t[0] + t[3]).join()).join(" ")')" "-2,-2,-2,-2 2,2,2,2"
run --check --ignore=TAN_UNUSED --report=g.json g.obj
is "$(value g.json '[len(r["files"][0]["meshes"])] + [f["code"] for f in r["files"][0]["findings"]]')" \
	"[1, 'UV_MIRROR_SEAM', 'UV_MIRROR_OVERLAP']"
# the same as without groups, and objects come before them
halves '#' '#' >n.obj
run --check --ignore=TAN_UNUSED --report=n.json n.obj
is "$(sed 's/[gn]\.obj//' g.json | cmp - <(sed 's/[gn]\.obj//' n.json))" ""
{ echo 'o body'; cat g.obj; } >o.obj
run o.obj o.glb
is "$(gltf o.glb 'g.meshes.map(m => m.name).join()')" body

scene "zero bytes behind the text of an OBJ are a finding"
for count in 1 40; do
	{ cat "$data/quad.obj"; head -c $count /dev/zero; } >q.obj
	run -v q.obj q.glb
	exits 0
	says "$count zero bytes at the end"
	run "$data/quad.obj" same.glb
	same q.glb same.glb
done

scene "an OBJ whose faces refer to vn, of which it has none, gets normals and a warning"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1/1 2/2/2 3/3/-1\n' >n.obj
run -v n.obj n.glb
exits 0
says NORMALS_NOT_THERE
says NORMALS_MADE
is "$(gltf n.glb 'rows(g.meshes[0].primitives[0].attributes.NORMAL).join(" ")')" "0,0,1 0,0,1 0,0,1"
printf 'vn 0 0 1\n' >>n.obj
run n.obj n.glb
exits 3

scene "an OBJ whose faces refer to vt, of which it has none, has no texture coordinates, and a warning says why"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/-1/1\n' >t.obj
run --normals=auto t.obj t.glb
exits 0
says UV_NOT_THERE
says_not NORMALS_NOT_THERE
is "$(gltf t.glb 'Object.keys(g.meshes[0].primitives[0].attributes).sort().join(" ")')" "NORMAL POSITION"
sed '/^vn/d' t.obj >tn.obj
run tn.obj t.glb
exits 0
says UV_NOT_THERE
says NORMALS_NOT_THERE
sed 's/^f.*/f 1\/1\/1 2\/2\/2 3\/3\/1/' t.obj >tn.obj
run tn.obj t.glb
exits 3
says 'face refers to "vn" number 2, but the file has 1'
printf 'vt 0 0\n' >>t.obj
run t.obj t.glb
exits 3

scene "a restart of KHR_mesh_primitive_restart is said to be unsupported, without the extension it is an error"
gltf new plain 'const points = add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]);
	const attributes = {POSITION: points, NORMAL: points, TEXCOORD_0: add("VEC2", 5126, [0, 0, 1, 0, 0, 1, 1, 1])};
	g.meshes = [{primitives: [{attributes, indices: add("SCALAR", 5123, [0, 1, 2, 65535, 1, 3, 2]), mode: 5}]}]'
gltf plain.gltf r 'g.extensionsUsed = ["KHR_mesh_primitive_restart"]'
run --only=all --check r.gltf
exits 5
says KHR_mesh_primitive_restart
run --only=all --check plain.gltf
exits 3

scene "CSV and Markdown are UTF-8 whatever a file is called"
name=$(printf 'caf\351"x.obj')
cp "$data/mirrored_cube.obj" "$name"
for format in 'csv caf\xe9' "markdown $(printf 'caf\357\277\275')"; do
	run --check --fail-on=never --report-format=${format% *} "$name"
	exits 0
	python3 -c 'import sys; sys.exit(sys.argv[2] not in open(sys.argv[1], encoding="utf-8").read())' "$WORK/out.txt" "${format#* }" ||
		wrong "$format is not UTF-8, or lacks the name"
done

done_testing
