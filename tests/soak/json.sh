#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/json.sh BUILD_DIR...: documents of 100 MB of JSON, with the first build: a million nodes over one mesh that
# needs nothing, and half a million nodes over 50 000 meshes of which every second one is solved. Prints seconds of the
# processor and peak of memory; more than 20 s or 8 times the text fail.
set -u
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0
for shape in "1000000 1" "500000 50000"; do
	# shellcheck disable=SC2086
	python3 tests/soak/json_big.py "$work/in.gltf" $shape || exit 1
	python3 - "$1/nmtan" "$work" "$shape" <<'EOF' && passed=$((passed + 1)) || failed=$((failed + 1))
import os, resource, subprocess, sys
tool, folder, shape = sys.argv[1:]
code = subprocess.call([tool, "-q", folder + "/in.gltf", folder + "/out.gltf"])
used = resource.getrusage(resource.RUSAGE_CHILDREN)
seconds, megabytes = used.ru_utime + used.ru_stime, used.ru_maxrss // 1024
size = os.path.getsize(folder + "/in.gltf") / 1e6
print("%.0f MB, %s nodes and %s meshes: %.2f s of the processor, peak %d MB" % (size, *shape.split(), seconds, megabytes))
sys.exit(code != 0 or seconds > 20 or megabytes > 8 * size)
EOF
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
