#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Faults of the system are errors, never missing files: every 19th system call of the tool fails, or finds an input that
# another process has emptied. tests/soak/faults.sh tries every one.
. "$ROOT/tests/support/cli.sh"
. "$ROOT/tests/faults/cases.sh"

make_inputs || { echo "not ok - the inputs of the sweep can be made"; exit 1; }
for kind in EIO ENOMEM EINTR ENOSPC shorten; do
	scene "$kind: a status and a line, no file by halves"
	sweep_all $kind -- $([ $kind = shorten ] && echo 5 || echo 19) >"$WORK/err.txt" 2>&1 || wrong "a fault is not told"
	case_name=$(tail -1 "$WORK/err.txt")
done

scene "devices are no inputs"
for device in /dev/full /dev/zero; do
	run --in-place $device
	exits 2
	says "$device: cannot read: it is a device"
	run $device out.glb
	exits 2
	run --check $device
	exits 2
done
only

scene "pipes and standard input are read"
mkfifo pipe.obj
cat "$data/head.obj" "$data/head.obj" >twice.obj
cat twice.obj >pipe.obj &
run -q pipe.obj out.glb
exits 0
wait
"$NMTAN" -q - same.glb <twice.obj || wrong "standard input, a file"
cat twice.obj | "$NMTAN" -q - piped.glb || wrong "standard input, a pipe"
cmp -s out.glb same.glb && cmp -s out.glb piped.glb || wrong "the outputs differ"

scene "what cannot be written to standard output is not laid to standard input"
"$NMTAN" -q "$data/head.obj" - >/dev/full 2>"$WORK/err.txt" && wrong "no error"
says "standard output: cannot write"
"$NMTAN" -q --check --report=- "$data/head.obj" >/dev/full 2>"$WORK/err.txt" && wrong "no error"
says "standard output"
says_not "standard input"

done_testing
