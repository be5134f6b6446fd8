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

# The output has what its input has, bit for bit, a right frame on every corner, and no error that the input has not.
sound() {
	exits 0
	silent
	ask answer.mjs meshopt same "$1" "$2" >faults || wrong "$1: $(cat faults)"
	local counts
	counts=$(ask answer.mjs frames "$2")
	[[ $counts =~ ^corners\ [1-9] && ! $counts =~ \ (unit|w|mixed|wrong)\ [1-9] ]] || wrong "$1: $counts"
	valid "$2" "$1"
}

# The extensions, modes and filters of a file's views, and how many are plain.
kinds='[...new Set(g.bufferViews.map((v) => Object.entries(v.extensions ?? {plain: {mode: "", filter: ""}})
	.map(([name, e]) => [name, e.mode, e.filter].join(" "))[0]))].sort().join()'

vertices() {
	gltf "$1" 'g.accessors[g.meshes[0].primitives[0].attributes.POSITION].count'
}

scene "what changes and what is new is packed as the file is, and not larger than what gltfpack makes of it with -gt"
bare
for words in "1.08 -c" "1.08 -cc" "1.12 -cc -ce khr" "0 -c -vi" "0 -c -noq" "0 -cc -vpf -vtf -vnf" "0 -c -vn 10"; do
	# shellcheck disable=SC2086
	set -- $words
	rm -f ./*.glb
	pack packed.glb "${@:2}"
	pack gt.glb "${@:2}" -gt
	run -q --verify packed.glb out.glb
	sound packed.glb out.glb
	[[ $* = *-vi* ]] || is "$(gltf out.glb "$kinds")" "$(gltf packed.glb "$kinds")"
	before=$(vertices packed.glb) after=$(vertices out.glb)
	[ "$before" -lt "$after" ] || wrong "$words: nothing is split"
	[ "$1" = 0 ] || awk "BEGIN { exit !($(stat -c %s out.glb) <= $1 * $(stat -c %s gt.glb)) }" ||
		wrong "$words: $(stat -c %s out.glb) bytes, gltfpack makes $(stat -c %s gt.glb)"
done

scene "tangents have the bits of the normals beside them, wherever in a view these lie"
bare
# the same again, twice as large, in another material: gltfpack puts its normals behind the first ones
gltf bare.gltf both 'const [mesh] = g.meshes, [p] = mesh.primitives, a = g.accessors[p.attributes.POSITION], twice = (x) => 2 * x;
	const large = add("VEC3", 5126, rows(p.attributes.POSITION).flat().map(twice));
	Object.assign(g.accessors[large], {min: a.min.map(twice), max: a.max.map(twice)});
	const material = g.materials.push({normalTexture: {index: 0, scale: 0.5}}) - 1;
	g.meshes.push({primitives: [{...p, attributes: {...p.attributes, POSITION: large}, material}]});
	g.scenes[0].nodes.push(g.nodes.push({mesh: 1}) - 1)'
mv both.gltf bare.gltf
for bits in 6 10; do
	pack packed.glb -cc -kn -vpf -vn $bits
	[ "$(gltf packed.glb 'g.accessors[g.meshes[1].primitives[0].attributes.NORMAL].byteOffset')" -gt 0 ] || wrong "it lies first"
	run -q --verify packed.glb out.glb
	sound packed.glb out.glb
	is "$(gltf out.glb 'rows(g.meshes[1].primitives[0].attributes.TANGENT)')" \
		"$(gltf out.glb 'rows(g.meshes[0].primitives[0].attributes.TANGENT)')"
done

scene "packed vertices that quantization made equal are welded, and packed again"
bare
for words in "-c -vp 4 -vt 3 -vn 3" "-cc -vp 4 -vt 2 -vn 3"; do
	rm -f ./*.glb
	# shellcheck disable=SC2086
	pack packed.glb $words
	run --verify --weld packed.glb out.glb
	exits 0
	says ", welded "
	ask answer.mjs meshopt same packed.glb out.glb >faults || wrong "$words: $(cat faults)"
	valid out.glb packed.glb
	is "$(gltf out.glb "$kinds")" "$(gltf packed.glb "$kinds")"
	run -q --verify packed.glb whole.glb
	[ "$(vertices out.glb)" -lt "$(vertices whole.glb)" ] || wrong "$words: nothing is welded"
done

scene "tangents that are there keep their place and form, and a repair settles"
bare
for words in "-c -gt" "-cc -gt" "-cc -gt -ce khr"; do
	rm -f ./*.glb
	# shellcheck disable=SC2086
	pack packed.glb $words
	run -q --verify --existing=replace packed.glb out.glb
	sound packed.glb out.glb
	is "$(gltf out.glb "$kinds")" "$(gltf packed.glb "$kinds")"
	is "$(gltf out.glb 'g.bufferViews.length')" "$(gltf packed.glb 'g.bufferViews.length')"
	run -q --verify --existing=repair packed.glb repaired.glb
	sound packed.glb repaired.glb
	run -q --verify --existing=repair repaired.glb again.glb
	same repaired.glb again.glb
done

scene "a reader without the extension finds the same in the fallback buffer"
bare
pack packed.gltf -cf
for words in "out.gltf" "out.glb"; do
	run -q --verify packed.gltf "$words"
	sound packed.gltf "$words"
done
gltf out.gltf plain 'g.bufferViews.forEach((v) => delete v.extensions);
	g.buffers.forEach((b) => delete b.extensions); bytes[1] = stored(1);
	g.extensionsUsed = ["KHR_mesh_quantization", "KHR_texture_transform"];
	g.extensionsRequired = ["KHR_mesh_quantization"]'
valid plain.gltf
run --check --fail-on=never plain.gltf
exits 0
counts=$(ask answer.mjs frames plain.gltf)
[[ ! $counts =~ \ (unit|w|mixed|wrong)\ [1-9] ]] || wrong "$counts"

scene "--meshopt=off writes plain what changes, --precision another type"
bare
pack packed.glb -cc
run -q --verify --meshopt=off packed.glb out.glb
exits 0
is "$(gltf out.glb "$kinds")" "plain  "
# what does not change itself has the bounds of what is decoded, whatever the encoder said of it
gltf bare.gltf both 'const [mesh] = g.meshes, copy = structuredClone(mesh);
	for (const p of copy.primitives) delete p.material;
	g.meshes.push(copy); g.nodes.push({mesh: 1, translation: [2, 0, 0]}); g.scenes[0].nodes.push(g.nodes.length - 1)'
cp both.gltf bare.gltf
pack both.glb -cc -vpf -kn
gltf both.glb moved 'for (const a of g.accessors) if (a.min) a.min[0] -= 1e-3, a.max[0] += 1e-3'
run -q --verify --meshopt=off moved.gltf out.glb
exits 0
is "$(gltf out.glb "$kinds")" "plain  "
valid out.glb
bare
run -q --verify --precision=float packed.glb out.glb
sound packed.glb out.glb
is "$(gltf out.glb 'g.accessors[g.meshes[0].primitives[0].attributes.TANGENT].componentType')" 5126
run -q --verify --precision=short packed.glb out.glb
sound packed.glb out.glb
is "$(gltf out.glb 'g.accessors[g.meshes[0].primitives[0].attributes.TANGENT].componentType')" 5122

done_testing
