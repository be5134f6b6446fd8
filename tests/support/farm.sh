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
clean() { list | "$NMTAN" -q -d clean --mirror="as sets" --files0-from=- || wrong "exit code $?"; }
prepare() { list | "$farm/nmtan-farm" prepare "my work" "$1" -d "o ut" --mirror="as sets" "${@:2}"; }
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
exec "$TOOL" "${@/#--files0-from=*/--files0-from=first/list0}"
END
	chmod +x stopping.sh
}
await_stop() { await eval '[ "$(cat "my work/2.1.jsonl" 2>/dev/null | wc -l)" = 40 ]'; }
