# SPDX-License-Identifier: MIT
# Limits for those who run what others send: what is beyond them ends in a clean way, with a status of its own.
. "$ROOT/tests/support/cli.sh"

# refused WORDS MESSAGE: exit code 7, the message, and nothing beside the input.
refused() {
	exits 7
	says "$1"
	only "${@:2}"
}
sanitized=true
case $NMTAN in
*/release/*) sanitized=false ;;
esac

scene "triangles are counted before the work, once for each primitive that has them"
python3 "$ROOT/tests/support/inputs.py" gltf_same_grid 100 s.glb
run --only=all --max-triangles=4000000 s.glb out.glb
refused "s.glb: 4321800 triangles, --max-triangles is 4000000" s.glb
run -q --only=all --max-triangles=4321800 s.glb out.glb
exits 0

scene "quads count twice, instances each, and --check has the same limit"
cp "$data/quad.obj" "$data/plates.gltf" "$data/plates.bin" "$data/bumps.png" .
run --max-triangles=1 quad.obj out.ply
refused "quad.obj: 2 triangles, --max-triangles is 1" quad.obj plates.gltf plates.bin bumps.png
run --check --max-triangles=1 quad.obj
refused "quad.obj: 2 triangles" quad.obj plates.gltf plates.bin bumps.png
gltf plates.gltf twice 'g.nodes.push(JSON.parse(JSON.stringify(g.nodes[0]))); g.scenes[0].nodes.push(g.nodes.length - 1)'
run --max-triangles=1 --only=all plates.gltf out.ply
first=$(grep -oE '[0-9]+ triangles' "$WORK/err.txt")
run --max-triangles=1 --only=all twice.gltf out.ply
[ "$(grep -oE '[0-9]+ triangles' "$WORK/err.txt" | grep -oE '[0-9]+')" -gt "${first%% *}" ] || wrong "the instance is not counted"

scene "a morph target that is baked has the triangles once more"
python3 "$ROOT/tests/support/inputs.py" gltf_targets_of_grid 100 t.glb 20
run --max-triangles=80799 t.glb out.glb
refused "t.glb: 80800 triangles with those of morph targets, --max-triangles is 80799" t.glb
for words in --max-triangles=80800 "--max-triangles=800 --morph=keep" "--max-triangles=800 --morph=drop" \
	"--max-triangles=800 --output-format=ply"; do
	# shellcheck disable=SC2086
	run -q $words t.glb -o out.glb
	exits 0
done
run -q --check --max-triangles=800 t.glb
exits 0

scene "the others of many go on"
cp "$data/quad.obj" "$data/head.obj" .
run --max-triangles=10 -d out --manifest=m.jsonl quad.obj head.obj
exits 7
exists out/quad.glb
[ ! -e out/head.glb ] || wrong "there is an output"
is "$(python3 -c 'import json; print(sorted(json.loads(line)["exit_code"] for line in open("m.jsonl")))')" "[0, 7]"

scene "pixels of images are counted before any is decoded"
python3 "$ROOT/tests/support/inputs.py" mtl_bumps 3 b.obj 256
# each is looked at to see whether it is grey, and then decoded for each result
run --max-pixels=262143 b.obj out.gltf
refused "b.obj: images of 262144 pixels are to be decoded and made, --max-pixels is 262143" b.obj b.mtl b.png
run --max-pixels=65535 b.obj out.gltf
refused "images of 65536 pixels" b.obj b.mtl b.png
run -q --max-pixels=262144 b.obj out.gltf
exits 0
rm -r out.*
cp "$data/plates.gltf" "$data/plates.bin" "$data/bumps.png" .
run --check --check-maps=on --max-pixels=100 plates.gltf
exits 7
says "plates.gltf: images of "

scene "each scan of a JPEG and each tile of a TIFF counts, and no image has more than 16 384 pixels for a byte"
python3 - <<'END'
import struct, zlib
def segment(marker, data):
    return b'\xff' + bytes((marker,)) + struct.pack('>H', 2 + len(data)) + data
# progressive, of 4 000 x 4 000 and 490 scans
scan = segment(0xda, bytes((1, 1, 0, 0, 0, 0))) + b'\x12\xff\x00'
open('scans.jpg', 'wb').write(b'\xff\xd8' + segment(0xc2, struct.pack('>BHHB', 8, 4000, 4000, 1) + b'\1\x11\0') + 490 * scan)
open('many.jpg', 'wb').write(b'\xff\xd8' + segment(0xc2, struct.pack('>BHHB', 8, 8, 8, 1) + b'\1\x11\0') +
                               segment(0xdb, bytes(1) + bytes((1,)) * 64) + segment(0xc4, bytes((0, 1)) + bytes(16)) + 502 * scan)
def tiff(path, width, height, tags, data, count):
    tables = struct.pack('<%dI' % count, *[8] * count) + struct.pack('<%dI' % count, *[len(data)] * count)
    at = 8 + len(data)
    tags = sorted([(256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, 8), (262, 3, 1, 1), (277, 3, 1, 1)] +
                  [(t, 4, n, {'offsets': at, 'sizes': at + 4 * count}.get(v, v)) for t, n, v in tags])
    open(path, 'wb').write(struct.pack('<2sHI', b'II', 42, at + len(tables)) + data + tables + struct.pack('<H', len(tags)) +
                           b''.join(struct.pack('<HHII', *t) for t in tags) + bytes(4))
rows = zlib.compress(bytes(16000 * 800), 9)
tiff('strips.tif', 16000, 16000, [(273, 20, 'offsets'), (278, 1, 800), (279, 20, 'sizes')], rows, 20)
# one column, of tiles of 4 096 x 16
tile = zlib.compress(bytes(4096 * 16), 9)
tiff('tiles.tif', 1, 1600, [(322, 1, 4096), (323, 1, 16), (324, 100, 'offsets'), (325, 100, 'sizes')], tile, 100)
for name in 'scans.jpg', 'many.jpg', 'strips.tif', 'tiles.tif':
    open(name + '.obj', 'w').write('mtllib %s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n' % name)
    open(name + '.mtl', 'w').write('newmtl m\nmap_Kd %s\n' % name)
END
for row in "scans.jpg 7840000000" "strips.tif 256000000" "tiles.tif 6553600"; do
	name=${row% *} pixels=${row#* }
	if [ $name != tiles.tif ]; then
		run --textures=png $name.obj out.gltf
		exits 7
		says "$name: $(stat -c %s $name) bytes of image are to be decoded to $pixels pixels"
		says "--max-pixels=$pixels allows it"
	fi
	run --textures=png --max-pixels=$((pixels - 1)) $name.obj out.gltf
	exits 7
	says "images of $pixels pixels are to be decoded and made"
	[ ! -e out.gltf ] || wrong "there is an output"
done
run -q --textures=png --max-pixels=256000000 strips.tif.obj out.gltf
exits 0
run -q --textures=png --max-pixels=7840000000 scans.jpg.obj out.gltf
exits 0
says IMAGE_DAMAGED
says_not "more than 500 scans"
run -q --textures=png many.jpg.obj out.gltf
says IMAGE_DAMAGED
run --textures=png many.jpg.obj out.gltf
says "JPEG: more than 500 scans"

scene "500 maps of 4096 x 4096 are not too many, 60 times as many are"
python3 "$ROOT/tests/support/inputs.py" mtl_bumps 500 b.obj
run --max-seconds=0.1 b.obj out.glb
refused "not done after" b.obj b.mtl b.png
python3 "$ROOT/tests/support/inputs.py" mtl_bumps 30000 b.obj
run b.obj out.glb
refused "are to be decoded and made, --max-pixels is 17179869184" b.obj b.mtl b.png

scene "a run that is late ends, without output, temporary files and report"
python3 "$ROOT/tests/support/inputs.py" gltf_long_windows 200 w.glb
for words in "" --verify --bitangents; do
	# shellcheck disable=SC2086
	run --only=all --max-seconds=0.05 $words w.glb out.glb
	refused "w.glb: not done after --max-seconds=0.05 (" w.glb
done
run --only=all --max-seconds=0.05 --check w.glb
refused "w.glb: not done after --max-seconds=0.05 (" w.glb
run -q --only=all --max-seconds=1000 "$data/quad.obj" out.glb
exits 0

scene "it ends in the midst of what it waits for"
mkfifo pipe
sleep 60 >pipe &
sleeper=$!
"$NMTAN" --max-seconds=0.2 - out.glb <pipe 2>"$WORK/err.txt"
status=$?
kill $sleeper
refused "standard input: not done after --max-seconds=0.2" pipe
# a pipe by its name that nobody opens to write, or whose writer says nothing: alone, of several, and as a list
cp "$data/quad.obj" .
for writer in none "sleep 60"; do
	[ "$writer" = none ] || { $writer >pipe & }
	while IFS='|' read -r words message; do
		# shellcheck disable=SC2086
		timeout 20 "$NMTAN" -q --max-seconds=0.2 $words 2>"$WORK/err.txt" </dev/null
		status=$?
		exits 7
		says "$message"
	done <<-'END'
		pipe out.glb|pipe: not done after --max-seconds=0.2
		-j1 -d out pipe quad.obj|pipe: not done after --max-seconds=0.2
		--check --fail-on=never pipe quad.obj|pipe: not done after --max-seconds=0.2
		--check --files-from=pipe|pipe: not read after --max-seconds=0.2
	END
	[ "$writer" = none ] || kill $!
done
is "$(ls out)" quad.glb
rm -r out
only pipe quad.obj
(sleep 0.3; cat "$data/quad.obj"; sleep 0.3) >pipe &
run -q --max-seconds=60 pipe out.glb
exits 0
run -q quad.obj want.glb
same out.glb want.glb

scene "one that is late leaves the others"
python3 "$ROOT/tests/support/inputs.py" gltf_long_windows 1000 w.glb
cp "$data/quad.obj" .
# On a busy machine the quad may be late, too; the other takes two seconds of the fastest processor.
for limit in 0.05 0.2 0.8; do
	run --only=all --max-seconds=$limit -d out w.glb quad.obj
	exits 7
	says "w.glb: not done after --max-seconds=$limit"
	[ ! -e out/quad.glb ] || break
done
is "$(ls -A out)" quad.glb

scene "an output has its name or the run is late, whenever the time is over"
cp "$data/plates.gltf" "$data/plates.bin" "$data/bumps.png" .
run -q --only=all plates.gltf good.glb
for i in $(seq 30); do
	rm -f out.glb
	run -q --only=all --max-seconds=0.00$((i / 2 % 10))$i plates.gltf out.glb
	[ $status = 0 ] || [ $status = 7 ] || wrong "exit code $status"
	if [ $status = 0 ]; then same out.glb good.glb; else [ ! -e out.glb ] || wrong "late, with an output"; fi
done
rm -f out.glb
only plates.gltf plates.bin bumps.png good.glb

# A sanitizer's shadow memory is beyond any limit.
if ! $sanitized; then
	scene "memory beyond the limit is refused"
	python3 "$ROOT/tests/support/inputs.py" gltf_long_windows 200 w.glb
	run --only=all --max-memory=24M w.glb out.glb
	refused "w.glb: --max-memory=24M is not enough: 7" w.glb
	says "M is the most that such a file needs: try half of it first"
	enough=$(sed -n 's/.*not enough: \([0-9]*M\).*/\1/p' "$WORK/err.txt")
	run --only=all --max-memory=24M --report=r.json w.glb out.glb
	exits 7
	grep -q -- "--max-memory=24M is not enough" r.json || wrong "the report does not say so"
	run -q --only=all --max-memory=$enough w.glb out.glb
	exits 0

	scene "memory that is not enough to begin is a limit, too"
	cp "$data"/{head.obj,quad_le.ply} .
	gltf "$data/plates.gltf" plates ''
	for size in 1 1500 1K 300K 1M 4M; do
		for file in head.obj quad_le.ply plates.gltf; do
			for words in "" --check --fix; do
				output=out.glb
				[ "$words" != --check ] || output=
				run $words --max-memory=$size $file $output
				exits 7
				is "$(cat "$WORK/err.txt")" "nmtan: $file: --max-memory=$size is not enough"
			done
		done
		run -d out --max-memory=$size head.obj quad_le.ply
		exits 7
		says "head.obj: --max-memory=$size is not enough"
		says "quad_le.ply: --max-memory=$size is not enough"
	done
fi

scene "limits that are no numbers"
for words in --max-seconds=0 --max-seconds=-1 --max-seconds=1s --max-seconds=nan --max-triangles=-1 --max-memory=x; do
	run $words in.glb out.glb
	exits 1
	says "${words%%=*}: '${words#*=}' is not"
done

done_testing
