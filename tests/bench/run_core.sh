#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run_core.sh PROGRAM FOLDER: the core's table, then the same meshes in the peers that the machine has.
set -u
program=$1 folder=$2
rm -rf "$folder" && mkdir -p "$folder" || exit 2
"$program" "$folder" || exit 1
# the peers read indexed triangles; mikktspace does not finish on collapsed ones (families 6 and 9) or hubs (8)
rm -f "$folder"/core[689].mesh

sh tests/bench/run_peers.sh "$folder"
rm -f "$folder"/*.mesh "$folder"/*.tan
[ -f "$folder/peers.txt" ] || exit 0
echo
echo "peers, million triangles a second, best of the runs that fit into a second; npm's are wasm under node"
awk 'FNR == NR { size[$1] = $2; name[$1] = $0; sub(/^[^ ]+ [^ ]+ /, "", name[$1]); next }
	{ printf "%-22s %8d %-28s %7.3f\n", name[$1], size[$1], $2, 1e-6 * size[$1] / $3 }' \
	"$folder/names.txt" "$folder/peers.txt" | sort | tee "$folder/peers.table"
