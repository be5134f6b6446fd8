#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run_error.sh PROGRAM FOLDER: run time against error. Peers that the machine has join: assimp natively
# (pkg-config assimp), npm's mikktspace and meshoptimizer under node, installed below build/. Missing ones are
# said and skipped.
set -u
program=$1 folder=$2
exchange=$folder/exchange peers=build/peers
rm -rf "$exchange" && mkdir -p "$exchange" "$peers" || exit 2
"$program" export "$exchange" || exit 2

if pkg-config --exists assimp 2>/dev/null; then
	# shellcheck disable=SC2046
	if ${CC:-gcc} -O2 -o "$peers/peer_assimp" tests/bench/peer_assimp.c $(pkg-config --cflags --libs assimp) -lm; then
		"$peers/peer_assimp" "$exchange" || echo "bench: assimp failed"
	fi
else
	echo "bench: no assimp (libassimp-dev), skipped"
fi

if command -v node >/dev/null && command -v npm >/dev/null; then
	if ! cmp -s tests/bench/package.json "$peers/package.json" || [ ! -d "$peers/node_modules" ]; then
		cp tests/bench/package.json "$peers/"
		npm install --prefix "$peers" --no-audit --no-fund --no-package-lock --loglevel=error >/dev/null ||
			echo "bench: npm cannot install the peers"
	fi
	node tests/bench/peers.mjs "$exchange" "$peers" || echo "bench: peers under node failed"
else
	echo "bench: no node and npm, their peers are skipped"
fi

"$program" judge "$exchange" "$folder" || exit 1
if command -v rsvg-convert >/dev/null; then
	for chart in "$folder"/*.svg; do
		rsvg-convert -o "${chart%.svg}.png" "$chart"
	done
else
	echo "bench: no rsvg-convert (librsvg2-bin), charts as SVG alone"
fi
cat "$folder/error.md"
