# SPDX-License-Identifier: MIT
# The recipes of data/farm, each with the engine that it is for; ssh, Slurm and Snakemake are in tests/soak/farm.sh.
. "$ROOT/tests/support/cli.sh"
. "$ROOT/tests/support/farm.sh"

scene "chunks are balanced by bytes, each name is in one of them, and the order is kept"
mkdir in
for i in $(seq 10 40); do head -c $((i * i * 4000)) /dev/zero >"in/$i.obj"; done
find in -type f -print0 | sort -z >list0
"$farm/nmtan-farm" prepare w 4 -d out <list0 || wrong "exit code $?"
cat w/[1-4].list0 | sort -z | cmp - list0 || wrong "names are lost"
for i in 1 2 3 4; do
	sort -z w/$i.list0 | cmp - w/$i.list0 || wrong "the order is another"
	xargs -0 stat -c %s <w/$i.list0 | awk '{ sum += $1 } END { print sum }'
done | sort -n >sums
awk 'NR == 1 { least = $1 } END { exit !($1 < 1.05 * least) }' sums || wrong "$(tr '\n' ' ' <sums)"
recipe "$farm/nmtan-farm" prepare in 4
exits 1
says "'in' is not empty"
# again: what was there stays where it was, what is new goes to the lightest
cp w/2.list0 two
{ grep -zv 'in/40.obj' list0; printf 'in/new.obj\0'; } | "$farm/nmtan-farm" prepare w 4 -d out || wrong "exit code $?"
is "$(cat w/[1-4].list0 | tr '\0' '\n' | sort | tr '\n' ' ')" \
	"$({ grep -zv 'in/40.obj' list0; printf 'in/new.obj\0'; } | tr '\0' '\n' | sort | tr '\n' ' ')"
is "$(tr '\0' '\n' <two | grep -v 'in/40.obj' | sort | comm -23 - <(tr '\0' '\n' <w/2.list0 | sort))" ""
recipe "$farm/nmtan-farm" run
exits 1
says "run: missing a required argument: 'work'; see nmtan-farm --help"
recipe "$farm/nmtan-farm" run w 5
exits 1
says "no chunk '5'"
recipe "$farm/nmtan-farm" merge in
exits 1
says "'in' was not prepared"

scene "of the lines of an input the last one counts, and those that are missing are told"
printf 'a.obj\0b.obj\0c.obj\0d.obj\0' | "$farm/nmtan-farm" prepare w 1
line() { printf '{"input":"%s.obj","status":"%s","exit_code":%s}\n' "$@"; }
{ line a done 0; line b failed 3; line c untried 2; printf '{"input":"d.ob'; } >w/1.1.jsonl
recipe "$farm/nmtan-farm" merge w
exits 2
says "not all inputs were tried; chunks to run again: 1 (2 of 4)"
{ line a up-to-date 0; line b done 0; line c failed 3; line d done 0; line d failed 2; } >w/1.2.jsonl
recipe "$farm/nmtan-farm" merge w
exits 1
says "2 of 4 inputs failed"
{ line a done 0; line b done 0; line c failed 3; line d failed 2; } >expected
same w/manifest.jsonl expected

scene "inputs that would have one output are refused, whatever the number of chunks"
mkdir x y
cp "$data/quad.obj" x
cp "$data/quad.obj" y
printf 'x/quad.obj\0y/quad.obj\0' | "$farm/nmtan-farm" prepare w 2 -d out
recipe "$farm/nmtan-farm" run w 1
exits 1
says "would both be written to"

scene "names that look the same in a manifest are told apart"
printf 'a\xff.obj\0a\xfe.obj\0' | "$farm/nmtan-farm" prepare w 1
{ line 'a\ufffd' failed 3; line 'a\ufffd' done 0; } >w/1.1.jsonl
recipe "$farm/nmtan-farm" merge w
exits 1
says "1 of 2 inputs failed"
same w/manifest.jsonl w/1.1.jsonl

scene "CDPATH leads nowhere"
export CDPATH=$PWD
printf '' | "$farm/nmtan-farm" prepare w 1
recipe "$farm/parallel.sh" w --jobs 1
says_not "was not prepared"
unset CDPATH

scene "GNU parallel: names of any kind; a failure is told, and each start makes what changed, and no more"
take_hard
clean
prepare 5 || wrong "prepare: $?"
cp "as sets/mirrored_cube.obj" good.obj
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >"as sets/mirrored_cube.obj"
recipe "$farm/parallel.sh" "my work" --jobs 2
exits 1
says "1 of $count inputs failed"
is "$(ls "my work" | grep -c '\.1\.jsonl')" 5
cp good.obj "as sets/mirrored_cube.obj"
recipe "$farm/parallel.sh" "my work" --jobs 2
exits 0
is_clean
is "$(cat "my work"/*.2.jsonl | grep -c '"status":"done"')" 1
cp "$data/quad.obj" "as sets/mirrored_cube.obj"
recipe "$farm/parallel.sh" "my work" --jobs 2
exits 0
is "$(cat "my work"/*.3.jsonl | grep -c '"status":"done"')" 1
recipe "$farm/parallel.sh" "my work" --jobs 2
exits 0
is "$(cat "my work"/*.4.jsonl | grep -c '"status":"done"')" 0

scene "GNU parallel: a worker that is killed, and all of it that is, lose nothing"
take_many
clean
stopping
prepare 4 --threads=1
(await_stop && kill -9 "$(cat first/pid)") &
TOOL=$NMTAN NMTAN=$PWD/stopping.sh recipe "$farm/parallel.sh" "my work" --jobs 2
exits 2
says "not all inputs were tried; chunks to run again: 2 (40 of "
is "$(awk 'NR > 1 && $7 != 0 { print $NF }' "my work/joblog")" 2
recipe "$farm/parallel.sh" "my work" --jobs 2
exits 0
is_clean
# what the killed one had made was not made again
is "$(cat "my work"/2.*.jsonl | grep -c '"status":"done"')" "$(tr -dc '\0' <"my work/2.list0" | wc -c)"

scene "array jobs of Kubernetes and AWS Batch count from 0"
cp "$data/quad.obj" a.obj
cp "$data/head.obj" b.obj
printf 'a.obj\0b.obj\0' | "$farm/nmtan-farm" prepare w 2 -d out || wrong "exit code $?"
JOB_COMPLETION_INDEX=0 recipe "$farm/nmtan-farm" run w
is "$(ls out w/*.jsonl | xargs)" "w/1.1.jsonl out: b.glb"
AWS_BATCH_JOB_ARRAY_INDEX=1 recipe "$farm/nmtan-farm" run w
is "$(ls out | xargs)" "a.glb b.glb"
AWS_BATCH_JOB_ARRAY_INDEX=2 recipe "$farm/nmtan-farm" run w
says "no chunk '3'"
JOB_COMPLETION_INDEX='' recipe "$farm/nmtan-farm" run w
says "no chunk ''"

# A cluster that runs an Indexed Job: kubectl.py FILE runs the command of each index, here, and ends pods by -9 where
# told to; a mount is the folder itself.
kubectl() {
	python3 - "$@" <<'END'
import json, os, subprocess, sys
job = json.load(open(sys.argv[1]))
spec, pod = job['spec'], job['spec']['template']['spec']
assert job['apiVersion'] == 'batch/v1' and job['kind'] == 'Job' and spec['completionMode'] == 'Indexed'
assert pod['restartPolicy'] == 'Never' and pod['volumes'][0]['persistentVolumeClaim']['claimName'] == 'meshes'
[box], [mount] = pod['containers'], pod['containers'][0]['volumeMounts']
assert mount['name'] == pod['volumes'][0]['name'] and os.path.isdir(mount['mountPath'])
[rule] = spec['podFailurePolicy']['rules']
for index in range(spec['completions']):
    for attempt in range(1 + spec['backoffLimitPerIndex']):
        code = subprocess.run(box['command'], env={**os.environ, 'JOB_COMPLETION_INDEX': str(index)}).returncode
        if code == 0 or (rule['action'] == 'FailIndex' and code in rule['onExitCodes']['values']):
            break
    print(index, attempt, code)
END
}

scene "Kubernetes: an Indexed Job runs each chunk, again where a pod was ended, once where an input fails"
take_hard
clean
prepare 3 || wrong "prepare: $?"
recipe "$farm/nmtan-farm" kubernetes "my work" image meshes "$PWD/as sets"
exits 1
says "where the claim is mounted"
"$farm/nmtan-farm" kubernetes "my work" image meshes "$PWD" >job.json || wrong "exit code $?"
mkdir bin
ln -s "$farm/nmtan-farm" bin/nmtan-farm
printf '#!/bin/sh\n[ "$JOB_COMPLETION_INDEX" != 1 ] || [ -e ended ] || { touch ended; kill -9 $$; }\nexec "%s" "$@"\n' "$NMTAN" >pod.sh
chmod +x pod.sh
PATH=$PWD/bin:$PATH NMTAN=$PWD/pod.sh kubectl job.json >pods 2>"$WORK/err.txt" || wrong "kubectl"
is "$(tr '\n' ' ' <pods)" "0 0 0 1 1 0 2 0 0 "
recipe "$farm/nmtan-farm" merge "my work"
exits 0
is_clean
printf 'v 0 0 0\nv 1 0 0\nf 1 2 3\n' >"as sets/mirrored_cube.obj"
PATH=$PWD/bin:$PATH kubectl job.json >pods 2>"$WORK/err.txt" || wrong "kubectl"
is "$(cut -d' ' -f2,3 pods | sort | uniq -c | xargs)" "2 0 0 1 0 3"

scene "an object store: a machine without memory of the last run makes what has changed, and puts it"
cat >rclone <<'END'
#!/bin/sh
mkdir -p "$2" "$3"
[ "$1" = copy ] || rm -rf "$3" && mkdir -p "$3" && cp -r "$2/." "$3/"
END
chmod +x rclone
export RCLONE=$PWD/rclone
mkdir -p store/deep
cp "$data"/mirrored_cube.* "$data/bumps.png" store/deep
cp "$data/quad.obj" store
"$NMTAN" -q -r -d clean --keep-tree=store store
made() {
	rm -rf scratch # another machine
	recipe "$farm/nmtan-farm" store "$PWD/store" "$PWD/target" "$PWD/scratch"
	exits ${1:-0}
	grep -c '"status":"done"' scratch/manifest.jsonl
}
is "$(made)" 2
diff -r -x .nmtan-record clean target >difference || wrong "$(cat difference)"
is "$(made)" 0
sed -i 's/^Kd.*/Kd 0 1 0/' store/deep/mirrored_cube.mtl
is "$(made)" 1
echo 'f 1 2 99' >>store/quad.obj
is "$(made 3)" 0
unset RCLONE

scene "the manual's questions to the manifest are answered"
if ! command -v jq >/dev/null; then
	skip_case "jq is not installed"
else
	question() { # the Nth command of that section, as it stands
		sed -n '/^\.SH WHAT THE MANIFEST SAYS/,/^\.SH GNU/p' "$ROOT/man/nmtan-farm.7" |
			awk -v n="$1" '/^\.nf/ { k++; next } /^\.fi/ { on = 0 } k == n && !/^\./ && /./ { print }' |
			sed -n '/^\t/p' | sed -e 's/\\-/-/g' -e 's/\\e/\\/g' >question.sh
		bash question.sh
	}
	cp "$data/quad.obj" a.obj
	cp "$data/mirrored_cube.obj" b.obj
	for name in c d; do printf 'v 0 0 0\nf 1 2 3\n' >$name.obj; done
	echo 'v x' >e.obj
	printf '%s\0' ?.obj | "$farm/nmtan-farm" prepare work 1 -d out
	recipe "$farm/nmtan-farm" run work 1
	recipe "$farm/nmtan-farm" merge work
	cp work/manifest.jsonl last.jsonl
	awk '$1 == "vt" { $2 = -$2 } 1' "$data/mirrored_cube.obj" >b.obj
	echo '# no other tangents' >>a.obj
	recipe "$farm/nmtan-farm" run work 1
	recipe "$farm/nmtan-farm" merge work
	is "$(question 1)" b.obj
	is "$(question 2 | grep -c ' [a-e].obj$')" 5
	is "$(question 3 | cut -d' ' -f1 | xargs)" "2 1"
fi

scene "Ninja: build.ninja is written for names of any kind but line feeds, and makes again what changed"
take_hard
recipe sh -c 'find "as sets" -name "*.obj" -print0 | "$0" ninja "o ut" "as sets" --method=area' "$farm/nmtan-farm"
exits 1
says "a name with a line feed cannot be in a build.ninja"
rm "as sets/-sub dir/"$'line\nfeed.obj'
list | "$NMTAN" -q --output-format=glb --method=area -d clean --keep-tree="as sets" --files-from=-
list | "$farm/nmtan-farm" ninja "o ut" "as sets" --method=area >build.ninja
ninja >made 2>&1 || wrong "$(cat made)"
diff -r clean "o ut" >difference || wrong "$(head -3 difference)"
# those that Ninja cannot read in a depfile are made again each time
rm "as sets/-sub dir/"*[\'\"\*\;\|]*
list | "$farm/nmtan-farm" ninja "o ut" "as sets" --method=area >build.ninja
is "$(ninja)" "ninja: no work to do."
later
touch "as sets/mirrored_cube.mtl" "as sets/-sub dir/two words.obj"
ninja -v >made
is "$(grep -c depfile made)" 2
is "$(ninja)" "ninja: no work to do."

scene "make: outputs are made again when what they were made of changes, and all that is below by one target"
unset MAKEFLAGS MFLAGS MAKELEVEL
mkdir -p in/sub
cp "$data"/mirrored_cube.* "$data/bumps.png" "$data"/plates.gltf "$data/plates.bin" in/sub
printf 'NMTAN_IN := in\ninclude %s\nall: out/sub/mirrored_cube.glb out/sub/plates.glb\n' "$farm/nmtan.mk" >Makefile
echo '.DEFAULT_GOAL := all' >>Makefile
make >made 2>&1 || wrong "$(cat made)"
is "$(make)" "make: Nothing to be done for 'all'."
later
touch in/sub/plates.bin
make >made
is "$(grep -c depfile made)" 1
grep -q plates made || wrong "$(cat made)"
is "$(make)" "make: Nothing to be done for 'all'."
take_hard
make NMTAN_IN="'as sets'" NMTAN_OUT="'o ut'" nmtan-update >made 2>&1 || wrong "$(cat made)"
clean
rm "o ut/.nmtan-record"
diff -r clean "o ut" >difference || wrong "$(head -3 difference)"

scene "--update notices what the page says, and makes nothing twice"
update() { "$NMTAN" --update $flags in/a.obj out/a.glb 2>err && { grep -q "up to date" err || echo >>log; }; }
notices 2 update

scene "make notices what the page says, and makes nothing twice"
printf 'NMTAN = ./program\nNMTAN_IN := in\nNMTAN_FLAGS = $(flags)\nall: out/a.glb\ninclude %s\n' "$farm/nmtan.mk" >Makefile
make_all() { make flags="$flags"; }
notices 3 make_all

scene "Ninja notices what the page says, and makes nothing twice"
ninja_all() { printf 'in/a.obj\0' | NMTAN=./program "$farm/nmtan-farm" ninja out in $flags >build.ninja && ninja; }
notices 4 ninja_all

done_testing
