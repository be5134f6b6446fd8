// SPDX-License-Identifier: MIT
//
// answer.mjs meshopt views OUT FILE...   writes all compressed views of the files and what npm's decoder makes of them,
//                                        as tests/unit/ext/test_meshopt.c compares them, and says how many
// answer.mjs meshopt same IN OUT         whether OUT has in all corners what IN has, bit for bit, but for tangents, and
//                                        fallback buffers the bytes of their views
import { writeFileSync } from 'node:fs';
import { open, packing, unpack } from './gltf.mjs';

const sizes = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };
const widths = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };

function views([out, ...paths], say) {
	const parts = [];
	for (const path of paths) {
		const file = open(path);
		for (const packed of (file.g.bufferViews ?? []).map(packing).filter(Boolean)) {
			const { mode, filter = 'NONE', byteStride, count, byteLength, byteOffset = 0 } = packed;
			const data = file.bytes[packed.buffer];
			parts.push(Buffer.from(`${mode} ${filter} ${byteStride} ${count} ${byteLength}\n`),
				data.subarray(byteOffset, byteOffset + byteLength), unpack(packed, data));
		}
	}
	writeFileSync(out, Buffer.concat(parts));
	say(`${parts.length / 3}`);
	return true;
}

// The bytes of an accessor's row; sparse ones have none.
function element(file, number, row) {
	const accessor = file.g.accessors[number], size = sizes[accessor.componentType] * widths[accessor.type];
	const begin = file.at(number, row);
	return file.bytes[file.g.bufferViews[accessor.bufferView].buffer].latin1Slice(begin, begin + size);
}

// A primitive's lists of attributes: its own and those of its targets.
const attributes = (primitive) => [primitive.attributes, ...(primitive.targets ?? [])];

// The corners of a primitive, all of each in one text.
function corners(file, primitive, names) {
	const dense = (number) => file.g.accessors[number].bufferView !== undefined && !file.g.accessors[number].sparse;
	const numbers = attributes(primitive).flatMap((list, k) => names[k].map((name) => list[name])).filter(dense);
	const vertices = file.g.accessors[primitive.attributes.POSITION].count, known = new Map();
	const rows = primitive.indices === undefined ? [...Array(vertices).keys()] : file.rows(primitive.indices).flat();
	const text = (v) => numbers.map((number) => element(file, number, v)).join('|');
	const all = rows.map((v) => known.get(v) ?? known.set(v, text(v)).get(v));
	// the codec may begin a triangle with any of its corners
	for (let i = 0; (primitive.mode ?? 4) === 4 && i < all.length; i += 3)
		all.splice(i, 3, ...[0, 1, 2].map((turn) => [0, 1, 2].map((k) => all[i + (k + turn) % 3])).sort()[0]);
	return all;
}

// The bytes of a view; of triangles, which an encoder may turn, each begins with its lowest index.
function content(packed, bytes) {
	const { mode, byteStride: size, count } = packed, data = Buffer.from(bytes), text = [];
	for (let i = 0; mode === 'TRIANGLES' && i < count; i += 3) {
		const [a, b, c] = [0, 1, 2].map((k) => data.readUIntLE((i + k) * size, size));
		text.push([[a, b, c], [b, c, a], [c, a, b]].find(([x, y, z]) => x <= y && x <= z));
	}
	return text.length ? text.join() : data.toString('latin1');
}

function same([before, after], say) {
	const a = open(before), b = open(after);
	let faults = 0;
	const fault = (text) => { faults++; say(text); };
	for (const [m, mesh] of (a.g.meshes ?? []).entries())
		for (const [p, primitive] of mesh.primitives.entries()) {
			const names = attributes(primitive).map((list) => Object.keys(list).filter((name) => name !== 'TANGENT'));
			const x = corners(a, primitive, names), y = corners(b, b.g.meshes[m].primitives[p], names);
			if (x.length !== y.length || x.some((text, i) => text !== y[i]))
				fault(`mesh ${m}, primitive ${p}: corner ${x.findIndex((text, i) => text !== y[i])} differs`);
		}
	for (const [i, view] of (b.g.bufferViews ?? []).entries()) {
		const packed = packing(view), there = packed && b.stored(view.buffer), begin = view.byteOffset ?? 0;
		const end = begin + view.byteLength;
		if (packed && (packed.count * packed.byteStride !== view.byteLength || end > b.g.buffers[view.buffer].byteLength))
			fault(`bufferView ${i}: ${packed.count} times ${packed.byteStride} in ${view.byteLength} bytes`);
		if (there && content(packed, there.subarray(begin, end)) !== content(packed, unpack(packed, b.bytes[packed.buffer])))
			fault(`bufferView ${i} and what is to be used in its place differ`);
	}
	return faults === 0;
}

export default function answer([what, ...words], say) {
	return (what === 'views' ? views : same)(words, say);
}
