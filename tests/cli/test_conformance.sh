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

# Lambert's law for each texel of each strip; renderers that do as the card's page says, and those that do not.
scene "the card says what a renderer does"
make_kit
PYTHONDONTWRITEBYTECODE=1 python3 - "$kit" >card.txt <<'PY'
import json, math, struct, sys, zlib
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

def unit(v):
	size = math.sqrt(sum(c * c for c in v))
	return [c / size for c in v]

def shade(strip, renderer, x, y):
	p = g["meshes"][strip]["primitives"][0]["attributes"]
	place, uv, n, t = (rows(p[k], w) for k, w in (("POSITION", 3), ("TEXCOORD_0", 2), ("NORMAL", 3), ("TANGENT", 4)))
	if renderer in ("no w", "no tangents"):
		t = [(*row[:3], 1) for row in t]
	if renderer == "no tangents":
		t = [(1, 0, 0, 1)] * len(t)
	# corners of the quad that x is in: left and right below, right and left above
	first = 4 * (len(uv) > 4 and x > 0.5)
	left, right = ((place[first + i][0] + 2) / 4 for i in (0, 1))
	x = (x - left) / (right - left)
	weights = ((1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y)
	mixed = lambda values: [sum(w * values[first + i][k] for i, w in enumerate(weights)) for k in range(len(values[0]))]
	u, v = mixed(uv)
	at = int(v * height) * (3 * width + 1) + 1 + 3 * int(u * width)
	m = [c / 127.5 - 1 for c in raw[at:at + 3]]
	if renderer == "green down":
		m[1] = -m[1]
	b = [[row[3] * c for c in kit.cross(n[i], row)] for i, row in enumerate(t)]
	n, t, b = mixed(n), mixed(t), mixed(b)
	if not renderer.startswith("by vertex"):
		b = [t[3] * c for c in kit.cross(n, t)]
	if renderer.endswith("units"):
		n, t, b = unit(n), unit(t[:3]), unit(b)
	return max(0, sum(a * c for a, c in zip(kit.combined((t, b, n), m), kit.LIGHT)))

def reads(strip, renderer):
	"""The word whose every dot is brighter than the ground around it; "?" where the other one can be seen."""
	seen = ""
	for begin, word in ((5, "PASS"), (37, "FAIL")):
		dots, ground = [], []
		for k, letter in enumerate(word):
			for at, dot in enumerate(kit.FONT[letter]):
				(dots if dot == "#" else ground).append(
					shade(strip, renderer, (begin + 6 * k + at % 5 + .5) / 64, 1 - (4 + at // 5 + .5) / 16))
		seen += word if min(dots) > max(ground) + .2 else "?" * (max(dots) > max(ground) + .05)
	return seen

for renderer in ("right", "by vertex", "units", "by vertex, units"):
	print(renderer + ":", *(reads(strip, renderer) for strip in range(5)))
for renderer in ("green down", "no w", "no tangents"):
	print(renderer + ":", *(reads(strip, renderer) for strip in range(3)))
PY
is "$(cat card.txt)" "right: PASS PASS PASS PASS PASS
by vertex: PASS PASS PASS FAIL PASS
units: PASS PASS PASS PASS FAIL
by vertex, units: PASS PASS PASS FAIL FAIL
green down: FAIL FAIL FAIL
no w: PASS FAIL PASS
no tangents: PASS PASS FAIL"

done_testing
