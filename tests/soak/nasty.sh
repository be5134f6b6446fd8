#!/bin/bash
# SPDX-License-Identifier: MIT
# The arc cosine for every float of [-1, 1]; 100 000 nasty meshes: the fast path against the definition, and grids under sanitizers, in as many processes as there are processors.
build=$1 sanitized=$2
each=$((100000 / $(nproc)))
pids=()
for ((i = 0; i < $(nproc); i++)); do
	NT_NASTY_FROM=$((i * each + 1000000)) NT_NASTY_COUNT=$each \
		"$build/tests/unit/tangent/fast/test_fast" >"$build/nasty.$i.log" 2>&1 &
	pids+=($!)
done
failed=0
NT_ALL_GRIDS=1 "$sanitized/tests/unit/tangent/fast/test_fast" >"$build/grids.log" 2>&1 || { failed=1; tail -20 "$build/grids.log"; }
NT_ACOS_ALL=1 "$build/tests/unit/tangent/test_acos" >"$build/acos.log" 2>&1 || { failed=$((failed + 1)); tail -20 "$build/acos.log"; }
for i in "${!pids[@]}"; do
	wait "${pids[$i]}" || { failed=$((failed + 1)); tail -20 "$build/nasty.$i.log"; }
done
echo "$((${#pids[@]} + 2 - failed)) passed, $failed failed"
[ "$failed" -eq 0 ]
