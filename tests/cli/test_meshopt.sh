# SPDX-License-Identifier: MIT
# Views that meshoptimizer compressed, in both versions of the codec: what gltfpack makes is read as npm's decoder does.
. "$ROOT/tests/support/cli.sh"

modules=$ROOT/build/node/node_modules
n=0

# pack NAME WORDS...: gltfpack makes NAME of bare.gltf.
pack() {
	node "$modules/gltfpack/cli.js" -i bare.gltf -o "$1" -tr "${@:2}" >"$WORK/out.txt" 2>&1 ||
		wrong "gltfpack ${*:2} fails"
}

# bare.gltf: the head without tangents, with a normal map. Its sides mirror each other, so that vertices are split.
bare() {
	run -q --only=all "$data/head.obj" head.glb
	gltf head.glb bare 'for (const p of g.meshes.flatMap((mesh) => mesh.primitives))
			delete p.attributes.TANGENT, p.material = 0;
		Object.assign(g, {materials: [{normalTexture: {index: 0}}], textures: [{source: 0}],
			images: [{uri: "bumps.png"}]})'
	cp "$data/bumps.png" .
}

if [ ! -d "$modules/gltfpack" ] || [ ! -d "$modules/meshoptimizer" ]; then
	scene "what gltfpack makes"
	skip_case "gltfpack and meshoptimizer are not installed (no network?)"
	done_testing
	exit
fi

scene "all codecs and filters are decoded as npm's decoder does"
bare
for words in "-c" "-cc -ce khr" "-c -ce khr -vpf -vtf -vnf" "-c -vi -ce khr" "-c -noq -ce khr"; do
	# shellcheck disable=SC2086
	pack "packed$((++n)).glb" $words
done
ask answer.mjs meshopt views packed.views packed?.glb >/dev/null || wrong "npm's decoder fails"
"$(dirname "$NMTAN")/tests/unit/ext/test_meshopt" packed.views >found || wrong "$(cat found)"
grep -qE '^[0-9]+ views, 1[0-9] of version 1, 0 differ' found || wrong "$(cat found)"
for packed in packed?.glb; do
	run -q --verify "$packed" out.glb
	exits 0
	silent
	ask answer.mjs meshopt same "$packed" out.glb >faults || wrong "$packed: $(cat faults)"
	counts=$(ask answer.mjs frames out.glb)
	[[ $counts =~ ^corners\ [1-9] && ! $counts =~ \ (unit|w|mixed|wrong)\ [1-9] ]] || wrong "$packed: $counts"
done

done_testing
