# SPDX-License-Identifier: MIT
# Words: what is asked for goes to standard output and succeeds, what is wrong is named and fails.
. "$ROOT/tests/support/cli.sh"

scene "help goes to standard output and succeeds"
run --help
exits 0
prints "--threads"
prints "7 a limit"
[ ! -s "$WORK/err.txt" ] || wrong "help wrote to standard error"

scene "there are at most 78 options; CHANGELOG names those that went, which are refused, and the new words are taken"
[ "$("$NMTAN" --help | grep -cE '^ {2,6}(-[a-zA-Z], )?--[a-z]')" -le 78 ] || wrong "$("$NMTAN" --help | grep -cE '^ {2,6}(-[a-zA-Z], )?--[a-z]')"
changes=$ROOT/.github/CHANGELOG.md # which a source package lacks
: >renamed
[ ! -e "$changes" ] || sed -n '/^| before/,$p' "$changes" | sed '1,2d' >renamed
for word in embed allow-outside confine update-by as files0-from mirror repair keep-going draco-speed uv-image; do
	[ ! -e "$changes" ] || grep -q "^| [^|]*\`--$word[\`=]" renamed || wrong "CHANGELOG does not name --$word"
	run --$word a.obj b.glb
	exits 1
	says "unknown option '--$word'"
done
while read -r word; do
	run --dry-run --check "$word" gone.obj
	says_not "unknown option"
done < <(sed 's/^|[^|]*|//' renamed | grep -o -- '`--[a-z][a-z=-]*`' | tr -d '`' | sort -u)

scene "-V is what others call --version"
run -V
exits 1
says "unknown option '-V'; did you mean --version?"
run -qV
says "unknown option '-V' in '-qV'; did you mean --version?"
run --check "" # an empty variable: "no such file" would have no name
exits 1
says "'' is no name of a file"

scene "-h is one screen, whose options exist and whose eight examples run as they stand"
run -h
exits 0
[ ! -s "$WORK/err.txt" ] || wrong "help wrote to standard error"
cp "$WORK/out.txt" first
is "$(awk 'length > 80' first)" ""
[ "$(wc -l <first)" -le 45 ] || wrong "$(wc -l <first) lines"
is "$(sed -n 's/^  \(-[^ ]*\).*/\1/p' first | wc -l)" 10
"$NMTAN" --help >all
for word in $(grep -oE -- ' --[a-z-]+' first | sort -u); do
	grep -qE -- "$word( |=|\[|$)" all || wrong "$word is no option"
done
cp "$data/head.obj" head.obj
cp "$data/transformed.gltf" "$data"/*.png .
"$NMTAN" -q transformed.gltf in.glb
"$NMTAN" -q "$data/quad_le.ply" in.ply
mv bumps.png n.png
mkdir assets
cp "$data/quad.obj" assets/
sed -n '/^Examples/,/^$/s/^  \(nmtan .*[^ ]\)   *.*/\1/p' first >examples
is "$(wc -l <examples)" 8
while read -r program words; do
	run $words
	exits 0
done <examples
exists head.glb out.glb in.html assets

scene "the version is one line"
run --version
exits 0
is "$(cat "$WORK/out.txt")" "nmtan $(sed -n 's/^#define NMTAN_VERSION_STRING "\(.*\)"/\1/p' "$ROOT/include/nmtan.h")"

scene "a code is explained as the table has it, or all that a pattern means"
run --explain=UV_MIRROR_SEAM
exits 0
is "$(sed 's/: .*/:/; 2s/.*/meaning/' ../out.txt)" "UV_MIRROR_SEAM (info)
meaning
  Remedy:
  Smallest example:"
[ ! -s ../err.txt ] || wrong "wrote to standard error"
is "$(sed -n '2s/^  //p' ../out.txt)" "$("$NMTAN" --list-codes | sed -n 's/^UV_MIRROR_SEAM  *info  *//p')"
run --explain='UV_MIRROR_*'
is "$(grep -c '^UV_MIRROR_[A-Z]* (' ../out.txt)" "$("$NMTAN" --list-codes | grep -c '^UV_MIRROR_')"

for words in "--explain UV_MIRROR_SEAM TAN_ZERO" "--explain=TAN_ZERO,uv_mirror_seam" "--explain TAN_ZERO --explain UV_MIRROR_SEAM"; do
	run $words
	is "$(sed -n 's/ (.*//p' ../out.txt | grep '^[A-Z]' | tr '\n' ' ')" "UV_MIRROR_SEAM TAN_ZERO "
done
run --explain TAN_ZERO head.obj
exits 1
says "--explain: 'head.obj' is no code"
run --explain TAN_ZERO
prints "  Remedy: $(sed -n '/ROW(TAN_ZERO,/,/ROW(TAN_NOT/{s/^\t\t"\(.*\)\.",$/\1/p}' "$ROOT/src/report/codes.c" | tail -1): nmtan --fix IN OUT"

scene "no words at all are a mistake, told on standard error"
run
exits 1
says "usage:"
[ ! -s "$WORK/out.txt" ] || wrong "wrote to standard output"

scene "what is refused leaves nothing"
cp "$data/quad.obj" in.obj
run -vj8x in.obj out.glb
exits 1
says "'8x'"
only in.obj

scene "an output name that tells no format is refused before the input is read"
run "$data/quad.obj" out.xyz
exits 1
says "out.xyz"
run "$data/quad.obj" out.obj
exits 1
says "out.obj: obj can only be read; an output is .gltf, .glb or .ply"
only

scene "names that begin with a dash come after two dashes"
cp "$data/quad.obj" ./-quad.obj
run -- -quad.obj -out.glb
exits 0
exists ./-out.glb

scene "help and reports that cannot be written are an error"
for words in --help "--check $data/quad.obj" "--check --report-format=json $data/quad.obj"; do
	# shellcheck disable=SC2086
	"$NMTAN" $words >/dev/full 2>"$WORK/err.txt"
	is $? 2
	says "standard output"
done

scene "who reads the first line alone gets no message"
# many more bytes than a pipe holds
for ((i = 0; i < 300; i++)); do echo "$data/head.obj"; done >names
# a pipe whose reader has gone before anything is written
mkfifo pipe
exec 3<>pipe 4>pipe 3>&-
for words in --list-codes "--help" "--check --report-format=json -q --files-from=names" \
	"--check -q --manifest=- --files-from=names"; do
	"$NMTAN" $words >&4 2>"$WORK/err.txt"
	is "$words: $? $(cat "$WORK/err.txt")" "$words: 141 "
done
exec 4>&-

scene "a run of many that is ended says what was done"
for name in {a..k}; do cp "$data/quad.obj" $name.obj; done
mkfifo wait.obj
for pause in 0.1 2 20; do # from an output's name to its sum, however busy the machine is
	rm -rf out
	env --default-signal=INT "$NMTAN" -d out -q nothing.obj [a-k].obj wait.obj 2>err.txt &
	process=$!
	await eval '[ "$(ls out/*.glb 2>/dev/null | wc -l)" = 11 ]'
	sleep $pause
	kill -INT $process
	wait $process
	is $? 130
	! grep -q "11 of 13 done" err.txt || break
done
grep -q "11 of 13 done, 1 failed, ended by a signal" err.txt || wrong "$(cat err.txt)"

scene "bash completes options, values and files"
"$NMTAN" --completion=bash >completion || wrong "exit code $?"
touch mesh.obj
complete_words() {
	bash -c '. ./completion
		compopt() { :; }
		COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _nmtan; printf "%s " "${COMPREPLY[@]}"' bash "$@"
}
is "$(complete_words nmtan --meth)" "--method= "
is "$(complete_words nmtan --method = le)" "lengyel "
is "$(complete_words nmtan --uv = '')" "auto "
is "$(complete_words nmtan --ver)" "--verify --verbose --version "
is "$(complete_words nmtan mes)" "mesh.obj "
is "$(complete_words nmtan --ignore = UV_MIRROR_L)" "UV_MIRROR_LONE "
is "$(complete_words nmtan --ignore = '' | wc -w)" "$("$NMTAN" --list-codes | grep -c '^[A-Z]')"
is "$(complete_words nmtan --severity = TAN_ZERO,UV_FOL)" "TAN_ZERO,UV_FOLDED_QUAD "
is "$(complete_words nmtan --severity = UV_FOLDED_QUAD = e)" "error "
is "$(complete_words nmtan --explain = UV_FOL)" "UV_FOLDED_QUAD "

scene "the zsh completion names every option of help"
"$NMTAN" --completion=zsh >completion || wrong "exit code $?"
"$NMTAN" --help | grep -o -- '--[a-z][a-z-]*[a-z]' | sort -u >names
while IFS= read -r name; do
	case $name in --check | --in-place | --*) ;; esac
	grep -qF -- "'$name" completion || wrong "$name is missing"
done <names
if command -v zsh >/dev/null 2>&1; then
	zsh -n completion || wrong "zsh cannot read it"
fi

done_testing
