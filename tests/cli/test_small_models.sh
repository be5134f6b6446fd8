# SPDX-License-Identifier: MIT
# The small models of data/make_gltf.py, each with tangents that follow from one sentence there: every
# number below is derived, none was taken from an output.
. "$ROOT/tests/support/cli.sh"

# tangents FILE PRIMITIVE EXPECTED...: row by row as [x,y,z,w], to a millionth.
tangents() {
	local found expected
	found=$(gltf "$1" "rows(g.meshes[0].primitives[$2].attributes.TANGENT).map((r) => r.map((c) => Math.round(c * 1e6) / 1e6 + 0))")
	shift 2
	expected=$(printf ',%s' "$@")
	is "$found" "[${expected#,}]"
}
convert() {
	scene "$1.gltf: $2"
	for ending in gltf glb; do
		run "$data/$1.gltf" "$1.$ending"
		exits 0
		valid "$1.$ending" "$data/$1.gltf"
	done
}
along_x=[1,0,0,1] along_y=[0,1,0,1]

convert morph "the target's tangents turn with its square"
for file in morph.gltf morph.glb; do
	tangents $file 0 $along_x $along_x $along_x $along_x
	# (0, 1, 0) - (1, 0, 0)
	is "$(gltf $file 'rows(g.meshes[0].primitives[0].targets[0].TANGENT).map((r) => r.map((c) => Math.round(c * 1e6) / 1e6 + 0))')" \
		"[[-1,1,0],[-1,1,0],[-1,1,0],[-1,1,0]]"
done

convert skin "the vertices of the mirror line are split, with their weights"
for file in skin.gltf skin.glb; do
	# Six and two; left of the line u runs against x, and turning T about once leaves w = -1.
	is "$(gltf $file 'g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count')" 8
	is "$(gltf $file '(() => {
		const p = g.meshes[0].primitives[0], a = (n) => rows(p.attributes[n]);
		const P = a("POSITION"), T = a("TANGENT"), W = a("WEIGHTS_0"), J = a("JOINTS_0");
		const corners = rows(p.indices).flat(), weights = new Map(), bad = [];
		for (let t = 0; t < corners.length; t += 3) {
			const ring = corners.slice(t, t + 3), side = Math.sign(ring.reduce((s, v) => s + P[v][0], 0));
			for (const v of ring) {
				if (T[v].join() !== [side, 0, 0, side].join()) bad.push(["T", v, T[v]]);
				const place = P[v].join(), k = [-3, 1, 3, -2, -1, 2][P[v][0] + 1 + 3 * P[v][1]];
				if (W[v].join() !== [(4 - k) / 8, (4 + k) / 8, 0, 0].join()) bad.push(["W", v, W[v]]);
				if (J[v].join() !== "0,1,0,0") bad.push(["J", v, J[v]]);
			}
		}
		return bad;
	})()')" "[]"
done

convert quantized "integers are decoded before the solve, and stay integers"
for file in quantized.gltf quantized.glb; do
	tangents $file 0 $along_x $along_x $along_x $along_x
	is "$(gltf $file '["POSITION", "NORMAL", "TEXCOORD_0", "TANGENT"].map((n) => g.accessors[g.meshes[0].primitives[0].attributes[n]].componentType)')" \
		"[5122,5120,5123,5126]"
done

convert sparse "rows of zeros and sparse rows make one attribute"
for file in sparse.gltf sparse.glb; do
	tangents $file 0 $along_y $along_y $along_y $along_y
	is "$(gltf $file 'g.accessors[0].sparse.count')" 3
done

# u' = v, v' = -u: u' grows along -y, -v' along x = z cross -y. Mirrored: u' = -3u, so T = -x; B = y stays, so w = -1.
convert transformed "a turned texture turns the tangents, a mirrored one flips them"
for file in transformed.gltf transformed.glb; do
	tangents $file 0 [0,-1,0,1] [0,-1,0,1] [0,-1,0,1] [0,-1,0,1]
	tangents $file 1 [-1,0,0,-1] [-1,0,0,-1] [-1,0,0,-1] [-1,0,0,-1]
done

# T = dP/du = x and v up along y for both quads: the sampler's turn and mirror are not looked at.
scene "--transform=keep: tangents of the file's own coordinates, which made_by names"
run --transform=keep "$data/transformed.gltf" kept.glb
exits 0
for primitive in 0 1; do tangents kept.glb $primitive [1,0,0,1] [1,0,0,1] [1,0,0,1] [1,0,0,1]; done
run --check --transform=keep --fail-on=warning --report=kept.json kept.glb
exits 0
made='[m["made_by"]["transform"] for m in r["files"][0]["meshes"]]'
is "$(value kept.json "$made")" "['bake', 'bake']"
run --check --fail-on=never --max-issues=0 --report=baked.json kept.glb
is "$(value baked.json "$made")" "['keep', 'keep']"
run --check --fail-on=never --max-issues=0 kept.glb
prints "100 % of the corners, the worst by 90 degrees, they were made without the texture transform, as Blender's exporter, glTF-Transform and gltfpack do"

convert multi_uv "the set that the normal texture asks for decides"
for file in multi_uv.gltf multi_uv.glb; do
	tangents $file 0 $along_y $along_y $along_y $along_y
done

convert variants "a primitive is solved when one of its variants needs it"
for file in variants.gltf variants.glb; do
	tangents $file 1 $along_x $along_x $along_x $along_x
	is "$(gltf $file 'g.meshes[0].primitives.map((p) => "TANGENT" in p.attributes)')" "[false,true,false]"
done

scene "the script makes them again, byte for byte"
PYTHONDONTWRITEBYTECODE=1 python3 "$data/make_gltf.py" . || wrong "data/make_gltf.py fails"
for model in morph skin quantized sparse transformed multi_uv variants; do
	same $model.gltf "$data/$model.gltf"
done

done_testing
