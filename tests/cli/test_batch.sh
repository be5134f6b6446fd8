# SPDX-License-Identifier: MIT
# Many files: every one is tried, in any number of threads, and told about in order.
# Leaks count.
. "$ROOT/tests/support/cli.sh"

scene "every input gets its output under its own name"
run -d out "$data/quad.obj" "$data/quad_le.ply" "$data/plates.glb"
exits 0
is "$(ls out | tr '\n' ' ')" "plates.glb quad.glb quad_le.ply "
says "3 of 3 done"
run "$data/plates.glb" single.glb
same single.glb out/plates.glb
# without an ending the bytes tell the format
rm -r out
cp "$data/plates.bin" "$data/bumps.png" .
for name in plates.gltf quad_le.ply plates.glb quad.obj; do cp "$data/$name" "${name#*.}"; done
run -d out gltf ply glb obj
exits 0
is "$(ls out | tr '\n' ' ')" "bumps.png glb.glb gltf.bin gltf.gltf obj.glb ply.ply "
# a folder that is gone has no name
here=$PWD
(mkdir gone && cd gone && rmdir ../gone && "$NMTAN" -q -d "$here/out" "$here/obj") || wrong "exit code $?"

scene "times and bytes of many are summed"
cp "$data/plates.gltf" "$data/plates.bin" "$data/bumps.png" .
cp plates.gltf second.gltf
counts() { sed -n 's/^\([0-9].*bytes read\|not decoded:\)/\1/p' "$WORK/err.txt" | grep -o '[0-9]*' | xargs; }
run --timing -d out plates.gltf
one=$(counts)
run --timing -d many plates.gltf second.gltf
is "$(counts)" "$(for n in $one; do echo $((2 * n)); done | xargs)"
is "$(wc -w <<<"$one")" 4

scene "failures do not stop the others and are named at the end"
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >bad.obj
run -d out missing.obj "$data/quad.obj" bad.obj "$data/plates.glb"
exits 2
exists out/quad.glb out/plates.glb
is "$(ls out | wc -l)" 2
says "bad.obj:3:"
says "2 of 4 done, 2 failed"
says "  1 failed: no such file: missing.obj"
run -q -d out missing.obj "$data/quad.obj"
exits 2
says "missing.obj"
says_not "quad.obj"

scene "the messages come in the order of the inputs for any number of threads"
for i in 1 2 3 4 5 6 7 8 9; do
	cp "$data/quad.obj" "m$i.obj"
done
grid_obj 60 >m3.obj
for threads in 1 2 8; do
	run -j$threads -d out m1.obj m2.obj m3.obj m4.obj m5.obj m6.obj m7.obj m8.obj m9.obj
	exits 0
	is "$(sed -n 's/^nmtan: \(m[0-9]\).obj -> .*/\1/p' "$WORK/err.txt" | tr '\n' ' ')" \
		"m1 m2 m3 m4 m5 m6 m7 m8 m9 "
	cat out/*.glb | cksum >"sum$threads"
done
same sum1 sum2
same sum1 sum8

scene "--jobs changes nothing that is said or written, --fail-fast stops, and failures are grouped"
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >bad.obj
grid_obj 40 >m1.obj
for i in 2 3 4 5 6; do cp "$data/quad.obj" m$i.obj; done
inputs="m1.obj bad.obj m2.obj missing.obj m3.obj m4.obj m5.obj gone.obj m6.obj"
for jobs in 1 2 4; do
	run -j4 --jobs=$jobs -d out$jobs $inputs
	exits 2
	says "6 of 9 done, 3 failed"
	says "  2 failed: no such file: missing.obj, gone.obj"
	sed -e 's/, [0-9.e-]* m*s$//' -e "s/out$jobs/out/" "$WORK/err.txt" >said$jobs
done
for jobs in 2 4; do
	diff said1 said$jobs >difference || wrong "$(cat difference)"
	diff -r out1 out$jobs >difference || wrong "$(cat difference)"
done
run -j4 --jobs=1 --fail-fast -d fast1 bad.obj m1.obj m2.obj
exits 3
says "2 not tried"
for i in $(seq 60); do cp m1.obj f$i.obj; done # of some milliseconds each
# a thread that is kept waiting may tell of the failure when the others have done all: not twenty times
for try in $(seq 20); do
	run -j4 --jobs=4 --fail-fast -d fast4 bad.obj f?.obj f??.obj
	exits 3
	! grep -q ' not tried' "$WORK/err.txt" || break
done
says " not tried"
is "$(ls fast1)" ""

scene "--memory bounds what is converted at a time, and changes nothing else"
# 3 MB of text each, which takes 18 MB, guessed to be 25; four at a time took 67 MB.
grid_obj 200 >m1.obj
for i in 2 3 4 5 6 7 8; do cp m1.obj m$i.obj; done
# Kilobytes that it takes at most, over those of a run of one small file.
peak() {
	python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$NMTAN" -q "$@"
}
least=$(peak "$data/quad.obj" q.glb)
taken() { echo $(($(peak -j4 --jobs=4 "$@" m?.obj) - least)); }
free=$(taken --memory=1G -d free)
bound=$(taken --memory=40M -d bound)
diff -r free bound >difference || wrong "$(cat difference)"
run -j4 --jobs=4 --memory=40M -d bound m?.obj
is "$(sed -n 's/^nmtan: \(m[0-9]\).obj -> .*/\1/p' "$WORK/err.txt" | tr '\n' ' ')" "m1 m2 m3 m4 m5 m6 m7 m8 "
case $BUILD in
*sanitize* | *tsan*) ;;
*) [ "$bound" -lt 40000 ] || wrong "$bound KB with 40 MB, $free KB without a bound" ;;
esac
run -d out --memory=lots m1.obj
exits 1
says "'lots' is not a size, as 500M, 2GiB or 2GB"

scene "pipes that nobody writes keep nothing waiting, neither files nor other pipes"
mkfifo first.obj second.obj third.obj
cp "$data/quad.obj" a.obj
cp "$data/quad.obj" b.obj
timeout 240 "$NMTAN" -d out --jobs=2 first.obj a.obj second.obj third.obj b.obj 2>"$WORK/err.txt" &
await eval '[ -e out/a.glb ] && [ -e out/b.glb ]' || wrong "files wait for pipes"
# two are read at a time
timeout 60 cp "$data/quad.obj" second.obj
await test -e out/second.glb || wrong "a pipe waits for another"
timeout 60 cp "$data/quad.obj" third.obj
await test -e out/third.glb || wrong "a pipe waits for another"
timeout 60 cp "$data/quad.obj" first.obj
wait $!
is $? 0
is "$(sed -n 's/^nmtan: \([a-z]*\)\.obj -> .*/\1/p' "$WORK/err.txt" | xargs)" "first a second third b"
for name in first second third b; do
	same out/a.glb out/$name.glb
done

scene "two inputs with one output are refused, the others go on, and what is there twice is one"
mkdir x y
cp "$data/quad.obj" x/a.obj
cp "$data/plates.glb" y/a.glb
cp "$data/quad.obj" x/b.obj
cp "$data/quad_le.ply" y/b.ply
cp "$data/quad.obj" one.obj
run -q -d out --output-format=glb --manifest=m --report=r.json x/a.obj y/a.glb one.obj x/b.obj ./one.obj y/b.ply
exits 1
says "'x/a.obj' and 'y/a.glb' would both be written to 'out/a.glb'"
says "'x/b.obj' and 'y/b.ply' would both be written to 'out/b.glb'; --keep-tree=. keeps the folders of inputs"
says "nmtan:   4 failed: would replace another output or an input: x/a.obj, y/a.glb, x/b.obj and 1 more"
is "$(wc -l <"$WORK/err.txt")" 4 # a line for each clash, the sum, and who failed
mkdir "it's" && cp -r x y "it's"
run -d new --output-format=glb "it's/x/b.obj" "it's/y/b.ply"
says "; --keep-tree='it'\''s' keeps the folders of inputs"
rm -r "it's"
is "$(ls out)" one.glb
is "$(wc -l <m)" 5
is "$(value r.json '[f["file"] for f in r["files"] if "another" in str(f["failure"]) or "both" in str(f["failure"])]')" \
	"['x/a.obj', 'y/a.glb', 'x/b.obj', 'y/b.ply']"
cp x/a.obj y/A.OBJ
run -q -d cases x/a.obj y/A.OBJ
exits 0
is "$(ls cases | wc -l)" 2
# where case makes no difference: the file has its other name
ln x/a.obj x/A.OBJ
run -q -d same x/a.obj y/A.OBJ
exits 1
says "'x/a.obj' and 'y/A.OBJ' would both be written to"
rm y/A.OBJ x/A.OBJ
run -d none --fail-fast x/a.obj y/a.glb one.obj
exits 1
says "0 of 3 done, 2 failed, 1 not tried"

scene "the refusal says which folder tells two inputs apart, by their spelling"
mkdir -p m/x m/y mx my work
for name in m/x/a m/y/a mx/a my/a; do cp "$data/quad.obj" $name.obj; done
cd work
while IFS='|' read -r one two said; do
	run -q -d o "$one" "$two"
	exits 1
	says "'o/a.glb'; --keep-tree=$said keeps"
	[ ! -e o ] || wrong "a folder of nothing"
done <<END
../m/x/a.obj|../m/y/a.obj|../m
$PWD/../m/x/a.obj|$PWD/../m/y/a.obj|$PWD/../m
../mx/a.obj|../my/a.obj|..
../m/x/a.obj|$PWD/../m/y/a.obj|ROOT
END
cd ..

scene "if a folder tells some inputs of one output apart, the refusal says both remedies"
mkdir -p b/s b/t
for name in b/m b/s/m b/t/m; do cp "$data/quad.obj" $name.obj; done
cp "$data/plates.glb" b/m.glb
run -q -r -d out b
exits 1
says "'b/m.glb', 'b/m.obj' and 2 more would all be written to 'out/m.glb'; --keep-tree=b keeps the folders of inputs, and of inputs in one folder: convert one of them by itself, to another name"
run -q -r -d out --keep-tree=b b
exits 1
says "'b/m.glb' and 'b/m.obj' would both be written to 'out/m.glb'; convert one"
exists out/s/m.glb out/t/m.glb
rm b/m.glb
run -q -r -d none b
exits 1
says "'b/m.obj', 'b/s/m.obj' and 'b/t/m.obj' would all be written to 'none/m.glb'"
says_not "in one folder"
run -q -r -d none --keep-tree=b b
exits 0

scene "if no folder tells two inputs apart, the refusal says what does"
cp "$data/quad.obj" b.obj
cp "$data/quad_le.ply" b.ply
run -q -d out --output-format=glb b.obj b.ply
exits 1
says "'b.obj' and 'b.ply' would both be written to 'out/b.glb'; convert one of them by itself, to another name"
run -q b.ply out.glb
exits 0
run -q --in-place -d . --output-format=ply b.obj b.ply
exits 1
says "'b.obj' and 'b.ply' would both be written to './b.ply'"
ln -s b.ply c.ply
cp "$data/quad_le.ply" a.ply
run -q --in-place a.ply b.ply c.ply
exits 1
says "'b.ply' would be written to 'b.ply', which is the input 'c.ply'; it is one file: name it once"

scene "the sum says what became of each output, and one reason is one line for all files that have it"
mkdir in
for i in 1 2 3 4 5; do cp "$data/quad.obj" in/o$i.obj; done
cp "$data/plates.glb" "$data/quad_le.ply" in
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >in/scan.obj
run -r -d out in
exits 0
says "nmtan: 8 of 8 done; 7 got tangents, 1 written without new tangents"
run -r -d again out
says "nmtan: 8 of 8 done; 8 unchanged"
run -r --dry-run -d none in
says "nmtan: 8 of 8 done; 7 got tangents, 1 written without new tangents; dry run, nothing written"
run -r --in-place in
exits 1
says "nmtan: 2 of 8 done, 6 failed; 2 got tangents"
says "nmtan:   6 failed: obj can only be read; an output is .gltf, .glb or .ply: -d DIR writes them elsewhere: in/o1.obj, in/o2.obj, in/o3.obj and 3 more"
is "$(grep -c '^nmtan:   ' "$WORK/err.txt")" 1
run -r --in-place --include='*l*' in
exits 0
says "2 of 2 done; 2 left as they were"

scene "a folder or a pattern in which nothing is found is an error, a list without names is not"
mkdir empty one
cp "$data/quad.obj" one
echo >empty/notes.txt
: >names
while IFS='|' read -r words message; do
	# shellcheck disable=SC2086
	run -q $words
	exits 2
	says "nmtan: $message"
	only empty names one
done <<-'EOF'
	-r -d out empty|empty: no mesh is in it or below it (.obj .ply .gltf .glb .drc); files looked at: 1
	-r --check empty|empty: no mesh is in it or below it (.obj .ply .gltf .glb .drc); files looked at: 1
	-r --check --exclude=one .|.: no mesh is in it or below it (.obj .ply .gltf .glb .drc) outside of folders that --exclude takes out; files looked at: 2
	-r -d out --include=*.glb one empty|one: no file matches --include='*.glb'; meshes looked at: 1
	-r --check --include=*.glb --include=b* --exclude=c one|one: no file matches --include='*.glb' or another pattern and no --exclude; meshes looked at: 1
	-r --in-place --exclude=*.obj one|one: --exclude takes out every mesh; meshes looked at: 1
EOF
run -r -d out empty one
exits 0
says "empty: warning: no mesh is in it"
exists out/quad.glb
run --check --files-from=names
exits 0
says "names: warning: there are no names in it, and nothing to do"
run -q -d out --files-from=names
exits 0
silent

scene "a folder that is too deep for a name is not passed over"
mkdir deep
(cd deep && for i in {1..17}; do mkdir -p "$(printf %0250d 0)" && cd -P "$(printf %0250d 0)"; done)
run -q -r -d out deep
exits 2
says "0: cannot read the folder: File name too long"
only deep

scene "a link to a mesh that leads nowhere is an input that fails"
mkdir l
cp "$data/quad.obj" l/b.obj
ln -s nowhere.glb l/a.glb
ln -s c.obj l/c.obj
ln -s nowhere.txt l/notes.txt
ln -s me@host.1 l/.#b.obj
run -r -d out l
exits 2
exists out/b.glb
says "l/a.glb: no such file"
says "1 of 3 done, 2 failed"
run -r -d again --exclude='[ac].*' l
exits 0
says "1 primitive"
run -q -r --check l
exits 2

scene "when all inputs are refused nothing is made"
mkdir x y
cp "$data/quad.obj" x/a.obj
cp "$data/plates.glb" y/a.glb
run -d out x/a.obj y/a.glb
exits 1
says "x/a.obj"
says "y/a.glb"
only x y

scene "an input in the output folder is not overwritten by another"
cp "$data/plates.glb" a.glb
cp "$data/quad_le.ply" a.ply
run -d . a.glb
exits 2
says "a.glb"
same a.glb "$data/plates.glb"
run --in-place -d . a.glb a.ply
exits 0
run "$data/plates.glb" expected.glb
same a.glb expected.glb

scene "what another input is made from is not overwritten"
mkdir in
{ echo "mtllib a.glb" && grep -v mtllib "$data/quad.obj"; } >b.obj
cp "$data/quad.obj" in/a.obj
echo "newmtl m" >a.glb
cp a.glb before
run -j1 -d . b.obj in/a.obj
exits 2
says "a.glb: refusing to write: another input of this run is made from it"
same a.glb before
exists b.glb
run -j1 -d . in/a.obj
exits 0

scene "the folder is made, and its parents, but no file becomes one"
run -d new/a/b// "$data/quad.obj"
exits 0
is "$(find new -type f)" new/a/b/quad.glb
run -d "$PWD/abs/a" "$data/quad.obj"
exits 0
echo >file
run -d file "$data/quad.obj"
exits 2
says "file"
run -d file/deeper "$data/quad.obj"
exits 2
says "file: is not a folder"
if [ -d /proc/self ]; then
	run "$data/quad.obj" /proc/quad.glb
	exits 2
	says '/proc/quad.glb: cannot write: the folder "/proc" takes no new files'
fi
only abs file new

done_testing
