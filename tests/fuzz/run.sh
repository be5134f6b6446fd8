#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/fuzz/run.sh BUILD FUZZ_BUILD SECONDS TARGET...: so many seconds with each target in turn. An input that fails
# is kept in FUZZ_BUILD/found/TARGET and the target goes on, unless it fails at the same input again. Inputs that lead
# further are kept in FUZZ_BUILD/corpus/TARGET, for the next time. Fails when an input did. To run one again:
#
#   FUZZ_VERBOSE=1 FUZZ_TARGET=ply build/fuzz/tests/fuzz/target build/fuzz/found/ply/crash-...
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$1 fuzz=$2 seconds=$3
shift 3
# An allocation that is too large is refused as in a full memory; others count as used.
export ASAN_OPTIONS=allocator_may_return_null=1:quarantine_size_mb=16:detect_stack_use_after_return=0
limits=(-timeout=20 -rss_limit_mb=1024 -malloc_limit_mb=512 -max_len=24576)
all_failed=0

bash tests/fuzz/seeds.sh "$build" "$fuzz/seeds" || exit 1
for target in "$@"; do
	export FUZZ_TARGET=$target
	corpus=$fuzz/corpus/$target found=$fuzz/found/$target log=$fuzz/$target.log
	mkdir -p "$corpus" "$found"
	: >"$log"
	dictionary=tests/fuzz/${target/glb/gltf}.dict
	executions=0 edges=0 failed=0 last= end=$((SECONDS + seconds))
	while [ $SECONDS -lt $end ]; do
		"$fuzz/tests/fuzz/target" "${limits[@]}" -max_total_time=$((end - SECONDS)) -dict="$dictionary" \
			-artifact_prefix="$found/" -print_final_stats=1 "$corpus" "$fuzz/seeds/$target" >"$log.run" 2>&1
		status=$?
		cat "$log.run" >>"$log"
		read -r more cov < <(awk '/^stat::number_of_executed_units/ { units = $2 }
			/ cov: / { for (i = 1; i < NF; i++) if ($i == "cov:") cov = $(i + 1) }
			END { print units + 0, cov + 0 }' "$log.run")
		executions=$((executions + more))
		[ "$cov" -le $edges ] || edges=$cov
		[ $status = 0 ] && continue
		failed=$((failed + 1))
		grep -aE 'WRONG|runtime error|ERROR: |SUMMARY: |Test unit written' "$log.run" | head -6
		[ "$more" -gt 0 ] || { tail -5 "$log.run"; break; }
		written=$(grep -a 'Test unit written' "$log.run")
		[ "$written" != "$last" ] || break
		last=$written
	done
	rm -f "$log.run"
	echo "$target: $executions executions, $edges edges, $failed crashes"
	all_failed=$((all_failed + failed))
done
[ $all_failed = 0 ]
