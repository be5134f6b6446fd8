# SPDX-License-Identifier: MIT
# The manual page says what the option table says: every option, every value, every default, no others.
. "$ROOT/tests/support/cli.sh"

page=$ROOT/man/nmtan.1
# A page as text without fonts, one option per line.
text() {
	sed -e 's/\\f[BIRP]//g' -e 's/\\-/-/g' "$1"
}
plain() { text "$page"; }
# equal A B: the two lists are.
equal() {
	diff "$1" "$2" >difference || wrong "they differ: $(cat difference)"
}
well_formed() {
	! command -v man >/dev/null 2>&1 || is "$(LC_ALL=C.UTF-8 man --warnings -l "$1" 2>&1 >/dev/null)" ""
}

scene "every option of help is in the manual and no other"
"$NMTAN" --help | grep -oE '^ {2,6}(-[a-zA-Z], )?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort >table
plain | grep -E '^\.BR? .*--[a-z]' | grep -oE -- '--[a-z-]+' | grep -vE '^--$' | sort -u >all
plain | sed -n '/^\.SH OPTIONS/,/^\.SH EXIT/p' | grep -A1 '^\.T[PQ]' | grep -oE -- '--[a-z-]+' | sort >manual
equal table manual

scene "short forms and values are those of help"
"$NMTAN" --help | grep -oE '^  -[a-zA-Z], --[a-z-]+' | tr -d ' ' | sort >table
plain | sed -n '/^\.SH OPTIONS/,/^\.SH EXIT/p' | grep -A1 '^\.TP' | tr -d '" ' |
	grep -oE -- '-[a-zA-Z],--[a-z-]+' | sort >manual
equal table manual
"$NMTAN" --help | grep -oE -- '--[a-z-]+=[a-z|N]+[|][a-zN|]+' | sort >table
plain | sed -n '/^\.SH OPTIONS/,/^\.SH EXIT/p' | grep -A1 '^\.TP' | tr -d '" ' |
	grep -oE -- '--[a-z-]+=[a-z|N]+[|][a-zN|]+' | sort >manual
equal table manual

scene "every default of help is in the manual"
"$NMTAN" --help | tr '\n' ' ' | tr -s ' ' | grep -oE 'default: [a-z0-9]+' | sort >table
plain | sed -n '/^\.SH OPTIONS/,/^\.SH EXIT/p' | grep -oE '^Default: [a-z0-9]+' |
	sed 's/^D/d/' | sort >manual
diff <(grep -v 'default: by' table) manual >difference || { sed 's/^/# /' difference; wrong "they differ"; }

scene "the manual has its sections and its version"
for section in NAME SYNOPSIS DESCRIPTION OPTIONS "EXIT STATUS" EXAMPLES FILES "SEE ALSO"; do
	grep -q "^\.SH $section$" "$page" || wrong "no section $section"
done
grep -q "\"nmtan $("$NMTAN" --version | cut -d' ' -f2)\"" "$page" || wrong "another version"
well_formed "$page"

scene "the report in the manual is what --check prints"
(cd "$ROOT" && "$NMTAN" --check data/plates.gltf 2>"$WORK/err.txt") >printed
plain | sed -n '/^nmtan --check data\/plates.gltf$/,/^\.fi$/p' | sed '1,/^\.nf$/d;/^\.fi$/d' >expected
exists expected printed
equal expected printed

scene "every exit code of help is in the manual"
for code in 0 1 2 3 4 5 6 7; do
	sed -n '/^\.SH EXIT/,/^\.SH ENV/p' "$page" | grep -q "^\.B $code$" || wrong "$code is missing"
done

scene "the pages are well formed, and nmtan has each option that they name, with its value"
"$NMTAN" --help | grep -oE -- '--[a-z-]+' | sort -u >options
for page in nmtan-mtl.7 nmtan-report.5 nmtan-engines.7; do
	well_formed "$ROOT/man/$page"
	grep -v 'cc program.c' "$ROOT/man/$page" | sed -e 's/\\-/-/g' >text
	grep -oE -- '--[a-z][a-z-]*' text | sort -u >named
	is "$page: $(comm -23 named options)" "$page: "
	# a value that is none is refused before any file is looked at
	while read -r word; do
		"$NMTAN" "$word" --dry-run gone.gltf gone.glb 2>said
		! grep -q -- "${word%%=*}:\|unknown option" said || wrong "$page: $word: $(head -1 said)"
	done < <(grep -oE -- '--[a-z][a-z-]*=[a-z][a-z-]*' text | sort -u)
done

# example CODE: the smallest example of a code, as the page has it.
example() {
	text "$ROOT/man/nmtan-report.5" | sed -n "/^\.SS $1 /,/^\.S[SH] [^$]/p" | grep -A1 'Smallest example' | sed -n '2s/\.$//p'
}

scene "examples of nmtan-report(5) that are commands find what they stand for"
cp "$data/plates.bin" .
mkdir a b
cp "$data/bumps.png" a
gltf "$data/plates.gltf" a/in 'g.images = [{uri: "bumps.png"}]; g.textures = [{source: 0}]'
cp plates.bin a
command=$(example LINK_LEAVES)
eval "run ${command#nmtan }"
exits 0
says "[LINK_LEAVES]"
is "$(gltf b/out.gltf 'g.images[0].uri')" "../a/bumps.png"
gltf "$data/quantized.gltf" outlined 'g.meshes[0].primitives[0].extensions = {CESIUM_primitive_outline: {indices: add("SCALAR", 5123, [0, 1], {})}};
	(g.extensionsUsed ??= []).push("CESIUM_primitive_outline")'
command=$(example WELD_LEFT)
command="${command#nmtan } outlined.gltf out.gltf"
eval "run ${command/ of a primitive with CESIUM_primitive_outline/}"
says "CESIUM_primitive_outline"
says "[WELD_LEFT]"
command=$(example TAN_QUANTIZED)
run -v ${command#converting any quad with } "$data/quad.obj" out.glb
exits 0
says "[TAN_QUANTIZED]"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n' >one.obj
run -q --only=needed one.obj one.gltf
command=$(example TAN_QUADS_NONE)
run ${command#one triangle of a glTF, converted with } one.gltf out.gltf
exits 0
says "[TAN_QUADS_NONE]"

scene "the page for importers is well formed and has a row and a section with sources for each engine"
engines=$ROOT/man/nmtan-engines.7
well_formed "$engines"
text "$engines" | sed -n '/^engine|/,/^\.TE/p' | sed '1d;$d;s/|.*//' >rows
text "$engines" | grep -A1 '^\.TP' | sed -n 's/^\.B //p' >sections
equal rows sections
is "$(wc -l <rows) $(grep -c 'Sources:' "$engines")" "8 8"

scene "the page about many machines has each file and command of the recipes, and no other"
farm=$ROOT/man/nmtan-farm.7
text "$farm" | sed -n '/^\.SH FILES/,/^\.PP/p' | grep -o '[A-Za-z-]*\.sh\|nmtan-farm\|nmtan\.mk\|Snakefile' | sort -u >manual
ls "$ROOT/data/farm" | sort >files
equal files manual
"$ROOT/data/farm/nmtan-farm" --help | grep -o '^    nmtan-farm [a-z]* [A-Z]* *\[*[A-Z]*' | tr -d '[' | awk '{ print $2, $3 }' | sort >help
text "$farm" | sed -n 's/^\.B nmtan-farm \([a-z]* [A-Z]*\).*/\1/p' | sort -u >manual
equal help manual
well_formed "$farm"
# what a service says: of an input's folder, and nothing beside it
mkdir job up
cp "$data/bumps.png" up
{ printf 'mtllib m.mtl\nusemtl m\n'; cat "$data/quad.obj"; } >job/in.obj
printf 'newmtl m\nmap_Kd ../up/bumps.png\n' >job/m.mtl
run ${service:=$(text "$farm" | sed -n 's/^\tnmtan \(--outside=no .*\)/\1/p')}
exits 0
says "IMAGE_MISSING"
run ${service/no/root}
says_not "IMAGE_MISSING"

done_testing
