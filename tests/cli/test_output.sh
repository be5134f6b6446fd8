# SPDX-License-Identifier: MIT
# Outputs: whole or not at all, never over an input, written through where they are no files.
. "$ROOT/tests/support/cli.sh"

scene "an output that is the input is refused by name"
cp "$data/plates.glb" a.glb
run a.glb a.glb
exits 2
says "a.glb"
ln a.glb hard.glb
ln -s a.glb soft.glb
run a.glb hard.glb
exits 2
says "hard.glb"
run a.glb soft.glb
exits 2
says "soft.glb"
run a.glb ./././a.glb
exits 2
same a.glb "$data/plates.glb"
only a.glb hard.glb soft.glb

scene "a buffer that no .glb can hold is refused by name before anything is made"
sed '/"plates.bin"/{n;s/[0-9][0-9]*/4400000000/;}' "$data/plates.gltf" >plates.gltf
cp "$data/plates.bin" . && truncate -s 4400000000 plates.bin
mkdir out
run plates.gltf out/plates.glb
exits 5
says "plates.gltf: /buffers/0: "
says "4 GiB"
only plates.gltf plates.bin out
rmdir out || wrong "something was left behind"
# a new one is in no input that could have its name
cp "$data/mirrored_cube.obj" "$data/mirrored_cube.mtl" "$data/bumps.png" .
truncate -s 4400000000 bumps.png
run mirrored_cube.obj out.glb
exits 5
says "nmtan: mirrored_cube.obj: the output would take 4 GiB or more"
[ ! -e out.glb ] || wrong "something was left behind"

scene "a sidecar never takes the name of a file of the input"
cp "$data/plates.gltf" "$data/plates.bin" "$data/bumps.png" .
mv plates.gltf other.gltf
# plates.gltf would bring a plates.bin, which is what other.gltf reads.
run --existing=replace other.gltf plates.gltf
exits 0
says "plates.bin is another file, so ours is plates-"
same plates.bin "$data/plates.bin"
is "$(ls | wc -l)" 5
# ... also where that was ours once
run plates.gltf plates.gltf
exits 2
run --bitangents "$data/plates.gltf" new.gltf
sed 's/new\.bin/old.bin/' new.gltf >old.gltf && mv new.gltf old2.gltf && mv new.bin old.bin && mv old2.gltf in.gltf
sed -i 's/"new\.bin"/"old.bin"/' in.gltf
cp old.bin before
run --existing=replace in.gltf old.gltf
exits 0
same old.bin before

scene "in-place replaces the input and nothing else"
cp "$data/plates.glb" a.glb
run "$data/plates.glb" expected.glb
run --in-place a.glb
exits 0
same a.glb expected.glb
cp "$data/plates.glb" a.glb
run --in-place a.glb a.glb
exits 0
same a.glb expected.glb
cp "$data/plates.glb" a.glb
cp "$data/plates.glb" b.glb
run --in-place a.glb b.glb
exits 0
says "2 of 2 done"
same a.glb expected.glb
same b.glb expected.glb
run --in-place --report=b.glb --report-format=text a.glb b.glb
exits 1
same b.glb expected.glb
run --in-place a.glb b.glb a.glb
exits 0
says "2 of 2 done"
cp "$data/quad.obj" .
run --in-place quad.obj
exits 1
same quad.obj "$data/quad.obj"

scene "two files that would be one are refused before anything is read, however they are spelled"
mkdir folder
ln -s folder link
touch there.json
ln there.json hard.json
ln -s there.json soft.json
options="--report= --manifest= --depfile= --record= -o"
for names in "new.glb ./new.glb" "folder/new.json link/new.json" "there.json hard.json" "soft.json $PWD/there.json"; do
	for one in $options; do
		for other in $options; do
			[ "$one" != "$other" ] || continue
			output=no.glb
			[ $one != -o ] && [ $other != -o ] || output=
			run --report-format=json $one${names% *} $other${names#* } nothing.obj $output
			exits 1
			says "are both '"
			says_not nothing.obj
		done
	done
done
cp "$data/quad.obj" .
for option in --report= --manifest= --depfile= --record=; do
	[ $option != --report= ] && format= || format=--report-format=json
	run -d folder $format ${option}link/quad.glb quad.obj nothing.obj
	exits 1
	says "${option%=} and an output are both 'link/quad.glb'"
	ln -f quad.obj input.json
	run $format ${option}input.json quad.obj no.glb
	exits 2
	says "input.json: refusing to write: it is the same file as the input quad.obj"
done
is "$(ls folder)" ""
[ ! -s there.json ] || wrong "$(cat there.json)"
run --report-format=json --report=/dev/null --manifest=/dev/null quad.obj no.glb
exits 0

scene "what stands in the way of an output is said with the way out"
cp "$data/plates.glb" a.glb
run a.glb a.glb
exits 2
says "the same file as the input a.glb; --in-place allows that"
mkdir out
for folder in out out/ new/; do
	run a.glb $folder
	exits 1
	says "nmtan: $folder: is a folder: to write into it use -d"
done
only a.glb out
rmdir out || wrong "something was written"

scene "what has no files beside it gets no copies"
cp "$data/plates.glb" a.glb
cp "$data/quad.obj" quad.obj
for words in "--images=copy a.glb - --output-format=glb" "--buffers=copy a.glb /dev/null" \
	"--images=copy quad.obj - --output-format=glb"; do
	# shellcheck disable=SC2086
	run $words
	exits 1
	says "=copy: there are no files beside"
done
only a.glb quad.obj

scene "a link to the output stays a link"
ln -s real.glb link.glb
echo old >real.glb
run "$data/quad.obj" link.glb
exits 0
[ -L link.glb ] || wrong "the link is gone"
run "$data/quad.obj" direct.glb
same real.glb direct.glb

scene "a full disk is an error of writing"
grep -v '^vn' "$data/mirrored_cube.obj" | sed 's|/[0-9]* | |g; s|/[0-9]*$||' >bare.obj
run bare.obj out.glb
says "[NORMALS_MADE]"
run --output-format=glb bare.obj /dev/full
says_not "[NORMALS_MADE]" # what was chosen for a file that is not there
rm bare.obj out.glb
run --output-format=glb "$data/head.obj" /dev/full
exits 2
says "/dev/full"
"$NMTAN" -q "$data/head.obj" - >/dev/full 2>"$WORK/err.txt"
is $? 2
says "No space left"

scene "closed standard streams do not become files"
cp "$data/mirrored_cube.obj" a.obj
cp "$data/mirrored_cube.obj" b.obj
run --images=none -d expected a.obj b.obj
"$NMTAN" --images=none -d out a.obj b.obj >&- 2>&- <&-
is $? 0
same out/a.glb expected/a.glb
same out/b.glb expected/b.glb
# The input would be 0 and the output 2, into which the stage "verify" would be told.
"$NMTAN" --images=none --progress=on --verify a.obj c.glb <&- 2>&-
is $? 0
same c.glb expected/a.glb
"$NMTAN" --images=none a.obj - >&- 2>"$WORK/err.txt"
is $? 2
says "Bad file descriptor"

scene "a reader that goes away is an error of writing"
grid_obj 120 >grid.obj
{ "$NMTAN" -q grid.obj - 2>"$WORK/err.txt"; echo $? >code; } | head -c 10 >/dev/null
is "$(cat code)" 2
says "Broken pipe"

# one that takes some bytes at a time gets them all
run -q grid.obj direct.glb
{ command python3 -c 'import fcntl, os; fcntl.fcntl(1, fcntl.F_SETFL, os.O_NONBLOCK)' && "$NMTAN" -q grid.obj -; } |
	{ sleep 0.1 && cat; } >piped.glb
same piped.glb direct.glb

scene "the null device takes everything"
run --output-format=glb "$data/head.obj" /dev/null
exits 0
[ -c /dev/null ] || wrong "/dev/null was replaced"
# a device has nothing beside it
run --output-format=gltf "$data/plates.gltf" /dev/null
exits 0
[ ! -e /dev/null.bin ] && [ ! -e /dev/bumps.png ] || wrong "there are files in /dev"
run --output-format=gltf "$data/head.obj" /dev/null
exits 1
says "glTF with a .bin cannot go to a device; write glb, or use --buffers=embed"

scene "a named pipe is written through"
mkfifo pipe.glb
cat pipe.glb >copy.glb &
run "$data/quad.obj" pipe.glb
exits 0
wait
[ -p pipe.glb ] || wrong "the pipe was replaced"
run "$data/quad.obj" direct.glb
same copy.glb direct.glb

scene "places that cannot be written are named"
run "$data/quad.obj" nowhere/out.glb
exits 2
says "nowhere/out.glb"
run "$data/quad.obj" /proc/nmtan.glb
exits 2
says "/proc/nmtan.glb"
run "$data/quad.obj" "$(printf %0300d 0).glb"
exits 2
says "0.glb: cannot write: File name too long"
mkdir folder.glb
run "$data/quad.obj" folder.glb
exits 2
says "folder.glb"
only folder.glb
if [ "$(id -u)" != 0 ]; then
	mkdir closed && chmod 555 closed
	run "$data/quad.obj" closed/out.glb
	exits 2
	says "closed/out.glb"
	chmod 755 closed
fi

scene "inputs that cannot be read are named"
run nothing.obj out.glb
exits 2
says "nothing.obj"
mkdir folder
run folder out.glb
exits 2
says "folder"
only folder

scene "a file that grows beyond the limit leaves nothing behind"
cp "$data/head.obj" .
(ulimit -f 8 && exec "$NMTAN" head.obj out.glb) 2>"$WORK/err.txt"
is $? 2
says "out.glb"
only head.obj

scene "an output that fails late leaves its sidecars behind no more than itself"
cp "$data/head.obj" .
mkdir head.gltf
run head.obj head.gltf
exits 2
only head.gltf head.obj

scene "modes follow the umask"
for mask in 022 077 027; do
	(umask $mask && exec "$NMTAN" -q "$data/head.obj" "m$mask.gltf")
	is "$(stat -c %a "m$mask.gltf" "m$mask.bin" | sort -u)" "$(printf '%o' $((0666 & ~mask)))"
done

scene "signals end the first process of a container, too, for which the system has no default"
if unshare -r -p -f true 2>/dev/null; then
	mkfifo pipe.obj
	unshare -r -p -f "$NMTAN" -q pipe.obj out.glb 2>/dev/null &
	exec 9>pipe.obj
	kill -TERM "$(pgrep -P $!)"
	exec 9>&-
	wait $!
	is $? 143
	only pipe.obj
fi

scene "a fault of the process after an input has changed is told as that, in a line that is safe for a terminal"
name=$'a\x1b.glb'
cp "$data/plates.glb" "$name"
mkfifo out.glb # whose reader it waits for when it has read the input
"$NMTAN" -q "$name" out.glb 2>"$WORK/err.txt" &
await grep -qa 'here/a.*\.glb' /proc/$!/maps || wrong "the input is not mapped"
truncate -s 10 "$name"
kill -SEGV $!
wait $!
is $? 2
says "nmtan: a?.glb: the file became shorter while it was read"

scene "a dry run writes nothing and says what it would do"
cp "$data/quad.obj" .
run --dry-run quad.obj out.gltf
exits 0
says "dry run"
only quad.obj
run --dry-run quad.obj -
exits 0
[ ! -s "$WORK/out.txt" ] || wrong "a dry run wrote to standard output"
run --dry-run -d out quad.obj
exits 0
only quad.obj

scene "sync and verify change nothing in the output"
run "$data/plates.glb" a.glb
run --sync --verify "$data/plates.glb" b.glb
exits 0
same a.glb b.glb

done_testing
