# SPDX-License-Identifier: MIT
# make lint finds nothing, and finds what it should.
. "$ROOT/tests/support/cli.sh"

scene "the tree keeps its rules"
make -s -C "$ROOT" MAKEFLAGS= config=release lint >found 2>&1 || wrong "make lint fails"
sed 's/^/# /' found

# table ROOM:USES...: the table of a tree of its own.
table() {
	mkdir -p tree/src
	printf '| room | what it is | may use |\n|---|---|---|\n' >tree/src/README.md
	for row in "$@"; do
		mkdir -p "tree/src/${row%%:*}"
		printf '| %s | - | %s |\n' "${row%%:*}" "${row#*:}" >>tree/src/README.md
		printf '/* SPDX-License-Identifier: MIT */\n' >"tree/src/${row%%:*}/first.h"
	done
}

# holds FILE TEXT: a file of that tree.
holds() {
	printf '/* SPDX-License-Identifier: MIT */\n%b\n' "$2" >"tree/src/$1"
}

# lint STATUS [BUILD_DIR]: what the checks say of that tree.
lint() {
	mkdir -p tree/tests/lint
	cp "$ROOT"/tests/lint/* tree/tests/lint/
	(cd tree && git init -q . && git add -A && bash tests/lint/rooms.sh ${2+"$2"}) >"$WORK/out.txt" 2>&1
	status=$?
	exits "$1"
}

scene "an arrow that the table does not have is found, in nested rooms too"
table base:- file:- gltf:file gltf/edit:gltf
holds gltf/edit/a.c '#include "gltf/first.h"\n#include "base/first.h"'
lint 0
holds gltf/edit/a.c '#include "file/first.h"'
lint 1
prints "src/gltf/edit/a.c: gltf/edit may not use file; it includes src/file/first.h"
holds gltf/edit/a.c ''
holds gltf/b.h '#include "gltf/edit/first.h"'
lint 1
prints "src/gltf/b.h: gltf may not use gltf/edit"

scene "an arrow that only symbols show is found"
table base:- report:- api:-
holds report/a.c 'void nt_solve(void);\nvoid nt_report(void);\nvoid nt_report(void) { nt_solve(); }'
holds api/b.c 'void nt_solve(void);\nvoid nt_solve(void) {}'
mkdir -p tree/build/report tree/build/api
${CC:-cc} -c -o tree/build/report/a.c.o tree/src/report/a.c && ${CC:-cc} -c -o tree/build/api/b.c.o tree/src/api/b.c
(cd tree && python3 "$ROOT/tests/lint/rooms.py" build) >"$WORK/out.txt"
is $? 1
prints "src/report/a.c: report may not use api; it calls nt_solve of src/api/b.c"

scene "a line of more than 120 columns is found, tabs counting as eight"
table base:-
printf -v words '%0112d' 0
holds base/a.c "\t// ${words:3}\n\t*$words = 1;"
lint 1
prints "src/base/a.c:3: a line of more than 120 columns"
! grep -q "a.c:2" "$WORK/out.txt" || wrong "120 columns are found"

scene "what .editorconfig says of blanks is kept"
table base:-
holds base/a.c 'int x; \n    int y;\n\tint z;'
lint 1
prints "src/base/a.c:2: a blank at the end"
prints "src/base/a.c:3: a blank at the end"
! grep -q "a.c:4" "$WORK/out.txt" || wrong "a tab is found"

scene "circles of headers, of files and of rooms are found"
table base:- file:ply ply:file
holds file/a.h '#include "file/b.h"'
holds file/b.h '#include "file/a.h"'
holds file/c.c '#include "ply/first.h"'
holds ply/d.c '#include "file/first.h"'
lint 1
prints "headers in a circle: src/file/a.h src/file/b.h"
prints "folders in a circle: file ply"
table base:-
holds base/a.c 'void a(void);\nvoid b(void);\nvoid a(void) { b(); }'
holds base/b.c 'void a(void);\nvoid b(void);\nvoid b(void) { a(); }'
mkdir -p tree/build/base
for c in a b; do ${CC:-cc} -c -o tree/build/base/$c.c.o tree/src/base/$c.c; done
(cd tree && python3 "$ROOT/tests/lint/rooms.py" build) >"$WORK/out.txt"
is $? 1
prints "files in a circle: src/base/a.c src/base/b.c"

scene "the table and the folders are the same"
table base:- file:gone
lint 1
prints "src/README.md: the table names gone, and src has no such folder"
table base:-
lint 1
prints "src/file: not in the table of src/README.md"
rm tree/src/README.md
lint 1
prints "src/README.md: is missing"

scene "a room that is too large is found"
table base:-
for i in $(seq 25); do holds base/f$i.c ''; done
lint 1
prints "src/base: 25 source files, 51 lines; at most 24 and 6500"
rm tree/src/base/*.c
yes '/* x */' | head -6500 >>tree/src/base/first.h
lint 1
prints "src/base: 0 source files, 6501 lines; at most 24 and 6500"

scene "printing and exiting outside cli are found"
table base:- cli:- tangent/fast:-
holds tangent/fast/a.c '\tprintf("x");'
holds tangent/fast/b.c '\texit(1);'
holds tangent/fast/c.c ' * it may exit(1) in a comment'
holds cli/d.c '\tprintf("x");'
lint 1
is "$(sed -n 's|^lint: src/\(.*\):2: prints or exits.*|\1|p' "$WORK/out.txt" | xargs)" "tangent/fast/a.c tangent/fast/b.c"
! grep -q '[cd]\.c' "$WORK/out.txt" || wrong "$(cat "$WORK/out.txt")"

scene "a format that cuts a text inside of a character is found"
table base:-
holds base/a.c '\tx("%.40s", name);'
lint 1
prints "src/base/a.c:2:%.40s: cuts a text"
holds base/a.c '\tx("%.*s %.4g", NT_CUT(40, name), number);'
lint 0

scene "C++ outside ext is found"
table base:- ext:-
holds ext/a.cpp ''
holds base/a.cpp ''
lint 1
prints "src/base/a.cpp: C++ outside src/ext"
! grep -q ext/a "$WORK/out.txt" || wrong "C++ in ext is found"

scene "sentences that hide who acts are found in comments, messages and manuals, and questions are not"
table base:-
number=0
for text in '/* What a call needs. */' '/* Reads all.\n * Where there is none it fails. */' '// Of two the first.' 'x("Done. Those are left.");' \
	'x("what is not read cannot be judged");'; do
	number=$((number + 1))
	holds base/bad$number.c "$text"
done
for text in '/* The input of a call, and what it needs. */' '/* What does it need? Nothing. */' 'x(", what"); x(" where it is");' 'int What, Where;'; do
	number=$((number + 1))
	holds base/good$number.c "$text"
done
lint 1
is "$(sed -n 's|^lint: src/base/\(.*\)\.c:[0-9]*: begins so that nobody acts:.*|\1|p' "$WORK/out.txt" | sort -u | xargs)" "bad1 bad2 bad3 bad4 bad5"
! grep -q good "$WORK/out.txt" || wrong "$(grep good "$WORK/out.txt")"
mkdir -p tree/man
printf '.TP\n.B \\-\\-all\nWhere all are meant.\n' >tree/man/x.1
lint 1
prints "man/x.1:3"
rm -r tree/man

scene "no sentence that ../shared/docs/english.md has a better one for is left"
english=$ROOT/../shared/docs/english.md
if [ -f "$english" ]; then
	for file in "$ROOT"/README.md "$ROOT"/man/* "$ROOT"/src/README.md $(find "$ROOT/src" "$ROOT/include" -name '*.[ch]'); do
		tr -s '\t\n *' ' ' <"$file"
	done | sed 's/\\-/-/g; s/" "//g' >all
	grep '^| [^w-]' "$english" | cut -d'|' -f3 | tr -d '`' | sed 's/^ //; s/[. ]*$//' | cut -c1-60 >before
	[ "$(wc -l <before)" -gt 20 ] || wrong "$(cat before)"
	is "$(while IFS= read -r sentence; do ! grep -qF -e "$sentence" all || echo "$sentence"; done <before)" ""
else
	skip_case "../shared is not here"
fi

scene "a file without licence line is found"
table base:-
lint 0
echo 'int x;' >tree/src/base/b.c
lint 1
prints "src/base/b.c: no SPDX line"

done_testing
