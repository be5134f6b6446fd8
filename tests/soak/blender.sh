#!/bin/sh
# SPDX-License-Identifier: MIT
#
# blender.sh BUILD: Blender's tangents beside those of the Python module, on Suzanne, the OBJs of ../shared/models and
# those of the folder that $MODELS names. Needs Debian's blender, whose Python finds Debian's numpy.
set -eu
cd "$(dirname "$0")/../.."
if ! command -v blender >/dev/null 2>&1; then
	echo "blender: not installed (700 MB), nothing was compared"
	exit 0
fi
make -s python
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m zipfile -e build/python/nmtan.whl "$work/wheel"
set --
for file in ../shared/models/obj/*.obj ${MODELS:+"$MODELS"/*.obj}; do
	[ ! -f "$file" ] || set -- "$@" "$file"
done
blender -b --factory-startup --python-exit-code 2 --python tests/soak/blender.py -- "$work/wheel" "$@" >"$work/said" 2>&1 ||
	{ status=$?; cat "$work/said"; exit $status; }
grep -E 'triangles, worst|^Blender [0-9.]+, nmtan' "$work/said"
echo "blender: $(grep -c 'triangles, worst' "$work/said") meshes compared, no other sign"
