# SPDX-License-Identifier: MIT
# Which inputs a run is about, and where their outputs go.
. "$ROOT/tests/support/cli.sh"

scene "names come from a list, from standard input, and from one with NULs, in their order"
cp "$data/quad.obj" a.obj
cp "$data/quad.obj" "two words.obj"
cp "$data/quad.obj" $'line\nfeed.obj'
cp "$data/quad.obj" ./-
printf 'two words.obj\n\na.obj' >list
run -d out --files-from=list
exits 0
is "$(sed -n 's/^nmtan: \([^>]*\) -> .*/\1/p' "$WORK/err.txt" | tr '\n' ,)" "two words.obj,a.obj,"
is "$(ls out | tr '\n' ,)" "a.glb,two words.glb,"
printf 'line\nfeed.obj\0-\0' >list0
run -d out0 a.obj --files-from=list0
exits 0
is "$(sed -n 's/^nmtan: \([^>]*\) -> .*/\1/p' "$WORK/err.txt" | tr '\n' ,)" 'a.obj,line\x0afeed.obj,./-,'
"$NMTAN" -q -d piped --files-from=- <list || wrong "exit code $?"
same "piped/two words.glb" "out/two words.glb"

scene "a list can be empty, but not missing, and needs a place for outputs"
: >list
run -d out --files-from=list
exits 0
says "list: warning: there are no names in it, and nothing to do"
run -d out --files-from=missing
exits 2
says "missing: no such file"
cp "$data/quad.obj" a.obj
run --files-from=list a.obj b.glb
exits 1
says "--files-from"
run --check --files-from=- -
exits 1
says "'-' can be read once only"
run -d out list -r --include=
exits 1
says "--include: ''"
for option in --keep-tree=x --include=x; do
	run "$option" a.obj b.glb
	exits 1
	says "${option%=x} needs"
done
only a.obj list out

scene "a folder stands for the meshes below it, in the order of their names"
mkdir -p in/sub/deep in/skip in/.git elsewhere
for name in in/b.obj in/a.obj in/sub/deep/c.OBJ in/skip/d.obj in/sub/e.obj; do cp "$data/quad.obj" $name; done
cp "$data/quad_le.ply" in/sub/f.ply
cp "$data/bumps.png" in/sub/
echo note >in/readme.txt
cp "$data/plates.glb" elsewhere/linked.glb
ln -s ../elsewhere/linked.glb in/g.glb
ln -s ../elsewhere in/folder
ln -s . in/sub/circle
ln -s me@host.1 in/.#a.obj # a lock of Emacs
run -r -d in/out --keep-tree=in --exclude=skip in
exits 0
is "$(sed -n 's/^nmtan: \([^>]*\) -> .*/\1/p' "$WORK/err.txt" | tr '\n' ' ')" \
	"in/a.obj in/b.obj in/g.glb in/sub/deep/c.OBJ in/sub/e.obj in/sub/f.ply "
is "$(cd in/out && find . -type f | sort | tr '\n' ' ')" \
	"./a.glb ./b.glb ./g.glb ./sub/deep/c.glb ./sub/e.glb ./sub/f.ply "
run -r -d in/out --keep-tree=in --exclude=skip in
exits 0
says "6 of 6 done"
run -d out in
exits 2
says "in: cannot read: Is a directory; -r takes the meshes in it"
run in out2
exits 2
says "in: cannot read: Is a directory; -r with -d DIR takes the meshes in it"
run --check .
exits 2
says "; -r takes the meshes in it"

scene "patterns are compared with names, and with paths where they have a slash"
mkdir -p in/x in/y
for name in in/x/one.obj in/x/two.obj in/y/one.obj in/y/three.ply; do cp "$data/quad.obj" $name; done
cp "$data/quad_le.ply" in/y/three.ply
chosen() {
	"$NMTAN" --check "$@" 2>&1 >/dev/null | sed -n 's/^nmtan: \(in[^:]*\): checked.*/\1/p' | tr '\n' ' ' | sed 's/ $//'
}
is "$(chosen -r in --include='one.*')" "in/x/one.obj in/y/one.obj"
is "$(chosen -r in --include='one.*' --include='*.ply')" "in/x/one.obj in/y/one.obj in/y/three.ply"
is "$(chosen -r in --include='x/*')" "in/x/one.obj in/x/two.obj"
is "$(chosen -r in --exclude='x/*')" "in/y/one.obj in/y/three.ply"
is "$(chosen -r in/x/ --exclude='t*')" "in/x/one.obj"
is "$(chosen -r in/y/one.obj in/x)" "in/y/one.obj in/x/one.obj in/x/two.obj"

scene "a folder that cannot be read is told before anything runs"
mkdir in
cp "$data/quad.obj" in/
python3 - <<'END'
import os
os.chdir("in")
for _ in range(20):
    os.mkdir("deep" * 60)
    os.chdir("deep" * 60)
END
run -r -d out in
exits 2
says "cannot read the folder: File name too long"
only in

scene "--keep-tree keeps the tree of inputs, so that equal names are no conflict"
mkdir -p a b/deep
cp "$data/quad.obj" a/m.obj
cp "$data/plates.glb" b/deep/m.glb
run -d o a/m.obj b/deep/m.glb
exits 1
cp "$data/plates.glb" a/m.glb
run -d o --keep-tree=. a/m.obj ./b/../b/deep/m.glb "$PWD/a/m.obj" a/m.glb
exits 1
rm a/m.glb
says "1 of 3 done, 2 failed"
says "would both be written to 'o/a/m.glb'"
run -d o --keep-tree=. a/m.obj ./b/../b/deep/m.glb
exits 0
is "$(find o -type f | sort | tr '\n' ' ')" "o/a/m.glb o/b/deep/m.glb "
run -d o --keep-tree=a a/m.obj b/deep/m.glb
exits 1
says "'b/deep/m.glb' is not below 'a'"
run -d o/ --keep-tree=/ a/m.obj
exits 0
exists "o/$PWD/a/m.glb"
run -d dry --keep-tree=. --dry-run a/m.obj
exits 0
only a b o

scene "--fail-fast stops after a failure, a run without it does not"
for i in 1 3 4 5; do cp "$data/quad.obj" $i.obj; done
run --fail-fast -j1 -d out 1.obj 2.obj 3.obj 4.obj 5.obj
exits 2
says "1 of 5 done, 1 failed, 3 not tried"
is "$(ls out)" 1.glb
run -j1 -d out 1.obj 2.obj 3.obj 4.obj 5.obj
exits 2
says "4 of 5 done, 1 failed"

scene "failures are grouped by what was wrong, ten lines at most"
for i in $(seq 12); do
	yes 'v 0 0 0' | head -$i >bad$i.obj
	echo "f 1 2 99" >>bad$i.obj
done
run -j2 -d out missing1.obj missing2.obj missing3.obj missing4.obj missing5.obj bad*.obj
exits 2
says "0 of 17 done, 17 failed"
says "nmtan:   5 failed: no such file: missing1.obj, missing2.obj, missing3.obj and 2 more"
is "$(grep -c '^nmtan:   1 failed: ' "$WORK/err.txt")" 9
says "nmtan:   3 failed for other reasons, which are printed above"
for i in 1 2; do printf '{"asset": {"version": "2.0"}, "buffers": [{"uri": "%s.bin", "byteLength": 4}]}' $i >gone$i.gltf; done
run -q -d out gone1.gltf gone2.gltf
says 'nmtan:   2 failed: a buffer cannot be opened: "...": gone1.gltf, gone2.gltf'
for i in x y; do echo "v 0 0 $i" >$i.obj; done
run -q -d out x.obj y.obj
says 'nmtan:   2 failed: found "...", expected a number: x.obj, y.obj'

scene "ten thousand names are few bytes"
cp "$data/quad.obj" .
for ((i = 0; i < 10000; i++)); do echo "missing_$i.obj"; done >list
run -q -j1 --check quad.obj
one=$(command time -f %M "$NMTAN" -q -j1 --check quad.obj 2>&1 >/dev/null | tail -1)
many=$(command time -f %M "$NMTAN" -q -j1 -d out --files-from=list 2>&1 >/dev/null | tail -1)
case $BUILD in
*sanitize*) ;;
*) [ $((many - one)) -lt 8192 ] || wrong "$one KB for a file, $many KB for ten thousand" ;;
esac

done_testing
