# SPDX-License-Identifier: MIT
#
# manifold_gltf NAME [MEMBERS]: NAME.gltf, a box of two primitives as EXT_mesh_manifold has it, with these members in the
# extension instead. At x = 1 its texture coordinates are mirrored; one corner has two vertices, which the manifold merges.
manifold_gltf() {
	local members=${2:-}
	node "$ROOT/tests/support/answer.mjs" gltf new "$1" "const members = ${members:-null};" '
		const points = [0, -1].flatMap((z) => [0, 1].flatMap((y) => [0, 1, 2].map((x) => [x, y, z]))).concat([[0, 0, 0]]);
		const quads = [[0, 1, 4, 3], [1, 2, 5, 4], [7, 6, 9, 10], [8, 7, 10, 11], [12, 3, 9, 6], [2, 8, 11, 5],
			[12, 6, 7, 1], [1, 7, 8, 2], [3, 4, 10, 9], [4, 5, 11, 10]];
		const list = quads.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]), merged = list.flatMap((v, c) => v === 12 ? [c] : []);
		const attributes = {POSITION: add("VEC3", 5126, points.flat(), {min: [0, 0, -1], max: [2, 1, 0]}),
			NORMAL: add("VEC3", 5126, points.flatMap(() => [0, 0, 1])),
			TEXCOORD_0: add("VEC2", 5126, points.flatMap(([x, y, z]) => [1 - Math.abs(1 - x), y - z / 2]))};
		const indices = add("SCALAR", 5123, list), whole = g.accessors[indices];
		const mergeIndices = add("SCALAR", 5123, merged), mergeValues = add("SCALAR", 5123, merged.map(() => 0));
		g.accessors.push({...whole, count: 12}, {...whole, byteOffset: 24, count: 48});
		whole.sparse = {count: merged.length, indices: {bufferView: mergeIndices, componentType: 5123},
			values: {bufferView: mergeValues}};
		const manifold = {manifoldPrimitive: {attributes: {POSITION: 0}, indices}, mergeIndices, mergeValues, ...members};
		Object.assign(g, {scene: 0, nodes: [{mesh: 0}], extensionsUsed: ["EXT_mesh_manifold"],
			scenes: [{nodes: [0]}],
			meshes: [{extensions: {EXT_mesh_manifold: manifold}, primitives: [6, 7].map((indices) => ({attributes, indices}))}]})'
}
