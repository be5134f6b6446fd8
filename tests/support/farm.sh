# SPDX-License-Identifier: MIT
#
# For tests of the recipes in data/farm, after cli.sh: meshes whose names hurt, and what a run without any engine makes.
farm=$ROOT/data/farm
export NMTAN

# Names that hurt, in folders that do, and the files that the meshes refer to.
hard=('two words.obj' "it's.obj" 'quo"te.obj' $'line\nfeed.obj' '-dash.obj' 'back\slash.obj' '$HOME `x`;.obj'
	'{}.obj' '100%.obj' '*.obj' 'a|b.obj' $'\xff\xfe.obj' 'é.obj')
take_hard() {
	local name
	mkdir -p "as sets/-sub dir"
	for name in "${hard[@]}"; do cp "$data/quad.obj" "as sets/-sub dir/$name"; done
	cp "$data"/mirrored_cube.* "$data/bumps.png" "$data"/plates.gltf "$data/plates.bin" "as sets/"
	count=$((${#hard[@]} + 2))
}
# Beside those 400 more, for what is to end in the middle.
take_many() {
	local i
	take_hard
	mkdir "as sets/many"
	for ((i = 0; i < 400; i++)); do cp "$data/mirrored_cube.obj" "as sets/many/$i.obj"; done
	cp "$data"/mirrored_cube.mtl "$data/bumps.png" "as sets/many/"
	count=$((count + 400))
}
list() { find "as sets" \( -name '*.obj' -o -name '*.gltf' \) -print0; }
clean() { list | "$NMTAN" -q -d clean --keep-tree="as sets" --files-from=- || wrong "exit code $?"; }
prepare() { list | "$farm/nmtan-farm" prepare "my work" "$1" -d "o ut" --keep-tree="as sets" "${@:2}"; }
is_clean() {
	diff -r clean "o ut" >difference || wrong "$(head -3 difference)"
	is "$(wc -l <"my work/manifest.jsonl")" $count
}
recipe() {
	"$@" >"$WORK/out.txt" 2>"$WORK/err.txt" </dev/null
	status=$?
}
# Makes stopping.sh, which runs $TOOL: the first time that chunk 2 is run, a pipe that nobody writes to stands behind its
# 40th input, where it waits for somebody to end it: first/pid.
stopping() {
	cat >stopping.sh <<'END'
#!/bin/bash
case "$*" in *"/2.list0 "*) mkdir first 2>/dev/null || exec "$TOOL" "$@" ;; *) exec "$TOOL" "$@" ;; esac
mkfifo "as sets/pipe.obj"
{ head -z -n 40 "my work/2.list0" && printf 'as sets/pipe.obj\0'; } >first/list0
echo $$ >first/pid
exec "$TOOL" "${@/#--files-from=*/--files-from=first/list0}"
END
	chmod +x stopping.sh
}
await_stop() { await eval '[ "$(cat "my work/2.1.jsonl" 2>/dev/null | wc -l)" = 40 ]'; }

# ---- what is noticed ----

# The meaning of each line of the table in nmtan-farm(7) for out/a.glb, which is made of in/a.obj, in/a.mtl and
# in/tex/n.png, by ./program; in/gone.png is missing where the line is about that.
event() {
	case $1 in
	"a file that was read gets a new time") touch in/v1/n.png ;;
	"one becomes another of an earlier time") cp -p in/v2/n.png in/v1/n.png ;;
	"one is deleted") rm in/v1/n.png ;;
	"one that was missing arrives") cp -p in/v2/n.png in/gone.png ;;
	"a link on the way to one is set anew") ln -sfn v2 in/tex ;;
	"the output is deleted") rm out/a.glb ;;
	"the output is changed") echo >>out/a.glb ;;
	"the options change") flags=--method=area ;;
	"another program of the same version") echo "# another" >>program ;;
	"another version") echo "# another" >>program && sed -i 's/"nmtan":"/&0/' out/.nmtan-record 2>/dev/null ;;
	*) wrong "no such event: $1" ;;
	esac
}

# notices COLUMN COMMAND: whether the command, which makes out/a.glb with $flags, does so as the column says: after each event,
# and not again.
notices() {
	local column=$1 line what expected flags
	shift
	sed -n '/^.SH WHAT IS NOTICED/,/^.fi/s/^\t\([a-z].*[a-z]\)  *\(yes\|no\)  *\(yes\|no\)  *\(yes\|no\)  *\(yes\|no\)$/\1|\2|\3|\4|\5/p' \
		"$ROOT/man/nmtan-farm.7" | sed 's/  *|/|/' >table
	[ "$(wc -l <table)" -ge 10 ] || wrong "there is no table"
	while read -r line <&3; do
		what=${line%%|*} flags=
		expected=$(echo "$line" | cut -d'|' -f$column)
		rm -rf in out log .ninja* .snakemake
		mkdir -p in/v1 in/v2 out
		{ printf 'mtllib a.mtl\nusemtl m\n' && grep '^[vf]' "$data/quad.obj"; } >in/a.obj
		printf 'newmtl m\nnorm tex/n.png\n' >in/a.mtl
		case $what in *missing*) echo 'map_Kd gone.png' >>in/a.mtl ;; esac
		cp "$data/bumps.png" in/v1/n.png
		cp "$data/bumps.png" in/v2/n.png
		printf '\xff' | dd of=in/v2/n.png bs=1 seek=60 conv=notrunc 2>/dev/null
		ln -s v1 in/tex
		printf '#!/bin/sh\necho >>log\nexec "%s" "$@"\n' "$NMTAN" >program
		chmod +x program
		find in program -exec touch -h -d '1 hour ago' {} +
		touch -d '2 hours ago' in/v2/n.png
		"$@" >said 2>&1 && "$@" >>said 2>&1 || wrong "$what: $(tail -3 said)"
		is "before, $what: $(wc -l <log)" "before, $what: 1"
		later
		event "$what"
		"$@" >said 2>&1 && "$@" >>said 2>&1 || wrong "$what: $(tail -3 said)"
		is "$what: $(wc -l <log)" "$what: $([ "$expected" = yes ] && echo 2 || echo 1)"
	done 3<table
}
