# SPDX-License-Identifier: MIT
# Extensions that refer to vertices, when vertices are copied.
. "$ROOT/tests/support/cli.sh"

# Two quads that meet at x = 1 with mirrored texture coordinates, so that the vertices there get copies. $1: the
# primitive's extensions, $2: the mesh's, $3: the scene's. Accessor 4 lists all edges of the outline, 5 has a number
# for each vertex.
mirrored_gltf() {
	python3 - "$@" <<'END'
import base64, json, struct, sys
positions = [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)]
uvs = [(1 - abs(1 - x), y) for x, y, z in positions]
indices = [0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]
edges = [0, 1, 1, 2, 2, 5, 5, 4, 4, 3, 3, 0, 1, 4]
arrays = [(b''.join(struct.pack('<3f', *p) for p in positions), 5126, 6, 'VEC3'),
          (struct.pack('<3f', 0, 0, 1) * 6, 5126, 6, 'VEC3'),
          (b''.join(struct.pack('<2f', *t) for t in uvs), 5126, 6, 'VEC2'),
          (struct.pack('<12H', *indices), 5123, 12, 'SCALAR'),
          (struct.pack('<14H', *edges), 5123, 14, 'SCALAR'),
          (struct.pack('<6f', *range(6)), 5126, 6, 'SCALAR')]
views, accessors, data = [], [], b''
for i, (content, kind, count, shape) in enumerate(arrays):
    views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(content)})
    accessors.append({'bufferView': i, 'componentType': kind, 'count': count, 'type': shape})
    data += content + b'\0' * (-len(content) % 4)
accessors[0].update(min=[0, 0, 0], max=[2, 1, 0])
of_primitive, of_mesh, of_scene = (json.loads(a) for a in sys.argv[1:4])
json.dump({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0], 'extensions': of_scene}],
           'nodes': [{'mesh': 0}], 'extensionsUsed': sorted({*of_primitive, *of_mesh, *of_scene, 'X'}),
           'meshes': [{'extensions': of_mesh, 'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1,
               'TEXCOORD_0': 2}, 'indices': 3, 'extensions': of_primitive}]}],
           'accessors': accessors, 'bufferViews': views, 'buffers': [{'byteLength': len(data),
               'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]},
          open('in.gltf', 'w'))
END
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

scene "EXT_mesh_manifold, whose merges cannot follow, gives one, too"
mirrored_gltf '{}' '{"EXT_mesh_manifold": {"mergeIndices": 4, "mergeValues": 4}}' '{}'
run --only=all in.gltf out.gltf
exits 0
says "/meshes/0/extensions/EXT_mesh_manifold"

scene "where nothing is copied there is no warning, and the outline is what it was"
mirrored_gltf '{"CESIUM_primitive_outline": {"indices": 4}, "VENDOR_weights": {"a": 5}}' '{"EXT_mesh_manifold": {}}' '{}'
sed -i 's/"TEXCOORD_0": 2/"TEXCOORD_0": 0/' in.gltf
python3 - <<'END'
import json
d = json.load(open('in.gltf'))
d['meshes'][0]['primitives'][0]['attributes']['TEXCOORD_0'] = 6
d['bufferViews'].append(dict(d['bufferViews'][0], byteStride=12))
d['accessors'].append({'bufferView': 6, 'componentType': 5126, 'count': 6, 'type': 'VEC2'})
json.dump(d, open('in.gltf', 'w'))
END
run --only=all in.gltf out.gltf
exits 0
says_not EXTENSION_STALE
is "$(gltf out.gltf 'g.meshes[0].primitives[0].extensions.CESIUM_primitive_outline.indices')" 4

done_testing
