# SPDX-License-Identifier: MIT
# README.md tells the truth: its C program compiles and prints what it says, its commands print what
# stands below them, its links lead somewhere, and it can be read in five minutes.
. "$ROOT/tests/support/cli.sh"
readme=$ROOT/README.md

# block LANGUAGE N: the Nth fenced block of that language.
block() {
	awk -v fence="\`\`\`$1" -v n="$2" '
		$0 == "```" && inside { inside = 0; next }
		inside && count == n { print }
		$0 == fence && !inside { inside = 1; count++; next }' "$readme"
}

scene "the C program of the README compiles without warnings and prints what stands below it"
block c 1 >program.c
block text 1 >expected
exists program.c expected
cc -std=c11 -Wall -Wextra -Werror -pedantic -I"$ROOT/include" -o program program.c \
	"$ROOT/build/release/libnmtan.a" -pthread -lm || wrong "does not compile"
./program >printed || wrong "exit code $?"
diff expected printed || wrong "prints something else"

scene "the C program of the README compiles as C++17 too"
block c 1 >program.cpp
c++ -std=c++17 -Wall -Wextra -Werror -pedantic -I"$ROOT/include" -fsyntax-only program.cpp || wrong "does not compile"

scene "the README begins with what works from a clone"
is "$(grep -oE '^    make( [a-z-]+)?' "$readme" | head -5 | tr -s ' \n' ' ')" " make make demo make deb make wasm-tool make web "
for target in demo deb wasm-tool web check install uninstall install-lib; do
	grep -qE "^$target:" "$ROOT"/Makefile "$ROOT"/src/bindings/*/*.mk || wrong "there is no make $target"
done
for word in --fix --existing=keep --existing=replace; do
	head -30 "$readme" | grep -q -- "\`[^\`]*$word" || wrong "its first page does not name $word"
done

scene "peers have the versions in the README that the measurements have"
grep -oE '(gltfpack|meshoptimizer|mikktspace) [0-9][0-9.]*[0-9]' "$readme" | sort -u >versions
[ "$(wc -l <versions)" -ge 3 ] || wrong "$(cat versions)"
while IFS= read -r peer; do
	grep -qE "${peer% *}[- ]${peer#* }([^0-9.]|$)" "$ROOT/tests/bench/README.md" || wrong "the measurements have no $peer"
done <versions

scene "make is quiet, and shows its commands if asked"
object() { env -u MAKEFLAGS make --no-print-directory -C "$ROOT" B="$WORK/$1" "${@:2}" "$WORK/$1/base/hash.c.o" 2>&1; }
is "$(object quiet)" ""
exists "$WORK/quiet/base/hash.c.o"
object loud V=1 | grep -q -- '-c -o .*hash.c.o' || wrong "V=1 shows no command"

scene "the README's demo is what make demo prints"
# Times differ from run to run; numbers before "s" and the table of --timing are left out.
clean() {
	sed -E 's/[0-9.]+ m?s$/N ms/; /^[a-z]+ +[0-9]+\.[0-9]+$/d; s/^(-[rwx-]+).* ([^ ]+)$/\1 \2/'
}
make -s -C "$ROOT" MAKEFLAGS= demo 2>&1 | clean >printed
sed -n '/^\$ make demo$/,/^```$/p' "$readme" | sed '1d;$d' | clean >expected
exists expected printed
diff expected printed || wrong "prints something else"

scene "the examples of the README and the manual run as they stand, twice"
mkdir -p assets/sub bin
cp "$data"/mirrored_cube.* "$data/bumps.png" assets/sub
cp "$data/plates.glb" assets
cp assets/plates.glb in.glb
cp "$data/quad.obj" in.obj
cp in.glb old.glb
cp in.glb new.glb
# what the words of the text call a file: each has the command in it once more
cp in.glb FILE
cp in.glb IN.glb
cp in.glb model.glb
cp "$data/plates.gltf" model.gltf
cp "$data"/head.obj "$data"/plates.bin "$data"/bumps.png .
mkdir data
cp "$data"/plates.gltf "$data"/plates.bin "$data"/bumps.png data
cp "$data"/plates.gltf "$data"/plates.bin "$data"/bumps.png assets
ln -s "$NMTAN" bin/nmtan
ln -s "$ROOT/data/farm/nmtan-farm" bin/nmtan-farm
sed -n '/^## Use/,/^## Formats/p; /^## Reports/,/^## Pipelines/p; /^## Pipelines/,/^## The library/p' "$readme" |
	sed -n 's/^    \([a-z].*\)/\1/p' | sort -u >examples
sed -n '1,/^Build it/s/^    \(nmtan .*\)/\1/p' "$readme" >>examples
# in the text, and with what they are about: nmtan --check FILE
grep -o '`nmtan -[^`]*`' "$readme" | tr -d '`' | grep -vE '^nmtan -(-version|h|-help)' | sed 's/ IN OUT/ IN.glb OUT.glb/' | sort -u >words
grep -qx 'nmtan --fix IN.glb OUT.glb' words || wrong "$(cat words)"
grep ' [A-Z]' words >>examples
# those of the manual come last, as some are in place
sed -e 's/\\-/-/g' "$ROOT/man/nmtan.1" | sed -n '/^\.SH EXAMPLES/,/^\.PP/p' | grep -E '^(nmtan|cat) ' >manual
[ "$(wc -l <manual)" = 9 ] || wrong "$(cat manual)"
cat manual >>examples
[ "$(wc -l <examples)" -ge 26 ] || wrong "$(wc -l <examples) examples"
while IFS= read -r example; do
	for time in first second; do
		case $example in
		*parallel*) command -v parallel >/dev/null || continue ;;
		*jq*) command -v jq >/dev/null || continue ;;
		esac
		(PATH=$PWD/bin:$PATH bash -o pipefail -c "$example") >"$WORK/out.txt" 2>"$WORK/err.txt" </dev/null
		status=$?
		# the exit code of findings is what such an example is for
		case $status:$example in 0:* | 6:*--check*) ;; *) wrong "$status, the $time time: $example" ;; esac
	done
done <examples

# The anchors of a page's headings, as renderers make them.
anchors() {
	sed -n 's/^##* //p' "$1" | tr '[:upper:] ' '[:lower:]-' | sed "s/[^a-z0-9_-]//g"
}

scene "the links of README, measurements and .github lead to files of the tree, and to headings in them"
for page in "$readme" "$ROOT"/tests/bench/README.md "$ROOT"/.github/*.md; do
	grep -oE '\]\([^)]+\)' "$page" | sed 's/^](//; s/)$//' | while IFS= read -r link; do
		case $link in http*) continue ;; \#*) target=$page ;; *) target=$(dirname "$page")/${link%%#*} ;; esac
		[ -e "$target" ] || echo "$link"
		case $link in *\#*) anchors "$target" | grep -qxF -e "${link#*#}" || echo "$link" ;; esac
	done
done >missing
is "$(cat missing)" ""

scene "the hook of pre-commit takes the files that the tool reads, and fails where one has an error"
hook=$ROOT/.pre-commit-hooks.yaml
entry=$(sed -n 's/^  entry: nmtan //p' "$hook")
ls "$data" "$data/damaged" | grep -E "$(sed -n 's/^  files: //p' "$hook")" | sed 's/.*\.//' | sort -u | tr '\n' ' ' >types
is "$(cat types)" "glb gltf obj ply "
# shellcheck disable=SC2086
run $entry "$data/quad.obj" "$data/quad_le.ply"
exits 0
# shellcheck disable=SC2086
run $entry "$data/quad.obj" "$data/damaged/glb_old.glb"
[ "$status" != 0 ] || wrong "a damaged file passes"

scene "every target of make that README and measurements name is there"
grep -ohE '(`|^    |^\$ )make [a-z]+(-[a-z]+)*' "$readme" "$ROOT/tests/bench/README.md" | sed "s/.*make //" | sort -u | while read -r target; do
	grep -qE "^(\.PHONY:.* )?$target( |:|\$)" "$ROOT/Makefile" "$ROOT"/tests/tests.mk "$ROOT"/src/bindings/*.mk "$ROOT"/src/bindings/*/*.mk || echo "$target"
done >missing
is "$(cat missing)" ""

scene "the README is read in five minutes: at most 2300 words"
[ "$(wc -w <"$readme")" -le 2300 ] || wrong "$(wc -w <"$readme") words"

done_testing
