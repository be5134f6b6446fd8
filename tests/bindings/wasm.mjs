// SPDX-License-Identifier: MIT
//
// node wasm.mjs PACKAGE DATA HEADER: the functions of the npm package against the goldens, the example of nmtan.h and
// what its page promises.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { Worker } from 'node:worker_threads';
import { equalBytes, triangleGoldens } from './golden.mjs';
import { done, test } from './tap.mjs';

const [folder, data, header] = process.argv.slice(2);
const url = (name) => pathToFileURL(`${folder}/${name}`).href;

await test('before it is ready a call says so', async () => {
	const core = await import(url('core.js'));
	assert.throws(() => core.generateTangents([], [], []), /not ready/);
});

const inlined = await import(url('index.js'));
const external = await import(url('external.node.js'));
await test('both entries become ready, and are then alike', async () => {
	await Promise.all([inlined.ready, external.ready]);
	assert.equal(inlined.isReady && external.isReady, true);
	assert.deepEqual(Object.keys(inlined), Object.keys(external));
});
const { generateCornerTangents, generateRepairedTangents, generateTangents, generateTangentsIndexed } = inlined;
const goldens = triangleGoldens(`${data}/golden`);
const up = {}, raw = {repair: false};

await test('corners: the bytes of every golden of triangles', () => {
	assert.ok(goldens.size > 20);
	for (const [name, g] of goldens)
		assert.ok(equalBytes(generateTangents(g.positions, g.normals, g.texcoords), g.tangents), name);
});

await test('the goldens of the unfinished sort and of the completed one have the bytes of their methods', () => {
	for (const [folder, method] of [['published', 'mikktspace'], ['sorted', 'mikktspace-sorted']]) {
		const some = triangleGoldens(`${data}/golden/edge_sort/${folder}`);
		assert.ok(some.size > 5);
		for (const [name, g] of some) {
			const indices = Uint32Array.from({length: g.positions.length / 3}, (_, i) => i);
			const r = generateTangentsIndexed(indices, g.positions, g.normals, g.texcoords, {...raw, method});
			assert.ok(equalBytes(r.tangents, g.tangents), `${folder}/${name}`);
		}
	}
});

const rowAt = (array, size, row) => array.subarray(size * row, size * row + size);

// The mesh with one vertex for each position, normal and texture coordinate that differ in their bits.
function weld(g) {
	const known = new Map(), of = [[], [], []], indices = [];
	for (let corner = 0; corner < g.positions.length / 3; corner++) {
		const rows = [rowAt(g.positions, 3, corner), rowAt(g.normals, 3, corner), rowAt(g.texcoords, 2, corner)];
		const key = rows.map((row) => Buffer.from(row.slice().buffer).toString('hex')).join();
		if (!known.has(key)) {
			known.set(key, known.size);
			rows.forEach((row, i) => of[i].push(...row));
		}
		indices.push(known.get(key));
	}
	return {indices, positions: of[0], normals: of[1], texcoords: of[2], vertices: known.size};
}

await test('indexed: split vertices have the goldens\' bytes at every corner, and sources are right', () => {
	for (const [name, g] of goldens) {
		const m = weld(g);
		const r = generateTangentsIndexed(m.indices, m.positions, m.normals, m.texcoords, raw);
		assert.equal(r.tangents.length, 4 * (m.vertices + r.sources.length));
		const corners = new Float32Array(4 * m.indices.length);
		r.indices.forEach((vertex, corner) => corners.set(rowAt(r.tangents, 4, vertex), 4 * corner));
		// a vertex has one of the tangents that are equal as numbers: 0 stands for -0
		assert.deepEqual(Array.from(corners, (x) => x + 0), Array.from(g.tangents, (x) => x + 0), name);
		r.indices.forEach((vertex, corner) =>
			assert.equal(vertex < m.vertices ? vertex : r.sources[vertex - m.vertices], m.indices[corner], name));
	}
});

const quads = {positions: [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0],
	normals: [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1], texcoords: [0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 1],
	indices: [0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]};
const solve = (m, options) => generateTangentsIndexed(m.indices, m.positions, m.normals, m.texcoords, options);
const left = [1, 0, 0, 1], right = [-1, 0, 0, -1];

await test('the example of nmtan.h: two copies, and the tangents that theory gives', () => {
	const r = solve(quads, up);
	assert.deepEqual([...r.sources], [1, 2]);
	assert.deepEqual([...r.tangents].map((x) => x + 0), [left, left, left, left, right, right, right, right].flat());
	assert.deepEqual([...r.indices], [0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7]);
	assert.equal(r.counts.mirrored, 2);
});

await test('glTF\'s v points down: the same quads with 1 - v have the same tangents', () => {
	const down = {...quads, texcoords: quads.texcoords.map((x, i) => (i % 2 ? 1 - x : x))};
	assert.deepEqual(solve(down, {vDown: true}), solve(quads, up));
	assert.deepEqual(down.texcoords, quads.texcoords.map((x, i) => (i % 2 ? 1 - x : x)), 'the input was changed');
});

await test('interleaved arrays, plain arrays and both widths of indices give the same', () => {
	const rows = [];
	for (let v = 0; v < 6; v++)
		rows.push(9, ...quads.positions.slice(3 * v, 3 * v + 3), ...quads.normals.slice(3 * v, 3 * v + 3),
			...quads.texcoords.slice(2 * v, 2 * v + 2));
	const array = new Float32Array(rows), at = (offset) => ({array, stride: 9, offset});
	const m = {positions: at(1), normals: at(4), texcoords: at(7), indices: quads.indices};
	assert.deepEqual(solve(m, up), solve(quads, up));
	for (const Type of [Uint8Array, Uint16Array, Uint32Array, Int32Array, Array])
		assert.deepEqual([...solve({...quads, indices: Type.from(quads.indices)}, up).indices], [...solve(quads, up).indices]);
	assert.ok(solve({...quads, indices: Uint16Array.from(quads.indices)}, up).indices instanceof Uint16Array);
	for (const Type of [Uint8Array, Uint32Array, Array]) // the first overload of index.d.ts
		assert.ok(solve({...quads, indices: Type.from(quads.indices)}, up).indices instanceof Uint32Array);
});

await test('v down is v negated, through every function', () => {
	const down = {...quads, texcoords: quads.texcoords.map((x, i) => (i % 2 ? -x : x))}, {positions, normals} = quads;
	assert.deepEqual(solve(down, {vDown: true}), solve(quads, {vDown: false}));
	assert.deepEqual(solve(quads), solve(quads, {vDown: false}));
	const soup = [quads.indices.flatMap((v) => positions.slice(3 * v, 3 * v + 3)), quads.indices.flatMap((v) => normals.slice(3 * v, 3 * v + 3))];
	const uvs = (m) => quads.indices.flatMap((v) => m.texcoords.slice(2 * v, 2 * v + 2));
	for (const make of [generateTangents, generateRepairedTangents]) {
		assert.deepEqual(make(...soup, uvs(down), {vDown: true}), make(...soup, uvs(quads)));
		assert.deepEqual([...make(...soup, uvs(down))].filter((_, i) => i % 4 === 3), [1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1].map((w) => -w));
	}
});

await test('quads, corners of indexed meshes, bitangents and faults', () => {
	const faceSizes = [4, 4], indices = [0, 1, 2, 3, 1, 4, 5, 2];
	const r = generateCornerTangents(indices, quads.positions, quads.normals, quads.texcoords,
		{faceSizes, bitangents: true, cornerFaults: true});
	assert.deepEqual([...r.tangents].map((x) => x + 0), [left, left, left, left, right, right, right, right].flat());
	assert.deepEqual([...r.bitangents].map((x) => x + 0), Array(8).fill([0, 1, 0]).flat());
	assert.deepEqual([...r.cornerFaults], Array(8).fill(0));
	assert.equal(r.counts.mirrored, 2);
	const split = solve({...quads, indices}, {faceSizes});
	assert.deepEqual([...split.sources], [1, 2]);
	assert.deepEqual([...split.indices], [0, 1, 2, 3, 6, 4, 5, 7]);
	const flat = generateCornerTangents(null, quads.positions.slice(0, 9), quads.normals.slice(0, 9), Array(6).fill(0), {cornerFaults: true});
	assert.deepEqual([...flat.cornerFaults].map((bits) => bits & 16), [16, 16, 16]); // NMTAN_FAULT_UNASSIGNED
	assert.equal(flat.bitangents, undefined);
});

await test('a threshold below the angle between two triangles keeps their tangents apart', () => {
	// on the second triangle u runs along (2, 1), on the first one along (1, 0)
	const m = {positions: [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], normals: Array(4).fill([0, 0, 1]).flat(),
		texcoords: [0, 0, 1, 0, 1, 1, 0, 2], indices: [0, 1, 2, 0, 2, 3]};
	assert.equal(solve(m).sources.length, 0);
	assert.equal(solve(m, {angularThreshold: 10}).sources.length, 2);
});

await test('normals of signed integers are normalized, and made unit where they are not', () => {
	const slanted = [100, 30, 70], length = Math.hypot(...slanted), normals = Array(6).fill(slanted).flat();
	const expected = solve({...quads, normals: normals.map((x) => x / length)}, up);
	for (const [Type, most] of [[Int8Array, 127], [Int16Array, 32767]]) {
		const r = solve({...quads, normals: Type.from(normals, (x) => Math.round(x / 127 * most))}, up);
		r.tangents.forEach((x, i) => assert.ok(Math.abs(x - expected.tangents[i]) < 1e-4, `${Type.name} ${i}`));
		assert.equal(r.counts.normalsNotUnit, 0);
	}
	assert.equal(solve({...quads, normals: normals}, up).counts.normalsNotUnit, 6);
	const minus = solve({...quads, normals: Int8Array.from(quads.normals, (x) => -128 * x)}, up);
	assert.deepEqual(minus.tangents, solve({...quads, normals: quads.normals.map((x) => -x)}, up).tangents);
});

await test('methods: each gives the flat quads their tangents; robust has none that is ill-conditioned', () => {
	for (const method of ['mikktspace', 'area', 'lengyel', 'robust', 'mikktspace-sorted']) {
		const r = solve(quads, {...up, method});
		assert.deepEqual([...r.tangents].map((x) => x + 0), [left, left, left, left, right, right, right, right].flat(), method);
		assert.equal(r.counts.illConditioned, 0);
	}
});

await test('a triangle without UV area: raw leaves the placeholder, repair puts a unit vector across the normal', () => {
	const m = {positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], normals: [0.6, 0, 0.8, 0.6, 0, 0.8, 0.6, 0, 0.8],
		texcoords: [0, 0, 0, 0, 0, 0], indices: [0, 1, 2]};
	assert.deepEqual([...rowAt(solve(m, raw).tangents, 4, 0)], [1, 0, 0, -1]);
	const r = solve(m, up), t = rowAt(r.tangents, 4, 0);
	assert.ok(Math.abs(t[0] * 0.6 + t[2] * 0.8) < 2 ** -10 && Math.abs(Math.hypot(t[0], t[1], t[2]) - 1) < 2 ** -20);
	assert.equal(r.counts.repairedUnassigned, 3);
	assert.equal(r.counts.degenerateTexcoords, 1);
});

await test('repaired corners: units across the normal, one w in a triangle; raw ones that are that keep their bytes', () => {
	let repaired = 0, kept = 0;
	const isFrame = (t, n) => Math.abs(Math.hypot(t[0], t[1], t[2]) - 1) < 2 ** -18 && Math.abs(t[3]) === 1 &&
		(Math.abs(Math.hypot(...n) - 1) > 2 ** -12 || Math.abs(t[0] * n[0] + t[1] * n[1] + t[2] * n[2]) < 2 ** -9);
	for (const [name, g] of goldens) {
		const made = generateRepairedTangents(g.positions, g.normals, g.texcoords), count = g.positions.length / 3;
		const raw = g.tangents, indices = Uint32Array.from({length: count}, (_, i) => i);
		const r = generateTangentsIndexed(indices, g.positions, g.normals, g.texcoords, up);
		assert.ok(equalBytes(made, r.tangents), name);
		for (let corner = 0; corner < count; corner++) {
			const [t, before] = [made, raw].map((a) => rowAt(a, 4, corner)), n = rowAt(g.normals, 3, corner);
			assert.ok(isFrame(t, n), `${name} ${corner}`);
			assert.equal(t[3], made[4 * (corner - corner % 3) + 3], name);
			repaired += !equalBytes(t, before);
			kept += equalBytes(t, before);
		}
	}
	assert.ok(repaired > 10 && kept > 1000, `${repaired} ${kept}`);
});

await test('the names of the counts are those of nmtan_counts, in order', () => {
	const struct = readFileSync(header, 'utf8').match(/typedef struct nmtan_counts \{([^}]*)\}/)[1];
	const names = [...struct.matchAll(/^\tsize_t (\w+);/gm)].map((match) => match[1]).slice(1);
	assert.deepEqual(Object.keys(solve(quads, up).counts),
		names.map((name) => name.replace(/_(.)/g, (whole, letter) => letter.toUpperCase())));
});

// an array that has an element by a getter, which does `body` first
const watched = (array, body) => Object.defineProperty([...array], 1, {get: () => { body(); return array[1]; }, enumerable: true});
// a typed array that tells its length, and how to make another, only after `body`
function typed(array, body) {
	return new (class extends Float32Array {
		get length() { body(); return super.length; }
		static get [Symbol.species]() { body(); return Float32Array; }
	})(array);
}

await test('a getter that calls a function of the package does not disturb the call that it is in', () => {
	const m = {...quads, indices: [0, 1, 2, 3, 1, 4, 5, 2]};
	let calls = 0;
	const other = () => { calls++; generateTangents([9, 9, 9, 8, 9, 9, 9, 8, 9], [0, 0, 1, 0, 0, 1, 0, 0, 1], [0, 0, 1, 0, 0, 1]); };
	for (const name of ['positions', 'normals', 'texcoords', 'indices'])
		assert.deepEqual(solve({...m, [name]: watched(m[name], other)}, {...up, faceSizes: watched([4, 4], other)}),
			solve(m, {...up, faceSizes: [4, 4]}), name);
	for (const name of ['positions', 'normals', 'texcoords'])
		assert.deepEqual(solve({...quads, [name]: {get array() { other(); return typed([0, ...quads[name]], other); }, offset: 1}}),
			solve(quads), name);
	const given = {get cornerFaults() { other(); return true; }, get vDown() { other(); return true; }};
	const corners = (options) => generateCornerTangents(quads.indices, quads.positions, quads.normals, quads.texcoords, options);
	assert.deepEqual(corners(given), corners({cornerFaults: true, vDown: true}));
	assert.ok(calls > 10, `${calls}`);
});

const hole = (array, at) => { const copy = [...array]; delete copy[at]; return copy; };
const wrong = [
	['positions with a hole', {positions: hole(quads.positions, 4)}, TypeError, /positions: an array of numbers/],
	['normals with a hole', {normals: hole(quads.normals, 0)}, TypeError, /normals: an array of numbers/],
	['texcoords with a hole', {texcoords: hole(quads.texcoords, 3)}, TypeError, /texcoords: an array of numbers/],
	['indices with a hole', {indices: hole([0, 1, 2], 2)}, TypeError, /indices\[2\]: undefined/],
	['an empty array that should have something', {indices: Array(3)}, TypeError, /indices\[0\]: undefined/],
	['positions that are no array', {positions: 7}, TypeError, /positions: an array/],
	['positions that are missing', {positions: undefined}, TypeError, /positions: an array/],
	['positions that are not threes', {positions: [1, 2]}, TypeError, /positions: 2 numbers/],
	['normals of another length', {normals: [0, 0, 1]}, TypeError, /normals: 1 vertices, positions has 6/],
	['a stride below the row', {texcoords: {array: quads.texcoords, stride: 1}}, TypeError, /stride/],
	['an offset behind the array', {texcoords: {array: quads.texcoords, offset: 99}}, TypeError, /texcoords/],
	['positions that are words', {positions: Array(18).fill('1')}, TypeError, /array of numbers/],
	['unsigned normals', {normals: Uint8Array.from(quads.normals)}, TypeError, /normals: floats are expected, or an Int8Array/],
	['64-bit integers', {positions: new BigInt64Array(18)}, TypeError, /array of numbers/],
	['an index too large', {indices: [0, 1, 6]}, TypeError, /index/],
	['a negative index', {indices: [0, 1, -1]}, TypeError, /indices\[2\]: -1/],
	['half an index', {indices: [0, 1, 0.5]}, TypeError, /indices\[2\]: 0.5/],
	['indices that are not threes', {indices: [0, 1]}, TypeError, /indices: 2/],
	['indices that are none', {indices: null}, TypeError, /indices/],
];
for (const [name, change, type, text] of wrong)
	await test(`refused: ${name}`, () => {
		assert.throws(() => solve({...quads, ...change}, up), (error) => error instanceof type && text.test(error.message));
		assert.deepEqual([...solve(quads, up).sources], [1, 2]); // and all is well afterwards
	});
await test('refused: options that are none, or of another type', () => {
	for (const [options, text] of [[{method: 'best'}, /method: one of mikktspace/], [{method: 1}, /method: string/],
		[{convention: 'gltf'}, /convention: the option is vDown now/], [{vdown: true}, /no "vdown", but method, repair, vDown/],
		[{vDown: 1}, /vDown: boolean/], [{repair: 'off'}, /repair: boolean/], [{angularThreshold: 181}, /angularThreshold/],
		[{angularThreshold: NaN}, /angularThreshold/], [{faceSizes: [3, 5, 4]}, /faceSizes: an array of 3 and 4/],
		[{faceSizes: [3, 3, 3]}, /faceSizes: they make 9 corners, indices has 12/], [{faceSizes: 4}, /faceSizes: object/],
		[{cornerFaults: true}, /no "cornerFaults"/], [null, /options: an object/], ['gltf', /options: an object/]])
		assert.throws(() => solve(quads, options), (error) => error instanceof TypeError && text.test(error.message), text);
	assert.throws(() => generateTangents(quads.positions.slice(0, 9), quads.normals.slice(0, 9), [0, 0, 1, 0, 1, 1], {repair: true}),
		/no "repair", but vDown/);
	assert.throws(() => generateTangents([0, 0, 0], [0, 0, 1], [0, 0]), /do not make triangles/);
});

await test('a mesh that 4 GB do not hold is a RangeError, and the next one is solved', () => {
	assert.throws(() => solve({...quads, indices: new Uint16Array(3 * 10 ** 8)}, up),
		(error) => error instanceof RangeError && /memory|large/.test(error.message));
	assert.deepEqual([...solve(quads, up).sources], [1, 2]);
});

await test('an empty mesh has no tangents', () => {
	assert.equal(generateTangents([], [], []).length, 0);
	assert.deepEqual([...solve({positions: [], normals: [], texcoords: [], indices: []}).tangents], []);
});

await test('a worker may use it', async () => {
	const source = `import { parentPort } from 'node:worker_threads';
		const nmtan = await import(${JSON.stringify(url('index.js'))});
		await nmtan.ready;
		parentPort.postMessage(nmtan.generateTangents([0,0,0, 1,0,0, 0,1,0], [0,0,1, 0,0,1, 0,0,1], [0,0, 1,0, 0,1]));`;
	const worker = new Worker(new URL(`data:text/javascript,${encodeURIComponent(source)}`));
	const answer = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
	assert.deepEqual([...answer].map((x) => x + 0), [left, left, left].flat());
	await worker.terminate();
});

await test('the program of the package\'s page prints what it says', async () => {
	const page = readFileSync(`${folder}/README.md`, 'utf8').match(/```js\n([^]*?)```/)[1];
	const said = [...page.matchAll(/console\.log\(.*\/\/ ([^\s:]+)/g)].map((match) => match[1]);
	const printed = [], log = console.log;
	console.log = (line) => printed.push(line);
	try {
		await import(`data:text/javascript,${encodeURIComponent(page.replace("'nmtan'", JSON.stringify(url('index.js'))))}`);
	} finally {
		console.log = log;
	}
	assert.equal(printed.length, 2);
	assert.deepEqual(printed.map((line) => line.replace(/-0/g, '0')), said);
});

await test('each function of index.d.ts is there, and no other', () => {
	const types = readFileSync(`${folder}/index.d.ts`, 'utf8');
	const names = new Set([...types.matchAll(/^export (?:function|const) (\w+)/gm)].map((match) => match[1]));
	assert.deepEqual([...names].sort(),
		Object.keys(inlined).sort());
});

await test('the module imports nothing and has at most 84 KiB compressed', async () => {
	const { gzipSync } = await import('node:zlib');
	const wasm = readFileSync(`${folder}/nmtan.wasm`);
	assert.deepEqual(WebAssembly.Module.imports(await WebAssembly.compile(wasm)), []);
	assert.ok(gzipSync(wasm, {level: 9}).length <= 84 * 1024, `${gzipSync(wasm, {level: 9}).length} bytes`);
});
done();
