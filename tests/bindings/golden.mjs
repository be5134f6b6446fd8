// SPDX-License-Identifier: MIT
//
// Reads the goldens of data/golden: corners one behind the other, V up.
import { readFileSync, readdirSync } from 'node:fs';

// {name, faces: sizes, positions, normals, texcoords, tangents}
export function readGolden(path) {
	const file = readFileSync(path);
	const faceCount = file.readUInt32LE(8), cornerCount = file.readUInt32LE(12);
	const sizes = file.subarray(16, 16 + faceCount);
	let at = 16 + (faceCount + 3 & ~3);
	const take = (count) => {
		const values = new Float32Array(count * cornerCount);
		for (let i = 0; i < values.length; i++, at += 4)
			values[i] = file.readFloatLE(at);
		return values;
	};
	return {sizes, positions: take(3), normals: take(3), texcoords: take(2), tangents: take(4)};
}

// The goldens that have triangles alone, by name.
export function triangleGoldens(folder) {
	const found = new Map();
	for (const name of readdirSync(folder).filter((name) => name.endsWith('.nmtg')).sort()) {
		const golden = readGolden(`${folder}/${name}`);
		if (golden.sizes.every((size) => size === 3))
			found.set(name, golden);
	}
	return found;
}

export const equalBytes = (a, b) => a.length === b.length &&
	Buffer.compare(Buffer.from(a.buffer, a.byteOffset, a.byteLength), Buffer.from(b.buffer, b.byteOffset, b.byteLength)) === 0;
