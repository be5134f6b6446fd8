#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run_peers.sh FOLDER: the meshes of a folder in npm's packages of peers.mjs under node, installed below build/. Missing
# ones are said and skipped.
folder=$1 peers=build/peers
mkdir -p "$peers" || exit 2
if command -v node >/dev/null && command -v npm >/dev/null; then
	if ! cmp -s tests/bench/package.json "$peers/package.json" || [ ! -d "$peers/node_modules" ]; then
		cp tests/bench/package.json "$peers/"
		npm install --prefix "$peers" --no-audit --no-fund --no-package-lock --loglevel=error >/dev/null ||
			echo "bench: npm cannot install the peers"
	fi
	node tests/bench/peers.mjs "$folder" "$peers" || echo "bench: peers under node failed"
else
	echo "bench: no node and npm, their peers are skipped"
fi
