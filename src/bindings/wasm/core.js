// SPDX-License-Identifier: MIT
//
// The functions of the package over a compiled WebAssembly module, which index.js and external.js bring. A job is a
// struct of 32-bit words: see entry.c. Calls are synchronous; memory is as large as the largest call needed, and given
// back after a call that failed or needed more than KEPT_BYTES.

const METHODS = ['mikktspace', 'area', 'lengyel', 'robust', 'mikktspace-sorted'];
const CONVENTIONS = ['mikktspace', 'gltf'];
const STATUS = ['', 'an argument is out of range', 'an index is not below the number of vertices',
	'a face has not three corners', 'the mesh is too large', 'out of memory'];
const OUT_OF_MEMORY = 5, TOO_LARGE = 4;

// Words of a job: where each stands. The counts follow their struct_bytes.
const WORD = {faces: 0, vertices: 1, indices: 2, positions: 3, normals: 4, texcoords: 5, splitIndices: 6, sources: 7,
	sourceCapacity: 8, tangents: 9, method: 10, noRepair: 11, vDown: 12, sourceCount: 13, counts: 15};
const COUNTS = ['degeneratePositions', 'degenerateTexcoords', 'mirrored', 'storedDifferently', 'foldedQuads',
	'repairedZero', 'repairedNotFinite', 'repairedParallel', 'repairedSign', 'repairedUnassigned', 'repairedLeaning',
	'illConditioned', 'sortedInstead', 'summedInstead'];

const KEPT_BYTES = 2 ** 28;

let module = null;
let wasm = null; // exports of the instance

export function install(compiled) {
	module = compiled;
}

function fail(status) {
	if (status === OUT_OF_MEMORY || status === TOO_LARGE)
		throw new RangeError(`nmtan: ${STATUS[status]}`);
	throw new TypeError(`nmtan: ${STATUS[status]}`);
}

// Runs body() with memory that nobody uses, and frees all of it.
function withMemory(body) {
	if (!module)
		throw new Error('nmtan: not ready: wait for the promise `ready`');
	if (!wasm) {
		wasm = new WebAssembly.Instance(module).exports;
		wasm.set_key(...Array.from({length: 4}, () => Math.random() * 2 ** 32));
	}
	let done = false;
	try {
		const result = body();
		done = wasm.memory.buffer.byteLength <= KEPT_BYTES;
		return result;
	} finally {
		wasm.forget();
		if (!done)
			wasm = null;
	}
}

function allocate(bytes) {
	const address = bytes < 2 ** 32 ? wasm.allocate(bytes) >>> 0 : 0;
	if (!address)
		fail(OUT_OF_MEMORY);
	return address;
}

const floats = (address, length) => new Float32Array(wasm.memory.buffer, address, length);
const words = (address, length) => new Uint32Array(wasm.memory.buffer, address, length);

function isArrayLike(value) {
	return Array.isArray(value) || (ArrayBuffer.isView(value) && typeof value.length === 'number');
}

// {array, stride, offset, count} of an attribute: numbers one behind the other, or rows `stride` numbers apart.
function attribute(value, name, size) {
	const {array, stride = size, offset = 0} = isArrayLike(value) ? {array: value} : value ?? {};
	if (!isArrayLike(array) || typeof array[0] === 'bigint')
		throw new TypeError(`nmtan: ${name}: an array of numbers is expected, or {array, stride, offset}`);
	if (!Number.isInteger(stride) || stride < size || !Number.isInteger(offset) || offset < 0)
		throw new TypeError(`nmtan: ${name}: stride must be a whole number from ${size}, offset one from 0`);
	const left = array.length - offset;
	if (stride === size && (left < 0 || left % size))
		throw new TypeError(`nmtan: ${name}: ${left} numbers, which is no multiple of ${size}`);
	return {array, stride, offset, count: stride === size ? left / size : Math.max(0, Math.floor((left - size) / stride) + 1)};
}

function put(address, from, size) {
	const to = floats(address, from.count * size);
	if (from.stride === size) {
		to.set(from.offset ? from.array.slice(from.offset) : from.array);
		return;
	}
	for (let row = 0, at = from.offset; row < from.count; row++, at += from.stride)
		for (let k = 0; k < size; k++)
			to[row * size + k] = from.array[at + k];
}

function attributes(positions, normals, texcoords) {
	const all = {positions: attribute(positions, 'positions', 3), normals: attribute(normals, 'normals', 3),
		texcoords: attribute(texcoords, 'texcoords', 2)};
	const count = all.positions.count;
	for (const name of ['normals', 'texcoords'])
		if (all[name].count !== count)
			throw new TypeError(`nmtan: ${name}: ${all[name].count} vertices, positions has ${count}`);
	return all;
}

// Allocates arrays of bytes[name], then writes them and the numbers into the job and returns all of them. Nothing is
// copied before there is room for everything.
function makeJob(numbers, bytes, from) {
	const values = {...numbers};
	for (const name in bytes)
		values[name] = allocate(bytes[name]);
	put(values.positions, from.positions, 3);
	put(values.normals, from.normals, 3);
	put(values.texcoords, from.texcoords, 2);
	const job = words(wasm.job() >>> 0, WORD.counts + COUNTS.length);
	job.fill(0);
	for (const name in values)
		job[WORD[name]] = values[name];
	return values;
}

const attributeBytes = (vertices) => ({positions: vertices * 12, normals: vertices * 12, texcoords: vertices * 8});

function choose(value, choices, name) {
	const number = choices.indexOf(value);
	if (number < 0)
		throw new TypeError(`nmtan: ${name}: one of ${choices.join(', ')} is expected, not ${String(value)}`);
	return number;
}

function cornerTangents(positions, normals, texcoords, noRepair) {
	const from = attributes(positions, normals, texcoords);
	const vertices = from.positions.count;
	if (vertices % 3)
		throw new TypeError(`nmtan: positions: ${vertices} vertices do not make triangles`);
	return withMemory(() => {
		const job = makeJob({faces: vertices / 3, vertices, noRepair},
			{...attributeBytes(vertices), tangents: vertices * 16}, from);
		const status = wasm.corner_tangents();
		if (status)
			fail(status);
		return floats(job.tangents, vertices * 4).slice();
	});
}

export function generateTangents(positions, normals, texcoords) {
	return cornerTangents(positions, normals, texcoords, 1);
}

export function generateRepairedTangents(positions, normals, texcoords) {
	return cornerTangents(positions, normals, texcoords, 0);
}

function checkIndices(indices) {
	if (!isArrayLike(indices) || indices instanceof Float32Array || indices instanceof Float64Array)
		throw new TypeError('nmtan: indices: an array of whole numbers is expected');
	if (indices.length % 3)
		throw new TypeError(`nmtan: indices: ${indices.length} do not make triangles`);
}

function putIndices(address, indices, vertices) {
	const to = words(address, indices.length);
	to.set(indices);
	if (Array.isArray(indices) || indices.BYTES_PER_ELEMENT > 4 || indices instanceof Int32Array)
		for (let i = 0; i < to.length; i++)
			if (to[i] !== indices[i])
				throw new TypeError(`nmtan: indices[${i}]: ${indices[i]} is not the number of a vertex below ${vertices}`);
}

// Indices of the caller's type where it holds them.
function takeIndices(address, count, vertices, like) {
	const found = words(address, count);
	const small = like instanceof Uint16Array && vertices <= 65535;
	return small ? Uint16Array.from(found) : found.slice();
}

export function generateTangentsIndexed(indices, positions, normals, texcoords, options = {}) {
	checkIndices(indices);
	const from = attributes(positions, normals, texcoords);
	const {method = 'mikktspace', repair = true, convention = 'gltf'} = options;
	const chosen = {method: choose(method, METHODS, 'method'), noRepair: repair ? 0 : 1,
		vDown: choose(convention, CONVENTIONS, 'convention')};
	const vertices = from.positions.count, corners = indices.length;
	return withMemory(() => {
		const job = makeJob({...chosen, faces: corners / 3, vertices, sourceCapacity: corners},
			{...attributeBytes(vertices), indices: corners * 4, splitIndices: corners * 4, sources: corners * 4,
				tangents: (vertices + corners) * 16}, from);
		putIndices(job.indices, indices, vertices);
		const status = wasm.vertex_tangents();
		if (status)
			fail(status);
		const written = words(wasm.job() >>> 0, WORD.counts + COUNTS.length);
		const copies = written[WORD.sourceCount];
		const counts = {};
		COUNTS.forEach((name, i) => { counts[name] = written[WORD.counts + i]; });
		return {
			tangents: floats(job.tangents, (vertices + copies) * 4).slice(),
			indices: takeIndices(job.splitIndices, corners, vertices + copies, indices),
			sources: words(job.sources, copies).slice(),
			counts,
		};
	});
}
