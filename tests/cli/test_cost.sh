# SPDX-License-Identifier: MIT
# Small files that ask for much work: time, memory and output stay in proportion to what is read, with the bounds that
# the manual states under LIMITS. Time is that of the processor, over that of counting in Python at the same time, so that
# neither a slow machine nor other programs matter; generous, and asked of one of three runs: what is quadratic misses it by far.
# Runs once: with the first build.
. "$ROOT/tests/support/cli.sh"

# inputs KIND COUNT FILE [SIDE]: what is asked for again, in another scene, is the same file.
inputs() {
	local made=$WORK/$1.$2.${4-}
	[ -e "$made/$3" ] || { mkdir -p "$made" && python3 "$ROOT/tests/support/inputs.py" "$1" "$2" "$made/$3" ${4+"$4"}; }
	ln "$made/$3" "$3"
}

# within TIMES MEGABYTES ARGUMENTS...: runs nmtan, which must take less memory, and so many times less processor time than
# Python takes to count to 50 million. Sanitizers cost a multiple, and keep 256 MB of what was freed.
within() {
	local times=$1 megabytes=$2
	shift 2
	command python3 -c '
import os, resource, subprocess, sys, time
times, megabytes = (int(word) for word in sys.argv[1:3])
out, err, *command = sys.argv[3:]
def counting():
    begin = time.process_time()
    for i in range(1000000):
        pass
    return 50 * (time.process_time() - begin)
for attempt in range(3):
    seconds = times * counting()
    # whoever needs far more is ended
    most = int(4 * seconds + 1)
    resource.setrlimit(resource.RLIMIT_CPU, (most + int(time.process_time()), resource.RLIM_INFINITY))
    child = subprocess.Popen(command, stdout=open(out, "wb"), stderr=open(err, "wb"), stdin=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    used, memory = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
    seconds = max(seconds, times * counting())
    if used <= seconds:
        break
if used > seconds:
    print("%.1f seconds of processor time, expected less than %.1f" % (used, seconds))
if memory > megabytes:
    print("%.0f MB, expected less than %d" % (memory, megabytes))
sys.exit(child.returncode)' $((times * factor)) $((megabytes * factor + (factor > 1 ? 256 : 0))) "$WORK/out.txt" "$WORK/err.txt" \
		"$NMTAN" "$@" >"$WORK/cost.txt" 2>&1
	status=$?
	[ ! -s "$WORK/cost.txt" ] || wrong "$(cat "$WORK/cost.txt")"
}

# grows KIND COUNT WORDS...: COUNT, 2 COUNT and 4 COUNT of a kind take linear time; IN is the input. With `first` set to words,
# what nmtan makes of it by these.
first=
grows() {
	local kind=$1 count=$2 size ending=obj files=()
	shift 2
	case $kind in
	gltf_*) ending=glb ;;
	ply_*) ending=ply ;;
	option_*) ending=txt ;;
	esac
	for size in 1 2 4; do
		python3 "$ROOT/tests/support/inputs.py" "$kind" $((size * count)) $size.$ending
		files+=($size.$ending)
		# shellcheck disable=SC2086
		[ -z "$first" ] || run -q $first $size.obj $size.glb
		[ -z "$first" ] || files[-1]=$size.glb
	done
	command python3 "$ROOT/tests/support/growth.py" 8 $((factor))e-1 "${files[@]}" -- "$NMTAN" -q --fail-on=never "$@" \
		>"$WORK/cost.txt" 2>&1 || wrong "$kind: $(cat "$WORK/cost.txt")"
}

# These have smaller inputs, too: what they see is seen in thousands.
case $NMTAN in
*/release/*) factor=1 blocks=8000 elements=40000 materials=40000 strip=80000 faces=80000 windows=600 parts=40000 ;;
*) factor=8 blocks=2000 elements=10000 materials=10000 strip=20000 faces=20000 windows=100 parts=10000 ;;
esac

scene "$blocks Draco blocks are found in linear time"
inputs obj_materials $blocks blocks.obj
run -q --only=all blocks.obj blocks.glb
run -q --only=all --existing=replace --draco=edgebreaker blocks.glb draco.glb
within 4 150 -q --only=all --existing=replace draco.glb out.glb
exits 0

scene "$faces triangles at one place are compressed in linear time, and a finding says how"
inputs obj_equal_faces "$faces" repeated.obj
run -q --only=all repeated.obj repeated.glb
within 5 300 -q --only=all --existing=replace --draco=edgebreaker --verify --report=r.json --fail-on=never repeated.glb out.glb
exits 0
is "$(value r.json '[f["code"] for f in r["files"][0]["findings"] if f["code"].startswith("DRACO")]')" "['DRACO_SEQUENTIAL']"

scene "what was quadratic once grows as its input does"
first=--only=all
for kind in obj_equal_faces obj_centre; do
	grows $kind $((faces / 8)) --only=all --existing=replace --draco=edgebreaker --verify IN out.glb
done
first=
grows obj_folded_quads $((faces / 8)) IN out.ply
grows obj_tiles $((faces / 8)) --check --report=r.json IN
grows obj_quads_of_objects $((faces / 8)) --check IN
grows mtl_bumps 10 --check IN
grows gltf_images_of_two_uses $((blocks / 5)) --flip-green=on IN out.glb
for kind in gltf_animated_transforms gltf_levels_of_detail; do
	grows $kind $((blocks / 5)) IN out.glb
done
for format in json html; do
	grows gltf_long_names 8000 --check --only=all --report=r.$format IN
done

scene "a library that has many names is read once, and names that no file can have are not followed"
grows obj_names_of_one_library 500 IN out.glb
for kind in mtl ply gltf; do
	grows ${kind}_slashes 200000 --images=embed IN out.glb
	grows ${kind}_slashes 200000 --images=embed --outside=yes IN out.glb
done

scene "a file that many buffers and images name is opened once, and copied once"
python3 "$ROOT/tests/support/inputs.py" gltf_names_of_one_pair 1500 many.gltf
mkdir out
within 4 100 -q --check many.gltf
within 4 100 -q --only=needed --existing=keep --images=copy --buffers=link --outside=yes --morph=keep --dry-run many.gltf out/many.gltf
gltf many.gltf unused 'delete g.meshes; g.nodes = [{}]; g.scenes = [{nodes: [0]}]'
mv unused.gltf many.gltf
within 4 100 -q --images=copy --buffers=link --outside=yes many.gltf out/many.gltf
exits 0
is "$(find out -name '*.png' | wc -l)" 1
within 4 100 -q --images=embed --buffers=link --outside=yes many.gltf out/many.glb
exits 0
[ "$(stat -c %s out/many.glb)" -lt 5000000 ] || wrong "$(stat -c %s out/many.glb) bytes"
rm -r out

scene "a file that many buffers name is one buffer of what is edited, as its views and errors say"
python3 "$ROOT/tests/support/inputs.py" gltf_names_of_one_pair 1500 many.gltf
for words in "many.gltf out.glb" "--buffers=embed many.gltf out.gltf" "many.gltf out.gltf"; do
	# shellcheck disable=SC2086
	run -q --only=all $words
	exits 0
	is "$(gltf "${words##* }" '[g.buffers.length, g.bufferViews.every((v) => v.buffer === 0)].join()')" 1,true
	[ "$(cat out.* | wc -c)" -lt 4000000 ] || wrong "$(cat out.* | wc -c) bytes"
	rm out.*
done
python3 -c 'import json
g = json.load(open("many.gltf"))
g["buffers"].append({"byteLength": 24, "uri": "data:;base64,!"})
g["bufferViews"][5] |= {"buffer": 1500, "byteOffset": 0}
json.dump(g, open("broken.gltf", "w"))'
run --only=all broken.gltf out.glb
exits 3
says "/buffers/1500"

scene "each scan of a JPEG and each strip of a TIFF takes as long as another, and counts"
for row in "jpeg_scans 20 262144" "tiff_high_strips 200 4096"; do
	read -r kind count pixels <<<"$row"
	grows $kind $count --textures=png --max-pixels=100000000000 IN out.gltf
	for size in 1 2 4; do
		run --textures=png --max-pixels=1 $size.obj out.gltf
		exits 7
		says "images of $((size * count * pixels)) pixels are to be decoded"
	done
done

scene "no more files are open at a time, however many an input or an output has"
for count in 30 120 600; do
	python3 "$ROOT/tests/support/inputs.py" gltf_files_apart $count $count.gltf
	python3 "$ROOT/tests/support/inputs.py" mtl_tga_images $count $count.obj
	for words in "--images=embed $count.gltf out.glb" "--images=copy --buffers=copy $count.gltf out/o.gltf" "$count.gltf out.gltf" \
		"--flip-green=on $count.gltf out.glb" "--textures=png $count.obj out.gltf" "--images=embed $count.obj out.glb" \
		"--check --check-maps=on $count.gltf"; do
		mkdir out
		# shellcheck disable=SC2086
		(ulimit -n 64 && exec "$NMTAN" -q --fail-on=never $words) >"$WORK/out.txt" 2>"$WORK/err.txt" </dev/null
		status=$?
		exits 0
		[ ! -s "$WORK/err.txt" ] || says_not "open files"
		rm -rf out out.*
	done
done

scene "outputs of many inputs are compared with each other in linear time"
grows option_inputs 200 -d out --files-from=IN --report=r.json --manifest=m --depfile=d --record=n

scene "morph targets that share an accessor take as long as they are many, and little memory each"
for count in 100 200 400; do
	python3 "$ROOT/tests/support/inputs.py" gltf_targets_of_grid $count $count.targets.glb 30
done
command python3 "$ROOT/tests/support/growth.py" 8 $((factor))e-1 100.targets.glb 200.targets.glb 400.targets.glb -- \
	"$NMTAN" -q IN out.glb >"$WORK/cost.txt" 2>&1 || wrong "$(cat "$WORK/cost.txt")"
# 2 000 targets: 31 MB, of which 23 are the output; one at a time is in memory, authored tangents or not, also of
# primitives that share vertices, and while these are compared
for kind in gltf_targets_of_grid gltf_targets_of_halves; do
	python3 "$ROOT/tests/support/inputs.py" $kind 2000 whole.glb 30
	for words in "" --weld; do
		# shellcheck disable=SC2086
		within 30 45 -q --only=all $words whole.glb out.glb
		exits 0
	done
	within 30 45 -q --only=all --existing=repair out.glb again.glb
	exits 0
	same out.glb again.glb
done

scene "a name of a megabyte is cut in reports"
printf 'o %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 0 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n' \
	"$(head -c 1000000 /dev/zero | tr '\0' x)" >long.obj
run -q --only=all long.obj long.glb
gltf long.glb many 'const p = g.meshes[0].primitives[0]; g.meshes[0].primitives = Array(1000).fill(p);'
for report in r.json r.html r.txt r.sarif; do
	within 3 200 -q --check --only=all --fail-on=never --report=$report many.gltf
	[ "$(stat -c %s $report)" -lt 6000000 ] || wrong "$report has $(stat -c %s $report) bytes"
done
grep -q 'xxx\.\.\. (1000000 bytes)' r.json || wrong "the name is not cut"

scene "a PLY header of many properties, or of $elements elements, is read in linear time"
grows ply_properties $((elements / 4)) IN out.ply
inputs ply_elements $elements e.ply
within 6 150 e.ply out.ply
exits 0

scene "an OBJ of $materials materials makes a document of as many primitives"
inputs obj_materials $materials m.obj
within 12 150 -q m.obj m.glb
exits 0
is "$(gltf m.glb 'g.meshes[0].primitives.length')" $materials
# at most 36 times the input: the geometry and the JSON of five accessors for every line of 34 bytes
[ $(($(stat -c %s m.glb) / $(stat -c %s m.obj))) -lt 36 ] || wrong "$(stat -c %s m.glb) bytes"

scene "a check of $blocks primitives takes linear time"
inputs obj_materials $blocks checked.obj
run -q --only=all checked.obj checked.glb
within 4 150 -q --check checked.glb
exits 0

scene "10 MB of JSON that nobody asks for take at most 48 bytes for each number and 80 for each member"
cp "$data"/plates.* "$data"/bumps.png .
python3 - <<'END'
note = '"n":[%s],"o":{%s}' % (','.join('1' * 4000000), ','.join('"k%d":0' % i for i in range(200000)))
text = open('plates.gltf').read().replace('"note": {}', '"note": {%s}' % note)
open('extras.gltf', 'w').write(text)
END
[ "$(stat -c %s extras.gltf)" -gt 10000000 ] || wrong "the input is small"
within 5 300 extras.gltf out.gltf
exits 0

scene "10 MB of ordinary nodes and meshes take at most eight times their size"
inputs gltf_named_nodes 80000 nodes.glb
within 2 80 -q nodes.glb out.glb
exits 0

scene "an OBJ whose $blocks materials have two images each"
python3 "$ROOT/tests/support/inputs.py" mtl_missing_images $blocks i.obj # and i.mtl
within 4 400 -q i.obj i.gltf
exits 0
is "$(gltf i.gltf 'g.materials.length')" $blocks

scene "images that are not written are decoded once, and not made"
python3 "$ROOT/tests/support/inputs.py" mtl_bumps 40 b.obj
for words in --check "--dry-run --report=r.json"; do
	# shellcheck disable=SC2086
	within 2 150 -q --fail-on=never $words b.obj $([ "$words" = --check ] || echo out.glb)
	exits 0
done
is "$(value r.json '[f["code"] for f in r["files"][0]["findings"]].count("IMAGE_CONVERTED")')" 40

scene "1 500 primitives over one set of accessors are judged and drawn once"
inputs gltf_same_grid 1500 s.glb
within 15 300 --check --report=s.html --only=all --fail-on=never s.glb
exits 0
[ "$(stat -c %s s.html)" -lt 2000000 ] || wrong "a page of $(stat -c %s s.html) bytes"
within 15 300 --check --report=s.json --only=all --fail-on=never s.glb
is "$(value s.json 'len(r["files"][0]["meshes"])')" 1500
is "$(value s.json '{m["same_as"] for m in r["files"][0]["meshes"][1:]}')" '{0}'
is "$(value s.json '{m["faces"] for m in r["files"][0]["meshes"]}')" '{43218}'
is "$(value s.json '{(f["mesh"], f["alike"]) for f in r["files"][0]["findings"] if f["code"] != "NMAP_CONSTANT"}')" '{(0, 1500)}'

scene "1 500 primitives over one set of accessors are one part of a join"
inputs gltf_same_grid 1500 s.glb
within 5 300 -q --across=mesh --only=all s.glb out.glb
exits 0
[ "$(stat -c %s out.glb)" -lt 3000000 ] || wrong "$(stat -c %s out.glb) bytes"

scene "primitives of one geometry whose material needs no tangents are judged once, too"
inputs gltf_same_grid 1500 s.glb
LC_ALL=C sed 's/"normalTexture"/"normalTextur_"/' s.glb >bare.glb
within 15 300 --check --report=s.json --fail-on=never bare.glb
is "$(value s.json '{f["alike"] for f in r["files"][0]["findings"]} - {1500}')" 'set()'

scene "$windows primitives with different parts of one index array are solved some at a time"
inputs gltf_long_windows "$windows" w.glb
within 16 800 -q --only=all w.glb out.glb
exits 0
is "$(gltf out.glb 'g.meshes[0].primitives.length')" "$windows"
rm out.glb

scene "what is solved some at a time is what is solved at once"
inputs gltf_long_windows 40 w.glb 30
run -q --only=all w.glb some.glb
exits 0
run -q --only=all --report=w.json --fail-on=never w.glb once.glb
same some.glb once.glb
# and what needs no repair keeps its bytes
run -q --only=all --existing=repair some.glb again.glb
same some.glb again.glb

# one takes 20 MB: each of 5 000 that took all vertices would ask for 800 MB
scene "5 000 primitives over one buffer cost what they use"
inputs gltf_ranges 5000 r.glb
for words in "" "--check" "--across=mesh" "--verify"; do
	rm -f out.glb
	# shellcheck disable=SC2086
	within 2 150 -q --only=all $words r.glb $([ "$words" = --check ] || echo out.glb)
	exits 0
done
run -q --only=all --output-format=ply -o out.ply r.glb
[ "$(stat -c %s out.ply)" -lt 3000000 ] || wrong "a PLY of $(stat -c %s out.ply) bytes"
rm -f out.glb out.ply

scene "$parts primitives with accessors of their own"
inputs gltf_grids "$parts" p.glb
within 4 190 -q p.glb out.glb
exits 0
is "$(gltf out.glb 'g.accessors.length')" $((5 * parts))
within 8 280 -q --check p.glb
exits 0
rm out.glb

scene "$((parts / 2)) primitives whose vertices are split"
inputs gltf_grids $((parts / 2)) p.glb 5
within 4 210 -q p.glb out.glb
exits 0
is "$(gltf out.glb 'g.accessors.length')" $((5 * parts / 2))
is "$(gltf out.glb 'g.accessors[0].count > 36')" true
rm out.glb

scene "the page of a long strip grows its sample in linear time"
inputs obj_strip $strip strip.obj
within 12 600 --check --report=s.html --fail-on=never strip.obj
exits 0

scene "a picture of an index takes time for rows, however many triangles lie on a pixel"
inputs obj_tiles "$faces" t.obj
within 2 300 -q --check --report=pages/ --fail-on=never t.obj
exits 0

scene "findings are looked up in a baseline in linear time, of the file's name and of another"
for size in 1 2 4; do
	python3 "$ROOT/tests/support/inputs.py" option_known $((size * faces)) $size.obj
	python3 "$ROOT/tests/support/inputs.py" obj_quads_of_objects $((size * faces / 32)) $size.obj
	ln $size.obj other.$size.obj
	ln $size.obj.json other.$size.obj.json
done
for name in "" other.; do
	command python3 "$ROOT/tests/support/growth.py" 8 $((factor))e-1 ${name}1.obj ${name}2.obj ${name}4.obj -- \
		"$NMTAN" -q --check --fail-on=never --baseline=IN.json IN >"$WORK/cost.txt" 2>&1 || wrong "$name: $(cat "$WORK/cost.txt")"
done

for kind in obj_hub obj_edge obj_patches; do
	scene "$kind: $faces faces that all meet, or none, are judged in nearly linear time, on any number of threads alike"
	inputs $kind $faces c.obj
	for threads in 1 3; do
		within 5 400 -q --check --report=c$threads.json --fail-on=never --threads=$threads c.obj
		exits 0
	done
	same c1.json c3.json
done

done_testing
