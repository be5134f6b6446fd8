# SPDX-License-Identifier: MIT
# src/README.md, the map of the source, names only what is there.
. "$ROOT/tests/support/cli.sh"

# The words in backticks that are paths, from src/ or from the top; of a built test, its source.
paths_of() {
	tr '\n' ' ' <"$1" | grep -oE '`[^`]+`' | tr -d '`' | tr ' ' '\n' | grep -E '^[A-Za-z0-9_.-]+(/|\.[chm][a-z]*$)[A-Za-z0-9_./-]*$' |
		sed -E 's,^build/[a-z]+/(tests/.*)$,\1.c,' | grep -v '^build/' | sort -u
}
missing_of() {
	paths_of "$1" | while IFS= read -r path; do
		[ -e "$ROOT/src/$path" ] || [ -e "$ROOT/$path" ] || echo "$path"
	done
}

scene "every path in the map of the source exists"
[ "$(paths_of "$ROOT/src/README.md" | wc -l)" -gt 60 ] || wrong "few paths are found in it"
is "$(missing_of "$ROOT/src/README.md")" ""

scene "a path that does not exist is found"
echo 'see `base/memory.c`, `base/nowhere.c`, `tests/unit/base` and `A=1 build/release/tests/unit/base/test_nothing`' >map.md
is "$(missing_of map.md)" "base/nowhere.c
tests/unit/base/test_nothing.c"

done_testing
