#!/bin/sh
# SPDX-License-Identifier: MIT
#
# textures.sh BUILD: an OBJ whose normal map is a TGA, and its twin with a PNG, in three.js in headless Chromium. Both GLBs
# hold the same samples and the same geometry, so that one renderer gets the same input: no pixel may differ. Then the same
# OBJ with its image moved, scaled and mirrored by -s and -o, beside the file without TANGENT, where the renderer makes
# tangents of screen derivatives: pixels may differ by less than 2 of 255 on average, for the derivatives of a triangle are not
# those of its vertices (with -s -1 1 it is 0.2, with the other w 6.1). Needs Chromium, and npm for three.
set -eu
cd "$(dirname "$0")/../.."
nmtan=$1/nmtan work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
npm install --prefix "$work" --no-audit --no-fund --loglevel=error three@0.187.0 >/dev/null 2>&1 ||
	{ echo "textures: three cannot be installed, nothing was rendered"; exit 0; }
node tests/picture/make_tile.mjs "$work"
"$nmtan" -q "$work/tile.obj" "$work/png.glb"
python3 tests/support/images.py tga "$work/tile_normal.png" "$work/tile_normal.tga"
sed -i 's/tile_normal.png/tile_normal.tga/' "$work/tile.mtl"
"$nmtan" -q "$work/tile.obj" "$work/tga.glb"
node tests/picture/render.mjs build/node/node_modules "$work/node_modules" "$work/twins.png" "$work/png.glb" "$work/tga.glb"
# The two halves of the picture, above the captions.
python3 tests/support/images.py rows "$work/twins.png" '"%d %d" % (
	sum(p != rows[0][0] for row in rows[:440] for p in row[:520]),
	sum(a != b for row in rows[:440] for a, b in zip(row[:520], row[520:])))' >"$work/pixels"
read -r drawn differ <"$work/pixels"
echo "textures: $drawn pixels drawn, $differ differ between the TGA and the PNG"
[ "$drawn" -ge 50000 ]
[ "$differ" = 0 ]

# Without its tangents.
bare() {
	python3 - "$1" "$2" <<-'END'
		import json
		import struct
		import sys
		data = open(sys.argv[1], "rb").read()
		size = struct.unpack_from("<I", data, 12)[0]
		document, rest = json.loads(data[20:20 + size]), data[20 + size:]
		[primitive["attributes"].pop("TANGENT") for mesh in document["meshes"] for primitive in mesh["primitives"]]
		text = json.dumps(document).encode()
		text += b" " * (-len(text) % 4)
		open(sys.argv[2], "wb").write(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest)
	END
}
for options in "-s 2 3" "-s -1 1 -o 0.25 0.5" "-s 1 -1 -o 0.5 0.25" "-s -1 -1 -o 0.125 0.75" "-s -2 3"; do
	sed -i "s/^norm .*/norm $options tile_normal.png/" "$work/tile.mtl"
	"$nmtan" -q "$work/tile.obj" "$work/moved.glb"
	bare "$work/moved.glb" "$work/bare.glb"
	DERIVATIVES=1 node tests/picture/render.mjs build/node/node_modules "$work/node_modules" "$work/moved.png" "$work/moved.glb" "$work/bare.glb"
	mean=$(python3 tests/support/images.py rows "$work/moved.png" '(lambda pairs: "%.2f" % (
		sum(abs(a - b) for p, q in pairs for a, b in zip(p[:3], q[:3])) / (3 * len(pairs))))(
		[(p, q) for row in rows[:440] for p, q in zip(row[:520], row[520:]) if p != rows[0][0]])')
	echo "textures: $options: by tangents and by derivatives pixels differ by $mean of 255"
	[ "${mean%.*}" -lt 2 ]
done
