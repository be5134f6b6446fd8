# SPDX-License-Identifier: MIT
# Doing only what is needed: what is there stays, what is up to date is not read, and nothing is lost when a batch ends early.
. "$ROOT/tests/support/cli.sh"

# Inode and time of change.
identity() {
	stat -c '%i %y' "$@"
}

scene "an output that has its bytes already keeps its inode and time with --write-if-changed, and not without"
run "$data/quad.obj" o.glb
before=$(identity o.glb)
run --write-if-changed "$data/quad.obj" o.glb
exits 0
says "left as it is"
is "$(identity o.glb)" "$before"
run --write-if-changed --bitangents "$data/quad.obj" o.glb
exits 0
says_not "left as it is"
run "$data/quad.obj" o.glb
[ "$(identity o.glb)" != "$before" ] || wrong "the output was not replaced"
only o.glb

scene "--write-if-changed keeps the files beside the output, too"
run "$data/quad.obj" o.gltf
before=$(identity o.gltf o.bin)
run --write-if-changed "$data/quad.obj" o.gltf
exits 0
is "$(identity o.gltf o.bin)" "$before"
only o.gltf o.bin

scene "--no-clobber decides before anything is read"
echo "no mesh at all" >bad.obj
echo "mine" >o.glb
run -n bad.obj o.glb
exits 2
says "o.glb: refusing to write: the file exists already"
run -n bad.obj other.glb
exits 3
is "$(cat o.glb)" mine
mkfifo nobody_writes
timeout 10 "$NMTAN" -n nobody_writes o.glb 2>"$WORK/err.txt"
is $? 2

done_testing
