# SPDX-License-Identifier: MIT
# The manifest: one line for each input, valid, and true.
# Leaks count.
. "$ROOT/tests/support/cli.sh"

# The value of a Python expression over m: the lines by input.
value() {
	python3 -c 'import json, sys; m = {l["input"]: l for l in map(json.loads, open(sys.argv[1]))}; print(eval(sys.argv[2]))' \
		"$@"
}

scene "each input has a line that says what became of it"
cp "$data"/mirrored_cube.obj "$data/bumps.png" "$data"/plates.* .
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >bad.obj
run --method=area --manifest=m -d out mirrored_cube.obj plates.gltf bad.obj missing.obj
exits 2
validates --lines manifest m
printf '{"asset": {"version": "2.0"}, x' >json.gltf
printf '{"asset": {"version": "2.0"}, "buffers": [{"uri": "gone.bin", "byteLength": 4}]}' >gone.gltf
run -q --manifest=w --weld -d out json.gltf gone.gltf plates.gltf
validates --lines manifest w
is "$(value w '[{k: e for k, e in m[f]["error"].items() if k != "message"} for f in ("json.gltf", "gone.gltf")]')" \
	"[{'file': 'json.gltf', 'offset': 30}, {'file': 'gone.gltf', 'pointer': '/buffers/0'}]"
is "$(value w '[m["plates.gltf"][k] for k in ("weld_before", "weld_after")]')" "[20, 20]" # none are equal
is "$(value m 'sorted((k, v["status"], v["exit_code"]) for k, v in m.items())')" \
	"[('bad.obj', 'failed', 3), ('mirrored_cube.obj', 'done', 0), ('missing.obj', 'failed', 2), ('plates.gltf', 'done', 0)]"
is "$(value m 'm["bad.obj"]["error"]')" \
	"{'message': 'face refers to \"v\" number 3, but the file has 2', 'file': 'bad.obj', 'line': 3}"
is "$(value m '[d["path"] for d in m["plates.gltf"]["dependencies"]], [d["path"] for d in m["plates.gltf"]["outputs"]]')" \
	"(['plates.gltf', 'plates.bin', 'bumps.png'], ['out/plates.gltf', 'out/bumps.png', 'out/plates.bin'])"
is "$(value m 'sum(d["bytes"] for d in m["plates.gltf"]["outputs"]), m["plates.gltf"]["bytes_written"]')" \
	"($(cat out/plates.* out/bumps.png | wc -c), $(cat out/plates.* out/bumps.png | wc -c))"
is "$(value m 'm["mirrored_cube.obj"]["missing"], m["mirrored_cube.obj"]["findings"]["MTL_MISSING"]')" \
	"(['mirrored_cube.mtl'], 1)"
is "$(value m '[m["plates.gltf"][k] for k in ("triangles", "vertices_before", "vertices_after", "split", "options")]')" \
	"[8, 12, 14, 2, '--method=area']"
is "$(value m '"origin" in m["plates.gltf"], m["plates.gltf"]["fixed"]')" "(False, {})"
# the stages are nearly all of a run; of twenty the scheduler leaves one alone
rest='m["plates.gltf"]["seconds"]["total"] - sum(v for k, v in m["plates.gltf"]["seconds"].items() if k != "total")'
for try in $(seq 20); do
	[ "$(value m "-1e-5 < $rest < 0.01")" != True ] || break
	run -q --manifest=m -d out plates.gltf
done
is "$(value m "-1e-5 < $rest < 0.01")" True

scene "a line has the findings of a check and of a report, and a check's sizes"
run -q "$data/mirrored_cube.obj" a.glb
gltf a.glb wrong 'for (const n of g.meshes.flatMap(m => m.primitives.map(p => p.attributes.TANGENT)))
	for (let i = 0; i < g.accessors[n].count; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12);
	const [p] = g.meshes[0].primitives; g.meshes[0].primitives = [p, p]'
for words in "--check" "--check --report=r.txt" "--check --max-issues=1" "--report=r.json" "--fail-on=error"; do
	to="out.glb"
	[ "${words#--check}" = "$words" ] || to=
	run -q --manifest=m $words wrong.gltf $to
	is "$words: $(value m 'm["wrong.gltf"]["findings"]["TAN_SIGN_MISMATCH"]')" "$words: 40"
done
validates --lines manifest m
run -q --check --manifest=m a.glb "$data/mirrored_cube.obj"
for file in a.glb "$data/mirrored_cube.obj"; do
	is "$(value m '[m["'"$file"'"][k] for k in ("triangles", "vertices_before", "vertices_after", "split")]')" \
		"$([ $file = a.glb ] && echo "[20, 40, 40, 0]" || echo "[20, 32, 40, 8]")"
done

scene "five primitives over the same vertices count them, and each kind of their copies, as one does"
for count in 1 5; do
	gltf new cube$count "const count = $count;" 'const p = [], t = [];
		for (let i = 0; i < 8; i++) { p.push(i >> 2, i >> 1 & 1, i & 1); t.push(i * 0.37 % 1, i * i * 0.23 % 1) }
		const position = add("VEC3", 5126, p, {min: [0, 0, 0], max: [1, 1, 1]}), texcoord = add("VEC2", 5126, t);
		const indices = add("SCALAR", 5123, [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6,
			0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]);
		g.meshes = [...Array(count)].map(() => ({primitives: [
			{attributes: {POSITION: position, TEXCOORD_0: texcoord}, indices}]}));
		g.nodes = g.meshes.map((m, mesh) => ({mesh})); g.scenes = [{nodes: g.nodes.map((n, i) => i)}]; g.scene = 0'
	run --only=all --normals=flat --manifest=m$count cube$count.gltf out$count.gltf
	exits 0
	value m$count '[[l[k] for k in ("vertices_before", "vertices_after", "split")] for l in m.values()]' >counts$count
	grep -o '[0-9][0-9]* -> .*differ)' "$WORK/err.txt" >>counts$count
	is "$(gltf out$count.gltf 'g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count')" \
		"$(value m$count '[l["vertices_after"] for l in m.values()][0]')"
done
same counts1 counts5
# what stays and what Draco has are counted so, too
run -q --only=all --normals=flat cube5.gltf kept.gltf
run --only=all --existing=repair kept.gltf out.gltf
says ", 26 vertices,"
gltf kept.gltf twice 'const n = g.meshes.map((m) => m.primitives[0]); for (const p of n) { delete p.attributes.TANGENT }'
for words in --weld "--weld --draco=sequential"; do
	run --only=all $words twice.gltf out.glb
	says ", 26 vertices"
done
grep -q '+16 where made normals differ' counts5 || wrong "of 24 corners of the sides 8 are there: $(cat counts5)"

scene "digests tell whose tangents, outputs and missing files have changed"
printf 'newmtl bumps\nKd 1 0 0\nmap_Kd none.png\n' >mirrored_cube.mtl
cp "$data/mirrored_cube.obj" .
digests() { value "$1" '[(l["tangents"], l["outputs"][0]["xxh128"], l["missing_digest"]) for l in m.values()][0]'; }
run -q --manifest=m -d out mirrored_cube.obj
validates --lines manifest m
! command -v xxhsum >/dev/null ||
	is "$(value m 'm["mirrored_cube.obj"]["outputs"][0]["xxh128"]')" "$(xxhsum -H2 out/mirrored_cube.glb | cut -d' ' -f1)"
digests m >before
change() { # what is another than before, as letters
	run -q -j$1 --manifest=m -d out mirrored_cube.obj
	digests m >now
	python3 -c 'a, b = (eval(open(f).read()) for f in ("before", "now"))
print("".join(c if x != y else "-" for c, x, y in zip("tom", a, b)))'
}
is "$(change 2)" "---"
sed -i 's/Kd 1/Kd 0/' mirrored_cube.mtl
is "$(change 1)" "-o-"
sed -i 's/none/nowhere/' mirrored_cube.mtl
is "$(change 1)" "-om"
awk '$1 == "vt" { $2 = -$2 } 1' "$data/mirrored_cube.obj" >mirrored_cube.obj
is "$(change 2)" "tom"

scene "what was left, up to date or not tried has a line, too"
cp "$data/quad.obj" a.obj
cp "$data/quad.obj" c.obj
run -d out a.obj
run --write-if-changed --manifest=m -d out a.obj
is "$(value m '[l["status"] for l in m.values()]')" "['left']"
later
run --update --manifest=m -d out a.obj
run --update --manifest=m --fail-fast -j1 -d out a.obj b.obj c.obj
exits 2
validates --lines manifest m
is "$(value m '[l["status"] for l in m.values()]')" "['up-to-date', 'failed', 'untried']"
is "$(value m '[d["path"] for d in m["a.obj"]["dependencies"]]')" "['a.obj']"

scene "each run spells a file in the same way, whether it was made, left or up to date"
mkdir -p in/tex here
printf 'newmtl m\nmap_Kd tex/n.png\nmap_Ks gone.png\n' >in/m.mtl
cp "$data/bumps.png" in/tex/n.png
{ echo 'mtllib m.mtl'; sed 's/^f/usemtl m\nf/' "$data/quad.obj" | grep -v ^mtllib; } >in/a.obj
ln -s in/a.obj link.obj
mkdir real
ln -s real out3
paths='[[d["path"] for d in l["outputs"] + l["dependencies"]] + l["missing"] + l["searched"] + [l.get("missing_digest")] for l in m.values()]'
while IFS='|' read -r folder input output; do
	cd "$WORK/here/$folder" || exit
	run -q --manifest=first -d $output $input
	later
	run -q --update=content --manifest=m -d $output $input
	first=$(value first "$paths")
	for options in --update --write-if-changed; do
		run -q $options --manifest=m -d $output $input
		is "$folder|$input|$output $options: $(value m "$paths")" "$folder|$input|$output $options: $first"
		is "$(value m '[l["status"] for l in m.values()]')" "['$([ $options = --update ] && echo up-to-date || echo left)']"
	done
done <<END
.|in/a.obj|out
.|./in/a.obj|./out2
.|in/a.obj|out3
.|link.obj|out4
here|../in/a.obj|../out5
here|../in/./a.obj|../out8
here|../in/tex/../a.obj|../out9
.|$PWD/in/a.obj|$PWD/out6
.|$PWD/in/a.obj|out7
in|a.obj|.
END
cd "$WORK/here"
run -q --update --manifest=m -d out in/a.obj
is "$(value m '[d["path"] for l in m.values() for d in l["outputs"] + l["dependencies"]]')" \
	"['out/a.glb', 'in/a.obj', 'in/m.mtl', 'in/tex/n.png']"

scene "a path through a link stays as it is spelled: without its .. it would name another file"
mkdir -p real/sub here
cp "$data"/plates.* "$data/bumps.png" real
ln -s ../real/sub here/link
echo other >here/plates.bin
cd here
run -q --manifest=m link/../plates.gltf o.glb
exits 0
is "$(value m '[d["path"] for l in m.values() for d in l["dependencies"]]')" \
	"['link/../plates.gltf', 'link/../plates.bin', 'link/../bumps.png']"
cd ..

scene "findings that fail are in the exit code, and --check has a manifest"
cp "$data/mirrored_cube.obj" a.obj
run --check -q --fail-on=warning --manifest=m a.obj
exits 6
validates --lines manifest m
is "$(value m 'm["a.obj"]["exit_code"], m["a.obj"]["outputs"]')" "(6, [])"

scene "a manifest is no input, and its failure is told"
cp "$data/quad.obj" a.obj
run --manifest=a.obj -d out a.obj
exits 2
says "a.obj: refusing to write: it is the same file as the input a.obj"
same a.obj "$data/quad.obj"
for content in text '{"inpu' '{"output": 1}'; do
	printf %s "$content" >m
	run --manifest=m -d none a.obj
	exits 2
	says "m: refusing to write: the file exists already and is no manifest"
	is "$(cat m)" "$content"
done
is "$(ls none)" ""
: >m
run -q --manifest=m -d out a.obj
exits 0
run --manifest=/dev/full -d out a.obj
exits 2
says "/dev/full: cannot write the manifest: No space left on device"
run --manifest=no/m -d out a.obj
exits 2
says "no/m: cannot write: there is no folder \"no\""

scene "standard output can have it, and many failures are found there"
for i in $(seq 12); do
	yes 'v 0 0 0' | head -$i >bad$i.obj
	echo "f 1 2 99" >>bad$i.obj
done
run -q --manifest=- -d out bad*.obj
exits 3
is "$(wc -l <"$WORK/out.txt")" 12
run --manifest=m -d out bad*.obj
says "2 failed for other reasons, which are in m"

# Two squares side by side in one set of six vertices; the right one is mirrored, so that the two vertices at the border
# need a copy. The third primitive is the first again.
scene "vertices that primitives share are counted once, and so are their copies"
gltf new pair 'const attributes = {POSITION: add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0]),
		NORMAL: add("VEC3", 5126, Array(6).fill([0, 0, 1]).flat()),
		TEXCOORD_0: add("VEC2", 5126, [0, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 0])};
	const square = a => ({attributes, indices: add("SCALAR", 5125, [a, a + 1, a + 4, a, a + 4, a + 3])});
	g.meshes = [{primitives: [square(0), square(1), square(0)]}]; g.nodes = [{mesh: 0}]'
run --only=all --manifest=m pair.gltf out.gltf
exits 0
says "3 primitives, 6 triangles, 6 -> 8 vertices (+2 where tangents differ)"
is "$(value m '[m["pair.gltf"][k] for k in ("vertices_before", "vertices_after", "split")]')" "[6, 8, 2]"
run -q --check --manifest=m out.gltf
is "$(value m '[m["out.gltf"][k] for k in ("triangles", "vertices_before", "vertices_after", "split")]')" "[6, 24, 24, 0]" # each of three has eight, as in its report
is "$(gltf out.gltf 'g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count')" 8

# A quad of four points on a line, and one of two points: four triangles without area in both reports. A conversion alone
# does not look for them.
scene "a conversion counts no triangles otherwise than its report does"
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n' >flat.obj
printf 'f 1/1/1 2/2/1 3/3/1 4/4/1\nf 1/1/1 1/2/1 2/3/1 2/4/1\nf 1/1/1 2/2/1 5/3/1\n' >>flat.obj
run --report=r.json --manifest=m flat.obj out.gltf
run --check --report=c.json flat.obj
for report in r c; do
	is "$report $(python3 -c 'import json; print([f["count"] for f in json.load(open("'$report'.json"))["files"][0]["findings"]
		if f["code"] == "POS_DEGENERATE_TRIANGLE"])')" "$report [4]"
done
is "$(value m 'm["flat.obj"]["findings"]["POS_DEGENERATE_TRIANGLE"]')" 4
run --manifest=m flat.obj out.gltf
is "$(value m '"POS_DEGENERATE_TRIANGLE" in m["flat.obj"]["findings"]')" False
echo 'f 1/1/1 2/2/1 3/2/1' >>flat.obj # without area in UV space either: the solve counts it, a report does not
run -q --check --report=c.json --manifest=m flat.obj
is "$(value m 'sorted(m["flat.obj"]["findings"])')" "$(python3 -c 'import json
print(sorted({f["code"] for f in json.load(open("c.json"))["files"][0]["findings"]}))')"


# NORMALS_MADE (an info) and UV_FOLDED_QUAD (a warning) are what stages find, UV_MIRROR_SEAM (an info) is what a check finds.
scene "a line leaves out what --min-severity, --severity and --ignore hide, whoever found it"
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3 4/4\n' >fold.obj
while IFS='|' read -r words codes; do
	run -q --fail-on=never --report=r.json --manifest=m $words fold.obj out.ply
	is "$words: $(value m '" ".join(c for c in ("NORMALS_MADE", "UV_FOLDED_QUAD", "UV_MIRROR_SEAM") if c in m["fold.obj"]["findings"])')" "$words: $codes"
done <<'END'
|NORMALS_MADE UV_FOLDED_QUAD UV_MIRROR_SEAM
--min-severity=warning|UV_FOLDED_QUAD
--min-severity=error|
--min-severity=warning --severity=UV_FOLDED_QUAD=info|
--ignore=NORMALS_MADE,UV_MIRROR_SEAM|UV_FOLDED_QUAD
END

done_testing
