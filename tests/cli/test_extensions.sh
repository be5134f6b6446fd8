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

# $1: the primitive's extensions, $2: the mesh's; $3: the pointer of what is told, whose extension stays as it was.
is_told() {
	mirrored_gltf "$1" "$2" '{}'
	for output in out.gltf out.glb; do
		run --only=all in.gltf $output
		exits 0
		is "$(gltf $output 'rows(g.meshes[0].primitives[0].attributes.POSITION).length')" 8
		says "$3"
		says "${3##*/} refers to vertices, and vertices were copied"
		is "$(gltf $output '[g.meshes[0].extensions, g.meshes[0].primitives[0].extensions]')" \
			"$(gltf in.gltf '[g.meshes[0].extensions, g.meshes[0].primitives[0].extensions]')"
	done
}

scene "extensions that refer to vertices by their numbers are told, and stay"
is_told '{"CESIUM_primitive_outline": {"indices": 4}}' '{}' /meshes/0/primitives/0/extensions/CESIUM_primitive_outline
is_told '{}' '{"EXT_mesh_manifold": {}}' /meshes/0/extensions/EXT_mesh_manifold
is_told '{}' '{"EXT_mesh_primitive_restart": {"primitiveGroups": [{"primitives": [0], "indices": 4}]}}' \
	/meshes/0/extensions/EXT_mesh_primitive_restart
is_told '{"EXT_mesh_features": {"featureIds": [{"featureCount": 6}]}}' '{}' \
	/meshes/0/primitives/0/extensions/EXT_mesh_features

scene "feature ids of an attribute or a texture go with the vertices"
for ids in '{"featureCount": 6, "attribute": 0}' '{"featureCount": 6, "texture": {"index": 0}}'; do
	mirrored_gltf "{\"EXT_mesh_features\": {\"featureIds\": [$ids]}}" '{}' '{}'
	run --only=all in.gltf out.gltf
	exits 0
	says_not EXTENSION_STALE
done

scene "feature ids that are the numbers of vertices keep their order in a block"
mirrored_gltf '{}' '{}' '{}'
run --only=all --draco=edgebreaker in.gltf block.gltf
gltf block.gltf block 'g.meshes[0].primitives[0].extensions.EXT_mesh_features = {featureIds: [{featureCount: 8}]}'
run -v --only=all --existing=replace block.gltf out.gltf
exits 0
says DRACO_SEQUENTIAL
says_not EXTENSION_STALE

scene "an unknown extension that points at a number for each vertex gives a warning with its pointer"
mirrored_gltf '{"VENDOR_weights": {"a": [{"of": 5}]}}' '{"VENDOR_other": {"scale": 5000}}' '{}'
run --only=all in.gltf out.gltf
exits 0
says "/meshes/0/primitives/0/extensions/VENDOR_weights/a/0/of"
says "VENDOR_weights refers to vertices"
says_not VENDOR_other

scene "EXT_mesh_manifold: the manifold stays what it was, and is told"
manifold_gltf in
run --only=all --buffers=embed in.gltf out.gltf
exits 0
says /meshes/0/extensions/EXT_mesh_manifold
corners='g.meshes[0].primitives.map((p) => rows(p.indices).map(([i]) => rows(p.attributes.POSITION)[i]))'
is "$(gltf out.gltf "$corners" | md5sum)" "$(gltf in.gltf "$corners" | md5sum)"
solid='(() => { const m = g.meshes[0].extensions.EXT_mesh_manifold.manifoldPrimitive, at = rows(m.attributes.POSITION);
	return rows(m.indices).map(([i]) => at[i]); })()'
is "$(gltf out.gltf "$solid" | md5sum)" "$(gltf in.gltf "$solid" | md5sum)"
valid out.gltf
mirrored_gltf '{}' '{"EXT_mesh_manifold": {}}' '{}'
run --existing=replace --only=all --draco=sequential in.gltf out.gltf
exits 0
says /meshes/0/extensions/EXT_mesh_manifold

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
