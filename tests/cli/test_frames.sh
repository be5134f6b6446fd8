# SPDX-License-Identifier: MIT
# The frame that is written: T of unit length across the unit normal, w the exact orientation of its triangle, on every
# corner, whatever normals and texture coordinates are like. Numbers are derived beside each case; frames.mjs counts.
. "$ROOT/tests/support/cli.sh"

# triangle NAME POSITIONS NORMALS TEXCOORDS: NAME.gltf with a normal map.
triangle() {
	gltf new "$1" "const [P, N, T] = [$2, $3, $4];" '
		const attributes = {POSITION: add("VEC3", 5126, P), NORMAL: add("VEC3", 5126, N), TEXCOORD_0: add("VEC2", 5126, T)};
		Object.assign(g, {scene: 0, scenes: [{nodes: [0]}], nodes: [{mesh: 0}], textures: [{source: 0}], images: [{uri: "n.png"}],
			meshes: [{primitives: [{attributes, material: 0}]}], materials: [{normalTexture: {index: 0}}]})'
}

# T of every vertex, to a millionth, and NORMAL.
tangents() {
	gltf "$1" 'JSON.stringify(rows(g.meshes[0].primitives[0].attributes.TANGENT).map((r) => r.map((c) => Math.round(c * 1e6) / 1e6 + 0)))'
}
normals() {
	gltf "$1" 'JSON.stringify(rows(g.meshes[0].primitives[0].attributes.NORMAL).map((r) => r.map((c) => Math.round(c * 1e6) / 1e6 + 0)))'
}

# No fault in a file, and it stays when it is converted again.
sound() {
	local counts existing
	counts=$(ask answer.mjs frames "$1") || wrong "$1 cannot be read"
	[[ $counts =~ ^corners\ [1-9] && ! $counts =~ \ (degree|lean|unit|w|mixed|wrong)\ [1-9] ]] || wrong "$1: $counts"
	for existing in keep repair; do
		"$NMTAN" -q --existing=$existing --only=all "$1" again.glb >/dev/null 2>&1
		same "$1" again.glb
	done
}

# How often a code was found by the conversion.
found() {
	value r.json "sum(i['count'] for f in r['files'] for i in f['findings'] if i['code'] == '$1')"
}

normal_obj() {
	printf '%s\n' 'v 0 0 0' 'v 1 0 1' 'v 0 1 0' 'vt 0 0' 'vt 1 0' 'vt 0 1' "vn $1" 'f 1/1/1 2/2/1 3/3/1'
}

# dP/du = (1, 0, 1). Across (0, 0, 1) that is (1, 0, 0), for a normal of any length.
scene "tangents lie across the unit normal"
for normal in '0 0 1' '0 0 .5' '0 0 1.1' '0 0 1.0003'; do
	normal_obj "$normal" >n.obj
	run --report=r.json n.obj n.glb
	exits 0
	is "$(tangents n.glb)" '[[1,0,0,1],[1,0,0,1],[1,0,0,1]]'
	is "$(normals n.glb)" '[[0,0,1],[0,0,1],[0,0,1]]'
	is "$(found NORMALS_SCALED)" "$([ "$normal" = '0 0 1' ] && echo 0 || echo 3)"
	sound n.glb
done

# The face's own is (1, 0, 1) x (0, 1, 0) = (-1, 0, 1), and dP/du lies across it.
scene "a zero normal is made anew"
normal_obj '0 0 0' >n.obj
run --report=r.json n.obj n.glb
exits 0
is "$(tangents n.glb)" '[[0.707107,0,0.707107,1],[0.707107,0,0.707107,1],[0.707107,0,0.707107,1]]'
is "$(normals n.glb)" '[[-0.707107,0,0.707107],[-0.707107,0,0.707107],[-0.707107,0,0.707107]]'
is "$(found NORMALS_MADE)" 3
sound n.glb

scene "so it is in a glTF, whose normals stay"
for length in 1 0.5 1.1; do
	triangle n '[0,0,0, 1,0,1, 0,1,0]' "[0,0,$length, 0,0,$length, 0,0,$length]" '[0,1, 1,1, 0,0]'
	run --report=r.json n.gltf n.glb
	exits 0
	is "$(tangents n.glb)" '[[1,0,0,1],[1,0,0,1],[1,0,0,1]]'
	is "$(normals n.glb)" "[[0,0,$length],[0,0,$length],[0,0,$length]]"
	is "$(found NORMALS_SCALED)" "$([ $length = 1 ] && echo 0 || echo 3)"
	sound n.glb
done
triangle n '[0,0,0, 1,0,1, 0,1,0]' '[0,0,0, 0,0,0, 0,0,0]' '[0,1, 1,1, 0,0]'
run --report=r.json n.gltf n.glb
exits 0
is "$(tangents n.glb)" '[[0.707107,0,0.707107,1],[0.707107,0,0.707107,1],[0.707107,0,0.707107,1]]'
is "$(normals n.glb)" '[[0,0,0],[0,0,0],[0,0,0]]'
is "$(found NORMALS_MADE)" 3
sound n.glb

# Its UV determinant, v up, is (.35)(-.9) - (1.05)(-.3): 0 in float, exactly that of the floats next to these. MikkTSpace
# leaves (1, 0, 0), which leans by .8.
scene "what MikkTSpace does not compute is repaired, and so is its mirrored twin"
triangle plain '[0,0,0, -0.6,0.8,0, 0,0,1]' '[0.8,0.6,0, 0.8,0.6,0, 0.8,0.6,0]' '[0,0, 1.05,0.9, 0.35,0.3]'
triangle twin '[0,0,0, -0.6,0.8,0, 0,0,1]' '[0.8,0.6,0, 0.8,0.6,0, 0.8,0.6,0]' '[0,0, 0.35,0.3, 1.05,0.9]'
triangle none '[0,0,0, -0.6,0.8,0, 0,0,1]' '[0.8,0.6,0, 0.8,0.6,0, 0.8,0.6,0]' '[0,0, 0,0, 0,0]'
for file in plain twin none; do
	run --report=r.json $file.gltf $file.glb
	exits 0
	is "$(found TAN_REPAIRED)" 3
	sound $file.glb
done

# Cut along its shorter UV diagonal, 1-3, the first quad has halves with determinants .5 and -.25. The second half has
# d1 = (0, 1, 0) and d2 = (-1, 1, 0) over (0, 1) and (.25, .5): dP/du = (.5 d1 - d2) / -.25 = (-4, 2, 0).
scene "each half of a folded quad has its own sign and its own vertices in a glTF"
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'v 0 1 0' 'v 2 0 0' 'v 2 1 0' 'vn 0 0 1' \
	'vt 0 0' 'vt 1 0' 'vt 1 1' 'vt 1.25 .5' 'vt 2 0' 'vt 2 1' 'f 1/1/1 2/2/1 3/3/1 4/4/1' 'f 2/2/1 5/5/1 6/6/1 3/3/1' >q.obj
run --report=r.json q.obj q.glb
exits 0
sound q.glb
is "$(found UV_FOLDED_QUAD)" 1
# T of the corners of triangles FIRST to END: of those at (x, y), as x,y:T
corners='(first, end) => { const p = g.meshes[0].primitives[0], P = rows(p.attributes.POSITION), T = rows(p.attributes.TANGENT);
	return rows(p.indices).flat().slice(3 * first, 3 * end).map((v) => `${P[v].slice(0, 2)}:${T[v].map((c) => Math.round(c * 1e6) / 1e6 + 0)}`).sort().join(" "); }'
is "$(gltf q.glb "($corners)(1, 2)")" \
	'0,1:-0.894427,0.447214,0,-1 1,0:-0.894427,0.447214,0,-1 1,1:-0.894427,0.447214,0,-1'
is "$(gltf q.glb 'g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count')" 9
# everything else has the bytes that the quads have
run --raw q.obj raw.glb
for range in '0, 1' '2, 4'; do
	is "$(gltf q.glb "($corners)($range)")" "$(gltf raw.glb "($corners)($range)")"
done

scene "in a PLY it stays a quad with one sign"
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'v 0 1 0' 'vn 0 0 1' 'vt 0 0' 'vt 1 0' 'vt 1 1' 'vt 1.25 .5' \
	'f 1/1/1 2/2/1 3/3/1 4/4/1' >q.obj
run --report=r.json q.obj q.ply
exits 0
is "$(found UV_FOLDED_QUAD)" 1
is "$(grep -ac 'element vertex 4' q.ply) $(grep -ac 'element face 1' q.ply)" '1 1'

# An arrowhead, in space and in texture space: its shorter diagonal, along which it is solved, lies outside.
scene "a quad that is concave is written inside, has its own sign, and is not called folded"
printf '%s\n' 'v 0 8 0' 'v -1 0 0' 'v 0 1 0' 'v 1 0 0' 'vn 0 0 1' 'vt 0.5 1' 'vt 0.375 0' 'vt 0.5 0.125' 'vt 0.625 0' \
	'f 1/1/1 2/2/1 3/3/1 4/4/1' >q.obj
for output in q.glb q.ply; do
	run --report=r.json q.obj $output
	exits 0
	is "$(found UV_FOLDED_QUAD) $(found TAN_REPAIRED)" '0 0'
	is "$(value r.json "r['files'][0]['meshes'][0]['triangles']['mirrored']")" 0
	run --existing=repair $output again.${output#*.}
	same $output again.${output#*.}
done
sound q.glb
is "$(gltf q.glb 'JSON.stringify(rows(g.meshes[0].primitives[0].indices).flat())')" '[0,1,2,0,2,3]'

# T and B of a quad are (1, 0, 0) and (0, 1, 0), w is 1; the author has both turned by 180 degrees.
scene "tangents that are reversed with the right w are repaired: --check calls them an error"
run "$data/quad.obj" quad.gltf
gltf quad.gltf reversed 'const n = g.meshes[0].primitives[0].attributes.TANGENT, b = bytes[0];
	for (let i = 0; i < g.accessors[n].count; i++)
		for (let k = 0; k < 3; k++)
			b.writeFloatLE(-rows(n)[i][k], at(n, i) + 4 * k)'
run --check --only=all --report=r.json reversed.gltf
is "$(found TAN_SIGN_MISMATCH)" 2
run --existing=repair --only=all --report=r.json reversed.gltf out.gltf
exits 0
is "$(found TAN_EXISTING_REPAIRED)" 6
is "$(tangents out.gltf)" "$(tangents quad.gltf)"

scene "deltas of morph targets that are right stay where they are"
for precision in float byte; do
	run --precision=$precision "$ROOT/data/morph.gltf" m.glb
	exits 0
	run --precision=$precision --existing=repair m.glb again.glb
	exits 0
	same m.glb again.glb
done

# AnimatedMorphCube has T = (1, 0, 0, 1) on all six sides, which is the normal of two: 4 triangles, 12 corners. It has no
# texture coordinates. Target 1 turns the normals of another side about x by 45 degrees, and no T with them.
cube=$ROOT/../shared/models/gltf/AnimatedMorphCube/glTF/AnimatedMorphCube.gltf
if [ -f "$cube" ]; then
	scene "tangents without texture coordinates are mended, or kept as they are"
	run --only=all --existing=keep --report=r.json "$cube" keep.glb
	exits 0
	is "$(found TAN_PARALLEL_NORMAL) $(found TAN_EXISTING_REPAIRED)" '8 0'
	is "$(tangents keep.glb)" "$(tangents "$cube")"
	for existing in repair replace; do
		run --only=all --existing=$existing --report=r.json --verify "$cube" $existing.glb
		exits 0
		is "$(found TAN_PARALLEL_NORMAL) $(found TAN_EXISTING_REPAIRED)" '0 12'
		sound $existing.glb
		run --check --report=r.json $existing.glb
		is "$(found TAN_PARALLEL_NORMAL)" 0
		# eight vertices get (0, 0, -+1), what Duff's basis has across (+-1, 0, 0); the others stay
		is "$(gltf $existing.glb '(() => { const a = g.meshes[0].primitives[0].attributes, N = rows(a.NORMAL);
			const T = rows(a.TANGENT); return [T.length, T.filter((t, v) => t.join() === "1,0,0,1" && N[v][0] === 0).length,
				T.filter((t, v) => t[0] === 0 && t[3] === 1 && N[v][0] !== 0).length]; })()')" '[24,16,8]'
	done
	same repair.glb replace.glb

	# what each target moves has unit tangents across its normals, also where base tangents are other ones now
	is "$(gltf repair.glb 'g.meshes[0].primitives[0].targets.map((t) => { const a = g.meshes[0].primitives[0].attributes;
		const N = rows(a.NORMAL), T = rows(a.TANGENT), n = rows(t.NORMAL), d = rows(t.TANGENT);
		return T.every((b, v) => { const m = N[v].map((x, i) => x + n[v][i]), s = d[v].map((x, i) => b[i] + x);
			return Math.abs(Math.hypot(...s) - 1) < 1e-6 && Math.abs(m.reduce((e, x, i) => e + x * s[i], 0)) < 1e-6; }); })')" \
		'[true,true]'
	run --only=all --existing=repair --morph=keep "$cube" kept.glb
	exits 0
	is "$(tangents kept.glb)" "$(tangents repair.glb)"
fi

scene "--morph=drop: a TANGENT that refers to nothing is gone like any other"
gltf "$data/morph.gltf" nothing 'g.meshes[0].primitives[0].targets[0].TANGENT = g.accessors.length'
run --morph=keep nothing.gltf out.glb
exits 3
says "refers to accessors["
run --morph=drop nothing.gltf out.glb
exits 0
is "$(gltf out.glb 'g.meshes[0].primitives[0].targets.some((t) => "TANGENT" in t)')" false

scene "one geometry with other morph targets is solved once, and both primitives have its tangents"
gltf "$data/morph.gltf" twice 'const all = g.meshes[0].primitives;
	all.push(structuredClone(all[0]));
	all[0].targets = [...all[0].targets, ...all[0].targets];
	g.meshes[0].weights = [0, 0]'
for morph in drop keep bake; do
	run --morph=$morph "$ROOT/data/morph.gltf" once.gltf
	exits 0
	run --morph=$morph --verify twice.gltf out.gltf
	exits 0
	is "$(gltf out.gltf 'g.meshes[0].primitives.every((p) => "TANGENT" in p.attributes)')" true
	is "$(tangents out.gltf)" "$(tangents once.gltf)"
	run --check --ignore=TAN_MORPH_MISSING --fail-on=warning out.gltf
	exits 0
done

done_testing
