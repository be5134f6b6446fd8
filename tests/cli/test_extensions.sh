# SPDX-License-Identifier: MIT
# Extensions that refer to vertices, when vertices are copied.
. "$ROOT/tests/support/cli.sh"
. "$ROOT/tests/support/manifold.sh"

# Two quads that meet at x = 1 with mirrored texture coordinates, so that the vertices there get copies. $1: the
# primitive's extensions, $2: the mesh's, $3: the scene's. Accessor 4 lists all edges of the outline, 5 has a number
# for each vertex.
mirrored_gltf() {
	gltf new in "const of = {primitive: $1, mesh: $2, scene: $3};" '
		const points = [0, 1].flatMap((y) => [0, 1, 2].map((x) => [x, y, 0]));
		const attributes = {POSITION: add("VEC3", 5126, points.flat(), {min: [0, 0, 0], max: [2, 1, 0]}),
			NORMAL: add("VEC3", 5126, points.flatMap(() => [0, 0, 1])),
			TEXCOORD_0: add("VEC2", 5126, points.flatMap(([x, y]) => [1 - Math.abs(1 - x), y]))};
		const indices = add("SCALAR", 5123, [0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]);
		add("SCALAR", 5123, [0, 1, 1, 2, 2, 5, 5, 4, 4, 3, 3, 0, 1, 4]);
		add("SCALAR", 5126, [0, 1, 2, 3, 4, 5]);
		Object.assign(g, {scene: 0, scenes: [{nodes: [0], extensions: of.scene}], nodes: [{mesh: 0}],
			extensionsUsed: ["X", ...Object.values(of).flatMap(Object.keys)],
			meshes: [{extensions: of.mesh, primitives: [{attributes, indices, extensions: of.primitive}]}]})'
}

# How many sides of triangles a client outlines, as the extension defines it.
sides='(() => { const p = g.meshes[0].primitives[0], flat = n => rows(n).map(r => r[0]), t = flat(p.indices);
	const e = flat(p.extensions.CESIUM_primitive_outline.indices), all = new Set();
	for (let i = 0; i < e.length; i += 2) all.add([e[i], e[i + 1]].sort().join());
	let n = 0;
	for (let c = 0; c < t.length; c++) n += all.has([t[c], t[c % 3 === 2 ? c - 2 : c + 1]].sort().join());
	return n; })()'

scene "CESIUM_primitive_outline: every outlined side stays outlined"
mirrored_gltf '{"CESIUM_primitive_outline": {"indices": 4}}' '{}' '{}'
is "$(gltf in.gltf "$sides")" 8
for output in out.gltf out.glb; do
	run --only=all in.gltf $output
	exits 0
	is "$(gltf $output 'rows(g.meshes[0].primitives[0].attributes.POSITION).length')" 8
	is "$(gltf $output "$sides")" 8
	says_not EXTENSION_STALE
	valid $output
done

scene "an unknown extension that points at a number for each vertex gives a warning with its pointer"
mirrored_gltf '{"VENDOR_weights": {"a": [{"of": 5}]}}' '{"VENDOR_other": {"scale": 5000}}' '{}'
run --only=all in.gltf out.gltf
exits 0
says "/meshes/0/primitives/0/extensions/VENDOR_weights/a/0/of"
says "VENDOR_weights refers to vertices"
says_not VENDOR_other

# Prints "manifold" when the extension of $1 says what the specification asks for, and as many merges as there are.
manifold_of() {
	gltf "$1" '(() => {
		const [mesh] = g.meshes, m = mesh.extensions.EXT_mesh_manifold, flat = (accessor) => rows(accessor).flat();
		const whole = g.accessors[m.manifoldPrimitive.indices], s = whole.sparse;
		const own = mesh.primitives.map((p) => g.accessors[p.indices]);
		const must = (...all) => all.forEach((good, i) => { if (!good) throw new Error(`condition ${i}`); });
		const before = flat({...whole, sparse: undefined}), after = [...before], merges = [g.accessors[m.mergeIndices], g.accessors[m.mergeValues]];
		const [places, values] = [{...s.indices}, {...s.values, componentType: whole.componentType}].map((part) =>
			flat({...part, type: "SCALAR", count: s.count}));
		places.forEach((place, i) => { after[place] = values[i]; });
		const position = m.manifoldPrimitive.attributes.POSITION, at = rows(position).map(String);
		const half = after.map((a, c) => [a, after[c % 3 === 2 ? c - 2 : c + 1]]), all = new Set(half.map(String));
		must(own.every((a) => a.bufferView === whole.bufferView && a.componentType === whole.componentType),
			before.join() === own.flatMap(flat).join(),
			places.join() === flat(merges[0]).join(), values.join() === flat(merges[1]).join(),
			merges[0].bufferView === s.indices.bufferView, merges[1].bufferView === s.values.bufferView,
			mesh.primitives.every((p) => p.attributes.POSITION === position),
			before.every((v, c) => at[v] === at[after[c]]),
			all.size === half.length && half.every(([a, b]) => all.has(`${b},${a}`)));
		return `manifold ${places.length} ${before.filter((v, c) => v !== after[c]).length}`;
	})()'
}

merges_copies() {
	local found
	found=$(manifold_of "$1")
	[[ $found == "manifold "* && $found != "manifold 4 4" ]] || wrong "no merges for the copies: $found"
}

scene "EXT_mesh_manifold: the manifold stays one, its merges follow"
manifold_gltf in
is "$(manifold_of in.gltf)" "manifold 4 4"
run --only=all --buffers=embed in.gltf out.gltf
exits 0
says_not EXTENSION_STALE
[ "$(gltf out.gltf 'rows(g.meshes[0].primitives[0].attributes.POSITION).length')" -gt 13 ] || wrong "nothing is copied"
merges_copies out.gltf
corners='g.meshes[0].primitives.map((p) => rows(p.indices).map(([i]) => rows(p.attributes.POSITION)[i]))'
is "$(gltf out.gltf "$corners" | md5sum)" "$(gltf in.gltf "$corners" | md5sum)"
is "$(gltf out.gltf 'g.meshes[0].primitives.map((p) => rows(p.attributes.TANGENT).length > 13)')" "[true,true]"
valid out.gltf
# where Draco cannot hold what primitives share, they are plain
run --existing=replace --only=all --buffers=embed --draco=sequential in.gltf out.gltf
says DRACO_PLAIN
says_not EXTENSION_STALE
merges_copies out.gltf
run --only=all in.gltf out.glb
exits 0
valid out.glb

scene "a mesh that is not as EXT_mesh_manifold demands gives a warning that says why"
while IFS='|' read -r members why; do
	manifold_gltf in "$members"
	run --existing=replace --only=all in.gltf out.gltf
	exits 0
	says "/meshes/0/extensions/EXT_mesh_manifold"
	says "EXT_mesh_manifold, $why, refers to vertices"
	valid out.gltf
done <<'END'
{"manifoldPrimitive": 7}|whose manifold has no indices
{"manifoldPrimitive": {"indices": 3}}|whose manifold has no POSITION
{"manifoldPrimitive": {"indices": 4, "attributes": {"POSITION": 0}}}|a primitive of which has other indices than the manifold
{"manifoldPrimitive": {"indices": 3, "attributes": {"POSITION": 1}}}|a primitive of which has another POSITION than the manifold
END
manifold_gltf in
gltf in.gltf in 'g.meshes[0].primitives[1].indices = 6'
run --existing=replace --only=all in.gltf out.gltf
says "EXT_mesh_manifold, whose manifold has other triangles than its primitives, refers to vertices"
mirrored_gltf '{}' '{"EXT_mesh_manifold": {}}' '{}'
run --existing=replace --only=all --draco=sequential in.gltf out.gltf
exits 0
says "EXT_mesh_manifold, whose primitives are compressed, refers to vertices"

scene "FB_geometry_metadata counts vertices: a warning says that there are more now"
mirrored_gltf '{}' '{}' '{"FB_geometry_metadata": {"vertexCount": 18, "primitiveCount": 12}}'
run --only=all in.gltf out.gltf
exits 0
says "/scenes/0/extensions/FB_geometry_metadata"
says "vertexCount of FB_geometry_metadata refers to vertices"

scene "where nothing is copied there is no warning, and the outline is what it was"
mirrored_gltf '{"CESIUM_primitive_outline": {"indices": 4}, "VENDOR_weights": {"a": 5}}' '{"EXT_mesh_manifold": {}}' \
	'{"FB_geometry_metadata": {"vertexCount": 6}}'
gltf in.gltf in 'g.meshes[0].primitives[0].attributes.TEXCOORD_0 = 6;
	g.bufferViews.push({...g.bufferViews[0], byteStride: 12});
	g.accessors.push({bufferView: 6, componentType: 5126, count: 6, type: "VEC2"})'
run --only=all in.gltf out.gltf
exits 0
says_not EXTENSION_STALE
is "$(gltf out.gltf 'g.meshes[0].primitives[0].extensions.CESIUM_primitive_outline.indices')" 4

scene "extensions that are an array have no names, and are passed over"
for place in 'g.meshes[0].primitives[0]' 'g.meshes[0]'; do
	gltf "$data/morph.gltf" array "$place.extensions = ['x', 1]"
	for option in --draco=off --draco=sequential --morph=drop; do
		run $option array.gltf out.glb
		exits 0
	done
done

scene "a primitive whose mode an extension explains is left as it is, another unknown mode is refused"
python3 - "$data/plates.gltf" <<'END'
import json, sys
g = json.load(open(sys.argv[1]))
p = g["meshes"][0]["primitives"]
p.append(dict(p[0], mode=2147483647, extensions={"EXT_primitive_voxels": {"shape": 0}}))
g["extensionsUsed"] = g.get("extensionsUsed", []) + ["EXT_primitive_voxels"]
json.dump(g, open("voxels.gltf", "w"))
del p[-1]["extensions"]
json.dump(g, open("unknown.gltf", "w"))
END
cp "$data"/plates.bin "$data/bumps.png" .
run --verify voxels.gltf out.gltf
exits 0
is "$(gltf out.gltf 'g.meshes[0].primitives[3]')" "$(gltf voxels.gltf 'g.meshes[0].primitives[3]')"
is "$(gltf out.gltf 'g.meshes[0].primitives[0].attributes.TANGENT !== undefined')" true
run --check --only=all --fail-on=never voxels.gltf
exits 0
run unknown.gltf out.gltf
exits 3
says "/meshes/0/primitives/3/mode: 2147483647, expected at most 6"

done_testing
