#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/published.sh BUILD_DIR...: the bytes of mikktspace.c as published, which lies with mikktspace.h in the folder
# that $MIKKTSPACE names, on 1 000 000 random meshes (NT_MESHES, from NT_FROM on), in as many processes as there are
# processors: see published.c. Without that folder nothing runs.
set -u
cd "$(dirname "$0")/../.." || exit 1
[ -f "${MIKKTSPACE:-.}/mikktspace.c" ] ||
	{ echo "published.sh: \$MIKKTSPACE names no folder that has mikktspace.c, nothing was compared"; exit 0; }
build=$1
make -s config="${build##*/}" MIKKTSPACE="$MIKKTSPACE" "$build/tests/soak/published" || exit 1
parts=$(nproc)
each=$((${NT_MESHES:-1000000} / parts))
pids=()
for ((part = 0; part < parts; part++)); do
	"$build/tests/soak/published" $((${NT_FROM:-0} + part * each)) $each >"$build/published.$part.out" 2>"$build/published.$part.log" &
	pids+=($!)
done
failed=0
for part in "${!pids[@]}"; do
	wait "${pids[$part]}" || { failed=$((failed + 1)); tail -20 "$build/published.$part.log"; }
done
cat "$build"/published.*.out | awk '{ meshes += $1; different += $2; matter += $3 }
	END { printf "published.sh: %d meshes, %d show the unfinished sort, %d differ\n", meshes, matter, different }'
rm -f "$build"/published.*.out
echo "$((parts - failed)) passed, $failed failed"
[ $failed = 0 ]
