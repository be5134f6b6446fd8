# SPDX-License-Identifier: MIT
# Where images lie: -s, -o and -clamp of MTL become KHR_texture_transform and samplers, and tangents follow.
. "$ROOT/tests/support/cli.sh"

python3 "$ROOT/tests/support/images.py" write "$WORK/n.png" 4 4 '(120 + x, 128 + y, 254)'

# A quad in the plane z = 0 with u = x and v = y, so that dP/du and dP/dv are the axes, whose material has the lines that
# are the arguments.
quad() {
	printf '%s\n' "mtllib m.mtl" "v 0 0 0" "v 1 0 0" "v 1 1 0" "v 0 1 0" "vt 0 0" "vt 1 0" "vt 1 1" "vt 0 1" "vn 0 0 1" \
		"usemtl m" "f 1/1/1 2/2/1 3/3/1 4/4/1" >quad.obj
	printf '%s\n' "newmtl m" "$@" >m.mtl
	cp "$WORK/n.png" .
}

# A renderer's view of the corners of a mesh, from the file alone: where it samples (v up again), and whether
# B = cross(N, T) w runs along -dP/dv and T along dP/du of the coordinates at which it samples (v down).
seen='(m => {
	const p = g.meshes[m].primitives[0], a = p.attributes, use = g.materials[p.material].normalTexture;
	const { offset: o = [0, 0], scale: s = [1, 1] } = use.extensions?.KHR_texture_transform ?? {};
	const uv = rows(a.TEXCOORD_0).map(t => [s[0] * t[0] + o[0], s[1] * t[1] + o[1]]);
	const P = rows(a.POSITION), N = rows(a.NORMAL), T = rows(a.TANGENT), i = rows(p.indices).flat();
	let right = true;
	for (let c = 0; c < i.length; c += 3) {
		const [x, y, z] = i.slice(c, c + 3), d = (b, k) => uv[b][k] - uv[x][k], e = (b, k) => P[b][k] - P[x][k];
		const det = d(y, 0) * d(z, 1) - d(y, 1) * d(z, 0);
		const du = [0, 1, 2].map(k => (d(z, 1) * e(y, k) - d(y, 1) * e(z, k)) / det);
		const dv = [0, 1, 2].map(k => (d(y, 0) * e(z, k) - d(z, 0) * e(y, k)) / det);
		for (const v of [x, y, z]) {
			const t = T[v].slice(0, 3), n = N[v];
			const B = [0, 1, 2].map(k => T[v][3] * (n[(k + 1) % 3] * t[(k + 2) % 3] - n[(k + 2) % 3] * t[(k + 1) % 3]));
			const along = (q, r) => q.reduce((sum, x, k) => sum + x * r[k], 0) / Math.hypot(...r);
			right &&= along(t, du) > 0.999 && along(B, dv) < -0.999;
		}
	}
	return [uv.map(t => [t[0], 1 - t[1]]), right];
})'

scene "an image lies where MTL puts it, and tangents follow it as it is sampled"
# s u + o of the corners (0, 0), (1, 0), (1, 1), (0, 1); the signs of T and w for upright coordinates are those of s
while read -r options corners tangent; do
	quad "norm $(echo "$options" | tr _ ' ') n.png"
	run quad.obj quad.glb
	exits 0
	is "$(gltf quad.glb "$seen(0)")" "[$corners,true]"
	is "$(gltf quad.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT)[0]')" "$tangent"
	run --check quad.glb
	is "$(grep -c 'TAN_' "$WORK/out.txt")" 0
done <<-'END'
	-s_2_3 [[0,0],[2,0],[2,3],[0,3]] [1,0,0,1]
	-s_2_3_1_-o_0.25_0.5_0 [[0.25,0.5],[2.25,0.5],[2.25,3.5],[0.25,3.5]] [1,0,0,1]
	-s_-1_1 [[0,0],[-1,0],[-1,1],[0,1]] [-1,0,0,-1]
	-o_0.25_0.5_-s_-1_1 [[0.25,0.5],[-0.75,0.5],[-0.75,1.5],[0.25,1.5]] [-1,0,0,-1]
	-s_1_-1 [[0,0],[1,0],[1,-1],[0,-1]] [1,0,0,-1]
	-s_1_-1_1_-o_-2_0.5 [[-2,0.5],[-1,0.5],[-1,-0.5],[-2,-0.5]] [1,0,0,-1]
	-s_-1_-1 [[0,0],[-1,0],[-1,-1],[0,-1]] [-1,0,0,1]
	-s_-1_-1_-o_0.75_0.25 [[0.75,0.25],[-0.25,0.25],[-0.25,-0.75],[0.75,-0.75]] [-1,0,0,1]
	-o_0.5 [[0.5,0],[1.5,0],[1.5,1],[0.5,1]] [1,0,0,1]
END

scene "each use of an image has its own place; the extension is used, not required"
quad "map_Kd -s 4 4 n.png" "norm -o 0.5 0 n.png" "map_Ke -s 1 1 1 -o 0 0 0 n.png"
run --bitangents quad.obj quad.gltf
exits 0
is "$(gltf quad.gltf '[g.extensionsUsed, g.extensionsRequired]')" '[["KHR_texture_transform"],null]'
is "$(gltf quad.gltf 'g.materials[0].pbrMetallicRoughness.baseColorTexture')" \
	'{"extensions":{"KHR_texture_transform":{"offset":[0,-3],"scale":[4,4]}},"index":0}'
is "$(gltf quad.gltf 'g.materials[0].emissiveTexture')" '{"index":0}'
is "$(gltf quad.gltf '[g.images.length, g.textures, g.samplers]')" '[1,[{"source":0}],null]'

scene "an image that is clamped has a sampler, its twin that repeats has none"
quad "map_Kd -clamp on n.png" "norm -clamp off n.png" "map_Ke -clamp on n.png"
run quad.obj quad.gltf
exits 0
is "$(gltf quad.gltf 'g.textures')" '[{"source":0},{"sampler":0,"source":0}]'
is "$(gltf quad.gltf 'g.samplers')" '[{"wrapS":33071,"wrapT":33071}]'
is "$(gltf quad.gltf '[g.materials[0].pbrMetallicRoughness.baseColorTexture, g.materials[0].normalTexture, g.materials[0].emissiveTexture]')" \
	'[{"index":1},{"index":0},{"index":1}]'

scene "-t has no place in a glTF, which is said; nothing of it is no turbulence"
quad "norm -t 0 0 0 n.png" "map_Kd -t 1 0 0 n.png"
run quad.obj quad.glb
exits 0
says "m.mtl:3: material \"m\": warning: 1 property of a material is not carried over: MTL: -t of map_Kd"
is "$(wc -l <"$WORK/err.txt")" 2

# Two squares of one object, with their own materials.
squares() {
	printf '%s\n' "mtllib m.mtl" "o body" "v 0 0 0" "v 1 0 0" "v 1 1 0" "v 0 1 0" "v 2 0 0" "v 2 1 0" \
		"vt 0 0" "vt 1 0" "vt 1 1" "vt 0 1" "vn 0 0 1" "usemtl a" "f 1/1/1 2/2/1 3/3/1 4/4/1" \
		"usemtl b" "f 2/1/1 5/2/1 6/3/1 3/4/1" "usemtl a" "f 1/1/1 2/2/1 3/3/1" >squares.obj
	printf '%s\n' "newmtl a" "$1" "newmtl b" "$2" >m.mtl
	cp "$WORK/n.png" .
}

scene "an object whose normal maps are mirrored in different ways is a mesh for each way; others stay one"
squares "norm -s -1 1 n.png" "norm n.png"
run squares.obj squares.glb
exits 0
is "$(gltf squares.glb 'g.meshes.map(m => m.name + m.primitives.length)')" '["body1","body1","body1"]'
for mesh in 0 1 2; do is "$(gltf squares.glb "$seen($mesh)[1]")" true; done
squares "norm -s 2 3 n.png" "norm -s 5 0.5 n.png"
run squares.obj squares.glb
is "$(gltf squares.glb 'g.meshes.map(m => m.name + m.primitives.length)')" '["body2"]'
squares "norm -s -2 3 n.png" "norm -s -5 1 n.png"
run squares.obj squares.glb
is "$(gltf squares.glb 'g.meshes.map(m => m.name + m.primitives.length)')" '["body2"]'
is "$(gltf squares.glb "$seen(0)[1]")" true

scene "overlap is judged where the image is sampled: repeated, clamped, moved"
# A square and its mirror image one tile further along u.
printf '%s\n' "mtllib m.mtl" "v 0 0 0" "v 1 0 0" "v 1 1 0" "v 0 1 0" "v 5 0 0" "v 6 0 0" "v 6 1 0" "v 5 1 0" \
	"vt 0.2 0.2" "vt 0.4 0.2" "vt 0.4 0.4" "vt 0.2 0.4" "vt 1.4 0.2" "vt 1.2 0.2" "vt 1.2 0.4" "vt 1.4 0.4" "vn 0 0 1" \
	"usemtl m" "f 1/1/1 2/2/1 3/3/1 4/4/1" "f 5/5/1 6/6/1 7/7/1 8/8/1" >pair.obj
cp "$WORK/n.png" .
while read -r options overlaps; do
	printf '%s\n' "newmtl m" "norm $(echo "$options" | tr _ ' ') n.png" >m.mtl
	run --check --report-format=json pair.obj
	is "$options $(grep -c '"UV_MIRROR_OVERLAP"' "$WORK/out.txt") $(grep -c '"UV_MIRROR_LONE"' "$WORK/out.txt")" "$options $overlaps"
done <<-'END'
	-bm_1 1 0
	-clamp_on 0 1
	-s_2 1 0
	-s_0.5 0 1
	-s_0.5_-clamp_on 0 1
END

# u' = -u folded is u again, and u' = 1 - u folded is 1 - u: a mirrored repeat sees an image and its twin, or not, by the
# offset of its transform.
scene "under a mirrored repeat the offset of a glTF's transform counts"
printf '%s\n' "mtllib m.mtl" "v 0 0 0" "v 1 0 0" "v 1 1 0" "v 0 1 0" "v 5 0 0" "v 6 0 0" "v 6 1 0" "v 5 1 0" \
	"vt 0.2 0.2" "vt 0.4 0.2" "vt 0.4 0.4" "vt 0.2 0.4" "vt -0.2 0.2" "vt -0.4 0.2" "vt -0.4 0.4" "vt -0.2 0.4" "vn 0 0 1" \
	"usemtl m" "f 1/1/1 2/2/1 3/3/1 4/4/1" "f 5/5/1 6/6/1 7/7/1 8/8/1" >pair.obj
printf '%s\n' "newmtl m" "norm -clamp on -o 0.25 0 n.png" >m.mtl
cp "$WORK/n.png" .
run pair.obj clamped.gltf
sed 's/"wrapS":33071/"wrapS":33648/' clamped.gltf >moved.gltf
sed 's/"offset":\[0.25,/"offset":[1.0,/' moved.gltf >tile.gltf
sed 's/"offset":\[0.25,/"offset":[0.0,/' moved.gltf >still.gltf
for name in moved:0 still:1 tile:1; do
	run --check --report-format=json "${name%:*}.gltf"
	is "$name $(grep -c '"UV_MIRROR_OVERLAP"' "$WORK/out.txt")" "$name ${name#*:}"
done

done_testing
