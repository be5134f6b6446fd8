// SPDX-License-Identifier: MIT
//
// decoders.mjs MODULES all|tangents FILE...: what draco3d and meshoptimizer's own decoder make of GLB files: every tangent has unit
// length and a w of exactly -1 or 1, what is in a block is within the bounds of its accessors and reaches them, blocks
// have the counts that the accessors say, and packed views have the bytes that they say.
// MODULES is the folder with these packages; tangents: bounds may be the input's. Prints "FILE: fault" and ends with 1 where there is one.
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { open, packing } from '../support/gltf.mjs';

const [modules, what, ...files] = process.argv.slice(2);
const draco = await createRequire(join(modules, 'package.json'))('draco3d').createDecoderModule({});
const most = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };

function decodeBlock(file, primitive) {
	const extension = primitive.extensions.KHR_draco_mesh_compression, view = file.g.bufferViews[extension.bufferView];
	const begin = view.byteOffset ?? 0, bytes = file.bytes[view.buffer].subarray(begin, begin + view.byteLength);
	const decoder = new draco.Decoder(), mesh = new draco.Mesh();
	const status = decoder.DecodeArrayToMesh(new Int8Array(bytes), bytes.length, mesh);
	if (!status.ok())
		throw new Error(`draco3d: ${status.error_msg()}`);
	const attribute = (name) => {
		const a = decoder.GetAttributeByUniqueId(mesh, extension.attributes[name]), values = new draco.DracoFloat32Array();
		decoder.GetAttributeFloatForAllPoints(mesh, a, values);
		const width = a.num_components();
		return Array.from({ length: mesh.num_points() }, (_, i) =>
			Array.from({ length: width }, (_, k) => values.GetValue(i * width + k)));
	};
	return { attribute, has: (name) => name in extension.attributes, points: mesh.num_points(), faces: mesh.num_faces() };
}

function judgeBounds(accessor, values, fault) {
	for (const [name, better] of [['min', Math.min], ['max', Math.max]])
		(accessor[name] ?? []).forEach((bound, k) => {
			const extreme = values.reduce((x, row) => better(x, row[k]), values[0][k]);
			if (Math.fround(bound) !== Math.fround(extreme))
				fault(`${name}[${k}] is ${bound}, of the values ${extreme}`);
		});
}

function judgePrimitive(file, primitive, fault) {
	const { g } = file, block = primitive.extensions?.KHR_draco_mesh_compression && decodeBlock(file, primitive);
	if (block && (block.points !== g.accessors[primitive.attributes.POSITION].count ||
		3 * block.faces !== g.accessors[primitive.indices].count))
		fault(`the block has ${block.points} points and ${block.faces} faces, its accessors others`);
	for (const name of ['POSITION', 'TANGENT']) {
		const number = primitive.attributes[name], accessor = g.accessors?.[number];
		if (!accessor || (!block?.has(name) && (accessor.bufferView === undefined || accessor.sparse)))
			continue;
		const stored = block?.has(name) ? block.attribute(name) : file.rows(number);
		/* of plain ones the validator judges; those that nobody solved keep their block, and the input's bounds */
		if (what === 'all' && primitive.attributes.TANGENT !== undefined && block?.has(name))
			judgeBounds(accessor, stored, (text) => fault(`${name}: ${text}`));
		const one = accessor.normalized ? most[accessor.componentType] : 1;
		if (name === 'TANGENT')
			for (const [i, t] of stored.entries()) {
				const length = Math.hypot(t[0], t[1], t[2]) / one;
				if (!(Math.abs(length - 1) <= 0.00674) || Math.abs(t[3]) !== one)
					return fault(`tangent ${i} is (${t.map((x) => x / one).join(' ')})`);
			}
	}
}

let faults = 0;
for (const path of files) {
	const fault = (text) => { faults++; console.log(`${path}: ${text}`.slice(0, 300)); };
	try {
		const file = open(path);
		for (const [i, view] of (file.g.bufferViews ?? []).entries())
			if (packing(view) && packing(view).count * packing(view).byteStride !== view.byteLength)
				fault(`view ${i} unpacks to other than ${view.byteLength} bytes`);
		for (const mesh of file.g.meshes ?? [])
			mesh.primitives.forEach((primitive) => judgePrimitive(file, primitive, fault));
	} catch (error) {
		fault(String(error));
	}
}
process.exit(faults ? 1 : 0);
