# SPDX-License-Identifier: MIT
#
# sets.sh RELEASE SANITIZE: output sets, every call: killed before it, failing, and the power cut after it, for many documents
# and ways to write them; over nothing, over an output of ours, beside somebody else's files, in place, and where
# files cannot be linked. tests/cli/test_sets.sh has the smallest of these.
set -u
cd "$(dirname "$0")/../.." || exit 1
nmtan=$PWD/$1/nmtan calls=$PWD/$1/tests/preload/calls.so data=$PWD/data
sets=$PWD/tests/support/sets.py
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1
mkdir "$work/in" && python3 tests/support/gltf_layouts.py "$work/in" || exit 1
cp "$data"/*.gl* "$data"/*.bin "$data"/*.png "$data"/*.obj "$data"/*.mtl "$data"/*.ply "$work/in"
cd "$work" || exit 1
tried=0 bad=0

sweep() {
	local line
	line=$(python3 "$sets" "$@")
	[ $? = 0 ] || echo "sets: $* -> $line"
	set -- $line
	tried=$((tried + ${2:-0})) bad=$((bad + ${4:-1}))
}

# each INPUT MAIN OPTIONS...: over nothing, over ours, beside others.
each() {
	local input=$PWD/in/$1 main=$2 stem=${2%.*} mode
	shift 2
	rm -rf nothing ours theirs && mkdir nothing ours theirs
	(cd ours && "$nmtan" -q --bitangents --existing=replace "$@" "$input" "$main" 2>/dev/null) || return 0
	for name in .bin -1.bin; do
		echo somebody >"theirs/$stem$name"
	done
	(cd theirs && "$nmtan" -q --bitangents --existing=replace "$@" "$input" "$main" 2>/dev/null)
	cmp -s "ours/$main" theirs/"$main" && rm -rf theirs
	for mode in kill fail power; do
		for before in nothing ours theirs; do
			[ ! -d $before ] || sweep $mode "$nmtan" "$calls" $before "$main" -q -j1 --sync --existing=replace "$@" "$input" "$main"
		done
		sweep $mode --also=link:1 "$nmtan" "$calls" ours "$main" -q -j1 --sync --existing=replace "$@" "$input" "$main"
	done
	for before in nothing ours; do
		sweep kill "$nmtan" "$calls" $before "$main" -q -j1 --existing=replace "$@" "$input" "$main"
	done
}

for input in plates.gltf plain.gltf three_buffers.gltf sparse.gltf quantized.gltf; do
	each $input o.gltf --buffers=copy --images=copy
	each $input o.glb --buffers=copy
	rm -rf place && mkdir place && cp in/*.bin in/*.png place && cp in/$input place/
	for mode in kill fail power; do
		sweep $mode "$nmtan" "$calls" place $input -q -j1 --sync --in-place $input
	done
done
each plates.gltf o.glb # one file, whatever is in it
each head.obj o.gltf --images=copy
each mirrored_cube.obj o.gltf --images=copy
each quad_le.ply o.gltf

echo "sets: $tried states tried, $bad bad"
[ $bad = 0 ] && [ $tried -gt 1000 ]
