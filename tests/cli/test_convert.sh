# SPDX-License-Identifier: MIT
# The main job on the meshes of data/.
# Leaks count.
. "$ROOT/tests/support/cli.sh"

scene "an OBJ becomes a GLB with tangents and one line says so"
run "$data/quad.obj" quad.glb
exits 0
only quad.glb
is "$(wc -l <"$WORK/err.txt")" 1
says "1 primitive"
says "2 triangles"
# An upright quad: T along x, w = +1 in glTF.
is "$(gltf quad.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT)')" \
	"[[1,0,0,1],[1,0,0,1],[1,0,0,1],[1,0,0,1]]"

scene "quiet says nothing"
run -q "$data/quad.obj" quad.glb
exits 0
silent

scene "but for what is left out of the output"
{ echo 'mtllib m.mtl'; echo 'usemtl b'; cat "$data/quad.obj"; } >q.obj
printf 'newmtl b\nmap_Kd nowhere.png\ndisp h.png\nPr x\n' >m.mtl
run -q q.obj q.glb
exits 0
is "$(cat "$WORK/err.txt")" "nmtan: q.obj: missing from the output: 1 IMAGE_MISSING, 2 MATERIAL_LOST; material \"b\" has none of its images"
run -q --ignore=IMAGE_MISSING,MATERIAL_LOST q.obj q.glb
silent

scene "and properties of a PLY that glTF has no place for"
sed 's/^property float x$/property float quality\n&/; /^end_header/q' "$data/quad_ascii.ply" >q.ply
sed '1,/^end_header/d; /^[0-9]* [0-9]* [0-9]* [0-9]*$/!{/^[34] /!s/^/0.5 /}' "$data/quad_ascii.ply" >>q.ply
run -q q.ply q.glb
exits 0
is "$(cat "$WORK/err.txt")" "nmtan: q.ply: missing from the output: 1 REFERENCE_LOST"
run q.ply q.glb
says "1 part of the input is not in the output: vertex quality"
run -q q.ply again.ply
silent

scene "what an output of another format lacks is told alike, by a quiet conversion and a check, and of no format that has it"
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'vt 0 0' 'vt 1 0' 'vt 0 1' 'f 1/1 2/2 3/3' 'l 1 2' 'l 2 3' 'p 1' 'curv 0 1 1 2' 'f 1 2' >l.obj
python3 - <<'END'
head = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property float s
property float t
element face 2
property list uchar int vertex_indices
property uchar flags
element edge 1
property int vertex1
property int vertex2
element none 0
property int a
element user 2
property list uchar int a
end_header
0 0 0 0 0
1 0 0 1 0
0 1 0 0 1
3 0 1 2 7
2 0 1 7
0 1
1 5
0
"""
open("e.ply", "w").write(head)
END
gltf "$data/plates.gltf" g 'const p = g.meshes[0].primitives[0];
	g.meshes[0].primitives.push({...p, mode: 0}); g.meshes.push({primitives: [p]});
	Object.assign(p.attributes, {TEXCOORD_1: p.attributes.TEXCOORD_0, _HEAT: p.attributes.TEXCOORD_0, COLOR_1: p.attributes.POSITION})'
while IFS='|' read -r input output place count list; do
	told="$count parts of the input are not in the output: $list"
	run "$input" "$output"
	exits 0
	says "nmtan: $input:${place}warning: $told [REFERENCE_LOST]"
	run -q "$input" "$output"
	is "$input: $(cat "$WORK/err.txt")" "$input: nmtan: $input: missing from the output: $count REFERENCE_LOST"
	run --check -q --fail-on=never --report=r.json -o "$output" "$input"
	is "$input: $(value r.json '[f["message"] for f in r["files"][0]["findings"] if f["code"] in ("REFERENCE_LOST", "STATEMENT_IGNORED")]')" \
		"$input: ['$told']"
done <<'END'
l.obj|o.glb|8: |5|faces of fewer than three corners (1), lines (2), points (1), curves (1)
l.obj|o.ply|8: |5|faces of fewer than three corners (1), lines (2), points (1), curves (1)
e.ply|o.glb|11: |4|face flags, element edge (1), element user (2), faces of fewer than three corners (1)
g.gltf|o.ply| |16|materials (3), primitives of points or lines (1), primitives that no scene shows (1), further sets of texture coordinates (3), other attributes (6), extras (1), textures (1)
END
run -v e.ply o.ply
says_not LOST
says_not "not used"
run --check --fail-on=never e.ply
is "$(grep -c "LOST\|IGNORED" "$WORK/out.txt")" 0

scene "vertices on a mirror seam are split, and no others"
cp "$data/bumps.png" .
run "$data/mirrored_cube.obj" cube.glb
exits 0
# Ten quads: two sides of 4 corners, four faces of 6 vertices, of which the 2 on the seam are doubled.
is "$(gltf cube.glb 'g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count')" 40
says "32 -> 40 vertices"
is "$(gltf cube.glb 'g.accessors[g.meshes[0].primitives[0].indices].count')" 60

scene "the normal map of the MTL arrives in the output"
run "$data/mirrored_cube.obj" cube.glb
exits 0
is "$(gltf cube.glb 'g.materials[0].name')" bumps
is "$(gltf cube.glb 'g.materials[0].normalTexture !== undefined')" true
is "$(gltf cube.glb 'g.images[0].uri === undefined')" true

scene "w mirrors with the texture"
run "$data/mirrored_cube.obj" cube.glb
# 20 triangles, half of them mirrored, and w is the same at the corners of each.
is "$(gltf cube.glb '(() => {
	const p = g.meshes[0].primitives[0], t = rows(p.attributes.TANGENT), i = rows(p.indices).flat();
	const w = [];
	for (let k = 0; k < i.length; k += 3)
		w.push(t[i[k]][3] === t[i[k + 1]][3] && t[i[k]][3] === t[i[k + 2]][3] ? t[i[k]][3] : 0);
	return [w.filter((x) => x === 1).length, w.filter((x) => x === -1).length];
})()')" "[10,10]"

scene "a glTF gets tangents where its materials need them"
run "$data/plates.glb" out.glb
exits 0
says "2 of 3 primitives"
is "$(gltf out.glb 'g.meshes[0].primitives.map((p) => p.attributes.TANGENT !== undefined)')" \
	"[true,false,true]"

scene "views of a new glTF say what is in them: vertices or indices, nothing of images"
cp "$data/bumps.png" .
run --images=embed "$data/mirrored_cube.obj" cube.glb
exits 0
is "$(gltf cube.glb '(() => { const [p] = g.meshes[0].primitives, of = (a) => g.bufferViews[g.accessors[a].bufferView].target;
	return [[...new Set(Object.values(p.attributes).map(of))], of(p.indices),
		g.images.map((i) => g.bufferViews[i.bufferView].target ?? "none")]; })()')" '[[34962],34963,["none"]]'

scene "the second of two runs finds nothing to do and copies the file"
run "$data/plates.glb" one.glb
run one.glb two.glb
exits 0
same one.glb two.glb

scene "every form of output holds the same tangents"
cp "$data/head.obj" .
run head.obj head.glb
exits 0
run head.obj head.gltf
exits 0
exists head.gltf head.bin
run --buffers=embed head.obj embedded.gltf
exits 0
run --output-format=glb head.obj unnamed
exits 0
same head.glb unnamed
tangents='rows(g.meshes[0].primitives[0].attributes.TANGENT)'
gltf head.glb "$tangents" >a
gltf head.gltf "$tangents" >b
gltf embedded.gltf "$tangents" >c
same a b
same a c
is "$(gltf embedded.gltf 'g.buffers[0].uri.slice(0, 5)')" data:

scene "triangles keep the order of the input"
run "$data/head.obj" head.glb
# Quad k of the file is cut into triangles 2k and 2k + 1, which have its corners.
is "$(gltf head.glb 'g.accessors[g.meshes[0].primitives[0].indices].count')" "$((12 * 14 * 2 * 2 * 3))"

scene "every variant of PLY gives the same frame"
for name in ascii le be wedge; do
	run "$data/quad_$name.ply" "$name.glb"
	exits 0
	is "$(gltf "$name.glb" 'rows(g.meshes[0].primitives[0].attributes.TANGENT).every(
		(t) => t.join() === "1,0,0,1")')" true
done

scene "a PLY keeps its format and gains four properties"
run "$data/quad_ascii.ply" ascii.ply
exits 0
grep -q '^format ascii 1.0' ascii.ply || wrong "not ascii"
for property in tx ty tz tw; do
	grep -q "^property float $property" ascii.ply || wrong "$property is missing"
done
grep -q '^comment one quad, texture upright' ascii.ply || wrong "the comment is lost"
run --bitangents "$data/quad_be.ply" be.ply
exits 0
grep -aq '^format binary_big_endian 1.0' be.ply || wrong "not big endian"
grep -aq '^property float bz' be.ply || wrong "no bitangents"

scene "bitangents of tangents that are kept are as long as these, whatever the normals are"
{
	printf '%s\n' ply 'format ascii 1.0' 'element vertex 3'
	printf 'property float %s\n' x y z nx ny nz s t tx ty tz tw
	printf '%s\n' 'element face 1' 'property list uchar int vertex_indices' end_header
	printf '%s 0 0 2 %s 1 0 0 1\n' '0 0 0' '0 0' '1 0 0' '1 0' '0 1 0' '0 1'
	echo 3 0 1 2
} >kept.ply
run --bitangents kept.ply out.glb
exits 0
is "$(gltf out.glb 'rows(g.meshes[0].primitives[0].attributes._BITANGENT)')" '[[0,1,0],[0,1,0],[0,1,0]]'

scene "faces of one and two corners stay in a binary PLY"
python3 - <<'END'
import struct
head = ("ply\nformat binary_%s_endian 1.0\nelement vertex 6\n" + "".join("property float %s\n" % n for n in "xyzst") +
        "element face 6\nproperty list uchar int vertex_indices\nend_header\n")
for name, order in ("little", "<"), ("big", ">"):
    with open(name + ".ply", "wb") as file:
        file.write((head % name).encode())
        for x, y in (0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (2, 1):
            file.write(struct.pack(order + "5f", x, y, 0, abs(x - 1), y))  # mirrored, so that vertices are copied
        for face in [0, 1, 2], [3, 1], [2], [0, 2, 3], [1, 4, 5], [1, 5, 2]:
            file.write(struct.pack(order + "B%di" % len(face), len(face), *face))
END
for order in little big; do
	run $order.ply out.ply
	exits 0
	is "$(python3 -c 'import struct, sys
d, order = open("out.ply", "rb").read(), "<" if sys.argv[1] == "little" else ">"
rest, faces = d[-66:], []
while rest:
    faces.append(struct.unpack_from(order + "%di" % rest[0], rest, 1))
    rest = rest[1 + 4 * len(faces[-1]):]
print(len(faces), faces[1:3])' $order)" "6 [(3, 1), (2,)]"
	says "6 -> 8 vertices"
done

scene "a glTF becomes a PLY"
run --only=all "$data/plates.gltf" plates.ply
exits 0
grep -aq '^property float tw' plates.ply || wrong "no tangents"
run plates.ply again.glb
exits 0

# 10 000 has floats 0.001 apart, which is the edge of a triangle that its node makes a thousandth
gltf new far 'g.meshes = [{primitives: [{attributes: {POSITION: add("VEC3", 5126, [0, 0, 0, 1, 0, 0, 0, 1, 0])}}]}];
	g.nodes = [{mesh: 0, scale: [1e-3, 1e-3, 1e-3], translation: [10000, 0, 0]}]'
run far.gltf far.ply
grep -aq '^property double x' far.ply || wrong "positions are rounded"

scene "a PLY that could not be read again is not written"
cp "$data/plates.bin" .
printf '\0\0\300\177' | dd of=plates.bin bs=1 seek=4 conv=notrunc status=none # y of the first vertex is NaN
cp "$data/plates.gltf" .
run --only=all plates.gltf plates.ply
exits 3
says 'nmtan: plates.gltf: /meshes/0/primitives/0: mesh "plates", primitive 0'
says "the position of vertex 0 is not finite"
only plates.bin plates.gltf
cp "$data/plates.bin" .
sed -i 's/"mesh": 0/"scale": [1e39, 1, 1], &/' plates.gltf
run --only=all plates.gltf plates.ply
exits 3
says "the position of vertex 1 is not finite where the node places it"
only plates.bin plates.gltf

scene "pipes carry meshes in and out"
cp "$data/plates.glb" x.glb
"$NMTAN" -q x.glb direct.glb
"$NMTAN" -q - - <x.glb >piped.glb || wrong "exit code $?"
same direct.glb piped.glb
# shellcheck disable=SC2002
cat x.glb | "$NMTAN" -q - - | "$NMTAN" -q --output-format=glb - - >twice.glb || wrong "exit code $?"
same direct.glb twice.glb
"$NMTAN" -q - - <"$data/quad_ascii.ply" | head -c 3 | grep -q ply || wrong "PLY does not stay PLY"
"$NMTAN" -q "$data/quad.obj" - | head -c 4 | grep -q glTF || wrong "OBJ does not become GLB"
"$NMTAN" -q "$data/quad.obj" /dev/stdout | head -c 4 | grep -q glTF || wrong "/dev/stdout is no stream"

scene "content counts before the name"
cp "$data/plates.glb" really.obj
run really.obj out.glb
exits 0
run "$data/plates.glb" expected.glb
same out.glb expected.glb

scene "the bytes are the same for every number of threads and every run"
grid_obj 120 >grid.obj
run -j1 grid.obj a.glb
exits 0
for threads in 1 2 3 8; do
	run -j$threads grid.obj b.glb
	exits 0
	same a.glb b.glb
done

scene "the locale does not matter"
run "$data/head.obj" a.glb
LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 run "$data/head.obj" b.glb
same a.glb b.glb
run "$data/quad_ascii.ply" a.ply
LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 run "$data/quad_ascii.ply" b.ply
same a.ply b.ply

scene "a buffer that is missing ends every way with 2, quiet or not, needed or not"
mkdir a
# nothing needs tangents, and nothing but a link would be written
node -e 'const g = JSON.parse(fs.readFileSync(process.argv[1])); for (const m of g.materials) delete m.normalTexture;
	g.buffers.push({uri: "not%20there.bin", byteLength: 4}, {byteLength: 4, extensions: {EXT_meshopt_compression: {fallback: true}}});
	fs.writeFileSync("a/in.gltf", JSON.stringify(g))' "$data/plates.gltf"
for way in "a/in.gltf a/out.gltf" "a/in.gltf out.gltf" "a/in.gltf out.glb" "--check a/in.gltf" "-q a/in.gltf a/out.gltf" \
	"-q --only=all a/in.gltf out.glb" "--buffers=link -q a/in.gltf out.gltf" "--severity=BUFFER_MISSING=info a/in.gltf out.gltf" \
	"--severity=BUFFER_MISSING=warning --fail-on=error --min-severity=error a/in.gltf out.gltf"; do
	run $way
	exits 2
	case $way in # one line for each, or for all
	*-q* | *--check* | *--severity*) says 'buffers cannot be opened: "plates.bin", "not%20there.bin"' ;;
	*)
		says '/buffers/1: error: buffer cannot be opened: '
		is "$(wc -l <"$WORK/err.txt")" 2
		;;
	esac
done
cp "$data/plates.bin" a
run -q a/in.gltf out.gltf
exits 2
is "$(cat "$WORK/err.txt")" 'nmtan: a/in.gltf: /buffers/1: a buffer cannot be opened: "not%20there.bin"'
printf '\0\0\0\0' >"a/not there.bin"
run -q a/in.gltf out.gltf
exits 0

scene "a pointer of Git LFS is not the file"
printf '%s\n' 'version https://git-lfs.github.com/spec/v1' "oid sha256:$(printf '%064d' 7)" 'size 39043' >pointer
for format in obj ply glb gltf drc; do
	cp pointer a.$format
	run a.$format out.glb
	exits 2
	says "a.$format: Git LFS's pointer to the file, not the file itself: git lfs pull brings it"
done
cp "$data/plates.gltf" "$data/mirrored_cube.obj" .
cp pointer plates.bin
cp pointer mirrored_cube.mtl
run plates.gltf out.glb
exits 2
says "plates.bin: /buffers/0: "
says "Git LFS's pointer"
run mirrored_cube.obj out.glb
exits 0
says "Git LFS's pointer to the file, not the file itself: git lfs pull brings it [MTL_MISSING]"
printf 'newmtl bumps\nKd 1 \0\n' >mirrored_cube.mtl
run mirrored_cube.obj out.glb
exits 0
says "material library cannot be read: mirrored_cube.mtl: a byte 0 in it, expected text [MTL_MISSING]"
while IFS='|' read -r code expected words; do
	cp pointer image.png
	printf 'newmtl bumps\nmap_Kd image.png\n' >mirrored_cube.mtl
	run $words
	exits "$code"
	says "$expected: git lfs pull brings it"
done <<-'END'
	0|image cannot be read: image.png (Git LFS's pointer to the file, not the file itself|mirrored_cube.obj out.gltf
	0|image cannot be read: image.png (Git LFS's pointer to the file, not the file itself|--images=link mirrored_cube.obj linked.gltf
	1|--base-color: 'image.png': Git LFS's pointer to the file, not the file itself|--base-color=image.png mirrored_cube.obj out.glb
	2|pointer: Git LFS's pointer to the file, not the file itself|--check --baseline=pointer mirrored_cube.obj
	2|pointer: Git LFS's pointer to the file, not the file itself|--check --files-from=pointer
END
grep -q '"uri" *: *"image.png"' linked.gltf || wrong "a link to an image that is a pointer is gone"
rm image.png linked.* out.*
cp "$data/plates.bin" .
cp pointer bumps.png
run plates.gltf out.glb
exits 0
says "/images/0: warning: image cannot be read: \"bumps.png\": Git LFS's pointer"
# what is not there keeps its name; what is no image is copied, and so is one that the texture cannot have without an extension
mkdir there
for format in glb gltf; do
	run plates.gltf there/out.$format
	is "$(gltf there/out.$format 'g.images')" '[{"uri":"bumps.png"}]'
done
only a.{obj,ply,glb,gltf,drc} pointer plates.gltf plates.bin bumps.png mirrored_cube.{obj,mtl} out.glb there
for text in "no image" "RIFF....WEBP"; do
	echo "$text" >bumps.png
	run plates.gltf out.glb
	exits 0
	says "/images/0: warning: image has a type that glTF does not carry: it stays a file [IMAGE_TYPE]"
	rm -r there && mkdir there
	run plates.gltf there/out.glb
	is "$(gltf there/out.glb 'g.images[0].uri')" bumps.png
	same bumps.png there/bumps.png
done

scene "a PLY of points is a PLY, and no glTF"
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 1 2\n' >p.ply
run p.ply q.ply
same p.ply q.ply
run p.ply q.glb
exits 5
says "p.ply: found no faces, expected a mesh"

scene "progress is shown when it is asked for and never in the output"
run --progress=on "$data/head.obj" -
exits 0
says "head.obj: parse"
"$NMTAN" -q "$data/head.obj" - | cmp -s - "$WORK/out.txt" || wrong "the output differs"

scene "on a terminal progress is shown after a second and wiped away"
if command -v script >/dev/null 2>&1; then
	cp "$data/head.obj" .
	# how long a run lasts is up to the machine, too: it may show progress if that is a second
	for try in $(seq 20); do
		begin=${EPOCHREALTIME//[!0-9]/}
		script -qec "'$NMTAN' head.obj a.glb" typed >/dev/null 2>&1
		[ $((${EPOCHREALTIME//[!0-9]/} - begin)) -ge 1000000 ] || break
	done
	[ $try = 20 ] || ! grep -q $'\r\033\[K' typed || wrong "a short run shows progress"
	# an input that waits until progress is seen, half a minute at most
	: >typed
	script -qefc "{ for i in \$(seq 300); do ! grep -q ': map, ' typed || break; sleep 0.1; done; cat head.obj; } |
		'$NMTAN' - b.glb" typed >/dev/null 2>&1
	grep -q ': map, [1-9]' typed || wrong "a long run shows none"
	grep -q $'\r\033\[K.*-> b.glb' typed || wrong "the line was not wiped away"
	script -qec "{ sleep 1.7; cat head.obj; } | '$NMTAN' --progress=off - b.glb" typed >/dev/null 2>&1
	grep -q ': map' typed && wrong "progress although it is off"
	same a.glb b.glb
fi

scene "colours are for terminals without NO_COLOR alone"
cp "$data/mirrored_cube.obj" .
run mirrored_cube.obj cube.glb
grep -q $'\033' "$WORK/err.txt" && wrong "colours in a file"
if command -v script >/dev/null 2>&1; then
	NO_COLOR= script -qec "'$NMTAN' mirrored_cube.obj cube.glb" typed >/dev/null 2>&1
	grep -q $'\033' typed || wrong "no colours on a terminal"
	NO_COLOR=1 script -qec "'$NMTAN' mirrored_cube.obj cube.glb" typed >/dev/null 2>&1
	grep -q $'\033' typed && wrong "colours although NO_COLOR is set"
fi

scene "what is not finite of a glTF is in no PLY"
for what in COLOR_0:colour "TEXCOORD_0:texture coordinate" NORMAL:normal; do
	gltf new nan "const broken = '${what%:*}';" 'const values = {POSITION: [0, 0, 0, 1, 0, 0, 0, 1, 0], TEXCOORD_0: [0, 0, 1, 0, 0, 1],
			COLOR_0: Array(12).fill(1), NORMAL: [0, 0, 1, 0, 0, 1, 0, 0, 1]}, attributes = {};
		values[broken][values[broken].length - 1] = NaN;
		for (const name in values) attributes[name] = add("VEC" + values[name].length / 3, 5126, values[name]);
		g.meshes = [{primitives: [{attributes}]}];
		g.nodes = [{mesh: 0}]'
	run nan.gltf out.ply
	exits 3
	says "the ${what#*:} of vertex 2 is not finite"
	run --only=all nan.gltf out.glb
	exits 0
done

scene "what PLY cannot hold of a glTF is told, each kind with its number"
python3 -c 'import json, sys
g = json.load(open(sys.argv[1]))
attributes = g["meshes"][0]["primitives"][0]["attributes"]
attributes["TEXCOORD_1"] = attributes["TEXCOORD_2"] = attributes["TEXCOORD_0"]
g["animations"] = [{"channels": [], "samplers": []}] * 3
g["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]
g["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}] * 2}}
g["nodes"][0]["extras"] = {"a": 1}
json.dump(g, open("full.gltf", "w"))' "$data/morph.gltf"
cp "$data"/*.png .
run full.gltf full.ply
exits 0
says "12 parts of the input are not in the output: materials (1), further sets of texture coordinates (2), morph targets (1), animations (3), cameras (1), lights (2), extras (1), textures (1) [REFERENCE_LOST]"
run -q full.gltf full.ply
says "missing from the output: 12 REFERENCE_LOST"
run full.gltf full.glb
says_not REFERENCE_LOST

# texture_file FILE: what MeshLab and trimesh take for the name of the image: the rest of the line, without what MeshLab drops.
texture_file() {
	LC_ALL=C sed -n '/^end_header/q; s/^comment TextureFile //p' "$1" | tr -d '\001-\040\175-\377'
}

# two.gltf: two triangles in two primitives; $1, $2: their base colours, of the images a.png and b.png
two_colors() {
	gltf new two "const attributes = {POSITION: add(\"VEC3\", 5126, [0, 0, 0, 1, 0, 0, 0, 1, 0]),
			TEXCOORD_0: add(\"VEC2\", 5126, [0, 0, 1, 0, 0, 1])};
		g.images = [{uri: \"tex/a.png\"}, {uri: \"tex/b%20c.png\"}];
		g.textures = [{source: 0}, {source: 1}, {source: 0}];
		const material = (info) => ({pbrMetallicRoughness: info && {baseColorTexture: info}});
		g.materials = [material($1), material($2)];
		g.meshes = [{primitives: [{attributes, material: 0}, {attributes, material: 1}]}];
		g.nodes = [{mesh: 0}]"
	mkdir -p tex
	cp "$data/bumps.png" tex/a.png
	cp "$data/bumps.png" "tex/b c.png"
}

scene "a PLY names the one image of base colours, as MeshLab reads it"
two_colors '{index: 0}' '{index: 2}'
run --only=all two.gltf two.ply
exits 0
is "$(texture_file two.ply)" tex/a.png
grep -aqx 'property float s' two.ply || wrong "MeshLab reads no texture coordinates"
says "materials (2), textures (2); tex/a.png stays: comment TextureFile"
mkdir out
run --only=all two.gltf out/two.ply
is "$(texture_file out/two.ply)" a.png
same out/a.png tex/a.png
run --only=all two.gltf out/two.ply
exits 0
is "$(cd out && echo *)" "a.png two.ply"
run --only=all --images=link two.gltf out/two.ply
is "$(texture_file out/two.ply)" ../tex/a.png
run --only=all --images=none two.gltf out/two.ply
is "$(texture_file out/two.ply)" ""
run --only=all --images=embed two.gltf out/two.ply
exits 1
says "a PLY names a file"
run --only=all --images=embed two.gltf two.glb
run --only=all two.glb out/two.ply
is "$(texture_file out/two.ply)" two.png
same out/two.png tex/a.png
run --only=all two.glb -
exits 0
run --only=all out/two.ply out/back.glb
exits 0
is "$(gltf out/back.glb '[g.images.length, g.materials[0].pbrMetallicRoughness.baseColorTexture.index]')" '[1,0]'

scene "a PLY does not take the place of the image that it names"
two_colors '{index: 0}' '{index: 0}'
cp tex/a.png own.ply
sed 's|tex/a.png|own.ply|' two.gltf >own.gltf
for words in "" --images=link; do
	run --only=all $words own.gltf own.ply
	exits 2
	says "own.ply: refusing to write"
	same own.ply tex/a.png
done

scene "an image whose name MeshLab does not read is copied under one that it reads"
two_colors '{index: 1}' '{index: 1}'
run --only=all two.gltf two.ply
exits 0
is "$(texture_file two.ply)" b_c.png
same b_c.png tex/a.png

scene "a PLY names no image if its parts have different ones, or if it lies otherwise; that is told"
while IFS='|' read -r first second why; do
	two_colors "$first" "$second"
	run --only=all two.gltf two.ply
	exits 0
	is "$(texture_file two.ply)" ""
	says "textures (3); no TextureFile: $why"
	only two.bin two.gltf two.ply tex
done <<-END
	{index: 0}|{index: 1}|not all of the mesh has one image of base colours
	{index: 0}|null|not all of the mesh has one image of base colours
	{index: 0, texCoord: 1}|{index: 0, texCoord: 1}|the image of base colours lies otherwise than the texture coordinates
END
two_colors '{index: 0}' '{index: 0}'
rm tex/a.png
run --only=all two.gltf two.ply
exits 0
says "no TextureFile: the image of base colours cannot be read"
is "$(texture_file two.ply)" ""

scene "an image outside of the input's folder is not copied beside a PLY, unless that is allowed"
mkdir in
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n' >in/in.obj
printf 'newmtl m\nmap_Kd %s\n' ../above.png >in/m.mtl
cp "$data/bumps.png" above.png
cp "$data/bumps.png" in/near.png
mkdir out
run in/in.obj out/a.ply
exits 0
is "$(texture_file out/a.ply)" above.png
run --outside=no in/in.obj out/b.ply
is "$(texture_file out/b.ply)" ""
says "materials (1), textures (1: ../above.png); no TextureFile: the image of base colours cannot be read"
printf 'newmtl m\nmap_Kd near.png\n' >in/m.mtl
run in/in.obj in/near.ply
is "$(texture_file in/near.ply)" near.png
says "1 part of the input is not in the output: materials (1); near.png stays: comment TextureFile"
printf 'map_Ke e.png\nnorm n.png\n' >>in/m.mtl
run in/in.obj in/near.ply
says "3 parts of the input are not in the output: materials (1), textures (2: n.png and others); near.png stays: comment TextureFile"

scene "a PLY made of a PLY says which image it leaves behind"
mkdir from to
cp "$data/bumps.png" from/wood.png
printf '%s\n' ply 'format ascii 1.0' 'comment TextureFile wood.png' 'comment TextureFile none.png' 'element vertex 3' 'property float x' \
	'property float y' 'property float z' 'property float s' 'property float t' 'element face 1' \
	'property list uchar int vertex_indices' end_header '0 0 0 0 0' '1 0 0 1 0' '0 1 0 0 1' '3 0 1 2' >from/a.ply
run from/a.ply to/a.ply
says "TextureFile is wood.png, which lies beside the input alone"
run from/a.ply from/b.ply
says_not TextureFile
cp from/wood.png to/
run from/a.ply to/a.ply
says_not TextureFile

# Lines of an OBJ. Asked is what the run says, with which exit code it fails and says so, or a JavaScript expression over the
# document g, its first primitive p, and what that has: indices I, positions P, texture coordinates U, normals N, colours C.
expression='((p) => ((I, P, U, N, C) => %s)(...[p.indices, ...["POSITION", "TEXCOORD_0", "NORMAL", "COLOR_0"].map((n) => p.attributes[n])]
	.map((a, i) => a === undefined ? [] : i ? rows(a) : rows(a).flat())))(g.meshes[0].primitives[0])'
while IFS=$'\t' read -r name lines question answer; do
	case $name in "#"*) continue ;; .) ;; *) scene "$name" ;; esac
	if [ "$lines" != . ]; then
		lines=${lines//@/v 0 0 0|v 1 0 0|v 0 1 0}
		printf '%b' "${lines//|/\\n}" >in.obj
		run -v in.obj out.glb
	fi
	case $question in
	says) says "$answer" ;;
	[0-9])
		exits "$question"
		says "$answer"
		;;
	*)
		exits 0
		case $answer in *=\>*) answer=$(gltf out.glb "$answer") ;; esac
		is "$(gltf out.glb "$(printf "$expression" "$question")")" "$answer"
		;;
	esac
done <"$ROOT/tests/cli/obj.tsv"

scene "borders to other primitives are looked at where that costs at most four times what is solved and 65 536 triangles"
# 800 triangles and 79 200, whose tangents would turn where they meet
grid_obj 200 | awk '/^v / {$4 = 0.002 * (NR * 7 % 11)} /^f / && (n++ == 0 || n == 401) {print "usemtl m" n} {print}' >grid.obj
run -q --only=all grid.obj grid.glb
for solved in 2 1; do
	gltf grid.glb some "const solved = $solved;" 'g.textures = [{}];
		g.materials.forEach((m, i) => i < solved && (m.normalTexture = {index: 0}))'
	run -v --report=r.json --existing=replace some.gltf out.glb
	exits 0
	if [ $solved = 2 ]; then says TAN_PRIMITIVE_BORDER; else says_not TAN_PRIMITIVE_BORDER; fi
done

scene "a line longer than what is read at once, and the lines behind it"
{ printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0'; awk 'BEGIN { printf "l"; for (i = 0; i < 600000; i++) printf " 1 2"; print "" }'; echo 'f 1 2 3'; echo 'f 1 2 4'; } >long.obj
run long.obj out.glb
exits 3
says 'long.obj:6: face refers to "v" number 4'
sed -i '$d' long.obj
run long.obj out.glb
exits 0
is "$(gltf out.glb 'rows(g.meshes[0].primitives[0].attributes.POSITION)')" "[[0,0,0],[1,0,0],[0,1,0]]"

done_testing
