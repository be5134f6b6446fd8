// SPDX-License-Identifier: MIT
//
// node js.mjs NMTAN PACKAGE MODULES FOLDER FILE...: million triangles a second of the npm package in Node, beside npm's
// mikktspace (wasm), three.js's own JavaScript and meshoptimizer's wasm in its compatible mode: on a clean torus of a
// million triangles and on the largest primitive of each FILE, which NMTAN converts to GLB in FOLDER. Runs are
// interleaved, each column is the best of them. Programs that need triangles without shared vertices get them made in
// the measured time, as their users have to; meshoptimizer gives a tangent for each corner and does not split.
import { spawnSync } from 'node:child_process';
import { createRequire } from 'node:module';
import { mkdirSync, readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { pathToFileURL } from 'node:url';

const [tool, npm, modules, folder, ...files] = process.argv.slice(2);
const require = createRequire(`${modules}/`);
const peer = (name) => import(pathToFileURL(require.resolve(name)).href);
const version = (name) => JSON.parse(readFileSync(`${modules}/node_modules/${name}/package.json`)).version;

const nmtan = await import(pathToFileURL(`${npm}/index.js`).href);
const mikktspace = require('mikktspace');
const three = await import(pathToFileURL(`${modules}/node_modules/three/examples/jsm/libs/mikktspace.module.js`).href);
const { MeshoptTangents: meshopt } = await peer('meshoptimizer');
await Promise.all([nmtan.ready, meshopt.ready]);

function torus(n) {
	const positions = [], normals = [], texcoords = [], indices = [];
	for (let y = 0; y <= n; y++)
		for (let x = 0; x <= n; x++) {
			const a = x / n * 2 * Math.PI, b = y / n * 2 * Math.PI, r = 2 + Math.cos(b);
			positions.push(r * Math.cos(a), r * Math.sin(a), Math.sin(b));
			normals.push(Math.cos(b) * Math.cos(a), Math.cos(b) * Math.sin(a), Math.sin(b));
			texcoords.push(x / n * 8, y / n * 4);
		}
	for (let y = 0; y < n; y++)
		for (let x = 0; x < n; x++) {
			const i = y * (n + 1) + x;
			indices.push(i, i + 1, i + n + 2, i, i + n + 2, i + n + 1);
		}
	return {positions: Float32Array.from(positions), normals: Float32Array.from(normals),
		texcoords: Float32Array.from(texcoords), indices: Uint32Array.from(indices)};
}

// The largest primitive of a file, v pointing up; nothing where it has no normals or texture coordinates.
async function model(file) {
	const { NodeIO } = await peer('@gltf-transform/core');
	const glb = `${folder}/${basename(file)}.glb`;
	const run = spawnSync(tool, ['-q', '--only=all', file, glb], {encoding: 'utf8'});
	if (run.status !== 0) {
		console.log(`${file}: ${run.stderr.trim()}`);
		return undefined;
	}
	const primitives = (await new NodeIO().read(glb)).getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives());
	const size = (primitive) => primitive.getIndices()?.getCount() ?? 0;
	const largest = primitives.reduce((a, b) => (size(b) > size(a) ? b : a));
	const floats = (semantic) => largest.getAttribute(semantic) && Float32Array.from(largest.getAttribute(semantic).getArray());
	const mesh = {positions: floats('POSITION'), normals: floats('NORMAL'), texcoords: floats('TEXCOORD_0'),
		indices: largest.getIndices() && Uint32Array.from(largest.getIndices().getArray())};
	return mesh.normals && mesh.texcoords && mesh.indices ? mesh : undefined;
}

function corners({positions, normals, texcoords, indices}) {
	const take = (from, size) => {
		const to = new Float32Array(indices.length * size);
		for (let corner = 0; corner < indices.length; corner++)
			for (let k = 0; k < size; k++)
				to[size * corner + k] = from[size * indices[corner] + k];
		return to;
	};
	return [take(positions, 3), take(normals, 3), take(texcoords, 2)];
}

const contenders = {
	'nmtan': (m) => nmtan.generateTangentsIndexed(m.indices, m.positions, m.normals, m.texcoords),
	'mikktspace': (m) => mikktspace.generateTangents(...corners(m)),
	'three': (m) => three.generateTangents(...corners(m)),
	'meshopt': (m) => meshopt.generateTangents(m.indices, m.positions, 3, m.normals, 3, m.texcoords, 2, ['Compatible']),
};

// Best seconds of each, of half a second of runs: engines compile what runs often a second time, and better. A
// program that is slower than a second runs twice.
function measure(mesh) {
	const best = {}, spent = {};
	for (let round = 0, left = true; left; round++) {
		left = false;
		for (const [name, run] of Object.entries(contenders)) {
			if (round >= 2 && spent[name] > (name === 'nmtan' || name === 'meshopt' ? 0.5 : 0.2))
				continue;
			const start = performance.now();
			run(mesh);
			const seconds = (performance.now() - start) / 1000;
			best[name] = Math.min(best[name] ?? Infinity, seconds);
			spent[name] = (spent[name] ?? 0) + seconds;
			left = true;
		}
	}
	return best;
}

mkdirSync(folder, {recursive: true});
console.log(`million triangles a second in Node ${process.version}, one thread; in brackets nmtan's ratio to it`);
console.log(`npm: mikktspace ${version('mikktspace')}, three ${version('three')} (its JavaScript), meshoptimizer ${version('meshoptimizer')} (compatible)`);
console.log(`${'mesh'.padEnd(20)}${'triangles'.padStart(10)}${'nmtan'.padStart(8)}${'mikktspace'.padStart(16)}${'three'.padStart(15)}${'meshoptimizer'.padStart(16)}`);
const meshes = [['clean torus', torus(707)]];
for (const file of files)
	meshes.push([basename(file).replace(/\.[^.]*$/, ''), await model(file)]);
for (const [name, mesh] of meshes.filter(([, found]) => found)) {
	const triangles = mesh.indices.length / 3, best = measure(mesh);
	const rate = (seconds) => (triangles / seconds / 1e6).toFixed(2);
	const cell = (peerName) => `${rate(best[peerName])} (${(best[peerName] / best.nmtan).toFixed(1)})`;
	console.log(`${name.padEnd(20)}${String(triangles).padStart(10)}${rate(best.nmtan).padStart(8)}` +
		`${cell('mikktspace').padStart(16)}${cell('three').padStart(15)}${cell('meshopt').padStart(16)}`);
}
