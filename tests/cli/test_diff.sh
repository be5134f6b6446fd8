# SPDX-License-Identifier: MIT
# --check --diff: what changed between two versions of an asset.
. "$ROOT/tests/support/cli.sh"

# Two separate unit squares in the plane z = 0; $1: the corners' texture coordinates of the second one, $2: a swap of lines.
squares() {
	printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\n'
	printf 'vn 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n'
	set -- $1
	printf 'f 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/%s/1 6/%s/1 7/%s/1 8/%s/1\n' "$@"
}

scene "what did not change is not told, whatever numbers it has"
squares "1 2 3 4" >old.obj
{ sed -n '/^v/p' old.obj; printf 'f 7/3/1 8/4/1 5/1/1\nf 5/1/1 6/2/1 7/3/1\nf 2/2/1 3/3/1 1/1/1\nf 3/3/1 4/4/1 1/1/1\n'; } >new.obj
run -q old.obj old.glb
run -q new.obj new.glb
run --check --diff --fail-on=info old.glb new.glb
exits 0
prints "old.glb -> new.glb: 0 new findings, 0 gone, 1 unchanged; 0 of 1 meshes changed"

# The second square's texture is turned by a quarter: T goes from (1,0,0) to (0,-1,0). Then it is mirrored: w changes, T too.
scene "turned tangents are counted with their angles, mirrored ones by w"
squares "1 2 3 4" >old.obj
squares "2 3 4 1" >turned.obj
squares "2 1 4 3" >mirrored.obj
for name in old turned mirrored; do run -q $name.obj $name.glb; done
run -q --check --diff --report=d.json old.glb turned.glb
validates diff d.json
is "$(value d.json '[(m["triangles_in_place"], m["corners_with_other_texcoords"], m["tangents"]["compared"],
	m["tangents"]["turned"], m["tangents"]["reversed_w"], round(m["tangents"]["worst_degrees"], 3),
	[h["corners"] for h in m["tangents"]["histogram"]]) for m in r["meshes"]]')" \
	"[(4, 6, 12, 6, 0, 90, [6, 0, 0, 0, 0, 6])]"
run -q --check --diff --report=d.json old.glb mirrored.glb
is "$(value d.json '[(m["tangents"]["turned"], m["tangents"]["reversed_w"], round(m["tangents"]["worst_degrees"], 3))
	for m in r["meshes"]]')" "[(6, 6, 180)]"
is "$(value d.json '[f["code"] for f in r["new_findings"]]')" "['UV_MIRROR_OVERLAP']"
run -q --check --diff --report=back.json mirrored.glb old.glb
is "$(value back.json '[f["code"] for f in r["gone_findings"]], r["new_findings"]')" "(['UV_MIRROR_OVERLAP'], [])"
# an OBJ is compared as it would be converted
run --check --diff mirrored.obj mirrored.glb
prints "0 of 12 tangents turned"

scene "new findings decide the exit code, old ones do not"
squares "1 2 3 4" >old.obj
sed 's/^vt 1 1$/vt 1 0/' old.obj >flat.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/3/1 3/2/1\n' >lone.obj
run --check --diff --fail-on=warning --severity=UV_MIRROR_LONE=warning old.obj lone.obj
exits 6
prints "new   warning  UV_MIRROR_LONE"
run --check --diff --fail-on=warning --severity=UV_MIRROR_LONE=warning lone.obj old.obj
exits 0
prints "gone  warning  UV_MIRROR_LONE"
run --check --diff --fail-on=warning --severity=UV_MIRROR_LONE=warning lone.obj lone.obj
exits 0
run --check --diff --report=d.md --fail-on=warning --severity=UV_MIRROR_LONE=warning old.obj lone.obj
exits 6
grep -q '^| warning | `UV_MIRROR_LONE` |' d.md || wrong "no row of the new finding"

scene "a page has both versions, what is new and gone, and names as text"
{ echo 'mtllib nowhere.mtl'; echo 'o </script><script>window.broken=1</script>'; squares "2 1 4 3"; } >old.obj
sed 's/^f 5.*/f 5\/1\/1 6\/2\/1 7\/3\/1 8\/4\/1/' old.obj >new.obj
run --check --diff --report=d.html old.obj new.obj
exits 0
is "$(value d.html '[f["name"] for f in r["files"]], r["diff"]["unchanged"] > 0')" "(['old.obj', 'new.obj'], True)"
is "$(value d.html '[[x["code"] for x in f["findings"] if not x["known"]] for f in r["files"]]')" "[['UV_MIRROR_OVERLAP'], []]"
is "$(value d.html '[(m["old"], m["new"], m["changed"], m["rows"][0][1]) for m in r["diff"]["meshes"]]')" \
	"[(0, 0, True, '6 of 12 tangents turned, by 180 degrees at most, 6 with w reversed')]"
grep -c '<script' d.html >scripts.txt
is "$(cat scripts.txt)" 4 # what there is, what shows it, a mesh of each version
# a vertex on the border of mirrored and unmirrored triangles is split, one of a tile of its own is not
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nvt 1 1\nf 1/1/1 2/2/1 3/3/1\n' >whole.obj
{ cat whole.obj; echo 'f 2/2/1 4/4/1 3/3/1'; } >plain.obj
{ cat whole.obj; echo 'f 2/2/1 4/1/1 3/3/1'; } >folded.obj
run --check --diff --report=f.html plain.obj folded.obj
is "$(value f.html '[(dict(m["rows"])["vertices"], dict(m["rows"])["split for tangents"]) for m in r["diff"]["meshes"]]')" "[('4 -> 6', '0 -> 2')]"
run --check --diff --threads=1 --report=d1.html old.obj new.obj
cmp d.html d1.html || wrong "one thread writes another page"
run --check --diff --report=same.html new.obj new.obj
is "$(value same.html '[m["changed"] for m in r["diff"]["meshes"]], [x["code"] for f in r["files"] for x in f["findings"] if not x["known"]]')" "([False], [])"

scene "wrong uses are refused"
cp "$data/quad.obj" .
run --check --diff quad.obj
exits 1
says "an old one and a new one"
run --diff quad.obj out.glb
exits 1
says "--diff needs --check: nmtan --check --diff OLD NEW"
run --check --diff --report=r.sarif quad.obj quad.obj
exits 1
says "text, JSON, Markdown or HTML"
run --check --diff --report=pages/ quad.obj quad.obj
exits 1
says "to one file"
run --check --diff --baseline=b.json quad.obj quad.obj
exits 1
run --check --diff quad.obj nothing.obj
exits 2
run --check --diff --report=/dev/full --report-format=json quad.obj quad.obj
exits 2
says "/dev/full"
only quad.obj
done_testing
