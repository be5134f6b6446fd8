#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/needed.sh BUILD_DIR...: a GLB of 200 MB and one hundred primitives, one or none of which needs
# tangents: what is read (test_needed.c), and how long the tool takes beside cp: at most 1.3 and 1.1 times as long.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
NT_HUNDRED_MB=200 "$build/tests/unit/pipeline/test_needed" >"$work/said" 2>&1
code=$?
grep 'bytes touched' "$work/said"

# Pairs of runs, each into a fresh file; the median of the pairs' ratios has to stay below the limit.
for which in "one 1.3 0" "none 1.1 1"; do
	set -- $which
	python3 tests/support/inputs.py gltf_hundred 200 "$work/in.glb" "$3" >/dev/null
	python3 - "$build/nmtan" "$work" "$1" "$2" <<'EOF' || code=1
import os, statistics, subprocess, sys, time
tool, folder, which, limit = sys.argv[1:]
source, target = folder + "/in.glb", folder + "/out.glb"
def milliseconds(*command):
    if os.path.exists(target):
        os.remove(target)
    begin = time.perf_counter()
    subprocess.check_call(command)
    return 1e3 * (time.perf_counter() - begin)
def pair():
    return milliseconds("cp", "--reflink=never", source, target), milliseconds(tool, "-q", source, target)
pair()
pairs = [pair() for _ in range(11)]
ratio = statistics.median(ours / copy for copy, ours in pairs)
print("%s needed: medians of cp %.1f ms, nmtan %.1f ms; of the ratios %.2f, at most %s" % (which,
      statistics.median(copy for copy, _ in pairs), statistics.median(ours for _, ours in pairs), ratio, limit))
sys.exit(ratio > float(limit))
EOF
done
[ $code = 0 ] && echo "3 passed, 0 failed" || { cat "$work/said"; echo "FAILED"; }
exit $code
