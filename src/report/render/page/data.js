// SPDX-License-Identifier: MIT
//
// What there is: the JSON of #data, and the geometry of a mesh when it is opened. src/report/render/html.c says how the
// JSON is laid out, src/report/pack/pack.h how geometry is packed. Names come from files: they are put into the page as text,
// never as markup.

const data = JSON.parse(document.getElementById('data').textContent);
const $ = id => document.getElementById(id);

// element('p', {class: 'note', onclick: f}, 'text', child...)
function element(name, properties, ...children) {
	const e = document.createElement(name);
	for (const [key, value] of Object.entries(properties || {})) {
		if (key.startsWith('on')) e.addEventListener(key.slice(2), value);
		else if (value === true) e.setAttribute(key, '');
		else if (value !== false && value !== null && value !== undefined) e.setAttribute(key, value);
	}
	e.append(...children.filter(c => c !== null && c !== undefined && c !== ''));
	return e;
}

const plural = (n, one, many) => count(n) + ' ' + (n === 1 ? one : many || one + 's');
const count = n => n.toLocaleString('en-US').replace(/,/g, '\u2009');

// Maps of texture coordinates: [a, b, c, d, e, f] takes (u, v) to (a u + b v + c, d u + e v + f).
const determinant = m => m[0] * m[4] - m[1] * m[3];

// ---- files, meshes, findings ----

const severities = ['error', 'warning', 'info'];
const severityName = {error: 'error', warning: 'warning', info: 'info'};
const files = data.files, findings = [];
files.forEach((file, f) => {
	file.number = f;
	file.meshes.forEach((mesh, m) => {
		mesh.file = file;
		mesh.number = m;
		// a mesh of the same geometry as an earlier one shows that one's
		const shown = file.meshes[mesh.same_as ?? m];
		mesh.source = 'g-' + f + '-' + shown.number;
		mesh.hasGeometry = shown.geometry;
		mesh.seamList = shown.seams; // nets of hard edges come behind the mirror seams
		mesh.mirrorSeams = shown.seams.filter(seam => !seam[6]).length;
		// normal map, base colour: {source, file, map}, of which source and file may be null
		mesh.pictures = shown.images.map(({image, file, map}) => ({source: image === null ? null : data.images[image], file,
			map: determinant(map) ? map : [1, 0, 0, 0, 1, 0]}));
		mesh.map = mesh.pictures[0].map;
		mesh.wrap = shown.wrap;
	});
	file.findings.forEach(finding => {
		finding.number = findings.length;
		finding.file = file;
		findings.push(finding);
	});
	if (file.page) return; // a row of a folder's index has the sums
	file.triangles = file.meshes.reduce((sum, mesh) => sum + mesh.triangles, 0);
	file.islands = file.meshes.reduce((sum, mesh) => sum + mesh.islands, 0);
	file.seams = file.meshes.reduce((sum, mesh) => sum + mesh.mirrorSeams, 0);
});

// ---- geometry ----

const digits = new Uint8Array(128);
[...'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/'].forEach((c, i) => { digits[c.charCodeAt(0)] = i; });

function fromBase64(text, begin) {
	let end = text.length;
	while (end > begin && text[end - 1] === '=') end--;
	const bytes = new Uint8Array((end - begin) * 3 >> 2);
	for (let i = begin, to = 0; i < end; i += 4, to += 3) {
		const group = digits[text.charCodeAt(i)] << 18 | digits[text.charCodeAt(i + 1)] << 12 |
			(i + 2 < end ? digits[text.charCodeAt(i + 2)] << 6 : 0) | (i + 3 < end ? digits[text.charCodeAt(i + 3)] : 0);
		bytes[to] = group >> 16;
		bytes[to + 1] = group >> 8;
		bytes[to + 2] = group;
	}
	return bytes;
}

async function inflate(bytes) {
	const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
	return new Uint8Array(await new Response(stream).arrayBuffer());
}

const streamNames = ['indices', 'positions', 'normals', 'texcoords', 'authored', 'computed', 'kinds', 'islands', 'outlines',
	'seams', 'numbers'];

// The streams of a mesh by name; null where one is not there.
function cutStreams(bytes) {
	const streams = {}, lengths = new DataView(bytes.buffer);
	let at = 4 * streamNames.length;
	streamNames.forEach((name, i) => {
		const length = lengths.getUint32(4 * i, true);
		streams[name] = length ? bytes.subarray(at, at + length) : null;
		at += length;
	});
	return streams;
}

class Varints {
	constructor(bytes) { this.bytes = bytes || new Uint8Array(0); this.at = 0; }
	next() {
		let value = 0, shift = 0, byte;
		do {
			byte = this.bytes[this.at++];
			value += (byte & 127) * 2 ** shift;
			shift += 7;
		} while (byte & 128);
		return value;
	}
	difference() { const z = this.next(); return z % 2 ? -(z + 1) / 2 : z / 2; }
}

// Undoes the planes of one component: calls put(vertex, code) in order.
function eachCode(bytes, at, planes, vertices, put) {
	const mask = planes === 3 ? 0xffffff : 0xffff;
	let code = 0;
	for (let v = 0; v < vertices; v++) {
		let z = bytes[at + v] | bytes[at + vertices + v] << 8;
		if (planes === 3) z |= bytes[at + 2 * vertices + v] << 16;
		code = code + (z & 1 ? -(z + 1 >> 1) : z >> 1) & mask;
		put(v, code);
	}
	return at + planes * vertices;
}

function readIndices(bytes, triangles) {
	const indices = new Uint32Array(3 * triangles);
	let next = 0, at = 0;
	for (let c = 0; c < indices.length; c++) {
		let byte = bytes[at++], code = byte & 127;
		for (let shift = 7; byte & 128; shift += 7) code |= ((byte = bytes[at++]) & 127) << shift;
		indices[c] = next - code;
		if (code === 0) next++;
	}
	return indices;
}

// Rows of `width` codes, of which `components` are in the stream.
function readCodes(bytes, vertices, components, width) {
	if (!bytes) return null;
	const codes = new Uint16Array(width * vertices);
	let at = 0;
	for (let k = 0; k < components; k++)
		at = eachCode(bytes, at, 2, vertices, (v, code) => { codes[width * v + k] = code; });
	// the sign of tangents stands behind their directions
	for (let v = 0; at < bytes.length; v++) codes[width * v + components] = bytes[at++];
	return codes;
}

function readTexcoords(bytes, vertices, origin, step) {
	if (!bytes) return null;
	const uv = new Float32Array(2 * vertices);
	let at = 0;
	for (let k = 0; k < 2; k++)
		at = eachCode(bytes, at, 3, vertices, (v, code) => { uv[2 * v + k] = origin[k] + code * step; });
	return uv;
}

function readDifferences(bytes, length) {
	const values = new Int32Array(length), from = new Varints(bytes);
	let value = 0;
	for (let i = 0; i < length; i++) values[i] = value += from.difference();
	return values;
}

// [{island, mirrored, loops: [Uint32Array of vertices]}]
function readOutlines(bytes) {
	if (!bytes) return [];
	const from = new Varints(bytes), regions = [];
	let region = 0, vertex = 0;
	for (let n = from.next(); n > 0; n--) {
		region += from.difference();
		const loops = [];
		for (let l = from.next(); l > 0; l--) {
			const loop = new Uint32Array(from.next());
			for (let i = 0; i < loop.length; i++) loop[i] = vertex += from.difference();
			loops.push(loop);
		}
		regions.push({island: region >> 1, mirrored: (region & 1) === 1, loops});
	}
	return regions;
}

// The edges of each seam, or net of hard edges: [unmirrored from, to, mirrored from, to]...
function readSeams(bytes, seams) {
	const from = new Varints(bytes), list = [];
	let vertex = 0;
	for (let s = 0; s < seams && bytes; s++) {
		const edges = new Uint32Array(4 * from.next());
		for (let i = 0; i < edges.length; i++) edges[i] = vertex += from.difference();
		list.push(edges);
	}
	return list;
}

const opened = new Map(); // source -> promise of geometry

// The element may come behind the script, in a page that is still being read.
async function findSource(id) {
	if (!$(id) && document.readyState === 'loading')
		await new Promise(done => document.addEventListener('DOMContentLoaded', done, {once: true}));
	return $(id).textContent;
}

async function readGeometry(mesh) {
	const text = await findSource(mesh.source), line = text.indexOf('\n');
	const g = JSON.parse(text.slice(0, line));
	const streams = cutStreams(await inflate(fromBase64(text, line + 1)));
	const {vertices, triangles} = g;
	g.indices = readIndices(streams.indices, triangles);
	g.positions = readCodes(streams.positions, vertices, 3, 4);
	g.normals = readCodes(streams.normals, vertices, 2, 2);
	g.texcoords = readTexcoords(streams.texcoords, vertices, g.uvOrigin, g.uvStep);
	g.authored = readCodes(streams.authored, vertices, 2, 4);
	g.computed = readCodes(streams.computed, vertices, 2, 4);
	g.kinds = streams.kinds;
	g.islands = streams.islands ? readDifferences(streams.islands, triangles) : new Int32Array(triangles);
	g.regions = readOutlines(streams.outlines);
	g.seams = readSeams(streams.seams, streams.seams ? Math.max(mesh.seamList.length, 1) : 0);
	g.firstHard = mesh.mirrorSeams;
	g.numbers = streams.numbers ? new Map() : null;
	const from = new Varints(streams.numbers);
	for (let t = 0, number = 0; g.numbers && t < triangles; t++) g.numbers.set(number += from.next(), t);
	for (let t = 0; t < triangles; t++) // what has no place in space is not drawn
		if (g.kinds[t] & 4) g.indices[3 * t + 1] = g.indices[3 * t + 2] = g.indices[3 * t];
	return g;
}

// The last few meshes stay; others can be read again.
const MOST_OPENED = 4;

function openGeometry(mesh) {
	if (!mesh.hasGeometry) return Promise.resolve(null);
	let promise = opened.get(mesh.source);
	opened.delete(mesh.source);
	promise ||= readGeometry(mesh);
	opened.set(mesh.source, promise);
	if (opened.size > MOST_OPENED) opened.delete(opened.keys().next().value);
	return promise;
}

// ---- questions about geometry ----

const positionOf = (g, v) => [0, 1, 2].map(i => g.origin[i] + g.positions[4 * v + i] * g.step[i]);

// The page's number of a triangle of the file; undefined where it was left out.
const localTriangle = (g, number) => g.numbers ? g.numbers.get(number) : number < g.triangles ? number : undefined;

function trianglesOfIsland(g, island) {
	const list = [];
	for (let t = 0; t < g.triangles; t++) if (g.islands[t] - 1 === island) list.push(t);
	return list;
}

// Triangles with an edge of the seam.
function trianglesOfSeam(g, seam) {
	const edges = g.seams[seam] || [], touched = new Uint8Array(g.vertices), list = [];
	for (const v of edges) touched[v] = 1;
	for (let t = 0; t < g.triangles; t++)
		if (touched[g.indices[3 * t]] + touched[g.indices[3 * t + 1]] + touched[g.indices[3 * t + 2]] > 1) list.push(t);
	return list;
}

// The bounds of all texture coordinates.
function uvBox(g) {
	const low = [Infinity, Infinity], high = [-Infinity, -Infinity], uv = g.texcoords;
	for (let i = 0; i < uv.length; i++) {
		low[i & 1] = Math.min(low[i & 1], uv[i]);
		high[i & 1] = Math.max(high[i & 1], uv[i]);
	}
	return {low, high};
}

// The last triangle, as it is drawn, whose texture coordinates are around a point; -1: none.
function triangleAtTexcoord(g, u, v) {
	const uv = g.texcoords, indices = g.indices;
	let found = -1;
	for (let t = 0; uv && t < g.triangles; t++) {
		if ((g.kinds[t] & 3) === 1) continue;
		const a = 2 * indices[3 * t], b = 2 * indices[3 * t + 1], c = 2 * indices[3 * t + 2];
		const ab = (uv[b] - uv[a]) * (v - uv[a + 1]) - (uv[b + 1] - uv[a + 1]) * (u - uv[a]);
		const bc = (uv[c] - uv[b]) * (v - uv[b + 1]) - (uv[c + 1] - uv[b + 1]) * (u - uv[b]);
		const ca = (uv[a] - uv[c]) * (v - uv[c + 1]) - (uv[a + 1] - uv[c + 1]) * (u - uv[c]);
		if (ab >= 0 && bc >= 0 && ca >= 0 || ab <= 0 && bc <= 0 && ca <= 0) found = t;
	}
	return found;
}
