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

# A box that is a manifold of two primitives; $1: what its extension has otherwise.
manifold_gltf() {
	python3 "$ROOT/tests/support/gltf_manifold.py" in.gltf "$@"
}

# Prints "manifold" when the extension of $1 says what the specification asks for, and as many merges as there are.
manifold_of() {
	python3 - "$1" <<'END'
import base64, json, struct, sys
g = json.load(open(sys.argv[1]))
data = base64.b64decode(g['buffers'][0]['uri'].split(',')[1])
def numbers(view, offset, kind, count):
    v = g['bufferViews'][view]
    return list(struct.unpack_from('<%d%s' % (count, {5121: 'B', 5123: 'H', 5125: 'I'}[kind]), data,
                                   v.get('byteOffset', 0) + offset))
def plain(a):
    return numbers(a['bufferView'], a.get('byteOffset', 0), a['componentType'], a['count'])
mesh, all_ = g['meshes'][0], g['accessors']
m = mesh['extensions']['EXT_mesh_manifold']
whole = all_[m['manifoldPrimitive']['indices']]
own = [all_[p['indices']] for p in mesh['primitives']]
assert all(a['bufferView'] == whole['bufferView'] and a['componentType'] == whole['componentType'] for a in own)
before = plain(whole)
assert before == [i for a in own for i in plain(a)]
after, s = list(before), whole['sparse']
places = numbers(s['indices']['bufferView'], s['indices'].get('byteOffset', 0), s['indices']['componentType'], s['count'])
values = numbers(s['values']['bufferView'], s['values'].get('byteOffset', 0), whole['componentType'], s['count'])
assert places == plain(all_[m['mergeIndices']]) and values == plain(all_[m['mergeValues']])
assert all_[m['mergeIndices']]['bufferView'] == s['indices']['bufferView']
assert all_[m['mergeValues']]['bufferView'] == s['values']['bufferView']
for place, value in zip(places, values):
    after[place] = value
assert {p['attributes']['POSITION'] for p in mesh['primitives']} == {m['manifoldPrimitive']['attributes']['POSITION']}
a = all_[m['manifoldPrimitive']['attributes']['POSITION']]
v = g['bufferViews'][a['bufferView']]
at = [struct.unpack_from('<3f', data, v['byteOffset'] + 12 * i) for i in range(a['count'])]
assert [at[i] for i in before] == [at[i] for i in after]
half = [(after[c], after[c - 2 if c % 3 == 2 else c + 1]) for c in range(len(after))]
assert len(set(half)) == len(half) and all((b, a) in set(half) for a, b in half)
print('manifold', len(places), sum(b != a for b, a in zip(before, after)))
END
}

scene "EXT_mesh_manifold: the manifold stays one, its merges follow"
manifold_gltf '{}'
is "$(manifold_of in.gltf)" "manifold 4 4"
run --only=all --embed in.gltf out.gltf
exits 0
says_not EXTENSION_STALE
[ "$(gltf out.gltf 'rows(g.meshes[0].primitives[0].attributes.POSITION).length')" -gt 13 ] || wrong "nothing is copied"
case $(manifold_of out.gltf) in "manifold 4 4" | "") wrong "no merges for the copies" ;; esac
corners='g.meshes[0].primitives.map((p) => rows(p.indices).map(([i]) => rows(p.attributes.POSITION)[i]))'
is "$(gltf out.gltf "$corners" | md5sum)" "$(gltf in.gltf "$corners" | md5sum)"
is "$(gltf out.gltf 'g.meshes[0].primitives.map((p) => rows(p.attributes.TANGENT).length > 13)')" "[true,true]"
vertices='g.meshes[0].primitives.map((p) => rows(p.attributes.POSITION).length).reduce((a, b) => a + b)'
is "$(gltf out.gltf 'Object.values(g.scenes[0].extensions.FB_geometry_metadata)')" "[$(gltf out.gltf "$vertices"),20]"
valid out.gltf
# where Draco cannot hold what primitives share, they are plain
run --existing=replace --only=all --embed --draco=sequential in.gltf out.gltf
says DRACO_PLAIN
says_not EXTENSION_STALE
case $(manifold_of out.gltf) in "manifold 4 4" | "") wrong "no merges for the copies" ;; esac
run --only=all in.gltf out.glb
exits 0
valid out.glb

scene "a mesh that is not as EXT_mesh_manifold demands gives a warning that says why"
while IFS='|' read -r members why; do
	manifold_gltf "$members"
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
manifold_gltf '{}'
sed -i 's/"indices": 7/"indices": 6/' in.gltf
run --existing=replace --only=all in.gltf out.gltf
says "EXT_mesh_manifold, whose manifold has other triangles than its primitives, refers to vertices"
manifold_gltf '{}'
mirrored_gltf '{}' '{"EXT_mesh_manifold": {}}' '{}'
run --existing=replace --only=all --draco=sequential in.gltf out.gltf
exits 0
says "EXT_mesh_manifold, whose primitives are compressed, refers to vertices"

scene "FB_geometry_metadata counts what the scene has now"
mirrored_gltf '{}' '{}' '{"FB_geometry_metadata": {"vertexCount": 18, "primitiveCount": 12, "sceneBounds": {"min": [0, 0, 0], "max": [2, 1, 0]}}}'
sed -i 's/"nodes": \[{"mesh": 0}\]/"nodes": [{"children": [1, 2]}, {"mesh": 0, "children": [3]}, {"mesh": 0}, {"mesh": 0, "children": [0, 9]}, {"mesh": 0}]/' in.gltf
run --only=all in.gltf out.gltf
exits 0
says_not EXTENSION_STALE
metadata='g.scenes[0].extensions.FB_geometry_metadata'
# three nodes show 8 vertices each instead of 6; the loop that they are in counts once
is "$(gltf out.gltf "[$metadata.vertexCount, $metadata.primitiveCount]")" "[24,12]"
sed -i 's/"vertexCount": 18/"vertexCount": 17/' in.gltf
run --existing=replace --only=all in.gltf out.gltf
exits 0
says "/scenes/0/extensions/FB_geometry_metadata"
is "$(gltf out.gltf "[$metadata.vertexCount, $metadata.primitiveCount]")" "[17,12]"

scene "where nothing is copied there is no warning, and the outline is what it was"
mirrored_gltf '{"CESIUM_primitive_outline": {"indices": 4}, "VENDOR_weights": {"a": 5}}' '{"EXT_mesh_manifold": {}}' '{}'
sed -i 's/"TEXCOORD_0": 2/"TEXCOORD_0": 0/' in.gltf
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

done_testing
