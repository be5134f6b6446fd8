#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/races.sh: the thread sanitizer in everything that has threads: the unit tests, the scripts of batches, reports
# and checks, and many models at once, converted and checked, in 4 jobs of 4 threads. There are no suppressions.
set -u
cd "$(dirname "$0")/../.." || exit 1
export TSAN_OPTIONS="exitcode=66 halt_on_error=1 second_deadlock_stack=1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
nmtan=$PWD/build/tsan/nmtan
code=0
make -s -j"$(nproc)" config=tsan all tests build/tsan/tests/bench/make_obj.o >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
make -s config=release build/release/tests/bench/make_obj.o &&
	gcc -o "$work/make_obj" build/release/tests/bench/make_obj.o -lm && "$work/make_obj" 150 >"$work/torus.obj" || exit 1

for part in tests/unit/ tests/api/ cli/test_batch cli/test_check cli/test_report cli/test_output; do
	bash tests/run --only=$part build/tsan >"$work/said" 2>&1 || { code=1; sed -n '/^failed:/,$p' "$work/said"; }
	tail -1 "$work/said"
done

models=("$work/torus.obj" data/*.obj data/*.ply data/*.gltf data/*.glb)
[ ! -d ../shared/models ] || mapfile -t -O ${#models[@]} models < <(
	find ../shared/models -type f -size -2M \( -name '*.gltf' -o -name '*.glb' -o -name '*.obj' -o -name '*.ply' -o -name '*.drc' \))
runs=0
for options in "-d $work/out --only=all --existing=replace" "-d $work/out --draco=edgebreaker --report=$work/r.html" \
	"--check --report=$work/r.json" "--check --across=mesh --report=$work/r.sarif"; do
	# shellcheck disable=SC2086
	"$nmtan" -q --jobs=4 --threads=4 $options "${models[@]}" >"$work/said" 2>&1
	[ $? != 66 ] && ! grep -q 'ThreadSanitizer' "$work/said" || { code=1; echo "FAILED $options"; grep -A30 ThreadSanitizer "$work/said" | head -40; }
	runs=$((runs + 1))
done
echo "$runs batches of ${#models[@]} models in 4 jobs of 4 threads: $([ $code = 0 ] && echo no races || echo "see above")"
exit $code
