# SPDX-License-Identifier: MIT
# One mesh through every door: the tool, C, npm's functions and Python's give each corner the same w, whether v points
# up or down. The mesh is what the tool writes of an OBJ with mirrored faces; each program prints w of its corners.
. "$ROOT/tests/support/cli.sh"

scene "the tool gives both signs of w"
cd "$WORK" || exit 1
run "$data/mirrored_cube.obj" tool.gltf
exits 0
# count of vertices and corners; x y z nx ny nz u v of each vertex; vertices of corners
cat >split.mjs <<'END'
import { readFileSync, writeFileSync } from 'node:fs';
const doc = JSON.parse(readFileSync('tool.gltf')), bin = readFileSync(doc.buffers[0].uri);
const read = (index) => {
	const {componentType, type, count, bufferView, byteOffset = 0} = doc.accessors[index], view = doc.bufferViews[bufferView];
	const size = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4}[type], bytes = {5121: 1, 5123: 2, 5125: 4, 5126: 4}[componentType];
	const at = (row, k) => (view.byteOffset ?? 0) + byteOffset + row * (view.byteStride ?? size * bytes) + k * bytes;
	return Array.from({length: count * size}, (_, i) => (componentType === 5126 ? bin.readFloatLE(at(Math.floor(i / size), i % size))
		: bin.readUIntLE(at(Math.floor(i / size), i % size), bytes)));
};
const primitive = doc.meshes[0].primitives[0], [p, n, t, tangents] = ['POSITION', 'NORMAL', 'TEXCOORD_0', 'TANGENT']
	.map((name) => read(primitive.attributes[name])), indices = read(primitive.indices);
for (const [name, v] of [['down', (x) => x], ['up', (x) => -x]])
	writeFileSync(`${name}.txt`, [`${p.length / 3} ${indices.length}`, ...Array.from({length: p.length / 3}, (_, i) =>
		[...p.slice(3 * i, 3 * i + 3), ...n.slice(3 * i, 3 * i + 3), t[2 * i], v(t[2 * i + 1])].join(' ')), indices.join(' ')].join('\n'));
console.log(indices.map((vertex) => tangents[4 * vertex + 3]).join('\n'));
END
cat >door.c <<'END'
#include <nmtan.h>
#include <stdio.h>
#include <stdlib.h>
int main(int argc, char **argv)
{
	static float rows[1000][8], tangents[4000][4];
	static uint32_t corners[3000], indices[3000], sources[3000];
	unsigned vertices, count;
	if (scanf("%u %u", &vertices, &count) != 2)
		return 1;
	for (unsigned i = 0; i < 8 * vertices; i++)
		scanf("%f", &rows[0][i]);
	for (unsigned c = 0; c < count; c++)
		scanf("%u", &corners[c]);
	nmtan_mesh mesh = NMTAN_MESH_INIT;
	mesh.v_down = argc > 1;
	mesh.face_count = count / 3;
	mesh.vertex_count = vertices;
	mesh.indices = corners;
	mesh.positions = rows[0];
	mesh.normals = rows[0] + 3;
	mesh.texcoords = rows[0] + 6;
	mesh.position_stride_bytes = mesh.normal_stride_bytes = mesh.texcoord_stride_bytes = 32;
	nmtan_split_output output = NMTAN_SPLIT_OUTPUT_INIT;
	output.indices = indices;
	output.sources = sources;
	output.source_capacity = count;
	output.vertex_tangents = tangents[0];
	if (nmtan_vertex_tangents(&mesh, NULL, &output, NULL))
		return 1;
	for (unsigned c = 0; c < count; c++)
		printf("%g\n", tangents[indices[c]][3]);
	return 0;
}
END
cat >door.mjs <<'END'
import { readFileSync, writeFileSync } from 'node:fs';
const [npm, name] = process.argv.slice(2), nmtan = await import(`${npm}/index.js`);
await nmtan.ready;
const [vertices, count, ...numbers] = readFileSync(`${name}.txt`, 'utf8').split(/\s+/).map(Number);
const array = numbers.slice(0, 8 * vertices), indices = numbers.slice(8 * vertices), given = name === 'down' ? {vDown: true} : undefined;
const at = (offset) => ({array, stride: 8, offset}), of = (offset, size) => indices.flatMap((v) => array.slice(8 * v + offset, 8 * v + offset + size));
const mesh = [at(0), at(3), at(6)], soup = [of(0, 3), of(3, 3), of(6, 2)];
const {tangents, indices: split} = nmtan.generateTangentsIndexed(indices, ...mesh, given);
const print = (door, w) => writeFileSync(`${door}.w`, `${w.join('\n')}\n`);
print('indexed', [...split].map((v) => tangents[4 * v + 3]));
for (const [door, made] of [['corners', nmtan.generateCornerTangents(indices, ...mesh, given).tangents],
	['soup', nmtan.generateTangents(...soup, given)], ['repaired', nmtan.generateRepairedTangents(...soup, given)]])
	print(door, Array.from({length: count}, (_, c) => made[4 * c + 3]));
END
cat >door.py <<'END'
import sys
import numpy as np, nmtan
words = open(sys.argv[1] + ".txt").read().split()
vertices = int(words[0])
rows = np.array(words[2:2 + 8 * vertices], np.float32).reshape(-1, 8)
faces = np.array(words[2 + 8 * vertices:], int).reshape(-1, 3)
given = {"v_down": True} if sys.argv[1] == "down" else {}
mesh = rows[:, :3], rows[:, 3:6], rows[:, 6:], faces
result = nmtan.vertex_tangents(*mesh, **given)
for name, w in (("vertices", result.tangents[result.faces.ravel(), 3]), ("tangents", nmtan.tangents(*mesh, **given)[:, 3])):
    np.savetxt(name + ".w", w, "%g")
END

node split.mjs >tool.w || wrong "split.mjs"
is "$(sort -u tool.w | tr '\n' ' ')" "-1 1 "
cc -std=c11 -O1 -I"$ROOT/include" -o door door.c "$BUILD/libnmtan.a" -pthread -lm 2>err.txt || wrong "$(cat err.txt)"

# same NAME: NAME.w is the tool's.
same() {
	cmp -s "$1.w" tool.w || wrong "$1: $(diff "$1.w" tool.w | head -5)"
}
for way in up down; do
	scene "C has the tool's w, v $way"
	cd "$WORK" || exit 1
	# shellcheck disable=SC2046
	./door $([ $way = up ] || echo v_down) <$way.txt >c.w || wrong "it fails"
	same c
	scene "npm has the tool's w through each function, v $way"
	cd "$WORK" || exit 1
	if make -C "$ROOT" -s wasm >make.txt 2>&1 && command -v clang >/dev/null; then
		node door.mjs "$ROOT/build/npm" $way || wrong "door.mjs"
		for door in indexed corners soup repaired; do same $door; done
	else
		skip_case "no clang"
	fi
	scene "Python has the tool's w through each function, v $way"
	cd "$WORK" || exit 1
	make -C "$ROOT" -s python >make.txt 2>&1 || wrong "$(tail -5 make.txt)"
	[ -d wheel ] || python3 -m zipfile -e "$ROOT/build/python/nmtan.whl" wheel
	if PYTHONPATH=$PWD/wheel /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
		PYTHONPATH=$PWD/wheel /usr/bin/python3 -B door.py $way || wrong "door.py"
		same vertices
		same tangents
	else
		skip_case "no numpy"
	fi
done
done_testing
