# SPDX-License-Identifier: MIT
# The HTML report in a real browser, alone and in the page of make web.
. "$ROOT/tests/support/cli.sh"
modules=$ROOT/build/node

# A plain quad at u 0..0.4 with a triangle that has no UV area and one that has none at all, and a mirrored quad at u 0.6..1 with a name
# that tries to be a script.
two_quads() {
	echo "o plain"
	printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '10 0 0' '11 0 0' '11 1 0' '10 1 0' '0 1.1 0' '1 1.1 0' '0 1.5 0'
	printf 'vt %s\n' '0 0' '0.4 0' '0.4 1' '0 1' '1 0' '0.6 0' '0.6 1' '1 1'
	printf '%s\n' "vn 0 0 1" "f 1/1/1 2/2/1 3/3/1 4/4/1" "f 9/1/1 10/1/1 11/1/1" "f 9/1/1 9/2/1 10/3/1" \
		"o </script><script>window.broken=1</script>" "f 5/5/1 6/6/1 7/7/1 8/8/1"
}

# A grid of 2 n^2 triangles, mirrored at its middle.
grid() {
	awk -v n="$1" 'BEGIN {
	for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) {
		printf "v %d %d %.3f\nvt %.5f %.5f\n", i, j, sin(i * j / 9000), (i < n / 2 ? i : n - i) / n, j / n }
	for (i = 0; i < n; i++) for (j = 0; j < n; j++) { a = i * (n + 1) + j + 1; b = a + n + 1
		printf "f %d/%d %d/%d %d/%d %d/%d\n", a, a, b, b, b + 1, b + 1, a + 1, a + 1 } }'
}

scene "an image that several meshes have is in a page once, however many of them it shows"
run --check --report=twice.html --fail-on=never "$data/transformed.gltf"
exits 0
[ "$(grep -ao '"images":\[{"image":[0-9]' twice.html | wc -l)" -gt 1 ] || wrong "no two meshes have an image"
[ "$(grep -ao 'data:image/png;base64,[^"]*' twice.html | sort | uniq -d | wc -l)" = 0 ] || wrong "an image is there twice"

scene "without JavaScript a page says which options write its findings as text"
for words in "--check $data/mirrored_cube.obj" "--check --diff $data/quad.obj $data/mirrored_cube.obj" "$data/mirrored_cube.obj out.glb"; do
	run -q --fail-on=never --report=r.html $words
	run -q --fail-on=never $(sed -n 's/.*<noscript>.*<code>\(.*\)<\/code>.*/\1/p' r.html) $words
	exits 0
	grep -q UV_MIRROR_SEAM report.txt || wrong "$words: report.txt has no findings"
	rm report.txt
done

# A browser shows the same for every build that made the page; sanitizers look at its making alone.
case $BUILD in *sanitize*) browses=false side=60 ;; *) browses=true side=300 ;; esac

# The page as a browser without modules makes it.
shown() {
	timeout 120 "${CHROMIUM:-/usr/bin/chromium}" --headless --no-sandbox --disable-gpu --virtual-time-budget=8000 \
		--dump-dom "file://$PWD/$1" 2>/dev/null
}

scene "an index sums what its rows have, and a finding that is gone has no command"
cp "$data"/{plates.gltf,plates.bin,bumps.png} .
sed 's/plates.bin/gone.bin/' plates.gltf >bad.gltf
run --check --report=index.html --fail-on=never bad.gltf plates.gltf
run --check --fail-on=never --report-format=text bad.gltf plates.gltf
is "$(grep -c '^  1 error, 0 warnings, 0 infos$' ../out.txt) $(tail -1 ../out.txt)" "1 2 files: 2 errors, 0 warnings, 4 infos"
run -q --fix plates.gltf fixed.gltf
run --check --diff --report=gone.html --fail-on=never plates.gltf fixed.gltf
run --check --diff --report=new.html --fail-on=never fixed.gltf plates.gltf
if ! $browses; then
	:
elif [ ! -x "${CHROMIUM:-/usr/bin/chromium}" ]; then
	skip_case "chromium is not installed"
else
	shown index.html >index.dom
	is "$(grep -o '>2 errors<' index.dom | head -1) $(grep -o '<td class="numeric error">1</td>' index.dom | wc -l)" ">2 errors< 2"
	is "$(shown new.html | grep -c 'class="command"><code>nmtan --fix plates.gltf') $(shown gone.html | grep -c 'class="command"')" "1 0"
fi

scene "pages of small, large, many and broken meshes work in Chromium: findings, views, frames, keys, links, names as text"
two_quads >two.obj
run --ignore=TAN_UNUSED --severity=UV_DEGENERATE_TRIANGLE=warning --report=two.html two.obj two.glb
exits 0
run --check --report=head.html "$data/head.obj"
exits 0
grid $side >large.obj
run --check --report=large.html large.obj
exits 0
grep -aq "\"triangles\":$((2 * side * side)),\"whole\":true" large.html || wrong "it is not whole"
awk 'BEGIN { print "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1"; for (i = 0; i < 20000; i++) printf "v %d 0 0\nv %d 0 0\nv %d 1 0\nv %d 1 0\nf -4/1 -3/2 -2/3 -1/4\n", 2 * i, 2 * i + 1, 2 * i + 1, 2 * i }' >stacked.obj
run --check --report=stacked.html --fail-on=never stacked.obj
mkdir many
cp "$data/head.obj" many/head.obj
printf 'v 0 0 0\nv 1 0 0\nf 1 2 7\n' >many/bad.obj
for i in $(seq 498); do cp "$data/quad.obj" "many/q$i.obj"; done
run --check --report=many.html --fail-on=never many/*.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n' >lines.obj
printf 'o <img src=x onerror=window.broken=1>\001\377"\047</script>\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >'"><script>window.broken=1.obj'
printf '# nothing\n' >empty.obj
run --check --report=bad.html --fail-on=never lines.obj empty.obj '"><script>window.broken=1.obj' "$data/mirrored_cube.obj"
{ echo 'o </script><script>window.broken=1</script>'
	printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '5 0 0' '6 0 0' '6 1 0' '5 1 0'
	printf 'vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n'; } >squares.obj
{ cat squares.obj; echo 'f 5/2/1 6/1/1 7/4/1 8/3/1'; } >mirrored.obj
{ cat squares.obj; echo 'f 5/1/1 6/2/1 7/3/1 8/4/1'; } >plain.obj
run --check --diff --report=diff.html mirrored.obj plain.obj
exists two.html head.html large.html many.html bad.html diff.html
run --check --report=pages/ --fail-on=never many/head.obj many/bad.obj many/q[12]?.obj many/q[1-9].obj many/q30.obj '"><script>window.broken=1.obj'
exists pages/index.html

# two quads, u 0.1 to 0.4 and 1.1 to 1.6, v 0.1 to 0.9
{ printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\nvn 0 0 1\n'
	printf 'vt %s\n' '0.1 0.1' '0.4 0.1' '0.4 0.9' '0.1 0.9' '1.1 0.1' '1.6 0.1' '1.6 0.9' '1.1 0.9'
	printf 'f 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/5/1 6/6/1 7/7/1 8/8/1\n'; } >tiles.obj
sed 's/^vt 1.6/vt 500/' tiles.obj >far.obj
python3 "$ROOT/tests/support/images.py" write n.png 32 32 '(128, 128, 255)'
run -q tiles.obj tiles.gltf
for wrapped in 'mirrored {}' 'shifted {KHR_texture_transform: {offset: [0.35, 0]}}'; do
	gltf tiles.gltf "${wrapped%% *}" "const extensions = ${wrapped#* };" 'Object.assign(g, {images: [{uri: "n.png"}],
		samplers: [{wrapS: 33648, wrapT: 10497}], textures: [{source: 0, sampler: 0}],
		materials: [{normalTexture: {index: 0, extensions}}], extensionsUsed: ["KHR_texture_transform"]});
		g.meshes[0].primitives[0].material = 0'
done
sed 's/^vt 1.6 0.9/vt 900 900/' tiles.obj >farther.obj
run --check --report=tiles.html --fail-on=never tiles.obj mirrored.gltf shifted.gltf far.obj farther.obj
exists tiles.html

# twelve findings of one code
for i in $(seq 12); do
	printf 'o %d\nv 0 0 0\nv %d 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf -3/-3 -2/-2 -1/-1\nf -3/-3 -3/-2 -1/-1\n' $i $i
done >twelve.obj
run --check --report=twelve.html --fail-on=never twelve.obj

# a quad on the left half of the texture, with a normal map and a red base colour: files, of which one gets lost, and in the glTF
mkdir tex
python3 "$ROOT/tests/support/images.py" write tex/red.png 8 8 '(255, 0, 0)'
# one that a browser shows and nmtan does not decode, and its copy, which gets lost
printf 'GIF89a\1\0\1\0\200\0\0\377\0\0\0\0\0!\371\4\0\0\0\0\0,\0\0\0\0\1\0\1\0\0\2\2D\1\0;' >tex/red.gif
cp tex/red.gif tex/lost.gif
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n' >half.obj
run -q half.obj half.gltf
while read -r name set uri; do
	gltf half.gltf $name "const uri = '$uri', texCoord = $set;" 'Object.assign(g, {images: [{uri: "n.png"}, {uri}],
		textures: [{source: 0}, {source: 1}],
		materials: [{normalTexture: {index: 0}, pbrMetallicRoughness: {baseColorTexture: {index: 1, texCoord}}}]});
		g.meshes[0].primitives[0].material = 0'
done <<END
red 0 tex/red.png
file 0 tex/red.gif
lost 0 tex/lost.gif
inside 0 data:image/png;base64,$(base64 -w 0 tex/red.png)
other 1 tex/red.png
END
run --check --report=pictures.html --fail-on=never red.gltf file.gltf lost.gltf inside.gltf other.gltf
grep -ao '"image":[0-9nul]*,"map":[^]]*\],"file":[^}]*' pictures.html | sed 's/"map":[^]]*.,//' >images.txt
is "$(cat images.txt)" '"image":0,"file":"n.png"
"image":1,"file":"tex/red.png"
"image":0,"file":"n.png"
"image":null,"file":"tex/red.gif"
"image":0,"file":"n.png"
"image":null,"file":"tex/lost.gif"
"image":0,"file":"n.png"
"image":1,"file":null
"image":0,"file":"n.png"
"image":null,"file":null'
rm tex/lost.gif
# a large one is there small, also that of an OBJ's material, of a type that no browser shows
python3 "$ROOT/tests/support/images.py" write large.tga 1500 750 '(x * y % 256, x // 6, y // 3)'
{ printf 'mtllib large.mtl\nusemtl m\n'; cat half.obj; } >texture.obj
printf 'newmtl m\nmap_Kd large.tga\n' >large.mtl
run --check --report=small.html --fail-on=never texture.obj
value small.html 'r["images"][0]' | sed 's/.*base64,//' | base64 -d >small.jpg
is "$(python3 -c 'import sys; b = open("small.jpg", "rb").read(); i = b.index(b"\xff\xc0"); print(b[i+7]*256 + b[i+8], b[i+5]*256 + b[i+6])')" "1024 512"
# a finding with votes of blocks: up and down above, nothing and down below
python3 -c 'import json, re
text = open("pictures.html", encoding="utf-8").read()
page = re.search(r"id=\"data\">(.*?)</script>", text, re.S)
data = json.loads(page.group(1))
data["files"][0]["findings"][0]["votes"] = [[90, -60], [5, -80]]
open("votes.html", "w", encoding="utf-8").write(text[:page.start(1)] + json.dumps(data).replace("<", "\\u003c") + text[page.end(1):])'
# w as it should be, and the reverse
python3 "$ROOT/tests/support/images.py" write slope.png 32 32 '(128, 210, 220)'
gltf half.gltf slope 'Object.assign(g, {images: [{uri: "slope.png"}], textures: [{source: 0}],
	materials: [{normalTexture: {index: 0}}]}); g.meshes[0].primitives[0].material = 0'
run -q slope.gltf right.gltf
gltf right.gltf wrong 'const n = g.meshes[0].primitives[0].attributes.TANGENT, b = bytes[0];
	for (let i = 0; i < g.accessors[n].count; i++) b.writeFloatLE(-b.readFloatLE(at(n, i) + 12), at(n, i) + 12)'
run --check --diff --report=lit.html wrong.gltf right.gltf
cp wrong.gltf "./-\$(touch broken)'.gltf"
run --check --report=names.html --fail-on=never -- "-\$(touch broken)'.gltf"
exists lit.html names.html twelve.html
run --check --report=below/ --fail-on=never red.gltf
grep -aq '"file":"../tex/red.png"' below/red.gltf.html || wrong "a page in a folder does not find the image"
run --check --report-format=html --fail-on=never red.gltf
prints '"file":null}],"wrap"'

run --check --threads=1 --report=large.1.html large.obj
cmp large.html large.1.html || wrong "one thread writes another page"
if ! $browses; then
	:
elif [ -f "$modules/node_modules/playwright-core/package.json" ] && command -v chromium >/dev/null 2>&1; then
	web=$ROOT/build/web
	env -u MAKEFLAGS make -s -C "$ROOT" build/web/report.html build/web/report.css build/web/report.js >make.txt 2>&1 ||
		wrong "make web: $(cat make.txt)"
	node "$ROOT/tests/report/page.mjs" "$modules" . "$web" >page.txt 2>&1 || wrong "$(head -c 3000 page.txt)"
else
	skip_case "chromium or playwright-core is not installed"
fi

# The page's data of the first mesh's normal map: what it is, and where it is looked up.
normal_map() {
	grep -ao '"image":[0-9]*,"map":[^]]*]' "$1" | head -1
	grep -ao 'data:image/[a-z]*' "$1" | head -1
}

scene "the lit mesh has the normal map as a conversion leaves it, where its transform puts it"
{ printf 'mtllib m.mtl\nusemtl m\n'; grep -v '^#\|^usemtl\|^mtllib' "$data/quad.obj"; } >quad.obj
printf 'newmtl m\nnorm -s 2 4 1 -o 0.25 0.5 0 n.tga\n' >m.mtl
python3 "$ROOT/tests/support/images.py" write n.tga 32 16 '(128 + (7 * x) % 60, 128, 240)'
run --check --report=quad.html --fail-on=never quad.obj
# v pointing up is 4 v + 0.5, so that v' = 1 - (4 (1 - v) + 0.5) = 4 v - 3.5
is "$(normal_map quad.html)" '"image":0,"map":[2,0,0.25,0,4,-3.5]
data:image/png'
run --report=converted.html quad.obj quad.glb
is "$(normal_map converted.html)" "$(normal_map quad.html)"
# a glTF's images are those of the source, wherever the output has them
run --images=copy --buffers=embed quad.obj quad.gltf
run --check --report=quad.html quad.gltf
run --check --report=quad.json quad.gltf
mkdir out
for output in out/quad.glb out/quad.gltf linked.gltf; do
	run --images=$([ $output = linked.gltf ] && echo link || echo copy) --report=converted.html quad.gltf $output
	is "$output $(normal_map converted.html | wc -c)" "$output $(normal_map quad.html | wc -c)"
	run --report=converted.json quad.gltf $output
	is "$output $(value converted.json '[i["texel_density"] for m in r["files"][0]["meshes"] for i in m["islands"]]')" \
		"$output $(value quad.json '[i["texel_density"] for m in r["files"][0]["meshes"] for i in m["islands"]]')"
	! grep -q '"texel_density":null' converted.json || wrong "$output has no density"
done
run --check --report=turned.html --fail-on=never "$data/transformed.gltf"
# by a quarter: u' = v + 0.5, v' = 7 - u
is "$(normal_map turned.html | sed 's/[0-9.]*e-17/0/g')" '"image":0,"map":[0,1,0.5,-1,0,7]
data:image/png'

# The front of the cube and what it folds to: the picture has them behind the one mirror seam, JSON has mirror seams alone.
scene "hard edges are in the picture, behind the mirror seams"
run --check --report=cube.html --fail-on=never "$data/mirrored_cube.obj"
is "$(grep -ao '"seams":\[\[[^}]*' cube.html)" '"seams":[[4,true,8,"x = 0",0,0],[2,false,4,"",0,0,1]]'
is "$(grep -ao '"code":"UV_HARD_EDGE".*"seam":[0-9]*' cube.html | grep -o '"seam":[0-9]*' | tr '\n' ' ')" '"seam":1 '
run --check --report=cube.json --fail-on=never "$data/mirrored_cube.obj"
is "$(value cube.json '[len(r["files"][0]["meshes"][0]["seams"]), [f["seam"] for f in r["files"][0]["findings"] if f["code"] == "UV_HARD_EDGE"]]')" '[1, [None]]'

done_testing
