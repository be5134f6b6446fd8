#!/bin/sh
# SPDX-License-Identifier: MIT
#
# textures.sh BUILD: an OBJ whose normal map is a TGA, and its twin with a PNG, in three.js in headless Chromium. Both GLBs
# hold the same samples and the same geometry, so that one renderer gets the same input: no pixel may differ. Needs
# Chromium, and npm for three.
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
python3 tests/support/images.py rows "$work/twins.png" >"$work/rows.json"
# The two halves of the picture, above the captions.
python3 - "$work/rows.json" <<-'END'
	import json
	import sys
	rows = json.load(open(sys.argv[1]))[:440]
	half = len(rows[0]) // 2
	drawn = sum(p != rows[0][0] for row in rows for p in row[:half])
	differ = sum(a != b for row in rows for a, b in zip(row[:half], row[half:]))
	print("textures: %d pixels drawn, %d differ between the TGA and the PNG" % (drawn, differ))
	sys.exit(drawn < 50000 or differ != 0)
END
