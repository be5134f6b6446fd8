# SPDX-License-Identifier: MIT
# The binary interface of libnmtan.so against data/libnmtan.abi. A program that was linked to an older library must
# run with a newer one: structs may grow at their end (see "Structs" in nmtan.h) and functions may be added, which is
# noted with NMTAN_UPDATE=1; all else needs a new soname.
. "$ROOT/tests/support/cli.sh"
dump=$data/libnmtan.abi

scene "the binary interface is that of data/libnmtan.abi"
if ! command -v abidw >/dev/null 2>&1; then
	skip_case "abidw is not installed (abigail-tools)"
	done_testing
	exit
fi
make -C "$ROOT" -s config=debug build/debug/libnmtan.so >make.txt 2>&1 || wrong "$(tail -5 make.txt)"
abidw --headers-dir "$ROOT/include" --drop-private-types --exported-interfaces-only --no-corpus-path --no-comp-dir-path \
	"$ROOT/build/debug/libnmtan.so" >now.abi 2>err.txt || wrong "$(cat err.txt)"
[ -z "${NMTAN_UPDATE-}" ] || cp now.abi "$dump"
abidiff "$dump" now.abi >diff.txt 2>&1 || wrong "it has changed: $(head -40 diff.txt)"
cp now.abi "$WORK/now.abi"

scene "a function that is gone, a member that has moved and an enumerator with another value are found"
for change in s/nmtan_split\'/nmtan_cut\'/ "s/layout-offset-in-bits='128'/layout-offset-in-bits='192'/" \
	"s/name='NMTAN_METHOD_ROBUST' value='3'/name='NMTAN_METHOD_ROBUST' value='4'/"; do
	sed "$change" "$WORK/now.abi" >changed.abi
	! cmp -s changed.abi "$WORK/now.abi" || wrong "$change changes nothing"
	! abidiff "$WORK/now.abi" changed.abi >/dev/null 2>&1 || wrong "$change is not found"
done

scene "every function of nmtan.h has a version, and nothing else is exported"
sed -n 's/^NMTAN_API .*\b\(nmtan_[a-z_]*\)(.*/\1/p' "$ROOT/include/nmtan.h" | sort -u >said.txt
nm -D --defined-only "$BUILD/libnmtan.so" | awk '$2 == "T" { print $3 }' >exported.txt
sed -n 's/@@NMTAN_.*//p' exported.txt | sort >versioned.txt
[ "$(wc -l <exported.txt)" = "$(wc -l <versioned.txt)" ] || wrong "without a version: $(grep -v @@ exported.txt)"
diff said.txt versioned.txt >diff.txt || wrong "$(cat diff.txt)"
done_testing
