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

const TEXCOORD_CODES = 1 << 18;
const MOST_STACKED = 8; // equal outlines of islands that are drawn

function fromBase64(text) {
	const letters = atob(text), bytes = new Uint8Array(letters.length);
	for (let i = 0; i < bytes.length; i++) bytes[i] = letters.charCodeAt(i);
	return bytes;
}

async function inflate(bytes) {
	if (!window.DecompressionStream) throw new Error('this browser has no DecompressionStream; a newer one has');
	const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
	return new Uint8Array(await new Response(stream).arrayBuffer());
}

const ARRAYS = ['numbers', 'corners', 'x', 'y', 'z', 'nx', 'ny', 'u', 'v', 'ax', 'ay', 'aw', 'cx', 'cy', 'cw', 'kinds', 'islands', 'seam_edges', 'seam_ends'];

// The arrays of numbers by name, as pack.h says how they are stored; those that are not there are undefined.
function readArrays(bytes, {planes, vertices, triangles, seams}) {
	const arrays = {}, counts = {numbers: triangles, corners: 3 * triangles, kinds: triangles, islands: triangles, seam_edges: seams};
	let at = 0;
	ARRAYS.forEach((name, n) => {
		const width = Number(planes[n]), mask = width < 4 ? (1 << 8 * width) - 1 : -1;
		if (!width) return;
		const count = name === 'seam_ends' ? 4 * arrays.seam_edges.reduce((sum, edges) => sum + edges, 0) : counts[name] ?? vertices;
		const numbers = arrays[name] = new Uint32Array(count);
		for (let k = 0; k < width; k++) for (let i = 0; i < count; i++) numbers[i] |= bytes[at++] << 8 * k;
		for (let i = 0, number = 0; i < count; i++) numbers[i] = number = number + (numbers[i] >>> 1 ^ -(numbers[i] & 1)) & mask;
	});
	return arrays;
}

function readIndices(indices) {
	for (let c = 0, next = 0; c < indices.length; c++) {
		const below = indices[c];
		indices[c] = next - below;
		if (below === 0) next++;
	}
	return indices;
}

// Arrays as the columns of one of rows, for WebGL; null where they are not there.
function joinColumns(width, ...columns) {
	if (!columns[0]) return null;
	const rows = new Uint16Array(width * columns[0].length);
	columns.forEach((column, k) => { for (let v = 0; v < column.length; v++) rows[width * v + k] = column[v]; });
	return rows;
}

// The order of things by a number of each, which is below `most`; equal ones stay in the order that they have.
function sortedBy(numbers, most, order) {
	const ends = new Uint32Array(most + 1), sorted = new Uint32Array(numbers.length);
	for (let i = 0; i < numbers.length; i++) ends[numbers[i] + 1]++;
	for (let n = 0; n < most; n++) ends[n + 1] += ends[n];
	for (let i = 0; i < numbers.length; i++) { const thing = order ? order[i] : i; sorted[ends[numbers[thing]]++] = thing; }
	return sorted;
}

// Finds for each vertex the first one with the same texture coordinates, which are codes.
function weldTexcoords(u, v) {
	const order = sortedBy(u, TEXCOORD_CODES, sortedBy(v, TEXCOORD_CODES)), points = new Uint32Array(u.length);
	for (let i = 0, point = 0; i < order.length; i++) {
		const vertex = order[i];
		if (u[vertex] !== u[point] || v[vertex] !== v[point] || i === 0) point = vertex;
		points[vertex] = point;
	}
	return points;
}

// Takes away those of edges[begin ... end) that others reverse; the rest stay in their order. Returns where they end.
function cancelEdges(edges, begin, end) {
	// of many those of one kind lie beside each other: what is left of the kind is all of one sign
	const sorted = end - begin > 32;
	if (sorted) edges.subarray(begin, end).sort((a, b) => Math.abs(a) - Math.abs(b));
	let left = begin;
	for (let i = begin; i < end; i++) {
		const edge = edges[i], last = sorted ? Math.max(begin, left - 1) : begin;
		let k = left - 1;
		while (k >= last && edges[k] !== -edge) k--;
		if (k < last) edges[left++] = edge;
		else edges.copyWithin(k, k + 1, left--);
	}
	return left;
}

// The outlines of islands, closed loops around the triangles of one island and one winding: [{island, mirrored, loops: [[vertex]]}].
// Filled by the rule that counts windings they cover what the triangles cover, and inner edges never show. Each triangle that spans an
// area has three edges, counterclockwise; those of one region that run against each other cancel, and what remains enters and leaves
// each point equally often, so that walking along it ends where it began.
//
// An edge is a number, listed at its lower point: 1 + higher point + region * vertices, below 0 if it runs down.
function findOutlines(g, u, v) {
	const {vertices, indices} = g, points = weldTexcoords(u, v), ends = new Uint32Array(vertices + 1);
	const eachEdge = on => {
		for (let t = 0; t < g.triangles; t++) {
			const kind = g.kinds[t] & 3, region = 2 * g.islands[t] - 2 + (kind === 0);
			if (kind === 1 || g.islands[t] === 0) continue;
			const a = points[indices[3 * t]], b = points[indices[3 * t + (kind ? 1 : 2)]], c = points[indices[3 * t + (kind ? 2 : 1)]];
			on(a, b, region);
			on(b, c, region);
			on(c, a, region);
		}
	};
	eachEdge((a, b) => { if (a !== b) ends[Math.min(a, b) + 1]++; });
	for (let p = 0; p < vertices; p++) ends[p + 1] += ends[p];
	const edges = new Float64Array(ends[vertices]), from = [], to = [], regionOf = [];
	eachEdge((a, b, region) => {
		if (a < b) edges[ends[a]++] = 1 + b + region * vertices;
		else if (a > b) edges[ends[b]++] = -1 - a - region * vertices;
	});
	for (let p = 0, begin = 0; p < vertices; begin = ends[p++])
		for (let i = begin, end = cancelEdges(edges, begin, ends[p]); i < end; i++) {
			const edge = Math.abs(edges[i]) - 1, region = Math.floor(edge / vertices), other = edge - region * vertices;
			from.push(edges[i] > 0 ? p : other);
			to.push(edges[i] > 0 ? other : p);
			regionOf.push(region);
		}
	const order = sortedBy(regionOf, regionOf.reduce((most, region) => Math.max(most, region + 1), 0));
	const next = [], leaving = new Int32Array(vertices).fill(-1), regions = []; // of each point an edge of the region that begins there
	for (let begin = 0, end = 0; begin < order.length; begin = end) {
		const region = regionOf[order[begin]], loops = [];
		for (; regionOf[order[end]] === region; end++) { const edge = order[end]; next[edge] = leaving[from[edge]]; leaving[from[edge]] = edge; }
		for (let i = begin; i < end; i++) while (leaving[from[order[i]]] >= 0) {
			const loop = [], first = from[order[i]];
			for (let at = first, edge; edge === undefined || at !== first; at = to[edge]) {
				loop.push(at);
				edge = leaving[at];
				leaving[at] = next[edge];
			}
			loops.push(loop);
		}
		regions.push({island: region >> 1, mirrored: (region & 1) === 1, loops});
	}
	return regions;
}

// Marks outlines of islands that are there often already, which takes time to draw and shows nothing. Returns the indices of the
// other triangles.
function leaveOutBuried(g) {
	const seen = new Map(), buried = new Set();
	for (const region of g.regions) {
		const key = region.mirrored + ' ' + region.loops.join(), times = seen.get(key) || 0;
		region.buried = times >= MOST_STACKED;
		if (region.buried) buried.add(2 * region.island + region.mirrored);
		seen.set(key, times + 1);
	}
	return buried.size ? g.indices.filter((_, c) => !buried.has(2 * g.islands[c / 3 | 0] - 2 + ((g.kinds[c / 3 | 0] & 3) === 0))) : g.indices;
}

// Triangles between cells of a grid, of which each has the first vertex in it: what is drawn of a large mesh while it turns.
function coarseIndices(g) {
	const cells = 64, scale = g.step.map(step => step * cells / (Math.max(...g.step) * 65536)), p = g.positions;
	const firsts = new Int32Array(cells ** 3).fill(-1), of = new Uint32Array(g.vertices), kept = new Uint32Array(g.indices.length);
	for (let v = 0; v < g.vertices; v++) {
		const cell = (p[4 * v] * scale[0] | 0) + cells * ((p[4 * v + 1] * scale[1] | 0) + cells * (p[4 * v + 2] * scale[2] | 0));
		if (firsts[cell] < 0) firsts[cell] = v;
		of[v] = firsts[cell];
	}
	let count = 0;
	for (let c = 0; c < g.indices.length; c += 3) {
		const [a, b, d] = [of[g.indices[c]], of[g.indices[c + 1]], of[g.indices[c + 2]]];
		if (a === b || b === d || d === a) continue;
		kept[count++] = a;
		kept[count++] = b;
		kept[count++] = d;
	}
	return kept.subarray(0, count);
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
	const g = JSON.parse(text.slice(0, line)), a = readArrays(await inflate(fromBase64(text.slice(line + 1))), g);
	const {vertices, triangles} = g, {u, v, numbers, seam_ends: ends} = a;
	g.indices = readIndices(a.corners);
	g.positions = joinColumns(4, a.x, a.y, a.z);
	g.normals = joinColumns(2, a.nx, a.ny);
	g.authored = joinColumns(4, a.ax, a.ay, a.aw);
	g.computed = joinColumns(4, a.cx, a.cy, a.cw);
	g.texcoords = u && new Float32Array(2 * vertices).map((_, i) => g.uvOrigin[i & 1] + (i & 1 ? v : u)[i >> 1] * g.uvStep);
	g.kinds = a.kinds;
	g.islands = a.islands || new Uint32Array(triangles);
	g.regions = u ? findOutlines(g, u, v) : [];
	let end = 0;
	g.seams = [...a.seam_edges || []].map(edges => ends ? ends.subarray(end, end += 4 * edges) : new Uint32Array(0));
	g.firstHard = mesh.mirrorSeams;
	g.numbers = numbers && new Map(Array.from(numbers, (number, t) => [number, t]));
	for (let t = 0; t < triangles; t++) // what has no place in space is not drawn
		if (g.kinds[t] & 4) g.indices[3 * t + 1] = g.indices[3 * t + 2] = g.indices[3 * t];
	g.covering = leaveOutBuried(g);
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
