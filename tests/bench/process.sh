#!/bin/sh
# SPDX-License-Identifier: MIT
#
# make bench-process: whole runs on small files beside those of gltfpack ($PEERS/gltfpack), in turns: milliseconds, and the
# part of the other's time that nmtan takes (medians, best quartiles). Measure on a machine that does nothing else.
set -eu
cd "$(dirname "$0")/../.."
root=$PWD runner=$PWD/$1 nmtan=$PWD/$2 peer=${PEERS:-/usr/bin}/gltfpack
work=$(mktemp -d)
trap 'cd / && rm -rf "$work"' EXIT
cd "$work"
mkdir in out

python3 "$root/tests/support/inputs.py" obj_torus 5000 torus.obj
sed -E '/^vn/d; /^f/s#(/[0-9]+)/[0-9]+#\1#g' torus.obj >bare.obj
cp "$root/data/plates.glb" plates.glb
seq 0 499 | while read -r i; do cp bare.obj "in/$i.obj" && echo "in/$i.obj"; done >list
echo 'int main() {}' >empty.cpp
${CXX:-c++} -O2 -o empty empty.cpp

printf '%-48s %9s %9s   %s\n' "" nmtan other "median quartile"
"$runner" 300 1 "nmtan --version, an empty C++ program" "$nmtan" --version -- "$work/empty"
[ -x "$peer" ] || { echo "no $peer: skipped" && exit; }
"$runner" 300 1 "a GLB of 4 KB" "$nmtan" -q plates.glb out/0.glb -- "$peer" -i plates.glb -o out/0.glb
"$runner" 200 1 "an OBJ of 5000 triangles" "$nmtan" -q torus.obj out/0.glb -- "$peer" -i torus.obj -o out/0.glb
"$runner" 200 1 "the same without normals" "$nmtan" -q bare.obj out/0.glb -- "$peer" -i bare.obj -o out/0.glb
"$runner" 3 500 "500 of them, in 500 processes" "$nmtan" -q in/@.obj out/@.glb -- "$peer" -i in/@.obj -o out/@.glb
"$runner" 3 500 "500 of them, nmtan in one process" "$nmtan" -q -d out --files-from=list -- "$peer" -i in/@.obj -o out/@.glb
for count in 1 500 2000 5000; do
	python3 "$root/tests/support/inputs.py" gltf_ranges $count pool.glb 160
	"$runner" 20 1 "$count primitives over 25 921 vertices" "$nmtan" -q --only=all pool.glb out/0.glb -- \
		"$peer" -noq -gt -i pool.glb -o out/0.glb 2>messages
	"$runner" 20 1 "the same, nmtan --check" "$nmtan" --check --only=all --fail-on=never pool.glb -- \
		"$peer" -noq -gt -i pool.glb -o out/0.glb 2>messages
done
