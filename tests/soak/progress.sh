#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/progress.sh BUILD_DIR...: with the first build, a batch that waits twelve seconds for one input: a log gets
# one line, after ten seconds, with what has ended and failed; a terminal one that replaces itself.
set -u
cd "$(dirname "$0")/../.." || exit 1
tool=$PWD/$1/nmtan
mesh=$PWD/data/quad.obj
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
passed=0 failed=0
judge() {
	if [ "$2" = "$3" ]; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED $1: got '$2', expected '$3'"
	fi
}
cp "$mesh" a.obj && cp "$mesh" b.obj && mkfifo slow.obj || exit 1

(sleep 12; cat a.obj >slow.obj) &
"$tool" -q -j1 --progress=on -d out a.obj missing.obj slow.obj b.obj 2>quiet
wait
judge "quiet is quiet" "$(grep -c 'files/s' quiet)" 0
(sleep 12; cat a.obj >slow.obj) &
"$tool" -j1 --progress=on -d out a.obj missing.obj slow.obj b.obj 2>log
wait
judge "a line in ten seconds" "$(grep -cE '^nmtan: 2 of 4 files, 1 failed, 0\.[12][0-9]* files/s, 0\.0 MB, (9|10|11) s left$' log)" 1
judge "and no other" "$(grep -c ' files, ' log)" 1
(sleep 3; cat a.obj >slow.obj) &
script -qec "'$tool' -j1 -d out a.obj missing.obj slow.obj b.obj" /dev/null >terminal
wait
judge "a terminal" "$(grep -c '2 of 4 files, 1 failed, .* s left, 1 s' terminal)" 1
echo "$passed passed, $failed failed"
[ $failed = 0 ]
