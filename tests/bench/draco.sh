#!/bin/sh
# SPDX-License-Identifier: MIT
#
# draco.sh NMTAN OBJ FOLDER: time against size of Draco's levels. Each method and level compresses the OBJ's mesh, best
# processor time of three; size and time are those of level 5, the default, times so much.
set -eu
nmtan=$1 obj=$2 folder=$3
mkdir -p "$folder"
"$nmtan" -q "$obj" "$folder/plain.glb"

# seconds OPTIONS...: of the processor, best of three.
seconds() {
	for run in 1 2 3; do
		( LC_ALL=C bash -c 'TIMEFORMAT="%U %S"; time "$@" 2>/dev/null' - "$nmtan" -q --threads=1 \
			--existing=replace --only=all "$@" "$folder/plain.glb" "$folder/out.glb" ) 2>&1
	done | awk '{ s = $1 + $2 } NR == 1 || s < best { best = s } END { print best }'
}

printf '%-12s %5s %10s %8s %7s %7s\n' method level bytes seconds size time
for method in edgebreaker sequential; do
	base_time=$(seconds --draco=$method --draco-speed=5)
	base_size=$(stat -c %s "$folder/out.glb")
	for level in 0 1 2 3 4 5 6 7 8 9 10; do
		time=$(seconds --draco=$method --draco-speed=$level)
		size=$(stat -c %s "$folder/out.glb")
		awk -v m=$method -v l=$level -v s="$size" -v t="$time" -v s0="$base_size" -v t0="$base_time" \
			'BEGIN { printf "%-12s %5d %10d %8.2f %7.2f %7.2f\n", m, l, s, t, s / s0, t / t0 }'
	done
done
