// SPDX-License-Identifier: MIT
//
// The functions of the package over a compiled WebAssembly module, which index.js and external.js bring. A job is a
// struct of 32-bit words: see entry.c. Calls are synchronous; memory is as large as the largest call needed, and given
// back after a call that failed or needed more than KEPT_BYTES.

const METHODS = ['mikktspace', 'area', 'lengyel', 'robust', 'mikktspace-sorted'];
const STATUS = ['', 'an argument is out of range', 'an index is not below the number of vertices',
	'a face has neither 3 nor 4 corners', 'the mesh is too large', 'out of memory'];
const OUT_OF_MEMORY = 5, TOO_LARGE = 4;

// Words of a job: where each stands. The counts follow their struct_bytes.
const WORD = {faces: 0, vertices: 1, indices: 2, positions: 3, normals: 4, texcoords: 5, faceSizes: 6, splitIndices: 7,
	sources: 8, sourceCapacity: 9, tangents: 10, bitangents: 11, cornerFaults: 12, method: 13, noRepair: 14, vDown: 15,
	angularThreshold: 16, sourceCount: 17, counts: 19};
const COUNTS = ['degeneratePositions', 'degenerateTexcoords', 'mirrored', 'storedDifferently', 'foldedQuads',
	'repairedZero', 'repairedNotFinite', 'repairedParallel', 'repairedSign', 'repairedUnassigned', 'repairedLeaning',
	'illConditioned', 'sortedInstead', 'summedInstead', 'normalsNotUnit'];

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
const bytesAt = (address, length) => new Uint8Array(wasm.memory.buffer, address, length);

const isArray = (value) => Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView));

// The caller's code must not run while the module's memory has arrays of a call: a getter that calls a function of this
// package would put its own there. So all that may run some is read before: options, and the elements of arrays, which
// become typed ones. Elements of typed arrays are no code, and lengths are asked of the type, not of the object.
const lengthOf = Object.getOwnPropertyDescriptor(Object.getPrototypeOf(Uint8Array).prototype, 'length').get;
const length = (array) => (Array.isArray(array) ? array.length : lengthOf.call(array));

// A typed array: `array` if it is one, else numbers of a type that holds them. Holes are no numbers.
function readNumbers(array, Type, message) {
	if (!Array.isArray(array))
		return array;
	const read = new Type(array.length);
	for (let i = 0; i < read.length; i++) {
		const value = array[i];
		if (typeof value !== 'number')
			throw new TypeError(`nmtan: ${message(i, value)}`);
		read[i] = value;
	}
	return read;
}

// {array, stride, offset, count} of an attribute: numbers one behind the other, or rows `stride` numbers apart.
function attribute(value, name, size) {
	const {array: given, stride = size, offset = 0} = isArray(value) ? {array: value} : value ?? {};
	const expected = () => `${name}: an array of numbers is expected, or {array, stride, offset}`;
	if (!isArray(given) || given instanceof BigInt64Array || given instanceof BigUint64Array)
		throw new TypeError(`nmtan: ${expected()}`);
	const array = readNumbers(given, Float32Array, expected);
	if (!Number.isInteger(stride) || stride < size || !Number.isInteger(offset) || offset < 0)
		throw new TypeError(`nmtan: ${name}: stride must be a whole number from ${size}, offset one from 0`);
	const left = length(array) - offset;
	if (stride === size && (left < 0 || left % size))
		throw new TypeError(`nmtan: ${name}: ${left} numbers, which is no multiple of ${size}`);
	return {array, stride, offset, count: stride === size ? left / size : Math.max(0, Math.floor((left - size) / stride) + 1)};
}

function put(address, from, size) {
	const to = floats(address, from.count * size);
	if (from.stride === size && !from.offset) {
		to.set(from.array);
		return;
	}
	for (let row = 0, at = from.offset; row < from.count; row++, at += from.stride)
		for (let k = 0; k < size; k++)
			to[row * size + k] = from.array[at + k];
}

// Normals as numbers: signed integers of 8 and 16 bits are normalized, as glTF has them, and made unit as the tool does.
function normalAttribute(value) {
	const given = attribute(value, 'normals', 3), {array, stride, offset, count} = given;
	if ([Uint8Array, Uint8ClampedArray, Uint16Array].some((type) => array instanceof type))
		throw new TypeError('nmtan: normals: floats are expected, or an Int8Array or Int16Array, which is normalized');
	const most = array instanceof Int8Array ? 127 : array instanceof Int16Array ? 32767 : 0;
	if (!most)
		return given;
	const made = new Float32Array(3 * count);
	for (let row = 0; row < count; row++) {
		const n = [0, 1, 2].map((k) => Math.fround(Math.max(array[offset + row * stride + k] / most, -1)));
		const squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
		const length = Math.abs(squared - 1) <= 2 ** -11 || !squared ? 1 : Math.sqrt(squared);
		made.set(n.map((x) => x / length), 3 * row);
	}
	return {array: made, stride: 3, offset: 0, count};
}

function attributes(positions, normals, texcoords) {
	const all = {positions: attribute(positions, 'positions', 3), normals: normalAttribute(normals),
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
	floats(job.byteOffset, job.length)[WORD.angularThreshold] = numbers.angularThreshold;
	return values;
}

const attributeBytes = (vertices) => ({positions: vertices * 12, normals: vertices * 12, texcoords: vertices * 8});

const TYPES = {method: 'string', repair: 'boolean', vDown: 'boolean', angularThreshold: 'number', faceSizes: 'object',
	bitangents: 'boolean', cornerFaults: 'boolean'};
const OF_MESH = ['method', 'repair', 'vDown', 'angularThreshold', 'faceSizes'];

// The options as words of a job, and, apart, those that a job has no words for. A key that is not one of `names` is an error.
function readOptions(given, names) {
	if (typeof given !== 'object' || given === null)
		throw new TypeError(`nmtan: options: an object is expected, not ${String(given)}`);
	const options = {...given};
	for (const [name, value] of Object.entries(options)) {
		if (name === 'convention')
			throw new TypeError("nmtan: convention: the option is vDown now: true for 'gltf'; v points up without it");
		if (!names.includes(name))
			throw new TypeError(`nmtan: options: there is no "${name}", but ${names.join(', ')}`);
		if (value !== undefined && typeof value !== TYPES[name])
			throw new TypeError(`nmtan: ${name}: ${TYPES[name]} is expected, not ${String(value)}`);
	}
	const {method = 'mikktspace', repair = true, vDown = false, angularThreshold = 180, faceSizes} = options;
	if (!METHODS.includes(method))
		throw new TypeError(`nmtan: method: one of ${METHODS.join(', ')} is expected, not ${method}`);
	if (!(angularThreshold > 0 && angularThreshold <= 180))
		throw new TypeError(`nmtan: angularThreshold: more than 0 and at most 180 degrees, not ${angularThreshold}`);
	return {faceSizes: readFaceSizes(faceSizes), bitangents: options.bitangents, cornerFaults: options.cornerFaults,
		words: {method: METHODS.indexOf(method), noRepair: repair ? 0 : 1, vDown: vDown ? 1 : 0, angularThreshold}};
}

function readFaceSizes(faceSizes) {
	const expected = () => 'faceSizes: an array of 3 and 4 is expected';
	if (faceSizes === undefined)
		return undefined;
	if (!isArray(faceSizes))
		throw new TypeError(`nmtan: ${expected()}`);
	const read = readNumbers(faceSizes, Float64Array, expected);
	for (let i = 0; i < length(read); i++)
		if (read[i] !== 3 && read[i] !== 4)
			throw new TypeError(`nmtan: ${expected()}`);
	return read;
}

// How many faces so many corners make.
function countFaces(faceSizes, corners, name) {
	if (faceSizes === undefined) {
		if (corners % 3)
			throw new TypeError(`nmtan: ${name}: ${corners} do not make triangles`);
		return corners / 3;
	}
	const count = length(faceSizes);
	let sum = 0;
	for (let i = 0; i < count; i++)
		sum += faceSizes[i];
	if (sum !== corners)
		throw new TypeError(`nmtan: faceSizes: they make ${sum} corners, ${name} has ${corners}`);
	return count;
}

function readIndices(indices, vertices) {
	if (!isArray(indices) || indices instanceof Float32Array || indices instanceof Float64Array)
		throw new TypeError('nmtan: indices: an array of whole numbers is expected');
	return readNumbers(indices, Float64Array, (i, value) =>
		`indices[${i}]: ${String(value)} is not the number of a vertex below ${vertices}`);
}

function putIndices(address, indices, vertices) {
	const to = words(address, length(indices));
	to.set(indices);
	if (![Uint8Array, Uint8ClampedArray, Uint16Array, Uint32Array].some((type) => indices instanceof type))
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

const sizesBytes = (faceSizes) => (faceSizes === undefined ? {} : {faceSizes: length(faceSizes)});

function putFaces(job, faceSizes, indices, vertices) {
	if (faceSizes !== undefined)
		bytesAt(job.faceSizes, length(faceSizes)).set(faceSizes);
	if (indices)
		putIndices(job.indices, indices, vertices);
}

function readCounts() {
	const written = words(wasm.job() >>> 0, WORD.counts + COUNTS.length);
	const counts = {};
	for (let i = 0; i < COUNTS.length; i++)
		counts[COUNTS[i]] = written[WORD.counts + i];
	return counts;
}

export function generateCornerTangents(given, positions, normals, texcoords, options = {}) {
	const {faceSizes, bitangents, cornerFaults, words: chosen} =
		readOptions(options, [...OF_MESH, 'bitangents', 'cornerFaults']);
	const from = attributes(positions, normals, texcoords);
	const vertices = from.positions.count;
	const indices = given && readIndices(given, vertices), corners = indices ? length(indices) : vertices;
	const faces = countFaces(faceSizes, corners, indices ? 'indices' : 'positions: vertices');
	const wanted = {...(indices ? {indices: corners * 4} : {}), ...sizesBytes(faceSizes), tangents: corners * 16,
		...(bitangents ? {bitangents: corners * 12} : {}), ...(cornerFaults ? {cornerFaults: corners} : {})};
	return withMemory(() => {
		const job = makeJob({...chosen, faces, vertices}, {...attributeBytes(vertices), ...wanted}, from);
		putFaces(job, faceSizes, indices, vertices);
		const status = wasm.corner_tangents();
		if (status)
			fail(status);
		return {
			tangents: floats(job.tangents, corners * 4).slice(),
			...(bitangents ? {bitangents: floats(job.bitangents, corners * 3).slice()} : {}),
			...(cornerFaults ? {cornerFaults: bytesAt(job.cornerFaults, corners).slice()} : {}),
			counts: readCounts(),
		};
	});
}

// As the package mikktspace has it.
function ofSoup(positions, normals, texcoords, options, repair) {
	readOptions(options, ['vDown']);
	return generateCornerTangents(null, positions, normals, texcoords, {...options, repair}).tangents;
}

export function generateTangents(positions, normals, texcoords, options = {}) {
	return ofSoup(positions, normals, texcoords, options, false);
}

export function generateRepairedTangents(positions, normals, texcoords, options = {}) {
	return ofSoup(positions, normals, texcoords, options, true);
}

export function generateTangentsIndexed(given, positions, normals, texcoords, options = {}) {
	const {faceSizes, words: chosen} = readOptions(options, OF_MESH);
	const from = attributes(positions, normals, texcoords);
	const vertices = from.positions.count, indices = readIndices(given, vertices), corners = length(indices);
	const faces = countFaces(faceSizes, corners, 'indices');
	return withMemory(() => {
		const job = makeJob({...chosen, faces, vertices, sourceCapacity: corners},
			{...attributeBytes(vertices), ...sizesBytes(faceSizes), indices: corners * 4, splitIndices: corners * 4,
				sources: corners * 4, tangents: (vertices + corners) * 16}, from);
		putFaces(job, faceSizes, indices, vertices);
		const status = wasm.vertex_tangents();
		if (status)
			fail(status);
		const copies = words(wasm.job() >>> 0, WORD.counts)[WORD.sourceCount];
		return {
			tangents: floats(job.tangents, (vertices + copies) * 4).slice(),
			indices: takeIndices(job.splitIndices, corners, vertices + copies, given),
			sources: words(job.sources, copies).slice(),
			counts: readCounts(),
		};
	});
}
