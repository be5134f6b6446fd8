#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/hostile.sh BUILD_DIR...: 10 000 damaged copies (NT_MUTATIONS) in all of the files of ../shared that
# are models or tests of the validator, and the files themselves, in as many processes as there are
# processors: see hostile.c. A third or more must come as far as geometry. NT_RUN=FILE:RUN, as the
# messages number them, runs one alone; NT_KEEP=PATH keeps its input.
set -u
cd "$(dirname "$0")/../.." || exit 1
[ -d ../shared ] || { echo "hostile.sh: ../shared is not here, nothing to run"; exit 0; }
export ASAN_OPTIONS=exitcode=99:allocator_may_return_null=1:max_allocation_size_mb=2048:quarantine_size_mb=16
mapfile -t files < <(find ../shared/models ../shared/corpus -type f \( -name '*.gltf' -o -name '*.glb' \
	-o -name '*.obj' -o -name '*.ply' -o -name '*.drc' \) | LC_ALL=C sort)
passed=0 failed=0
parts=$(nproc)
for build in "$@"; do
	pids=()
	for ((part = 0; part < parts; part++)); do
		"$build/tests/soak/hostile" $part "$parts" "${NT_MUTATIONS:-10000}" "${files[@]}" \
			>"$build/hostile.$part.out" 2>"$build/hostile.$part.log" </dev/null &
		pids+=($!)
	done
	for part in "${!pids[@]}"; do
		wait "${pids[$part]}" || { failed=$((failed + 1)); grep -aE 'hostile:|ERROR|runtime error' "$build/hostile.$part.log" | tail -40; }
	done
	cat "$build"/hostile.*.out | awk -v build="$build" '
		{ files += $1; runs += $2; written += $3; refused += $4; met += $5; opened += $6; bad += $9
		  slowest = $7 > slowest ? $7 : slowest; largest = $8 > largest ? $8 : largest }
		END { printf "%s: %d files whole and %d mutations: %d written, %d refused, %d as far as geometry; " \
			"%d opens watched; slowest %.2f s, largest %d MB; %d bad\n",
			build, files, runs, written, refused, met, opened, slowest, largest, bad
		      exit met * 3 < runs }' || { failed=$((failed + 1)); echo "FAILED less than a third came as far as geometry"; }
	rm -f "$build"/hostile.*.out
	passed=$((passed + 1))
done
echo "$((passed > failed ? passed - failed : 0)) passed, $failed failed"
[ $failed = 0 ]
