#!/bin/bash
# SPDX-License-Identifier: MIT
#
# rooms.sh [BUILD_DIR]: make lint. Allowed arrows between rooms (rooms.py), SPDX lines, nothing that prints or exits
# outside src/cli, C++ in src/ext alone, lines of C and C++ of at most 120 columns, no addresses of package registries
# or paths of one machine, and with BUILD_DIR what the libraries show and need. Prints one line per fault.
set -u
cd "$(dirname "$0")/../.." || exit 1
faults=0
fault() {
	echo "lint: $*"
	faults=$((faults + 1))
}

# Arrows between rooms: includes, and symbols where there is a build.
python3 tests/lint/rooms.py ${1+"$1"} || faults=$((faults + 1))

# Sentences that hide who acts.
python3 -B tests/lint/sentences.py || faults=$((faults + 1))

while IFS= read -r file; do
	fault "$file: C++ outside src/ext"
done < <(find src -name '*.[ch]pp' ! -path 'src/ext/*' | sort)

while IFS= read -r place; do
	fault "$place: a line of more than 120 columns"
done < <(git ls-files -z '*.c' '*.h' '*.cpp' '*.hpp' 2>/dev/null | xargs -0r awk '
	length > 64 { gsub(/\t/, "        "); if (length > 120) print FILENAME ":" FNR }')

while IFS= read -r place; do
	fault "$place: a blank at the end, or spaces where .editorconfig has tabs"
done < <(git ls-files -z '*.c' '*.h' '*.cpp' '*.sh' '*.py' '*.mk' Makefile 2>/dev/null | xargs -0r awk '
	/[ \t]$/ || (FILENAME ~ /\.c(pp)?$/ && /^    /) { print FILENAME ":" FNR }')

while IFS= read -r place; do
	fault "$place: cuts a text inside of a character: %.*s and NT_CUT()"
done < <(grep -rnoE --include='*.[ch]' --include='*.[ch]pp' '%[0-9]*\.[0-9]+s' src)

calls='(^|[^a-zA-Z0-9_.>])(abort|exit|_exit|_Exit|quick_exit|printf|puts|putchar|perror|vprintf)[[:space:]]*\(|fprintf[[:space:]]*\([[:space:]]*std|std::(cout|cerr)'
while IFS= read -r file; do
	# Comments may speak of printf; code may not call it.
	sed -E 's,/\*.*\*/,,; s,^[[:space:]]*\*.*,,; s,//.*,,' "$file" | grep -nE "$calls" |
		# The handler of a deadly signal may end what the signal would have ended.
		{ [ "$file" = src/file/temporary.c ] && grep -v '_exit(128 + ' || cat; } |
		while IFS= read -r line; do echo "lint: $file:${line%%:*}: prints or exits: ${line#*:}"; done |
		grep . && faults=$((faults + 1))
done < <(grep -rlE --include='*.[ch]' --include='*.[ch]pp' "$calls" src | grep -v '^src/cli/' | sort)

marked=$(git ls-files -z 2>/dev/null | xargs -0 grep -nHsIm1 'SPDX-License-Identifier: MIT' | sed -nE 's/:[123]:.*//p')
while IFS= read -r file; do
	case $file in
	LICENSE | .gitignore | .clang-format | *README.md | man/* | data/*) continue ;;
	*.json | *.tsv | *.png | *.bin | *.glb | *.gltf) continue ;;
	esac
	[[ $'\n'$marked$'\n' == *$'\n'"$file"$'\n'* ]] || fault "$file: no SPDX line at its top"
done < <(git ls-files 2>/dev/null)

while IFS= read -r hit; do
	fault "$hit"
done < <(git grep -nIE 'registry\.[a-z]+\.|"resolved"|(^|[^a-zA-Z0-9_.}])/(work|root|home/[a-z]+)/' -- . ':!tests/lint' 2>/dev/null)

# Symbols that the shared library exports, and that the static one needs.
build=${1-}
if [ -n "$build" ]; then
	while IFS= read -r symbol; do
		fault "libnmtan.so exports $symbol"
	done < <(nm -D --defined-only "$build/libnmtan.so" | awk '$2 != "A" && $3 !~ /^nmtan_/ { print $3 }')
	while IFS= read -r symbol; do
		fault "libnmtan.a needs C++: $symbol"
	done < <(nm -u "$build/libnmtan.a" 2>/dev/null | awk '$2 ~ /^(_Z|__cxa|__gxx)/ { print $2 }' | sort -u)
fi

[ $faults = 0 ] && echo "lint: nothing found"
[ $faults = 0 ]
