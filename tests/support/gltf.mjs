// SPDX-License-Identifier: MIT
//
// node gltf.mjs FILE EXPRESSION: prints the value of a JavaScript expression over a .gltf or .glb, with
// g the document and rows(accessor) an accessor's rows of numbers.
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';

const [path, expression] = process.argv.slice(2);
const bytes = readFileSync(path);
let g, chunk;
if (bytes.toString('latin1', 0, 4) === 'glTF') {
	const size = bytes.readUInt32LE(12);
	g = JSON.parse(bytes.toString('utf8', 20, 20 + size));
	chunk = bytes.subarray(20 + size + 8);
} else {
	g = JSON.parse(bytes.toString('utf8'));
}

function bufferBytes(index) {
	const uri = g.buffers[index].uri;
	if (uri === undefined)
		return chunk;
	return uri.startsWith('data:') ? Buffer.from(uri.slice(uri.indexOf(',') + 1), 'base64')
		: readFileSync(join(dirname(path), decodeURIComponent(uri)));
}

const widths = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const readers = { 5120: ['readInt8', 1], 5122: ['readInt16LE', 2], 5121: ['readUInt8', 1], 5123: ['readUInt16LE', 2], 5125: ['readUInt32LE', 4], 5126: ['readFloatLE', 4] };

function rows(number) {
	const accessor = g.accessors[number], view = g.bufferViews[accessor.bufferView];
	const [method, size] = readers[accessor.componentType], width = widths[accessor.type];
	const data = bufferBytes(view.buffer), stride = view.byteStride ?? width * size;
	const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
	return Array.from({ length: accessor.count }, (_, row) =>
		Array.from({ length: width }, (_, k) => data[method](start + row * stride + k * size)));
}

const value = new Function('g', 'rows', `return (${expression});`)(g, rows);
console.log(typeof value === 'string' ? value : JSON.stringify(value));
