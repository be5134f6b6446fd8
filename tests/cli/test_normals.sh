# SPDX-License-Identifier: MIT
# --normals: what is missing is made, what the input has is replaced only when that is asked for.
. "$ROOT/tests/support/cli.sh"

# Two triangles in the plane z = 0 with the normal (0, 0.6, 0.8), which the plane does not have.
tilted_obj() {
	printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0'
	printf 'vt %s\n' '0 0' '1 0' '1 1' '0 1'
	printf 'vn 0 0.6 0.8\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n'
}

# N by N quads in the plane z = 0.3 x + 0.7 y, each cut in two, without normals.
plane_obj() {
	awk -v n="$1" 'BEGIN {
		for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) {
			printf "v %.9g %.9g %.9g\n", i / n, j / n, 0.3 * i / n + 0.7 * j / n
			printf "vt %g %g\n", i / n, j / n
		}
		for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
			a = j * (n + 1) + i + 1; b = a + 1; c = b + n + 1; d = c - 1
			printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, b, b, c, c, a, a, c, c, d, d
		}
	}'
}

normals='[...new Set(rows(g.meshes[0].primitives[0].attributes.NORMAL).map(n => n.map(x => x.toFixed(3)).join(" ")))].join(", ")'
positions='rows(g.meshes[0].primitives[0].attributes.POSITION).length'

scene "smooth and flat leave the normals that an OBJ, a PLY and a glTF have"
tilted_obj >t.obj
run t.obj t.glb
run t.obj t.ply
for input in t.obj t.ply t.glb; do
	for choice in smooth flat; do
		run -v --only=all --existing=replace --normals=$choice "$input" out.glb
		exits 0
		says_not NORMALS_MADE
		says_not NORMALS_REPLACED
		is "$(gltf out.glb "$normals")" "0.000 0.600 0.800"
	done
done

scene "replace-smooth and replace-flat replace them, and say so"
tilted_obj >t.obj
run t.obj t.glb
for input in t.obj t.glb; do
	for choice in replace-smooth replace-flat; do
		run -v --only=all --existing=replace --normals=$choice "$input" out.glb
		exits 0
		says "6 normals of the input were replaced"
		says_not NORMALS_MADE
		is "$(gltf out.glb "$normals")" "0.000 0.000 1.000"
		is "$(gltf out.glb "$positions")" 4
	done
done

# A cube of 8 vertices, whose faces meet at 90 degrees: flat below that, and what smooth makes above.
scene "angle:N: faces that meet at less share a normal, in PLY, OBJ and glTF"
{
	printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0 0 1' '1 0 1' '1 1 1' '0 1 1'
	printf 'vt %s\n' '0 0' '1 0' '1 1' '0 1'
	for face in '1 4 3 2' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8'; do
		set -- $face
		echo "f $1/1 $2/2 $3/3 $4/4"
	done
} >cube.obj
run cube.obj cube.ply
{ printf 'ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n'
	printf 'property float s\nproperty float t\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n'
	awk '$1 == "v" { print $2, $3, $4, $2 + 0.1 * $4, $3 + 0.2 * $4 } $1 == "f" {
		printf 4; for (i = 2; i <= 5; i++) printf " %d", $i - 1; print "" }' cube.obj; } >cube.ply
run --normals=smooth --buffers=embed cube.ply cube.gltf
python3 -c 'import json
g = json.load(open("cube.gltf"))
for p in g["meshes"][0]["primitives"]:
    del p["attributes"]["NORMAL"], p["attributes"]["TANGENT"]
json.dump(g, open("cube.gltf", "w"))'
for input in cube.obj cube.ply cube.gltf; do
	run --only=all --normals=angle:90 $input flat.glb
	exits 0
	is "$(gltf flat.glb "$positions")" 24
	is "$(gltf flat.glb '[...new Set(rows(g.meshes[0].primitives[0].attributes.NORMAL).map(n => n.map(Math.abs).sort().join(" ")))]')" '["0 0 1"]'
	run --only=all --normals=angle:91 $input smooth.glb
	exits 0
	is "$(gltf smooth.glb '[...new Set(rows(g.meshes[0].primitives[0].attributes.NORMAL).map(n => n.map(x => Math.abs(x).toFixed(5)).join(" ")))]')" \
		'["0.57735 0.57735 0.57735"]'
done
run --only=all --existing=replace --normals=replace-angle:30 smooth.glb flat.glb
is "$(gltf flat.glb "$positions")" 24

scene "an OBJ without s gets smooth normals, and -v says why"
sed '/^vn/d' "$data/quad.obj" | sed 's,/[0-9]*\( \|$\),\1,g' >t.obj
run -v t.obj t.glb
says "4 corners got a computed normal: smooth, because the file has no s [NORMALS_MADE]"
{ echo 's off'; cat t.obj; } >s.obj
run -v s.obj t.glb
says "4 corners got a computed normal [NORMALS_MADE]"

scene "where only some faces have normals the others get them"
{
	tilted_obj
	printf 'v 2 0 0\nv 2 1 0\nvt 2 0\nvt 2 1\nf 2/2 5/5 3/3\n'
} >t.obj
run -v --normals=flat t.obj out.glb
says NORMALS_MADE
says_not NORMALS_REPLACED
is "$(gltf out.glb "$normals")" "0.000 0.600 0.800, 0.000 0.000 1.000"
run -v --normals=replace-flat t.obj out.glb
says NORMALS_MADE
says "6 normals of the input were replaced"
is "$(gltf out.glb "$normals")" "0.000 0.000 1.000"

scene "where the faces of a group cancel, corners have the normals of their own faces"
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'vt 0 0' 'vt 1 0' 'vt 0 1' 's 1' 'f 1/1 2/2 3/3' 'f 3/3 2/2 1/1' >t.obj
run t.obj out.glb
exits 0
says "warning: 6 made normals are flat: the faces around cancel out [NORMALS_CANCELLED]"
is "$(gltf out.glb "$normals")" "0.000 0.000 1.000, 0.000 0.000 -1.000"
run --normals=flat t.obj out.glb
says_not NORMALS_CANCELLED

scene "triangles of one plane keep sharing their vertices"
plane_obj 9 >p.obj
for choice in auto smooth flat replace-smooth replace-flat; do
	run --normals=$choice p.obj out.glb
	exits 0
	is "$choice $(gltf out.glb "$positions")" "$choice 100"
done

scene "flat normals of a cube of eight vertices make three of each"
{
	for z in 0 1; do printf 'v %s\n' "0 0 $z" "1 0 $z" "1 1 $z" "0 1 $z"; done
	echo 'vt 0 0'
	for face in '1 4 3 2' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8'; do
		set -- $face
		echo "f $1/1 $2/1 $3/1"
		echo "f $1/1 $3/1 $4/1"
	done
} >c.obj
run --normals=flat --raw c.obj c.ply
exits 0
is "$(grep -a '^element vertex' c.ply)" "element vertex 24"

scene "a list that ends with indices of no triangle loses these where normals are made and need vertices"
gltf new tail 'const attributes = {POSITION: add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1]),
		TEXCOORD_0: add("VEC2", 5126, [0, 0, 1, 0, 0, 1, .4, .3, .8, .9])};
	g.meshes = [{primitives: [{attributes, indices: add("SCALAR", 5123, [0, 1, 2, 0, 2, 3, 1, 4])}]}]'
run --only=all --normals=flat tail.gltf out.gltf
exits 0
is "$(gltf out.gltf '[g.accessors[g.meshes[0].primitives[0].indices].count, g.accessors[0].count]')" '[6,7]'

scene "a scan without texture coordinates gets the normals that are asked for"
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'v 1 1 1' 'f 1 2 3' 'f 2 4 3' >scan.obj
run scan.obj scan.ply
exits 0
says "skipped 1 primitive (no texture coordinates), 1 primitive without normals (--normals=smooth makes them)"
run scan.obj scan.gltf
for input in scan.obj scan.ply scan.gltf; do
	# (0, 0, 1) and (-1, -1, 1) / 3^.5: smooth, each corner weighs by its angle, at the ends of the common edge
	run $input plain.glb
	is "$(gltf plain.glb 'Object.keys(g.meshes[0].primitives[0].attributes).join()')" POSITION
	run --normals=flat $input flat.glb
	exits 0
	is "$(gltf flat.glb "$normals")" "0.000 0.000 1.000, -0.577 -0.577 0.577"
	is "$(gltf flat.glb "$positions")" 6
	run --normals=smooth $input smooth.glb
	exits 0
	is "$(gltf smooth.glb "$positions")" 4
	is "$(gltf smooth.glb "$normals" | tr , '\n' | wc -l)" 3
	run --normals=angle:60 $input angle.glb
	is "$(gltf angle.glb "$normals")" "$(gltf smooth.glb "$normals")"
	run --normals=angle:30 $input angle.glb
	is "$(gltf angle.glb "$normals")" "$(gltf flat.glb "$normals")"
	run -q --normals=smooth $input out.ply
	is "$(grep -ac 'property float n[xyz]' out.ply) $(grep -ac 'property float t[xyzw]' out.ply)" "3 0"
done
run --verify --normals=flat scan.gltf flat.glb
exits 0
says "0 of 1 primitives, made the normals of 1 primitive without tangents (+2 vertices where they differ)"
run --normals=angle:30 scan.obj flat.glb
says "skipped 1 primitive (no texture coordinates), made the normals of 1 primitive without tangents (+2 vertices where they differ)"
run --check --fail-on=warning --normals=flat scan.gltf
exits 0

scene "a mesh that needs no tangents gets the normals that are asked for, and no tangents"
plane_obj 2 >plane.obj
run --only=needed plane.obj plane.gltf
run --only=needed plane.obj plane.ply
for input in plane.obj plane.gltf; do
	run -q --only=needed --normals=auto $input plain.gltf
	is "$(gltf plain.gltf 'Object.keys(g.meshes[0].primitives[0].attributes).sort().join()')" POSITION,TEXCOORD_0
	run -q --only=needed --normals=smooth $input out.gltf
	exits 0
	is "$(gltf out.gltf 'Object.keys(g.meshes[0].primitives[0].attributes).sort().join()')" NORMAL,POSITION,TEXCOORD_0
	is "$(gltf out.gltf "$normals")" "-0.239 -0.557 0.796" # (-0.3, -0.7, 1) of unit length
	is "$(gltf out.gltf "$positions")" 9
done
# beside one that needs tangents, over the same vertices: each has what it asked for
gltf out.gltf both 'const p = g.meshes[0].primitives[0]; delete p.attributes.NORMAL;
	g.meshes[0].primitives.push({...p, attributes: {...p.attributes}, material: g.materials.push({normalTexture: {index: 0}}) - 1});
	g.textures = [{source: 0}]; g.images = [{uri: "n.png"}]'
run --verify --normals=smooth both.gltf out.glb
exits 0
says "1 of 2 primitives"
is "$(gltf out.glb 'g.meshes[0].primitives.map(p => Object.keys(p.attributes).sort().join())')" \
	'["NORMAL,POSITION,TEXCOORD_0","NORMAL,POSITION,TANGENT,TEXCOORD_0"]'
# and welds by them alone, whatever malloc returns
gltf new soup 'const corners = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0];
	const attributes = {POSITION: add("VEC3", 5126, corners, {min: [0, 0, 0], max: [1, 1, 0]})};
	g.meshes = [{primitives: [{attributes}]}]; g.nodes = [{mesh: 0}]; g.scenes = [{nodes: [0]}]; g.scene = 0'
MALLOC_PERTURB_=165 run --normals=smooth --only=needed --weld soup.gltf out.gltf
exits 0
says "welded 6 vertices to 4"
is "$(gltf out.gltf "$normals")" "0.000 0.000 1.000"
MALLOC_PERTURB_=165 run --verify --normals=smooth --weld both.gltf out.glb
exits 0

scene "normals that are replaced take the tangents with them, without another word"
tilted_obj >t.obj
run t.obj t.ply
run --only=all t.obj t.glb
run -v --normals=replace-flat t.ply out.ply
exits 0
says "6 normals of the input were replaced"
run -q out.ply out.glb
is "$(gltf out.glb "$normals")" "0.000 0.000 1.000"
run -v --normals=replace-flat t.glb out.glb
says "6 normals of the input were replaced"
is "$(gltf out.glb "$normals")" "0.000 0.000 1.000"
run --check --fail-on=warning out.glb
exits 0

done_testing
