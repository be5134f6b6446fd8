# SPDX-License-Identifier: MIT
# Small files that ask for much work: time, memory and output stay in proportion to what is read, with the bounds that
# the manual states under LIMITS. Times are generous, since the machine may be busy; what is quadratic misses them
# by far.
. "$ROOT/tests/support/cli.sh"

inputs() {
	python3 "$ROOT/tests/support/cost_inputs.py" "$@"
}

# within SECONDS MEGABYTES ARGUMENTS...: runs nmtan, which must stay below both. Sanitizers cost a multiple.
within() {
	local seconds=$1 megabytes=$2 factor=1
	shift 2
	case $NMTAN in */release/*) ;; *) factor=8 ;; esac
	python3 -c '
import resource, subprocess, sys
seconds, megabytes, out, err, *command = sys.argv[1:]
try:
    status = subprocess.run(command, stdout=open(out, "wb"), stderr=open(err, "wb"),
                            stdin=subprocess.DEVNULL, timeout=float(seconds)).returncode
except subprocess.TimeoutExpired:
    sys.exit("more than %s seconds" % seconds)
used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
if used > float(megabytes):
    print("%.0f MB, expected less than %s" % (used, megabytes))
sys.exit(status)' $((seconds * factor)) $((megabytes * factor)) "$WORK/out.txt" "$WORK/err.txt" \
		"$NMTAN" "$@" >"$WORK/cost.txt" 2>&1
	status=$?
	[ ! -s "$WORK/cost.txt" ] || wrong "$(cat "$WORK/cost.txt")"
}

# A value of a JSON file.
value() {
	python3 -c 'import json, sys; r = json.load(open(sys.argv[1])); print(eval(sys.argv[2]))' "$@"
}

scene "a PLY header of 100 000 elements is read in linear time"
inputs elements 100000 e.ply
within 15 300 e.ply out.ply
exits 0

scene "an OBJ of 100 000 materials makes a document of 100 000 primitives"
inputs usemtl 100000 m.obj
within 30 300 -q m.obj m.glb
exits 0
is "$(gltf m.glb 'g.meshes[0].primitives.length')" 100000
# at most 36 times the input: the geometry and the JSON of five accessors for every line of 34 bytes
[ $(($(stat -c %s m.glb) / $(stat -c %s m.obj))) -lt 36 ] || wrong "$(stat -c %s m.glb) bytes"

scene "1 500 primitives over one set of accessors are judged and drawn once"
inputs same 1500 s.glb
within 15 300 --check --report=s.html --only=all --fail-on=never s.glb
exits 0
[ "$(stat -c %s s.html)" -lt 20000000 ] || wrong "a page of $(stat -c %s s.html) bytes"
within 15 300 --check --report=s.json --only=all --fail-on=never s.glb
is "$(value s.json 'len(r["files"][0]["meshes"])')" 1500
is "$(value s.json '{m["same_as"] for m in r["files"][0]["meshes"][1:]}')" '{0}'
is "$(value s.json '{m["faces"] for m in r["files"][0]["meshes"]}')" '{43218}'
is "$(value s.json '{(f["mesh"], f["alike"]) for f in r["files"][0]["findings"]}')" '{(0, 1500)}'

scene "primitives of one geometry whose material needs no tangents are judged once, too"
inputs same 1500 s.glb
python3 - <<'END'
data = open('s.glb', 'rb').read()
open('s.glb', 'wb').write(data.replace(b'"normalTexture"', b'"normalTextur_"'))
END
within 15 300 --check --report=s.json --fail-on=never s.glb
is "$(value s.json '{f["alike"] for f in r["files"][0]["findings"]} - {1500}')" 'set()'

scene "the page of a long strip grows its sample in linear time"
inputs strip 200000 strip.obj
within 30 1500 --check --report=s.html --fail-on=never strip.obj
exits 0

done_testing
