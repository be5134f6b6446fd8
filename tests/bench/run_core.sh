#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run_core.sh PROGRAM FOLDER: the core's table, then the same meshes in the peers that the machine has: assimp
# natively, npm's mikktspace and meshoptimizer under node (wasm).
set -u
program=$1 folder=$2 peers=build/peers
rm -rf "$folder" && mkdir -p "$folder" "$peers" || exit 2
"$program" "$folder" || exit 1
# the peers read indexed triangles; mikktspace does not finish on collapsed ones (families 6 and 9) or hubs (8)
rm -f "$folder"/core[689].mesh

if pkg-config --exists assimp 2>/dev/null; then
	# shellcheck disable=SC2046
	${CC:-gcc} -O2 -o "$peers/peer_assimp" tests/bench/peer_assimp.c $(pkg-config --cflags --libs assimp) -lm &&
		"$peers/peer_assimp" "$folder"
else
	echo "bench: no assimp (libassimp-dev), skipped"
fi
if command -v node >/dev/null && command -v npm >/dev/null; then
	if ! cmp -s tests/bench/package.json "$peers/package.json" || [ ! -d "$peers/node_modules" ]; then
		cp tests/bench/package.json "$peers/"
		npm install --prefix "$peers" --no-audit --no-fund --no-package-lock --loglevel=error >/dev/null ||
			echo "bench: npm cannot install the peers"
	fi
	node tests/bench/peers.mjs "$folder" "$peers"
else
	echo "bench: no node and npm, their peers are skipped"
fi
rm -f "$folder"/*.mesh "$folder"/*.tan
[ -f "$folder/peers.txt" ] || exit 0
echo
echo "peers, million triangles a second, best of the runs that fit into a second; npm's are wasm under node"
awk 'FNR == NR { size[$1] = $2; name[$1] = $0; sub(/^[^ ]+ [^ ]+ /, "", name[$1]); next }
	{ printf "%-22s %8d %-28s %7.3f\n", name[$1], size[$1], $2, 1e-6 * size[$1] / $3 }' \
	"$folder/names.txt" "$folder/peers.txt" | sort | tee "$folder/peers.table"
