# SPDX-License-Identifier: MIT
# --quads: triangles of a glTF that are solved as the quads that they are halves of. The same quads in an OBJ give the
# right answer, which are no halves; the glTF has them cut by the diagonal that nmtan would not take.
. "$ROOT/tests/support/cli.sh"

# A bumpy grid of 12 by 12 quads with odd texture coordinates. Positions are whole 1024ths and
# texture coordinates whole 4096ths, so that what is added to them, or 1 - v, is exact.
# $1: what is added to z of every third vertex; $2: a vertex whose texture coordinates are pushed over two quads beside it,
# whose smaller halves are mirrored then; $3: how many quads are in the first object, all if it is empty.
quads() {
	awk -v lift="${1:-0}" -v folded="${2-}" -v first="${3-}" 'BEGIN {
		n = 12
		for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) {
			k = j * (n + 1) + i
			z = int(300 * sin(i * 1.7 + j) * cos(j * 1.3)) + (k % 3 == 0 ? lift : 0)
			printf "v %.10g %.10g %.10g\n", (1024 * i + int(300 * sin(k))) / 1024, (1024 * j + int(300 * cos(3 * k))) / 1024, z / 1024
			push = k + 1 == folded ? 0.7 : 0
			printf "vt %.10g %.10g\n", int(256 * (i + 1 + push + 0.3 * sin(5 * k))) / 4096, int(256 * (j + 1 + push + 0.3 * cos(7 * k))) / 4096
			x = 0.4 * sin(11 * k); y = 0.4 * cos(13 * k)
			printf "vn %.9g %.9g %.9g\n", x, y, sqrt(1 - x * x - y * y)
		}
		print "o one"
		for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
			if (first && j * n + i == first)
				print "o two"
			a = j * (n + 1) + i + 1; b = a + 1; c = b + n + 1; d = c - 1
			printf "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, c, c, c, d, d, d
		}
	}'
}

# The other two halves of each quad of a primitive p, and p with its indices replaced.
recut='const halves = (p) => { const c = rows(p.indices).flat(), out = [];
	for (let i = 0; i < c.length; i += 6) {
		const [x, y, z, , , w] = c.slice(i, i + 6), fan = c[i + 3] === x && c[i + 4] === z;
		out.push(...(fan ? [x, y, w, y, z, w] : [x, y, c[i + 4], x, c[i + 4], z]));
	} return out; };
	const cut = (p, more) => { p.indices = add("SCALAR", 5125, [...halves(p), ...(more ?? [])]); return p; };
	const all = g.meshes.flatMap((m) => m.primitives);'
strip='g.meshes.flatMap((m) => m.primitives).forEach((p) => { delete p.attributes.TANGENT; });'

# The vertices at each place, once: position and texture coordinates, then the tangent. $1: how tangents are printed.
places() {
	gltf "$2" "[...new Set(g.meshes.flatMap((m) => m.primitives).flatMap((p) => {
		const [x, t, u] = ['POSITION', 'TANGENT', 'TEXCOORD_0'].map((name) => rows(p.attributes[name]));
		const used = p.indices === undefined ? x.keys() : rows(p.indices).flat();
		return Array.from(used, (v) => JSON.stringify([x[v], u[v], t[v]${1:+.map((c) => c.toFixed($1))}])); }))].sort().join('\n')"
}
same_places() { is "$(places "${3-}" "$1" | sha1sum)" "$(places "${3-}" "$2" | sha1sum)"; }
other_places() { [ "$(places "" "$1")" != "$(places "" "$2")" ] || wrong "$1 and $2 have the same tangents"; }

# obj.glb of the OBJ (made by $1, with options behind it), cut.gltf with its tangents and the other halves, bare.gltf without.
inputs() {
	"${@:2}" >quads.obj
	run -q $1 quads.obj obj.glb
	gltf obj.glb cut "$recut" 'all.forEach((p) => cut(p));'
	gltf cut.gltf bare "$strip"
}

scene "pairs are solved as quads, and only where that is asked for"
inputs "" quads 0
run --only=all --quads=pairs bare.gltf pairs.glb
exits 0
says "288 triangles (as 144 quads)"
says_not "TAN_QUADS_NONE"
same_places pairs.glb obj.glb
is "$(gltf pairs.glb 'rows(g.meshes[0].primitives[0].indices)')" "$(gltf bare.gltf 'rows(g.meshes[0].primitives[0].indices)')"
for choice in auto off; do
	run --only=all --quads=$choice bare.gltf $choice.glb
	says_not "quads"
	other_places $choice.glb obj.glb
done
cmp auto.glb off.glb || wrong "without proof there are quads"
run --only=all --quads=pairs --threads=1 bare.gltf one.glb
run --only=all --quads=pairs --threads=7 bare.gltf seven.glb
same one.glb pairs.glb
same seven.glb pairs.glb

# They negate x, and exchange two corners of each triangle so that it stays wound as it was; the OBJ says what the quads are.
scene "halves of exporters that mirror the model are pairs, too"
inputs "" quads 0
awk '/^vn? / { $2 = $2 ~ /^-/ ? substr($2, 2) : "-" $2 } /^f / { print $1, $2, $5, $4, $3; next } 1' quads.obj >mirrored.obj
run -q mirrored.obj mirrored.glb
for corners in 0,2,1 2,1,0; do
	gltf bare.gltf exported 'const p = g.meshes[0].primitives[0], a = p.attributes;
		for (const n of [a.POSITION, a.NORMAL]) for (let v = 0; v < g.accessors[n].count; v++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, v)), at(n, v));
		const c = rows(p.indices).flat();
		p.indices = add("SCALAR", 5125, c.map((_, i) => c[i - i % 3 + ['$corners'][i % 3]]));'
	run --only=all --quads=pairs exported.gltf pairs.glb
	says "288 triangles (as 144 quads)"
	same_places pairs.glb mirrored.glb
done

scene "pairs are asked for and there are none: a warning"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' >one.obj
run -q one.obj one.gltf
run --only=all --existing=replace --quads=pairs one.gltf out.glb
exits 0
says "one.gltf: warning: --quads=pairs changes nothing: no two triangles that follow each other are a quad [TAN_QUADS_NONE]"

scene "tangents of quads prove quads"
inputs "" quads 0
gltf cut.gltf hole 'const a = g.meshes[0].primitives[0].attributes.TANGENT;
	bytes[0].fill(0, at(a, 30), at(a, 30) + 12);'
for existing in replace repair; do
	run --only=all --existing=$existing hole.gltf $existing.glb
	exits 0
	says "(as 144 quads)"
	same_places $existing.glb obj.glb
	run --only=all --existing=$existing --quads=off hole.gltf off.glb
	says_not "quads"
	other_places off.glb obj.glb
done
# those of triangles prove triangles
run -q --only=all bare.gltf triangles.glb
run --only=all --existing=replace triangles.glb again.glb
says_not "quads"
same_places again.glb triangles.glb

scene "a report tells whose tangents these are, and compares with the same faces"
inputs "" quads 0
made='[tuple(m["made_by"][k] for k in ("method", "faces", "w", "agreement", "within_degrees")) for m in r["files"][0]["meshes"]]'
run -q --check --report=q.json cut.gltf
exits 0
validates report q.json
is "$(value q.json "$made")" "[('mikktspace', 'quads', 'right', 1, 0.1)]"
is "$(value q.json '[h["corners"] for h in r["files"][0]["meshes"][0]["direction_histogram"]][1:]')" "[0, 0, 0, 0, 0]"
run --check cut.gltf
prints "MikkTSpace, on quads"
run -q --check --report=q.html cut.gltf
grep -q "MikkTSpace, on quads" q.html || wrong "the page does not say it"
run -q --check --quads=off --report=off.json cut.gltf
is "$(value off.json '[m["made_by"]["method"] for m in r["files"][0]["meshes"]]')" "['unknown']"
run -q --only=all --quads=pairs --method=area bare.gltf area.glb
run -q --check --report=a.json area.glb
is "$(value a.json "$made")" "[('area', 'quads', 'right', 1, 0.1)]"
run -q --only=all --existing=replace cut.gltf again.glb
run --check --diff cut.gltf again.glb
prints "0 of 1 meshes changed"

scene "the smaller half of a folded quad may have the sign of the quad"
inputs --raw quads 0 85
codes='sorted(f["code"] for f in r["files"][0]["findings"] if f["code"].startswith("TAN_"))'
run --check --only=all --report=f.json cut.gltf
exits 0
is "$(value f.json "'TAN_QUAD_SIGN' in $codes, 'TAN_SIGN_MISMATCH' in $codes")" "(True, False)"
run --check --only=all --quads=off --fail-on=info --report=f.json cut.gltf
exits 6
is "$(value f.json "'TAN_QUAD_SIGN' in $codes, 'TAN_SIGN_MISMATCH' in $codes")" "(False, True)"
run --only=all --existing=repair cut.gltf repair.glb
same_places repair.glb obj.glb
warnings='sorted(f["code"] for f in r["files"][0]["findings"] if f["severity"] == "warning" and f["code"].startswith("TAN_"))'
# what is solved on quads has the baker's sign, too, however it is known that there are quads
for words in "--existing=replace" "--existing=replace --raw" "--existing=replace --quads=pairs"; do
	run --only=all $words cut.gltf own.glb
	exits 0
	same_places own.glb obj.glb
done
run --only=all --quads=pairs bare.gltf own.glb
same_places own.glb obj.glb
run -q --check --only=all --fail-on=never --report=f.json own.glb
is "$(value f.json "$warnings")" "[]"
# on triangles each half has its own
run --only=all --existing=replace --quads=off cut.gltf own.glb
is "$(gltf own.glb '(() => { const p = g.meshes[0].primitives[0], i = rows(p.indices).flat(),
	[u, t] = ["TEXCOORD_0", "TANGENT"].map((name) => rows(p.attributes[name])); let wrong = 0;
	for (let c = 0; c < i.length; c += 3) {
		const [a, b, d] = i.slice(c, c + 3), area = (u[b][0] - u[a][0]) * (u[d][1] - u[a][1]) - (u[b][1] - u[a][1]) * (u[d][0] - u[a][0]);
		wrong += [a, b, d].some((v) => t[v][3] * area >= 0); /* v points down here */
	} return wrong; })()')" 0

# Every sixth quad has one half without area, which its tangents do not show if it is solved as triangles; of every
# eighteenth two texture coordinates are exchanged: it crosses itself, and each half is written with its own sign. Two
# flat ones behind them share an edge, and the smaller half of the first has the second one's tangents.
scene "tangents of quads beside those of folded quads' halves are no mismatch"
quads 0 | awk '/^f / { k++; split($3, b, "/"); split($2, a, "/")
	if (k % 6 == 1) { split($4, c, "/"); $4 = c[1] "/" b[2] "/" c[3] }
	if (k % 18 == 4) { $2 = a[1] "/" b[2] "/" a[3]; $3 = b[1] "/" a[2] "/" b[3] } } 1' >folded.obj
printf 'v %s 9\n' "0 0" "1 0" "1 1" "0 1" "1 2" "0 2" >>folded.obj
printf 'vt %s\n' ".2 0" "-.1 0" ".1 .1" "0 .1" ".1 .2" "0 .2" >>folded.obj
printf '%s\n' 'vn 0 0 1' 'f -6/-6/-1 -5/-5/-1 -4/-4/-1 -3/-3/-1' 'f -3/-3/-1 -4/-4/-1 -2/-2/-1 -1/-1/-1' >>folded.obj
run --normal-map="$data/bumps.png" folded.obj own.glb
says "9 quads cross themselves in UV space"
run -q --check --fail-on=never --report=f.json own.glb
is "$(value f.json "$warnings")" "[]"
is "$(value f.json "$made")" "[('mikktspace', 'quads', 'right', 1, 0.1)]"
# nor are vertices shared by both windings, whatever the convention of w is
gltf own.glb inverted 'const n = g.meshes[0].primitives[0].attributes.TANGENT;
	for (let v = 0; v < g.accessors[n].count; v++) { const w = at(n, v) + 12; bytes[0].writeFloatLE(-bytes[0].readFloatLE(w), w); }'
run -q --check --fail-on=never --report=f.json inverted.gltf
is "$(value f.json "$made, 'TAN_MIRROR_SHARED_VERTEX' in $codes")" "([('mikktspace', 'quads', 'inverted', 1, 0.1)], False)"

# As Blender exports a mesh of several materials: solved as one, written as primitives.
scene "tangents that were made for all primitives of a mesh are known away from the borders"
inputs "" quads 0
gltf cut.gltf parts 'const p = g.meshes[0].primitives[0], c = rows(p.indices).flat();
	g.meshes[0].primitives = [c.slice(0, 432), c.slice(432)].map((i) => ({ ...p, indices: add("SCALAR", 5125, i) }));'
gltf parts.gltf alone 'const [one, two] = g.meshes[0].primitives;
	g.meshes = [one, two].map((p) => ({ primitives: [p] })); g.nodes = [{ mesh: 0 }, { mesh: 1 }]; g.scenes = [{ nodes: [0, 1] }]; g.scene = 0;'
made='[(m["made_by"]["method"], m["made_by"]["faces"], m["made_by"]["across"]) for m in r["files"][0]["meshes"]]'
run --check --only=all --fail-on=warning --report=p.json parts.gltf
exits 0
validates report p.json
is "$(value p.json "$made")" "[('mikktspace', 'quads', 'mesh'), ('mikktspace', 'quads', 'mesh')]"
is "$(value p.json '[f["code"] for f in r["files"][0]["findings"] if f["code"].startswith("TAN_DIR")]')" "[]"
run --only=all --existing=replace --across=mesh parts.gltf whole.glb
says "as 144 quads"
same_places whole.glb obj.glb
# two meshes were never solved as one
run --check --only=all --report=p.json alone.gltf
is "$(value p.json "$made")" "[('unknown', 'quads', 'primitive'), ('unknown', 'quads', 'primitive')]"

scene "primitives over one buffer pair their own triangles, and --across=mesh all of them as one"
quads 0 "" 50 >two.obj
run -q two.obj two.glb
inputs "" quads 0
# the same vertices for both, and the first one's triangles again in a third
gltf cut.gltf pool "$strip" 'const [p] = g.meshes[0].primitives, c = rows(p.indices).flat();
	g.meshes[0].primitives = [c.slice(0, 300), c.slice(300), c.slice(0, 300)].map((part) =>
		({ ...p, indices: add("SCALAR", 5125, part) }));'
run --only=all --quads=pairs pool.gltf apart.glb
exits 0
says "(as 194 quads)"
same_places apart.glb two.glb
run --only=all --quads=pairs --across=mesh pool.gltf whole.glb
gltf whole.glb first 'g.meshes[0].primitives.pop();'
same_places first.gltf obj.glb
# tangents prove them there too, each primitive by itself
run -q --only=all --existing=replace apart.glb again.glb
same_places again.glb two.glb
run -q --only=all --existing=replace --across=mesh --quads=pairs --threads=3 first.gltf again.glb
same_places again.glb obj.glb

scene "primitives without indices"
inputs "" quads 0
gltf bare.gltf flat 'const p = g.meshes[0].primitives[0], c = rows(p.indices).flat(); delete p.indices;
	for (const name in p.attributes)
		p.attributes[name] = add(g.accessors[p.attributes[name]].type, 5126, c.flatMap((v) => rows(p.attributes[name])[v]));'
run --only=all --quads=pairs flat.gltf out.glb
says "(as 144 quads)"
same_places out.glb obj.glb
run -q --only=all --existing=replace out.glb again.glb
same_places again.glb obj.glb

scene "morph targets are solved on the quads of the base"
inputs "" quads 0
quads 512 >moved.obj
run -q moved.obj moved.glb
gltf bare.gltf morph 'const p = g.meshes[0].primitives[0], moved = open("moved.glb"), to = moved.rows(moved.g.meshes[0].primitives[0].attributes.POSITION);
	p.targets = [{ POSITION: add("VEC3", 5126, rows(p.attributes.POSITION).flatMap((x, v) => x.map((c, k) => to[v][k] - c))) }];'
run --only=all --quads=pairs morph.gltf out.glb
exits 0
same_places out.glb obj.glb
is "$(gltf out.glb '(() => { const p = g.meshes[0].primitives[0], moved = open("moved.glb"), to = moved.rows(moved.g.meshes[0].primitives[0].attributes.TANGENT);
	const base = rows(p.attributes.TANGENT), add = rows(p.targets[0].TANGENT);
	return add.every((d, v) => d.every((c, k) => Math.abs(base[v][k] + c - to[v][k]) < 1e-6)) && add.some((d) => Math.hypot(...d) > 0.1); })()')" true

# Sequential compression keeps the order of triangles and vertices.
scene "Draco in and out"
inputs "" quads 0
apart='(() => { const a = rows(g.meshes[0].primitives[0].attributes.TANGENT), o = open("obj.glb"), b = o.rows(o.g.meshes[0].primitives[0].attributes.TANGENT);
	return Math.max(...a.map((t, v) => Math.acos(Math.min(1, t.slice(0, 3).reduce((s, c, k) => s + c * b[v][k], 0) / Math.hypot(...t.slice(0, 3))))))
		* 180 / Math.PI < 0.1; })()'
run --only=all --draco=sequential --draco-bits=20,20,20,20 cut.gltf kept.glb
run -q --only=all --existing=replace --draco=sequential --draco-bits=20,20,20,20 cut.gltf packed.glb
run -q --check --report=p.json packed.glb
is "$(value p.json '[m["made_by"]["faces"] for m in r["files"][0]["meshes"]]')" "['quads']"
run --only=all --existing=replace --draco=off packed.glb plain.glb
exits 0
says "(as 144 quads)"
is "$(gltf plain.glb "$apart")" true
run -q --only=all --existing=replace --quads=off --draco=off packed.glb off.glb
is "$(gltf off.glb "$apart")" false
gltf packed.glb naked "$strip" 'delete g.meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.attributes.TANGENT;'
run -q --only=all --quads=pairs --draco=off naked.gltf plain.glb
is "$(gltf plain.glb "$apart")" true

# A mark that the file makes is believed, tangents or not; (a b c)(a c d) is what it says, so that the first halves go in.
scene "FB_ngon_encoding says which triangles are quads"
inputs "" quads 0
fans='const fan = (p) => { const c = rows(p.indices).flat(), out = []; let last;
	for (let i = 0; i < c.length; i += 6) { /* (a b d)(b c d) becomes a fan from a, or from b where a was the last one */
		const form = c[i + 3] === c[i] ? [c[i], c[i + 1], c[i + 2], c[i + 5]] : [c[i], c[i + 1], c[i + 4], c[i + 2]];
		const at = form[0] === last ? 1 : 0, [a, b, d, e] = [...form.slice(at), ...form.slice(0, at)];
		out.push(a, b, d, a, d, e), last = a;
	} return out; };
	g.extensionsUsed = ["FB_ngon_encoding"];'
gltf bare.gltf fans "$fans" 'const p = g.meshes[0].primitives[0]; p.extensions = { FB_ngon_encoding: {} };
	p.indices = add("SCALAR", 5125, fan(p));'
run --only=all fans.gltf out.glb
says "(as 144 quads)"
same_places out.glb obj.glb
run --only=all --quads=off fans.gltf out.glb
says_not quads

# Triangles (0 1 2)(0 2 3) are one polygon, (4 2 1) another. 3 folded onto 1 has the first corner of the quad copied, 4 folded
# over the side 1 2 others.
scene "a polygon whose first corner is copied loses its FB_ngon_encoding, one whose other corners are copied keeps it"
while IFS='|' read -r folded marked options said left; do
	gltf new in 'const uvs = [0, 0, 1, 0, 1, 1, 0, 1, 2, 1], up = Array(5).fill([0, 0, 1]).flat(), to = {3: [1, 0], 4: [0, 1]};
		const strip = (v) => ({attributes: {POSITION: add("VEC3", 5126, uvs.flatMap((x, i) => i % 2 ? [x, 0] : [x])),
			NORMAL: add("VEC3", 5126, up), TEXCOORD_0: add("VEC2", 5126, uvs.map((x, i) => i >> 1 === v ? to[v][i % 2] : x))},
			indices: add("SCALAR", 5123, [0, 1, 2, 0, 2, 3, 4, 2, 1]), '"$marked"'});
		g.meshes = [{primitives: ['"$folded"'].map(strip)}]; g.nodes = [{mesh: 0}]; g.scenes = [{nodes: [0]}];
		g.extensionsUsed = ["FB_ngon_encoding"]'
	# shellcheck disable=SC2086
	run --only=all $options in.gltf out.glb
	exits 0
	is "$folded $options: $(grep -c POLYGONS_DROPPED "$WORK/err.txt")" "$folded $options: $said"
	is "$folded $options: $(gltf out.glb '[g.meshes[0].primitives.filter((p) => p.extensions?.FB_ngon_encoding).length, (g.extensionsUsed ?? []).includes("FB_ngon_encoding")].join()')" \
		"$folded $options: $left"
done <<'END'
3|extensions: {FB_ngon_encoding: {}}|--quads=off|1|0,false
4|extensions: {FB_ngon_encoding: {}}||0|1,true
3, 4, 3|extensions: {FB_ngon_encoding: {}}|--quads=off|2|1,true
4|extensions: {FB_ngon_encoding: {}}|--draco=edgebreaker|1|0,false
3|extras: 1||0|0,true
END

scene "other words are refused"
cp "$data/quad.obj" .
run --quads=all quad.obj out.glb
exits 1
says "--quads"
done_testing
