// SPDX-License-Identifier: MIT
//
// node peers.mjs FOLDER MODULES: tangents by npm's packages, for each FOLDER/*.mesh and its FOLDER/*.glb: mikktspace and
// meshoptimizer (both wasm), three.js's own JavaScript (computeMikkTSpaceTangents and BufferGeometry.computeTangents)
// and glTF-Transform's tangents(), from file to file without the start of node.
// Writes NAME.PEER.tan (float32 x 4 per corner, v up) or NAME.PEER.glb, appends "NAME PEER seconds" to FOLDER/peers.txt
// and "PEER" with its version to FOLDER/versions.txt.
// A .mesh is uint32 vertex count and corner count, then float32 positions, normals, texture coordinates by
// vertex, uint32 indices.
import { createRequire } from 'node:module';
import { appendFileSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { join, resolve } from 'node:path';

const [folder, modules] = process.argv.slice(2);
const require = createRequire(pathToFileURL(join(resolve(modules), 'x.js')));
const load = (name) => import(pathToFileURL(require.resolve(name)));

// The version of a package that does not export its package.json.
function version(name) {
	return JSON.parse(readFileSync(join(modules, 'node_modules', name, 'package.json'))).version;
}

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
async function time(run) {
	let best = Infinity, result;
	const end = performance.now() + 1000;
	for (let i = 0; i < 20 && performance.now() < end; i++) {
		const start = performance.now();
		result = await run();
		best = Math.min(best, performance.now() - start);
	}
	return [result, best / 1000];
}

// Each peer makes a function of a mesh and the path of its GLB; that returns tangents, or nothing where it wrote a GLB.
const peers = {};
async function add(name, module, prepare) {
	try {
		Object.assign(peers, await prepare());
		appendFileSync(join(folder, 'versions.txt'), `${name} ${version(module)}\n`);
	} catch (error) {
		console.log(`bench: ${name} skipped: ${error.message.split('\n')[0]}`);
	}
}

await add('mikktspace', 'mikktspace', () => {
	const { generateTangents } = require('mikktspace');
	return { 'mikktspace': (m) => {
		const p = unindex(m.indices, m.positions, 3), n = unindex(m.indices, m.normals, 3);
		const t = unindex(m.indices, m.texcoords, 2);
		return () => generateTangents(p, n, t);
	} };
});
await add('meshoptimizer', 'meshoptimizer', async () => {
	const { MeshoptTangents } = await load('meshoptimizer');
	await MeshoptTangents.ready;
	const run = (m, flags) => () => MeshoptTangents.generateTangents(m.indices, m.positions, 3, m.normals, 3,
		m.texcoords, 2, flags);
	return { 'meshoptimizer': (m) => run(m, []), 'meshoptimizer-compatible': (m) => run(m, ['Compatible']) };
});
await add('three', 'three', async () => {
	const at = (path) => import(pathToFileURL(join(resolve(modules), 'node_modules/three', path)));
	const three = await at('build/three.module.js'), utils = await at('examples/jsm/utils/BufferGeometryUtils.js');
	const mikk = await at('examples/jsm/libs/mikktspace.module.js');
	await mikk.ready;
	const geometry = (m) => new three.BufferGeometry()
		.setAttribute('position', new three.BufferAttribute(m.positions, 3))
		.setAttribute('normal', new three.BufferAttribute(m.normals, 3))
		.setAttribute('uv', new three.BufferAttribute(m.texcoords, 2))
		.setIndex(new three.BufferAttribute(m.indices, 1));
	return {
		'three-computeMikkTSpaceTangents': (m) => () => utils.computeMikkTSpaceTangents(geometry(m), mikk, false).attributes.tangent.array,
		'three-computeTangents': (m) => () => {
			const g = geometry(m);
			g.computeTangents();
			return unindex(m.indices, g.attributes.tangent.array, 4);
		},
	};
});
await add('gltf-transform', '@gltf-transform/functions', async () => {
	const { NodeIO } = await load('@gltf-transform/core'), { tangents, unweld } = await load('@gltf-transform/functions');
	const { generateTangents } = require('mikktspace');
	return { 'gltf-transform': (m, path) => async () => {
		const io = new NodeIO(), document = await io.read(path);
		document.setLogger({ debug() {}, info() {}, warn() {}, error() {} });
		await document.transform(unweld(), tangents({ generateTangents })); // of welded primitives it makes none
		await io.write(path.replace(/glb$/, 'gltf-transform.glb'), document);
	} };
});

for (const file of readdirSync(folder).filter((name) => name.endsWith('.mesh')).sort()) {
	const mesh = read(join(folder, file)), name = file.slice(0, -5);
	for (const [peer, prepare] of Object.entries(peers)) {
		try {
			const [tangents, seconds] = await time(prepare(mesh, join(folder, `${name}.glb`)));
			if (tangents)
				writeFileSync(join(folder, `${name}.${peer}.tan`), Buffer.from(tangents.buffer, tangents.byteOffset,
					tangents.byteLength));
			appendFileSync(join(folder, 'peers.txt'), `${name} ${peer} ${seconds}\n`);
		} catch (error) {
			console.log(`bench: ${peer} fails on ${name}: ${error.message.split('\n')[0]}`);
		}
	}
}
