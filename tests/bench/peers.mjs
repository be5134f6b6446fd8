// SPDX-License-Identifier: MIT
//
// node peers.mjs FOLDER MODULES: tangents by npm mikktspace and meshoptimizer (both wasm) for each FOLDER/*.mesh.
// Writes NAME.PEER.tan (float32 x 4 per corner) and appends "NAME PEER seconds" to FOLDER/peers.txt.
// A .mesh is uint32 vertex count and corner count, then float32 positions, normals, texture coordinates by
// vertex, uint32 indices.
import { createRequire } from 'node:module';
import { appendFileSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { join, resolve } from 'node:path';

const [folder, modules] = process.argv.slice(2);
const require = createRequire(pathToFileURL(join(resolve(modules), 'x.js')));

function read(path) {
	const bytes = readFileSync(path);
	const data = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
	const [vertices, corners] = new Uint32Array(data, 0, 2);
	let at = 8;
	const floats = (count) => { const a = new Float32Array(data, at, count); at += 4 * count; return a; };
	return { positions: floats(3 * vertices), normals: floats(3 * vertices), texcoords: floats(2 * vertices),
		indices: new Uint32Array(data, at, corners) };
}

function unindex(indices, rows, width) {
	const out = new Float32Array(indices.length * width);
	indices.forEach((v, c) => out.set(rows.subarray(v * width, v * width + width), c * width));
	return out;
}

// Best of several runs within a second; a first run that takes longer than that is not repeated.
function time(run) {
	let best = Infinity, result;
	const end = performance.now() + 1000;
	for (let i = 0; i < 20 && performance.now() < end; i++) {
		const start = performance.now();
		result = run();
		best = Math.min(best, performance.now() - start);
	}
	return [result, best / 1000];
}

const peers = {};
try {
	const { generateTangents } = require('mikktspace');
	peers['mikktspace-npm'] = (m) => {
		const p = unindex(m.indices, m.positions, 3), n = unindex(m.indices, m.normals, 3);
		const t = unindex(m.indices, m.texcoords, 2);
		return () => generateTangents(p, n, t);
	};
} catch (error) {
	console.log(`peers: mikktspace skipped: ${error.message}`);
}
try {
	const { MeshoptTangents } = await import(pathToFileURL(require.resolve('meshoptimizer')));
	await MeshoptTangents.ready;
	const run = (m, flags) => () => MeshoptTangents.generateTangents(m.indices, m.positions, 3, m.normals, 3,
		m.texcoords, 2, flags);
	peers['meshoptimizer-npm'] = (m) => run(m, []);
	peers['meshoptimizer-npm-compatible'] = (m) => run(m, ['Compatible']);
} catch (error) {
	console.log(`peers: meshoptimizer skipped: ${error.message}`);
}

for (const file of readdirSync(folder).filter((name) => name.endsWith('.mesh')).sort()) {
	const mesh = read(join(folder, file)), name = file.slice(0, -5);
	for (const [peer, prepare] of Object.entries(peers)) {
		const [tangents, seconds] = time(prepare(mesh));
		writeFileSync(join(folder, `${name}.${peer}.tan`), Buffer.from(tangents.buffer, tangents.byteOffset,
			tangents.byteLength));
		appendFileSync(join(folder, 'peers.txt'), `${name} ${peer} ${seconds}\n`);
	}
}
