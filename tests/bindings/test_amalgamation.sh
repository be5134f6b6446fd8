# SPDX-License-Identifier: MIT
# build/amalgamation/nmtan.c by several compilers, with flags that change how floats are computed elsewhere: one digest
# of the golden meshes for all. tests/soak/amalgamation.sh has other processors. It also sets NMTAN_LEVEL to -O1, for which gcc
# takes three times as long as for -O0; then all compilers are asked, of all meshes. Without it, those marked "soak" are not: gcc has their
# optimizations, processors and system library in other rows, or in other tests.
. "$ROOT/tests/support/cli.sh"
cd "$WORK" || exit 1
level=${NMTAN_LEVEL--O0}
make -C "$ROOT" -s amalgamation build/release/libnmtan.a >make.txt 2>&1 || wrong "$(tail -5 make.txt)"
one=$ROOT/build/amalgamation
# those of less than 145 KB: what is larger is a torus, a plane or a sphere, too
[ -n "${NMTAN_LEVEL-}" ] && size=+0 || size=-145k
mapfile -t goldens < <(find "$ROOT/data/golden" -name '*.nmtg' -size $size | LC_ALL=C sort)

# digest COMMAND...: what the program prints that it builds of digest.c and nmtan.c, the sources being last. Builds that
# optimize nothing have no warnings, which takes less time than to look at the source once more.
digest() {
	local warnings=-w
	[[ " $* " != *" -O0 "* ]] || warnings="-Wall -Wextra -Wpedantic -Werror"
	"$@" $warnings -I"$one" "$ROOT/tests/api/digest.c" "$source" -o digest -lm 2>err.txt || { cat err.txt; return; }
	./digest "${goldens[@]}"
}
source=$ROOT/build/release/libnmtan.a
expected=$(digest gcc -pthread)
source=$one/nmtan.c

scene "the library passes its own test, and one file has at most 15 000 lines"
[ "${expected#* }" = "self-test 1" ] || wrong "$expected"
[ "$(wc -l <"$source")" -le 15000 ] || wrong "$(wc -l "$source")"

# Kernels for processors of before 2013 run nowhere else: old.c does not ask for AVX2.
while IFS='|' read -r name command soak; do
	[ -z "$soak" ] || [ -n "${NMTAN_LEVEL-}" ] || continue
	scene "$name: the same results"
	if ! command -v "${command%% *}" >/dev/null; then
		skip_case "${command%% *} is not here"
		continue
	fi
	[ "$name" = "${name%without AVX2}" ] || source=$PWD/old.c
	[ "$source" = "$one/nmtan.c" ] || sed 's/has(bit_AVX2, 0x6)/0/' "$one/nmtan.c" >"$source"
	# shellcheck disable=SC2086
	actual=$(digest $command -DNMTAN_SUMS)
	source=$one/nmtan.c
	[ "$actual" = "$expected" ] || wrong "$actual, not $expected"
done <<END
gcc, each instruction set|gcc -std=c11 $level -DNMTAN_AVX512
gcc, a processor without AVX2|gcc $level -DNMTAN_FILE="old.c"|soak
gcc, fused operations and straight-line vectors|gcc -Os -march=haswell
gcc, C++17, threads of the caller|g++ -std=c++17 -x c++ -O0 -DNMTAN_JOBS
clang, fused operations|clang -O1 -march=haswell -DNMTAN_ONE_SET|soak
clang as MSVC, plain C11|clang -std=c11 -fms-extensions -fms-compatibility -DNMTAN_PLAIN_C
clang, C++17, threads|clang++ -std=c++17 -x c++ -O0 -pthread -DNMTAN_THREADS
musl, static|musl-gcc -O0 -static|soak
END

# Bytes of code at -O2: 561 395 at commit 13aeea55, 380 339 before code had levels and sums a macro.
scene "without NMTAN_SUMS it passes its own test, and at -O2 it is at most 200 000 bytes of code"
gcc ${NMTAN_LEVEL:+-O2} -w -c -I"$one" "$source" -o size.o
code=$(objdump -h size.o | awk '$2 == ".text" { print $3 }')
[ -z "${NMTAN_LEVEL-}" ] || [ $((16#$code)) -le 200000 ] || wrong "$((16#$code)) bytes of code"
printf '#include "nmtan.h"\nint main(void) { return !nmtan_self_test(); }\n' >self.c
gcc -w -I"$one" self.c size.o -o self -lm && ./self || wrong "the self-test fails without NMTAN_SUMS"

scene "flags that reorder floats are refused"
for flags in -ffast-math -funsafe-math-optimizations -ffinite-math-only; do
	! gcc $flags -E -I"$one" "$source" 2>err.txt >/dev/null || wrong "gcc $flags is taken"
	grep -q "change the results" err.txt || wrong "$(cat err.txt)"
done
! command -v clang >/dev/null || ! clang -ffast-math -E -I"$one" "$source" 2>err.txt >/dev/null || wrong "clang"

scene "no warnings, in C and C++, in plain C neither; the first lines name the macros"
for define in DEFAULTS SUMS PLAIN_C THREADS; do
	for compiler in "gcc -std=c11" "clang -std=c11" "g++ -std=c++17 -x c++" "clang++ -std=c++17 -x c++" "g++ -std=c++20 -x c++" "clang++ -std=c++20 -x c++"; do
		case "$define $compiler" in
		# the digests above have had these
		"SUMS gcc"* | *S*"++ -std=c++17"*) continue ;;
		*++20*) [ $define = THREADS ] || [ -n "${NMTAN_LEVEL-}" ] || continue ;;
		esac
		# shellcheck disable=SC2086
		! command -v "${compiler%% *}" >/dev/null || $compiler -Wall -Wextra -Wpedantic -Werror -fsyntax-only -DNMTAN_$define \
			-I"$one" "$source" >err.txt 2>&1 || wrong "$compiler -DNMTAN_$define: $(head -20 err.txt)"
	done
	[ $define = PLAIN_C ] || [ $define = DEFAULTS ] || sed -n '1,/\*\//p' "$source" | grep -q "^ \*   NMTAN_$define " || wrong "the first lines do not name NMTAN_$define"
done

scene "nmtan_self_test() sees contraction, and optimizations of clang's that have no macro"
all=("${goldens[@]}")
goldens=("${goldens[0]}")
if command -v clang >/dev/null; then
	actual=$(digest clang -O0 -funsafe-math-optimizations -DNMTAN_SUMS)
	[ "${actual#* }" = "self-test 0" ] || wrong "clang: $actual"
fi
if [ -n "${NMTAN_LEVEL-}" ]; then
	grep -v 'pragma GCC optimize' "$source" >nmtan.c
	source=$PWD/nmtan.c
	actual=$(digest gcc -O1 -fexpensive-optimizations -mfma -ffp-contract=fast -DNMTAN_ONE_SET -DNMTAN_SUMS)
	[ "${actual#* }" = "self-test 0" ] || wrong "$actual"
fi
goldens=("${all[@]}")

scene "add_subdirectory() finds nmtan::nmtan"
mkdir -p project
cat >project/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.13)
project(importer C)
add_subdirectory("$one" nmtan)
add_executable(importer "$ROOT/tests/api/digest.c")
target_link_libraries(importer nmtan::nmtan)
END
if cmake -DNMTAN_SUMS=ON -S project -B made >cmake.txt 2>&1 && cmake --build made >cmake.txt 2>&1; then
	[ "$(made/importer "${goldens[@]}")" = "$expected" ] || wrong "another digest"
else
	wrong "$(tail -5 cmake.txt)"
fi

done_testing
