# SPDX-License-Identifier: MIT
# Many files: every one is tried, in any number of threads, and told about in order.
. "$ROOT/tests/support/cli.sh"

scene "every input gets its output under its own name"
run -d out "$data/quad.obj" "$data/quad_le.ply" "$data/plates.glb"
exits 0
is "$(ls out | tr '\n' ' ')" "plates.glb quad.glb quad_le.ply "
says "3 of 3 done"
run "$data/plates.glb" single.glb
same single.glb out/plates.glb

scene "failures do not stop the others and are named at the end"
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >bad.obj
run -d out missing.obj "$data/quad.obj" bad.obj "$data/plates.glb"
exits 2
exists out/quad.glb out/plates.glb
is "$(ls out | wc -l)" 2
says "bad.obj:3:"
says "2 of 4 done, 2 failed:"
says "  1: no such file: missing.obj"
run -q -d out missing.obj "$data/quad.obj"
exits 2
says "missing.obj"
says_not "quad.obj"

scene "of many exit codes the worst counts"
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >bad.obj
run -d out bad.obj "$data/quad.obj"
exits 3
run -d out bad.obj missing.obj
exits 2
run --check "$data/quad.obj" bad.obj
exits 3

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

scene "two inputs with one output are refused before anything runs"
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

scene "the folder is made but not its parents"
run -d no/where "$data/quad.obj"
exits 2
says "no/where"
echo >file
run -d file "$data/quad.obj"
exits 2
says "file"
only file

done_testing
