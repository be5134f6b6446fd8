#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Exhausted memory is exit 4 with one line, whoever allocates: every 23rd allocation fails, once and with all that
# come after it. tests/soak/faults.sh fails every one.
. "$ROOT/tests/support/cli.sh"
. "$ROOT/tests/faults/cases.sh"

make_inputs || { echo "not ok - the inputs of the sweep can be made"; exit 1; }
for kind in "memory" "memory onwards"; do
	scene "$kind: a status and a line, no file by halves"
	sweep_all "$kind" -- 23 >"$WORK/err.txt" 2>&1 || wrong "a fault is not told"
	case_name=$(tail -1 "$WORK/err.txt")
done

# Not among the cases: libtiff itself, which does not look whether it has a libjpeg, ends where all that comes after fails.
scene "a JPEG in a TIFF: each allocation fails once"
is "$(sweep memory 1 <<<"a JPEG in a TIFF | jpeg.obj jpeg.mtl e.tif || --images=embed --threads=1 jpeg.obj o.glb" | sed 's/.*, //')" "bad 0"

done_testing
