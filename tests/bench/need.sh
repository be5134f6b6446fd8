#!/bin/bash
# SPDX-License-Identifier: MIT
#
# make bench-need [FILES="FILE..."]: peak memory of one run for each FILE, over that of the smallest run, beside the guess of
# src/batch/gate.c. Without FILES, for some that are made: ordinary ones, and the worst of each format, in which every
# corner is a vertex of its own.
set -eu
nmtan=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(cd "$(dirname "$0")" && pwd)

# How many MB a run takes at most.
peak() {
	python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdin=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024)' "$nmtan" -q --threads=1 --only=all --existing=replace "$@"
}

make_files() {
	while read -r name kind count; do
		python3 "$here/../support/inputs.py" "$kind" "$count" "$work/$name"
	done <<-END
		ordinary.obj obj_torus 125000
		corners.obj obj_corners 200000
		terse.obj obj_grid 90000
		corners.ply ply_corners 200000
		far.ply ply_far 90000
		corners.glb gltf_corners 200000
		nodes.glb gltf_nodes_of_one_mesh 200000
	END
	for name in ordinary.ply ordinary.glb ordinary.gltf; do "$nmtan" -q "$work/ordinary.obj" "$work/$name"; done
	"$nmtan" -q --draco=edgebreaker --existing=replace --only=all "$work/ordinary.glb" "$work/draco.glb"
}

least=$(peak "$here/../../data/quad.obj" "$work/least.glb")
row() {
	local need
	need=$("$(dirname "$nmtan")/tests/bench/need" "$@" out.glb)
	awk -v name="$(basename "$1")" -v options="${*:2}" -v peak=$(($(peak "$@" "$work/out.glb") - least)) \
		-v need="$need" -v size="$(stat -Lc %s "$1")" 'BEGIN {
		printf "%-16s %-24s %8.2f MB file %8.1f MB taken %8.1f MB guessed %7.1f taken per byte\n",
			name, options, size / 1e6, peak / 1e6, need / 1e6, peak / size }'
}
if [ $# -gt 0 ]; then
	for file; do row "$file"; done
	exit
fi
make_files
for file in ordinary terse corners; do row "$work/$file.obj"; row "$work/$file.obj" --verify --report="$work/r.html"; done
for file in ordinary corners; do row "$work/$file.ply"; done
row "$work/far.ply" --origin=keep --verify --report="$work/r.json"
for file in ordinary corners nodes draco; do
	row "$work/$file.glb"
	row "$work/$file.glb" --verify --report="$work/r.html"
done
for file in ordinary corners; do row "$work/$file.glb" --draco=edgebreaker; done
row "$work/ordinary.gltf"
