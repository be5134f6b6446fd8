# SPDX-License-Identifier: MIT
# The conformance kit: meshes with what mikktspace.c answers (tests/soak/conformance.sh asks it again), and the card.
. "$ROOT/tests/support/cli.sh"
kit=$ROOT/tests/conformance

make_kit() {
	PYTHONDONTWRITEBYTECODE=1 python3 "$kit/kit.py" kit || wrong "kit.py"
}

score() {
	NMTAN=$NMTAN sh kit/score.sh "$@" >score.txt
}

# broken NAME PYTHON: answers in NAME/ that are changed by PYTHON, which has each corner as [x, y, z, w] in c.
broken() {
	mkdir -p "$1"
	PYTHONDONTWRITEBYTECODE=1 python3 - "$kit" "$1" "$2" <<'PY'
import json, math, sys
sys.path.insert(0, sys.argv[1])
import kit
for mesh in json.load(open(sys.argv[1] + "/meshes.json")):
	for c in mesh["expected"]["triangles"]["published"]:
		exec(sys.argv[3])
	kit.write_expected(mesh, "published", "%s/%s.glb" % (sys.argv[2], mesh["name"]))
PY
}

scene "the same kit comes out twice, and glTF says it is one"
make_kit
cp kit.zip first.zip
make_kit
same kit.zip first.zip
for file in kit/card.glb kit/quad_cuts.glb kit/texture_transform.glb kit/expected/*.glb; do valid "$file"; done

scene "nmtan gives the answers of mikktspace.c, from OBJ and from glTF"
make_kit
mkdir obj gltf sorted
for file in kit/*.obj; do "$NMTAN" -q "$file" "obj/$(basename "$file" .obj).glb" || wrong "$file"; done
run -q -d gltf kit/*_*.glb kit/antiparallel.glb kit/degenerate.glb kit/turned.glb kit/upright.glb
run -q -d sorted --method=mikktspace-sorted kit/unfinished_sort.glb
score obj || wrong "$(cat score.txt)"
is "$(tail -1 score.txt)" "9 passed, 0 failed"
score gltf || wrong "$(cat score.txt)"
is "$(tail -1 score.txt)" "12 passed, 0 failed"
score sorted sorted || wrong "$(cat score.txt)"
! score sorted || wrong "both dialects pass"

scene "wrong answers fail, each of them"
make_kit
broken w 'c[3] = -c[3]'
broken degree 'a = math.radians(1); c[:2] = [c[0] * math.cos(a) - c[1] * math.sin(a), c[0] * math.sin(a) + c[1] * math.cos(a)]'
for name in w degree; do
	! score $name || wrong "$name passes"
	is "$(tail -1 score.txt)" "0 passed, 12 failed"
done
mkdir none
! score none || wrong "nothing passes"

# Lambert's law for each texel of each strip, B per pixel; a renderer that is right, and four that are not.
scene "the card shows PASS to those who are right and FAIL to others"
make_kit
is "$(PYTHONDONTWRITEBYTECODE=1 python3 - "$kit" <<'PY'
import json, struct, sys, zlib
sys.path.insert(0, sys.argv[1])
import kit
data = open("kit/card.glb", "rb").read()
length = struct.unpack("<I", data[12:16])[0]
g, blob = json.loads(data[20:20 + length]), data[28 + length:]

def rows(accessor, width):
	a = g["accessors"][accessor]
	begin = g["bufferViews"][a["bufferView"]]["byteOffset"]
	floats = struct.unpack_from("<%df" % (width * a["count"]), blob, begin)
	return [floats[i:i + width] for i in range(0, len(floats), width)]

view = g["bufferViews"][0]
image = blob[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]
raw = zlib.decompress(image[image.index(b"IDAT") + 4:])
width, height = struct.unpack(">II", image[16:24])

def shade(strip, renderer, x, y):
	p = g["meshes"][strip]["primitives"][0]["attributes"]
	uv, t = rows(p["TEXCOORD_0"], 2), rows(p["TANGENT"], 4)[0]
	u, v = (uv[0][i] + x * (uv[1][i] - uv[0][i]) + y * (uv[3][i] - uv[0][i]) for i in (0, 1))
	at = int(v * height) * (3 * width + 1) + 1 + 3 * int(u * width)
	n = [c / 127.5 - 1 for c in raw[at:at + 3]]
	if renderer == "green down":
		n[1] = -n[1]
	tangent = (1, 0) if renderer == "no tangents" else t[:2]
	w = t[3] if renderer in ("right", "green down") else 1
	normal = (n[0] * tangent[0] - n[1] * w * tangent[1], n[0] * tangent[1] + n[1] * w * tangent[0], n[2])
	return max(0, sum(a * b for a, b in zip(normal, kit.LIGHT)))

def reads(strip, renderer):
	"""The word whose every dot differs from the ground around it, where the other one's do not."""
	seen = ""
	for begin, word in ((5, "PASS"), (37, "FAIL")):
		dots = [shade(strip, renderer, (begin + 6 * k + at % 5 + .5) / 64, 1 - (4 + at // 5 + .5) / 16)
			for k, letter in enumerate(word) for at, dot in enumerate(kit.FONT[letter]) if dot == "#"]
		ground = shade(strip, renderer, .5, .5)
		seen += word * (min(dots) > ground + .5) + "?" * (ground + .05 < max(dots) < ground + .5)
	return seen

for renderer in ("right", "green down", "no w", "no tangents"):
	print(renderer + ":", *(reads(strip, renderer) for strip in range(3)), end=". ")
PY
)" "right: PASS PASS PASS. green down: FAIL FAIL FAIL. no w: PASS FAIL PASS. no tangents: PASS PASS FAIL. "

done_testing
