// SPDX-License-Identifier: MIT
//
// answer.mjs gltf FILE EXPRESSION           prints the value of a JavaScript expression over a .gltf or .glb
// answer.mjs gltf FILE NAME STATEMENTS...   writes NAME.gltf, with its buffers beside it, after the statements
//
// They see g, the document; bytes, the buffers, which they may change and replace; rows(accessor), an accessor's rows of
// numbers, by its number or itself; at(accessor, row), where one begins in its buffer; add(TYPE, COMPONENT TYPE, NUMBERS,
// MEMBERS), which makes an accessor in the first buffer and gives its number; and open(FILE), another file with all of
// these. The file "new" is a document with nothing in it. If views are compressed by meshoptimizer, bytes has what
// npm's decoder makes of them, in place of what a fallback buffer has.
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const widths = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
const readers = { 5120: ['readInt8', 1], 5122: ['readInt16LE', 2], 5121: ['readUInt8', 1], 5123: ['readUInt16LE', 2], 5125: ['readUInt32LE', 4], 5126: ['readFloatLE', 4] };

// npm's decoder, where it is installed.
let decoder;
try {
	const modules = join(dirname(fileURLToPath(import.meta.url)), '../../build/node/package.json');
	decoder = createRequire(modules)('meshoptimizer/decoder.cjs');
	await decoder.ready;
} catch { /* a file that needs it will say so */ }

// The extension that compresses a view; undefined: nothing.
export const packing = (view) => view.extensions?.EXT_meshopt_compression ?? view.extensions?.KHR_meshopt_compression;

// The bytes of a view that is compressed: data is those of the buffer that has them.
export function unpack(packed, data) {
	const { count, byteStride, byteOffset = 0, byteLength, mode, filter } = packed, out = new Uint8Array(count * byteStride);
	decoder.decodeGltfBuffer(out, count, byteStride, data.subarray(byteOffset, byteOffset + byteLength), mode, filter);
	return out;
}

const empty = '{"asset": {"version": "2.0"}, "buffers": [{"uri": "data:,"}], "bufferViews": [], "accessors": []}';

export function open(path) {
	const file = path === 'new' ? Buffer.from(empty) : readFileSync(path), binary = file.toString('latin1', 0, 4) === 'glTF';
	const size = binary ? file.readUInt32LE(12) : 0;
	const g = JSON.parse(binary ? file.toString('utf8', 20, 20 + size) : file.toString('utf8'));
	const chunk = binary ? file.subarray(20 + size + 8) : undefined;
	const loaded = [];
	const bytes = new Proxy(loaded, { get: (target, name) => {
		if (typeof name !== 'string' || !/^\d+$/.test(name))
			return target[name];
		return target[name] ??= unpacked(Number(name), stored(name));
	} });
	const stored = (number) => {
		const uri = g.buffers[number].uri;
		return uri === undefined ? Number(number) ? undefined : chunk
			: uri.startsWith('data:') ? Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64')
				: readFileSync(join(dirname(path), decodeURIComponent(uri)));
	};
	const unpacked = (number, there) => {
		const views = (g.bufferViews ?? []).filter((view) => view.buffer === number && packing(view));
		const data = views.length ? Buffer.alloc(g.buffers[number].byteLength) : there;
		if (views.length && there)
			there.copy(data);
		for (const view of views)
			data.set(unpack(packing(view), bytes[packing(view).buffer]), view.byteOffset ?? 0);
		return data;
	};
	const shape = (accessor) => {
		const [method, size] = readers[accessor.componentType], width = widths[accessor.type];
		return { method, size, width, stride: g.bufferViews[accessor.bufferView]?.byteStride ?? width * size };
	};
	const of = (accessor) => typeof accessor === 'number' ? g.accessors[accessor] : accessor;
	const at = (number, row = 0) => {
		const accessor = of(number), view = g.bufferViews[accessor.bufferView];
		return (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0) + row * shape(accessor).stride;
	};
	const rows = (number) => {
		const accessor = of(number), { method, size, width } = shape(accessor), { sparse } = accessor;
		const row = (bytes, at) => Array.from({ length: width }, (_, k) => bytes ? bytes[method](at + k * size) : 0);
		const data = accessor.bufferView === undefined ? undefined : bytes[g.bufferViews[accessor.bufferView].buffer];
		const all = Array.from({ length: accessor.count }, (_, i) => row(data, data && at(number, i)));
		if (sparse) {
			const { indices, values } = sparse, from = g.bufferViews[values.bufferView];
			rows({ type: 'SCALAR', count: sparse.count, ...indices }).forEach(([i], k) => { all[i] = row(bytes[from.buffer],
				(from.byteOffset ?? 0) + (values.byteOffset ?? 0) + k * width * size); });
		}
		return all;
	};
	const add = (type, componentType, numbers, more) => {
		const [method, size] = readers[componentType], data = Buffer.alloc(numbers.length * size);
		numbers.forEach((x, i) => data[method.replace('read', 'write')](x, i * size));
		const begin = bytes[0].length + 3 & ~3;
		loaded[0] = Buffer.concat([bytes[0], Buffer.alloc(begin - bytes[0].length), data]);
		const bufferView = g.bufferViews.push({ buffer: 0, byteOffset: begin, byteLength: data.length }) - 1;
		return g.accessors.push({ bufferView, componentType, type, count: numbers.length / widths[type], ...more }) - 1;
	};
	return { g, bytes, stored, rows, at, add };
}

export default function answer([path, expression, ...statements], say) {
	const file = open(path);
	const run = (text) => new Function(...Object.keys(file), 'open', text)(...Object.values(file), open);
	if (statements.length === 0) {
		const value = run(`return (${expression});`);
		say(typeof value === 'string' ? value : JSON.stringify(value));
		return true;
	}
	run(statements.join('\n'));
	for (const [i, buffer] of (file.g.buffers ?? []).entries()) {
		if (file.bytes[i] === undefined) /* of no URI */
			continue;
		const name = `${expression}${i ? `-${i}` : ''}.bin`, data = file.bytes[i];
		Object.assign(buffer, { uri: name.replace(/.*\//, ''), byteLength: data.length });
		writeFileSync(name, data);
	}
	writeFileSync(`${expression}.gltf`, JSON.stringify(file.g));
	return true;
}
