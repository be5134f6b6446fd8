#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/races.sh: the thread sanitizer in everything that has threads: many models at once, converted and checked, in 4 jobs
# of 4 threads, the unit tests of the rooms that start some, the scripts of batches, reports and checks.
#
# One thing is suppressed: where a mapped file has become shorter, the handler of SIGBUS (src/file/watch.c) maps zeros while
# others may read there. The kernel does that at once, and a page behind the end never had bytes: nobody sees but zeros.
set -u
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d)
echo "race:put_zeros" >"$work/suppressions"
export TSAN_OPTIONS="exitcode=66 halt_on_error=1 second_deadlock_stack=1 suppressions=$work/suppressions"
trap 'rm -rf "$work"' EXIT
code=0
make -s -j"$(nproc)" config=tsan all tests >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }

# Everything that is small; some of it is damaged, and fails. Packed views and blocks of Draco are opened for several
# meshes of one file at once: the table has the former, the second batch makes the latter.
mkdir "$work/in" && cp -r data "$work/in/"
[ ! -d ../shared/models ] || cp -r ../shared/models "$work/in/"
chmod -R u+w "$work/in"
find "$work/in" -type f -size +2M -delete
(cd "$work/in" && python3 -B "$OLDPWD/tests/support/gltf_table.py" make) || exit 1
runs=0
for options in "--keep-tree=in -d out --only=all --existing=replace in" "--keep-tree=in -d blocks --only=all --draco=edgebreaker \
	--report=r.html in" "--keep-tree=blocks -d plain --existing=replace --draco=off --verify blocks" "--check --report=r.json in" \
	"--check --across=mesh --report=r.sarif in"; do
	# shellcheck disable=SC2086
	(cd "$work" && exec "$OLDPWD/build/tsan/nmtan" -q --recursive --jobs=4 --threads=4 $options) >"$work/said" 2>&1
	[ $? != 66 ] && ! grep -q ThreadSanitizer "$work/said" || { code=1; echo "FAILED $options"; head -60 "$work/said"; }
	runs=$((runs + 1))
done
[ "$(find "$work/out" -name '*.gl*' | wc -l)" -gt 10 ] || { code=1; echo "FAILED nothing was converted"; }
echo "$runs batches of 4 jobs with 4 threads: $([ $code = 0 ] && echo "no races" || echo "see above")"

# The rooms that start threads (the lanes of tangent/fast compare every set and count, which takes too long here), and scripts.
for part in unit/base/ unit/file/ unit/topology/ unit/obj/ unit/pipeline/ cli/test_batch \
	cli/test_check cli/test_report cli/test_limits; do
	bash tests/run --only=$part build/tsan >"$work/said" 2>&1 || { code=1; sed -n '/^failed:/,$p' "$work/said"; }
	echo "$part: $(tail -1 "$work/said")"
done
exit $code
