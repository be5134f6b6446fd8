#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run.sh NMTAN DIR: makes data/signs.png anew: one tile with the tangents of gltfpack 1.3.0, whose w has the wrong
# sign on every triangle, and with ours. Needs Chromium, and npm for three, gltfpack and playwright-core.
set -eu
nmtan=$1 dir=$2 here=$(dirname "$0")

mkdir -p "$dir"
[ -d "$dir/node_modules/three" ] || npm install --prefix "$dir" --no-audit --no-fund --loglevel=error \
	three@0.187.0 gltfpack@1.3.0 >/dev/null

node "$here/make_tile.mjs" "$dir"
"$nmtan" -q "$dir/tile.obj" "$dir/ours.glb"
node "$dir/node_modules/gltfpack/cli.js" -noq -gt -i "$dir/ours.glb" -o "$dir/theirs.glb"

# The README says: the validator finds nothing in either file, --check finds the wrong sign in one.
node tests/support/answer.mjs validate "$dir/ours.glb"
node tests/support/answer.mjs validate "$dir/theirs.glb"
"$nmtan" --check -q --report-format=text --fail-on=info "$dir/ours.glb" >"$dir/ours.txt"
"$nmtan" --check -q --report-format=text "$dir/theirs.glb" | grep 'TAN_SIGN_MISMATCH.* 100 % ' || {
	echo "run.sh: the tangents of gltfpack have the right sign: the picture needs another text" >&2
	exit 1
}
node "$here/render.mjs" build/node/node_modules "$dir/node_modules" "$dir/signs.png" "$dir/theirs.glb" "$dir/ours.glb"
if command -v optipng >/dev/null; then optipng -quiet -o5 "$dir/signs.png"; fi
cp "$dir/signs.png" data/signs.png
