#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/progress.sh BUILD_DIR...: with the first build, a batch that waits twelve seconds for one input: a log gets
# one line, after ten seconds, with what has ended and failed; a terminal one that replaces itself.
cd "$(dirname "$0")/../.." || exit 1
ROOT=$PWD NMTAN=$PWD/$1/nmtan WORK=$(mktemp -d)
. "$ROOT/tests/support/cli.sh"
inputs="a.obj missing.obj slow.obj b.obj"

# waits SECONDS: slow.obj comes after so long.
waits() {
	cp "$data/quad.obj" a.obj
	cp "$data/quad.obj" b.obj
	mkfifo slow.obj
	(sleep "$1" && cat a.obj >slow.obj) &
}

scene "quiet is quiet"
waits 12
run -q -j1 --progress=on -d out $inputs
says_not files/s

scene "a line in ten seconds, and no other"
waits 12
run -j1 --progress=on -d out $inputs
is "$(grep -cE '^nmtan: 2 of 4 files, 1 failed, 0\.[12][0-9]* files/s, 0\.0 MB, (9|10|11) s left$' "$WORK/err.txt")" 1
is "$(grep -c ' files, ' "$WORK/err.txt")" 1

scene "a terminal"
waits 3
script -qec "'$NMTAN' -j1 -d out $inputs" /dev/null >terminal
is "$(grep -c '2 of 4 files, 1 failed, .* s left, 1 s' terminal)" 1
cd / && done_testing && rm -rf "$WORK"
