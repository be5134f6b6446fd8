# SPDX-License-Identifier: MIT
# The example at the top of include/nmtan.h compiles as it stands, in C11 and in C++17, without a warning, and
# gives what the header says; so do the macros that initialise structs.
. "$ROOT/tests/support/cli.sh"
header=$ROOT/include/nmtan.h

# The program in the first comment, indented by five spaces.
cd "$WORK" || exit 1
sed -n '1,/^#ifndef/s/^ \*     //p' "$header" >example

cat >program.c <<'END'
#include <nmtan.h>
#include <stdio.h>

int main(void)
{
#include "example"
	printf("%s, %u copies\n", nmtan_status_text(status), (unsigned)output.source_count);
	for (int c = 0; c < 3; c++)
		printf("%u: %g %g %g %g\n", (unsigned)indices[c], tangents[indices[c]][0], tangents[indices[c]][1],
			tangents[indices[c]][2], tangents[indices[c]][3]);
	const nmtan_options options = NMTAN_OPTIONS_INIT;
	const nmtan_output corners = NMTAN_OUTPUT_INIT;
	const nmtan_counts counts = NMTAN_COUNTS_INIT;
	const nmtan_timing timing = NMTAN_TIMING_INIT;
	const nmtan_stored_uv stored = NMTAN_STORED_UV_INIT;
	return options.struct_bytes == sizeof options && corners.struct_bytes == sizeof corners &&
		counts.struct_bytes == sizeof counts && timing.struct_bytes == sizeof timing &&
		stored.struct_bytes == sizeof stored ? 0 : 1;
}
END
cp program.c program.cpp

# Derived by hand: u grows along +x, v of v up along +y.
cat >expected <<'END'
ok, 0 copies
0: 1 0 0 1
1: 1 0 0 1
2: 1 0 0 1
END
strict="-Wall -Wextra -Werror -pedantic"

scene "the example of nmtan.h has at most fifteen lines and runs as C11"
is "$(($(wc -l <../example) <= 15))" 1
cc -std=c11 $strict -I"$ROOT/include" -o program ../program.c "$BUILD/libnmtan.a" -pthread -lm ||
	wrong "does not compile"
./program >printed || wrong "exit code $?"
diff ../expected printed || wrong "prints something else"

scene "the example of nmtan.h runs as C++17"
c++ -std=c++17 $strict -I"$ROOT/include" -o program ../program.cpp "$BUILD/libnmtan.a" -pthread -lm ||
	wrong "does not compile"
./program >printed || wrong "exit code $?"
diff ../expected printed || wrong "prints something else"

scene "each function has a page for man, which says what the header says; without its comment there is none"
make -C "$ROOT" -s build/man3/nmtan.3 >make.txt 2>&1 || wrong "$(tail -5 make.txt)"
is "$(cd "$ROOT/build/man3" && echo *.3)" "$(cd "$ROOT" && { echo nmtan.3 && sed -n 's/^NMTAN_[AI][A-Z]* .*\b\(nmtan_[a-z_]*\)(.*/\1.3/p' include/nmtan.h; } |
	LC_ALL=C sort | tr '\n' ' ' | sed 's/ $//')"
for page in "$ROOT"/build/man3/*.3; do
	if command -v man >/dev/null; then
		MANWIDTH=100 man --warnings -E UTF-8 -l "$page" 2>&1 >text.txt | head -3 | grep . && wrong "$page"
	fi
done
if command -v man >/dev/null; then
	MANWIDTH=200 man -E UTF-8 -l "$ROOT/build/man3/nmtan_vertex_tangents.3" | col -b >text.txt
	for said in "nmtan_vertex_tangents - computes a tangent for every vertex" "0: v points up in texcoords" NMTAN_ERROR_CAPACITY; do
		grep -q "$said" text.txt || wrong "no $said"
	done
fi
sed '/^NMTAN_API nmtan_status nmtan_tangents/i int between;' "$header" >without.h
! python3 -B "$ROOT/src/api/man3.py" without.h pages 2>err.txt || wrong "a function without a comment"
grep -q "no comment in front of {'nmtan_tangents'}" err.txt || wrong "$(cat err.txt)"
done_testing
