# SPDX-License-Identifier: MIT
# Colours of vertices: sRGB in OBJ, PLY and .drc, linear in glTF. 188 / 255 is 0.5029 in linear light.
. "$ROOT/tests/support/cli.sh"

# A quad folded along its diagonal in texture space: its vertices are copied. The arguments stand behind the `v` lines.
fold() {
	printf '%s\n' "v 0 0 0$1" "v 1 0 0$2" "v 1 1 0$3" "v 0 1 0$4" "$5" "vt 0 0" "vt 1 0" "vt 1 1" "vn 0 0 1" \
		"f 1/1/1 2/2/1 3/3/1" "f 1/1/1 3/3/1 4/2/1" >fold.obj
}
colors='rows(g.meshes[0].primitives[0].attributes.COLOR_0).map(c => c.map(x => Math.round(1e4 * x) / 1e4))'

scene "colours of an OBJ's vertices arrive as COLOR_0, and go with every copy"
fold " 1 0 0" " 0 0.7372549 0" " 0 0 1 0.5" "" ""
run --verify fold.obj fold.glb
exits 0
valid fold.glb
is "$(gltf fold.glb 'g.accessors[g.meshes[0].primitives[0].attributes.COLOR_0].componentType')" 5126
is "$(gltf fold.glb "$colors")" "[[1,0,0,1],[0,0.5029,0,1],[0,0,1,0.5],[1,1,1,1],[1,0,0,1],[0,0,1,0.5]]"

scene "a PLY has the bytes that an OBJ had, and gives them back"
fold " 1 0 0" " 0 0.73725490196 0" " 0.00392156863 0.01568627451 0.01176470588 0.50196078431" "" ""
run fold.obj fold.ply
exits 0
is "$(grep -ac '^property uchar red' fold.ply)" 1
python3 - >colors.txt <<-'END'
	data = open("fold.ply", "rb").read()
	head, body = data.split(b"end_header\n", 1)
	names = [line.split()[1:] for line in head.decode().splitlines() if line.startswith("property") and "list" not in line]
	sizes = {"float": 4, "uchar": 1}
	row = sum(sizes[t] for t, _ in names)
	at = sum(sizes[t] for t, n in names[:[n for _, n in names].index("red")])
	print(*(body[i * row + at:i * row + at + 4].hex() for i in range(4)))
END
is "$(cat colors.txt)" "ff0000ff 00bc00ff 01040380 ffffffff"
run --existing=replace fold.ply back.glb
exits 0
is "$(gltf back.glb "$colors.slice(0, 3)")" "[[1,0,0,1],[0,0.5029,0,1],[0.0003,0.0012,0.0009,0.502]]"
run back.glb again.ply
exits 0
is "$(grep -ac '^property uchar red' again.ply)" 1

done_testing
