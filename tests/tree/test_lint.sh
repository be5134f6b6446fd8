# SPDX-License-Identifier: MIT
# make lint finds nothing, and finds what it should.
. "$ROOT/tests/support/cli.sh"

scene "the tree keeps its rules"
make -s -C "$ROOT" MAKEFLAGS= config=release lint >found 2>&1 || wrong "make lint fails"
sed 's/^/# /' found

# A tree of its own with one fault.
faulty() {
	mkdir -p tree/src/base tree/src/cli tree/src/tangent tree/tests/lint
	cp "$ROOT/tests/lint/rooms.sh" tree/tests/lint/
	printf '/* SPDX-License-Identifier: MIT */\n%s\n' "$2" >"tree/$1"
	(cd tree && git init -q . && git add -A && bash tests/lint/rooms.sh) >"$WORK/out.txt" 2>&1
	status=$?
	exits "$3"
}

scene "an arrow that the design does not have is found"
faulty src/base/a.c '#include "io/file.h"' 1
prints "src/base/a.c: base may not include io"

scene "printing and exiting outside cli are found"
faulty src/tangent/a.c '	printf("x");' 1
prints "src/tangent/a.c:2: prints or exits"
rm -rf tree
faulty src/tangent/a.c '	exit(1);' 1
rm -rf tree
faulty src/tangent/a.c ' * it may exit(1) in a comment' 0
rm -rf tree
faulty src/cli/a.c '	printf("x");' 0

scene "a file without licence line is found"
faulty src/base/a.c '' 0
echo 'int x;' >tree/src/base/b.c
(cd tree && git add -A && bash tests/lint/rooms.sh) >"$WORK/out.txt"
is $? 1
prints "src/base/b.c: no SPDX line"

done_testing
