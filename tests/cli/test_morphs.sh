# SPDX-License-Identifier: MIT
# Tangents of morph targets take what the targets move: sparse where that is smaller, as integers where the targets'
# normals are, in the accessors that are there. The judges are solves of the moved mesh and the Khronos validator.
. "$ROOT/tests/support/cli.sh"
mkdir -p "$WORK/in"
python3 "$ROOT/tests/support/morph_files.py" "$WORK/in" || exit 1
size() { stat -c %s "$1"; }
# component type and number of sparse elements of each target's TANGENT, with how often they occur
forms='(() => { const seen = {}; for (const t of g.meshes[0].primitives[0].targets) { const a = g.accessors[t.TANGENT],
	key = `${a.componentType} ${a.normalized ?? false} ${a.sparse !== undefined} ${a.bufferView !== undefined}`;
	seen[key] = (seen[key] ?? 0) + 1; } return seen; })()'
# accessors that nothing refers to
unused='(() => { const p = g.meshes[0].primitives[0], used = new Set([p.indices, ...Object.values(p.attributes),
	...p.targets.flatMap(Object.values)]); return g.accessors.filter((_, i) => !used.has(i)).length; })()'

scene "100 targets of 5 vertices each take a sixth of a file"
run --verify "$WORK/in/sparse.gltf" sparse.glb
exits 0
valid sparse.glb
[ "$(size sparse.glb)" -lt 1000000 ] || wrong "$(size sparse.glb) bytes"
is "$(gltf sparse.glb "$forms")" '{"5126 false true false":100}'
# each vertex and its six neighbours, at most
is "$(gltf sparse.glb 'g.meshes[0].primitives[0].targets.every((t) => { const n = g.accessors[t.TANGENT].sparse.count;
	return n > 5 && n <= 35; })')" true
# the values are the same under sanitizers, which take seconds for each
if [[ $BUILD != *sanitize* ]]; then
	run --morph=drop "$WORK/in/moved.gltf" moved.glb
	python3 "$ROOT/tests/support/gltf_morphs.py" sparse.glb 7 moved.glb >"$WORK/err.txt" 2>&1 ||
		wrong "$(cat "$WORK/err.txt")"
	for existing in repair replace; do
		run --existing=$existing sparse.glb again.glb
		same sparse.glb again.glb
	done
fi

scene "dense deltas that are there give way to sparse ones of bytes, and nothing of them is left"
for existing in replace repair; do
	run --verify --existing=$existing "$WORK/in/avatar.gltf" avatar.glb
	exits 0
	valid avatar.glb
	is "$(gltf avatar.glb "$forms")" '{"5120 true true false":103}'
	is "$(gltf avatar.glb "$unused")" 0
	is "$(gltf avatar.glb 'g.accessors.length')" "$(gltf "$WORK/in/avatar.gltf" 'g.accessors.length')"
done
gltf "$WORK/in/avatar.gltf" bare 'for (const t of g.meshes[0].primitives[0].targets) delete t.TANGENT'
run bare.gltf all.glb
exits 0
# all that is not TANGENT, and half of it
[ "$(size avatar.glb)" -lt $((1905000 * 3 / 2)) ] || wrong "$(size avatar.glb) bytes"
for options in --precision=byte --draco=sequential --draco=edgebreaker; do
	# shellcheck disable=SC2086
	run --verify --existing=replace $options "$WORK/in/avatar.gltf" out.glb
	exits 0
	valid out.glb
	is "$(gltf out.glb "$forms")" '{"5120 true true false":103}'
done

scene "targets that move nothing have one accessor together, of one element"
run --verify "$WORK/in/still.gltf" still.glb
exits 0
valid still.glb
is "$(gltf still.glb 'new Set(g.meshes[0].primitives[0].targets.map((t) => t.TANGENT)).size')" 1
is "$(gltf still.glb 'g.accessors[g.meshes[0].primitives[0].targets[0].TANGENT].sparse.count')" 1

# 180 degrees about z: T turns from (1, 0, 0) to (-1, 0, 0), a delta of -2, which integers do not have
scene "deltas beyond 1 are floats, whatever the normals are"
gltf "$data/morph.gltf" turned 'const p = g.meshes[0].primitives[0];
	p.targets = [{POSITION: add("VEC3", 5126, rows(p.attributes.POSITION).flatMap(([x, y]) => [-2 * x, -2 * y, 0]),
		{min: [-2, -2, 0], max: [0, 0, 0]}), NORMAL: add("VEC3", 5120, Array(16).fill(0), {normalized: true, count: 4})}];
	g.bufferViews.at(-1).byteStride = 4;
	g.extensionsUsed = ["KHR_mesh_quantization"], g.extensionsRequired = ["KHR_mesh_quantization"]'
run --verify turned.gltf turned.glb
exits 0
valid turned.glb
is "$(gltf turned.glb "$forms")" '{"5126 false false true":1}'
is "$(gltf turned.glb 'new Set(rows(g.meshes[0].primitives[0].targets[0].TANGENT).map(String)).size')" 1
is "$(gltf turned.glb 'rows(g.meshes[0].primitives[0].targets[0].TANGENT)[0]')" '[-2,0,0]'

scene "a line says what targets take when it is more than the mesh"
gltf "$data/morph.gltf" many 'const p = g.meshes[0].primitives[0];
	p.targets = Array(20).fill(p.targets[0]);
	delete g.meshes[0].weights'
run many.gltf many.glb
exits 0
says "tangents of 20 morph targets take 0.00096 MB, their meshes 0.000204"
run "$data/morph.gltf" one.glb
says_not "morph target"

# T of a quad is (1, 0, 0); the author has it 0.5 degrees off, and a target moves one of its two triangles
scene "an authored tangent that a target does not turn has no delta"
gltf "$WORK/in/still.gltf" authored 'const p = g.meshes[0].primitives[0];
	p.attributes.TANGENT = add("VEC4", 5126,
		rows(p.attributes.TEXCOORD_0).flatMap(() => [0.9999619, 0.0087265, 0, -1]))'
run --existing=repair --verify authored.gltf authored.glb
exits 0
is "$(gltf authored.glb 'rows(g.meshes[0].primitives[0].targets[0].TANGENT).flat().every((x) => x === 0)')" true
is "$(gltf authored.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT).every((t) => t[1] > 0.0087 && t[1] < 0.0088)')" true

# Two triangles of a quad as primitives of their own: a target moves a corner that only the first has, so that its
# tangents differ from the second's at the two corners that both have, while the base's are (1, 0, 0) everywhere.
scene "vertices that primitives share are split, and not welded, if a target alone turns their tangents apart"
triangles='const p = g.meshes[0].primitives[0], q = structuredClone(p), a = p.attributes,
	two = (u, v) => { p.indices = add("SCALAR", 5123, u), q.indices = add("SCALAR", 5123, v); };
	a.POSITION = add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], {min: [0, 0, 0], max: [1, 1, 0]});
	a.NORMAL = add("VEC3", 5126, Array(4).fill([0, 0, 1]).flat());
	a.TEXCOORD_0 = add("VEC2", 5126, [0, 1, 1, 1, 1, 0, 0, 0]);
	p.targets = [{POSITION: add("VEC3", 5126, [0, 0, 0, 0, -0.5, 0, ...Array(6).fill(0)], {min: [0, -0.5, 0], max: [0, 0, 0]})}];
	q.attributes = a, q.targets = p.targets, g.meshes[0].primitives = [p, q]'
soup='for (const o of [a, p.targets[0]]) for (const name in o) { const r = rows(o[name]), v = [0, 1, 2, 0, 2, 3].map((i) => r[i]);
	const bounds = (f) => v[0].map((_, k) => f(...v.map((x) => x[k])));
	o[name] = add(v[0].length === 2 ? "VEC2" : "VEC3", 5126, v.flat(), name === "POSITION" ? {min: bounds(Math.min), max: bounds(Math.max)} : {}); }'
gltf "$data/morph.gltf" shared "$triangles; two([0, 1, 2], [0, 2, 3])"
gltf "$data/morph.gltf" soup "$triangles; two([0, 1, 2], [3, 4, 5]); $soup"
gltf "$data/morph.gltf" one "$triangles; two([0, 1, 2], [3, 4, 5]); $soup; p.indices = add('SCALAR', 5123, [0, 1, 2, 3, 4, 5]); g.meshes[0].primitives = [p]"
while read -r count words; do
	# shellcheck disable=SC2086
	run -q --only=all --verify $words $count.glb
	exits 0
	is "$(gltf $count.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT).length')" "${count%.*}"
	is "$(gltf $count.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT).every((t) => t[0] === 1)')" true
done <<'END'
6.1 shared.gltf
4.1 --morph=drop shared.gltf
6.2 --weld shared.gltf
6.3 --weld soup.gltf
4.2 --weld --morph=drop soup.gltf
4.3 --weld --across=mesh soup.gltf
4.4 --weld one.gltf
END

scene "--across=mesh: a report compares a primitive that is kept without its targets"
gltf "$data/morph.gltf" kept "$triangles; two([0, 1, 2], [0, 2, 3]); q.attributes = {...a, TANGENT: add('VEC4', 5126, Array(4).fill([1, 0, 0, 1]).flat())}"
run --across=mesh --only=all --report=r.txt --report-format=text kept.gltf out.glb
exits 0 # the sanitizers find what nobody frees
is "$(gltf out.glb 'g.meshes[0].primitives.map((p) => p.targets.map((t) => "TANGENT" in t).join()).join()')" true,false

scene "a client adds a target's normals to those that were made: what it has then is solved"
mkdir "$WORK/layouts"
python3 "$ROOT/tests/support/gltf_layouts.py" "$WORK/layouts" || exit 1
for name in plain sequential_u8; do
	run --only=all --normals=replace-smooth "$WORK/layouts/$name.gltf" made.glb
	exits 0
	gltf made.glb drawn 'const p = g.meshes[0].primitives[0], a = p.attributes, t = p.targets[0], unit = (v) => {
			const l = Math.hypot(...v); return v.map((x) => x / l); },
		sums = (base, delta) => { const d = rows(delta); return rows(base).map((r, i) => r.map((x, k) => Math.fround(x + d[i][k]))); };
		if (!t.NORMAL) throw Error("no test");
		const points = sums(a.POSITION, t.POSITION), bounds = (f) => [0, 1, 2].map((k) => f(...points.map((v) => v[k])));
		a.POSITION = add("VEC3", 5126, points.flat(), {min: bounds(Math.min), max: bounds(Math.max)});
		a.NORMAL = add("VEC3", 5126, sums(a.NORMAL, t.NORMAL).flatMap(unit));
		delete a.TANGENT; delete p.targets; delete g.meshes[0].weights'
	run --only=all drawn.gltf drawn.glb
	exits 0
	python3 "$ROOT/tests/support/gltf_morphs.py" made.glb 0 drawn.glb >"$WORK/err.txt" 2>&1 || wrong "$(cat "$WORK/err.txt")"
done

done_testing
