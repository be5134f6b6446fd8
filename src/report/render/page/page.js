// SPDX-License-Identifier: MIT
//
// The page of an HTML report: a table of findings that can be filtered and sorted, the UV layout and a
// WebGL2 view of one mesh at a time. Choosing a finding takes both views to it.
//
// Everything shown comes from the JSON in #data and is put into the page as text, never as markup: names
// come from files. Nothing is loaded from anywhere. Texture coordinates have v pointing down here, as the
// images do; w and bitangents are for v up.
'use strict';
(() => {
const data = JSON.parse(document.getElementById('data').textContent);
const $ = id => document.getElementById(id);

function element(name, text, className) {
	const e = document.createElement(name);
	if (text !== undefined) e.textContent = text;
	if (className) e.className = className;
	return e;
}

// ---- what there is ----

const meshes = [], findings = [];
data.files.forEach((file, f) => {
	// a mesh of the same geometry as an earlier one shows that one's pictures
	file.meshes.forEach((mesh, m) => {
		const first = mesh.same_as ?? m, shown = file.meshes[first];
		meshes.push({...mesh, seams: shown.seams, geometry: shown.geometry, image: shown.image,
			file: file.name, key: f + '-' + first});
	});
	const first = meshes.length - file.meshes.length;
	file.findings.forEach(finding => findings.push({...finding, file: file.name, number: findings.length,
		where: finding.mesh === null ? -1 : first + finding.mesh}));
});

// ---- the table ----

const order = {error: 0, warning: 1, info: 2};
const columns = [
	['severity', 'Severity', x => order[x.severity]], ['code', 'Code', x => x.code],
	['count', 'Count', x => x.count], ['mesh', 'Where', x => x.where < 0 ? '' : meshes[x.where].label],
	['message', 'Finding', x => x.message]];
const filter = {error: true, warning: true, info: true, code: '', text: '', sort: null, down: false};
let chosen = null;

function isShown(x) {
	const text = filter.text.toLowerCase();
	return filter[x.severity] && (!filter.code || x.code === filter.code) && (!text ||
		(x.message + ' ' + x.code + ' ' + x.file + ' ' + (x.where < 0 ? '' : meshes[x.where].label))
			.toLowerCase().includes(text));
}

function sorted(list) {
	if (!filter.sort) return list;
	const key = columns.find(c => c[0] === filter.sort)[2], sign = filter.down ? -1 : 1;
	return list.slice().sort((a, b) => {
		const x = key(a), y = key(b);
		return (x < y ? -1 : x > y ? 1 : a.number - b.number) * sign;
	});
}

function findingRow(x) {
	const row = element('tr');
	row.dataset.finding = x.number;
	if (x === chosen) row.classList.add('chosen');
	if (x.known) row.classList.add('known');
	row.append(element('td', x.severity, x.severity));
	const cell = element('td', undefined, 'code'), go = element('button', x.code);
	go.type = 'button';
	go.addEventListener('click', () => choose(x));
	cell.append(go);
	row.append(cell, element('td', x.count));
	const label = x.where < 0 ? x.file : (data.files.length > 1 ? x.file + ': ' : '') + meshes[x.where].label;
	row.append(element('td', label + (x.line ? ', line ' + x.line : '')));
	const message = element('td', x.message + (x.known ? ' (known)' : ''));
	if (x === chosen) message.append(element('div', x.remedy, 'remedy'));
	row.append(message);
	return row;
}

function showTable() {
	const shown = sorted(findings.filter(isShown));
	$('rows').replaceChildren(...shown.map(findingRow));
	$('shown').textContent = shown.length + ' of ' + findings.length + ' shown' +
		(data.left_out ? ', ' + data.left_out + ' more are not on this page' : '');
	document.querySelectorAll('th').forEach(th => th.setAttribute('aria-sort',
		th.dataset.column !== filter.sort ? 'none' : filter.down ? 'descending' : 'ascending'));
}

function makeTable() {
	for (const [name, title] of columns) {
		const th = element('th'), button = element('button', title);
		th.dataset.column = name;
		button.type = 'button';
		button.addEventListener('click', () => {
			filter.down = filter.sort === name && !filter.down;
			filter.sort = name;
			showTable();
		});
		th.append(button);
		$('columns').append(th);
	}
	for (const severity of ['error', 'warning', 'info'])
		$('show-' + severity).addEventListener('change', e => { filter[severity] = e.target.checked; showTable(); });
	for (const code of [...new Set(findings.map(x => x.code))].sort())
		$('code').append(new Option(code, code));
	$('code').addEventListener('change', e => { filter.code = e.target.value; showTable(); });
	$('text').addEventListener('input', e => { filter.text = e.target.value; showTable(); });
	showTable();
}

// ---- meshes ----

let current = -1;

function showMesh(index) {
	if (index === current || !meshes[index]) return;
	current = index;
	const mesh = meshes[index];
	$('mesh').value = index;
	const picture = $('uv-' + mesh.key);
	$('uv').replaceChildren(picture ? picture.content.cloneNode(true)
		: element('p', mesh.has_uv ? 'The page has no room for this picture; --uv-image=DIR draws it.'
			: 'No texture coordinates.', 'note'));
	$('facts').replaceChildren(...mesh.facts.flatMap(([name, value]) => [element('dt', name), element('dd', value)]));
	$('note').textContent = mesh.geometry ? mesh.geometry.note : 'No geometry here: ' + mesh.why;
	if (view) view.load(mesh);
}

// A ring around a place of the UV layout, in its own units.
function markUv(finding) {
	const svg = $('uv').querySelector('svg');
	if (!svg) return;
	svg.querySelectorAll('.marker').forEach(e => e.remove());
	svg.querySelectorAll('.seam.chosen').forEach(e => e.classList.remove('chosen'));
	const [ox, oy] = svg.dataset.origin.split(' ').map(Number), factor = Number(svg.dataset.factor);
	if (finding.seam !== null)
		svg.querySelectorAll('[data-seam="' + finding.seam + '"]').forEach(e => e.classList.add('chosen'));
	for (const uv of finding.uvs.slice(0, 3)) {
		for (const className of ['marker halo', 'marker']) {
			const ring = document.createElementNS('http://www.w3.org/2000/svg', 'circle');
			ring.setAttribute('class', className);
			ring.setAttribute('cx', (uv[0] - ox) * factor);
			ring.setAttribute('cy', (uv[1] - oy) * factor);
			ring.setAttribute('r', 18);
			svg.append(ring);
		}
	}
}

function choose(finding) {
	chosen = finding;
	showTable();
	if (finding.where >= 0) {
		showMesh(finding.where);
		markUv(finding);
		if (view) view.focus(finding);
	}
	const row = document.querySelector('tr.chosen button');
	if (row) row.focus({preventScroll: false});
}

// ---- small vectors and matrices ----

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = a => { const l = Math.hypot(...a) || 1; return [a[0] / l, a[1] / l, a[2] / l]; };

function lookAt(eye, target) { // column-major
	const z = unit(sub(eye, target)), x = unit(cross([0, 1, 0], z)), y = cross(z, x);
	return [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, eye), -dot(y, eye), -dot(z, eye), 1];
}

function perspective(angle, aspect, near, far) {
	const f = 1 / Math.tan(angle / 2);
	return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
}

function multiply(a, b) {
	const c = new Array(16).fill(0);
	for (let i = 0; i < 4; i++) for (let k = 0; k < 4; k++) for (let j = 0; j < 4; j++)
		c[4 * i + k] += a[4 * j + k] * b[4 * i + j];
	return c;
}

// ---- shaders ----

const surfaceVertex = `#version 300 es
uniform mat4 camera; uniform vec3 light;
layout(location=0) in vec3 position; layout(location=1) in vec3 normal;
layout(location=2) in vec4 tangent; layout(location=3) in vec2 uv;
out vec3 p, n; out vec4 t; out vec2 st; out vec3 lightInFrame;
void main() {
	p = position; n = normal; t = tangent; st = uv;
	vec3 b = cross(normal, tangent.xyz) * tangent.w;
	lightInFrame = vec3(dot(light, tangent.xyz), dot(light, b), dot(light, normal));
	gl_Position = camera * vec4(position, 1.0);
}`;

// The frame from screen derivatives: T and B as the gradients of u and v over the surface, with their
// common scale taken out, so that a mirrored triangle gets a mirrored frame without stored data.
const surfaceFragment = `#version 300 es
precision highp float;
uniform int show, frame; uniform bool stored, normals; uniform vec3 light, eye; uniform sampler2D bump;
in vec3 p, n; in vec4 t; in vec2 st; in vec3 lightInFrame;
out vec4 colour;
mat3 derivativeFrame(vec3 normal) {
	vec3 px = dFdx(p), py = dFdy(p);
	vec2 d = vec2(1.0, -1.0), ux = dFdx(st) * d, uy = dFdy(st) * d;
	vec3 a = cross(py, normal), b = cross(normal, px);
	float side = dot(cross(px, py), normal) < 0.0 ? -1.0 : 1.0;
	vec3 gu = side * (a * ux.x + b * uy.x), gv = side * (a * ux.y + b * uy.y);
	float s = inversesqrt(max(max(dot(gu, gu), dot(gv, gv)), 1e-30));
	return mat3(gu * s, gv * s, normal);
}
vec3 grid() {
	vec2 cell = floor(st * 8.0);
	float check = mod(cell.x + cell.y, 2.0);
	vec2 edge = abs(fract(st * 8.0) - 0.5);
	float line = step(0.47, max(edge.x, edge.y));
	vec3 base = vec3(fract(st.x), 1.0 - fract(st.y), 0.35) * 0.65 + 0.2;
	return mix(base * (0.75 + 0.25 * check), vec3(0.1), line * 0.6);
}
void main() {
	vec3 face = normalize(cross(dFdx(p), dFdy(p)));
	vec3 normal = normals ? normalize(n) : face;
	mat3 own = mat3(t.xyz, cross(n, t.xyz) * t.w, n);
	mat3 derived = derivativeFrame(normal);
	mat3 used = stored && frame != 2 ? own : derived;
	if (show == 1) { colour = vec4(normal * 0.5 + 0.5, 1.0); return; }
	if (show == 2) { colour = vec4(normalize(used[0]) * 0.5 + 0.5, 1.0); return; }
	if (show == 3) { colour = vec4(normalize(used[1]) * 0.5 + 0.5, 1.0); return; }
	if (show == 4) {
		float w = stored && frame != 2 ? t.w : dot(cross(used[2], used[0]), used[1]);
		float shade = 0.75 + 0.25 * dot(normal, light);
		colour = vec4((w > 0.99 || (frame == 2 || !stored) && w > 0.0 ? vec3(0.25, 0.5, 0.85)
			: w < -0.99 || (frame == 2 || !stored) && w < 0.0 ? vec3(0.85, 0.25, 0.2) : vec3(0.9, 0.8, 0.1)) * shade, 1.0);
		return;
	}
	if (show == 5) { colour = vec4(grid() * (0.7 + 0.3 * abs(dot(normal, light))), 1.0); return; }
	vec3 m = texture(bump, st).xyz * 2.0 - 1.0;
	float diffuse;
	if (stored && frame == 1) diffuse = dot(normalize(m), normalize(lightInFrame));
	else diffuse = dot(normalize(used * m), light);
	vec3 lit = vec3(0.72, 0.72, 0.70) * (0.15 + 0.85 * max(diffuse, 0.0));
	vec3 h = normalize(light + normalize(eye - p));
	vec3 bumped = stored && frame == 1 ? normal : normalize(used * m);
	lit += 0.25 * pow(max(dot(bumped, h), 0.0), 40.0);
	colour = vec4(lit, 1.0);
}`;

const lineVertex = `#version 300 es
uniform mat4 camera;
layout(location=0) in vec3 position; layout(location=1) in vec3 colour;
out vec3 c;
void main() { c = colour; gl_Position = camera * vec4(position, 1.0); gl_Position.z -= 0.0005 * gl_Position.w; }`;
const lineFragment = `#version 300 es
precision highp float;
in vec3 c; out vec4 colour;
void main() { colour = vec4(c, 1.0); }`;

// ---- the view ----

function numbers(text, Type) {
	if (!text) return null;
	const raw = atob(text), bytes = new Uint8Array(raw.length);
	for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
	return new Type(bytes.buffer);
}

// A field of domes, for meshes without a normal map of their own: green up, as glTF has it.
function domes() {
	const size = 256, pixels = new Uint8Array(4 * size * size);
	for (let y = 0; y < size; y++) for (let x = 0; x < size; x++) {
		const u = (x % 64 + 0.5) / 32 - 1, v = 1 - (y % 64 + 0.5) / 32, r = Math.hypot(u, v);
		const n = r < 0.85 ? unit([u, v, Math.sqrt(Math.max(1.2 - r * r, 0.05))]) : [0, 0, 1];
		pixels.set([127.5 + 127.5 * n[0], 127.5 + 127.5 * n[1], 127.5 + 127.5 * n[2], 255], 4 * (y * size + x));
	}
	return {size, pixels};
}

class View {
	constructor(canvas) {
		const gl = canvas.getContext('webgl2', {antialias: true, preserveDrawingBuffer: true});
		if (!gl) throw new Error('WebGL2 is not available');
		this.gl = gl;
		this.canvas = canvas;
		this.surface = this.program(surfaceVertex, surfaceFragment);
		this.lines = this.program(lineVertex, lineFragment);
		this.bump = gl.createTexture();
		this.camera = {target: [0, 0, 0], distance: 3, yaw: 0.6, pitch: 0.35};
		this.show = 0;
		this.frame = 0;
		this.vectors = false;
		this.seams = true;
		this.listen();
		new ResizeObserver(() => this.draw()).observe(canvas);
	}

	program(vertex, fragment) {
		const gl = this.gl, program = gl.createProgram();
		for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
			const shader = gl.createShader(type);
			gl.shaderSource(shader, text);
			gl.compileShader(shader);
			gl.attachShader(program, shader);
		}
		gl.linkProgram(program);
		if (!gl.getProgramParameter(program, gl.LINK_STATUS))
			throw new Error('shader: ' + gl.getProgramInfoLog(program));
		return program;
	}

	buffer(array, index, size) {
		const gl = this.gl, buffer = gl.createBuffer();
		gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
		gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
		gl.enableVertexAttribArray(index);
		gl.vertexAttribPointer(index, size, gl.FLOAT, false, 0, 0);
		this.buffers.push(buffer);
	}

	load(mesh) {
		const gl = this.gl;
		(this.buffers || []).forEach(b => gl.deleteBuffer(b));
		this.buffers = [];
		this.mesh = mesh;
		const g = mesh.geometry;
		this.count = 0;
		if (g) {
			this.positions = numbers(g.positions, Float32Array);
			this.normals = numbers(g.normals, Float32Array);
			this.tangents = numbers(g.tangents, Float32Array);
			const uv = numbers(g.texcoords, Float32Array), vertices = this.positions.length / 3;
			this.array = gl.createVertexArray();
			gl.bindVertexArray(this.array);
			this.buffer(this.positions, 0, 3);
			this.buffer(this.normals || new Float32Array(3 * vertices), 1, 3);
			this.buffer(this.tangents || new Float32Array(4 * vertices), 2, 4);
			this.buffer(uv || new Float32Array(2 * vertices), 3, 2);
			const indices = numbers(g.indices, Uint32Array), elements = gl.createBuffer();
			gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, elements);
			gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
			this.buffers.push(elements);
			gl.bindVertexArray(null);
			this.count = indices.length;
			this.loadBump(mesh.image === null ? null : data.images[mesh.image]);
			this.makeSeams();
			this.makeVectors();
			this.home();
		}
		this.draw();
	}

	texture(fill) {
		const gl = this.gl;
		gl.bindTexture(gl.TEXTURE_2D, this.bump);
		fill(gl);
		gl.generateMipmap(gl.TEXTURE_2D);
		gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
	}

	loadBump(source) {
		const {size, pixels} = domes();
		this.texture(gl => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, size, size, 0, gl.RGBA, gl.UNSIGNED_BYTE, pixels));
		if (!source) return;
		const mesh = this.mesh, image = new Image();
		image.onload = () => {
			if (mesh !== this.mesh) return;
			this.texture(gl => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, image));
			this.draw();
		};
		image.src = source;
	}

	lineBuffer(list) {
		const gl = this.gl, array = gl.createVertexArray();
		gl.bindVertexArray(array);
		this.buffer(new Float32Array(list.positions), 0, 3);
		this.buffer(new Float32Array(list.colours), 1, 3);
		gl.bindVertexArray(null);
		return {array, count: list.positions.length / 3};
	}

	makeSeams() {
		const list = {positions: [], colours: []};
		this.mesh.seams.forEach(seam => {
			for (let i = 0; i + 5 < seam.points.length; i += 3)
				list.positions.push(...seam.points.slice(i, i + 6));
		});
		for (let i = 0; i < list.positions.length; i += 3) list.colours.push(1, 0.75, 0);
		this.seamLines = this.lineBuffer(list);
	}

	makeVectors() {
		const list = {positions: [], colours: []}, vertices = this.positions.length / 3;
		const length = 0.03 * this.extent(), step = Math.ceil(vertices / 20000);
		for (let v = 0; v < vertices; v += step) {
			const p = this.positions.subarray(3 * v, 3 * v + 3);
			const n = this.normals && this.normals.subarray(3 * v, 3 * v + 3);
			const t = this.tangents && this.tangents.subarray(4 * v, 4 * v + 4);
			const arrow = (d, colour) => {
				list.positions.push(p[0], p[1], p[2], p[0] + length * d[0], p[1] + length * d[1], p[2] + length * d[2]);
				list.colours.push(...colour, ...colour);
			};
			if (t) arrow(t, [0.9, 0.1, 0.1]);
			if (t && n) arrow(cross(n, t).map(x => x * t[3]), [0.1, 0.75, 0.1]);
			if (n) arrow(n, [0.15, 0.35, 1]);
		}
		this.vectorLines = this.lineBuffer(list);
	}

	extent() {
		const b = this.mesh.box;
		return b ? Math.hypot(b[1][0] - b[0][0], b[1][1] - b[0][1], b[1][2] - b[0][2]) || 1 : 1;
	}

	home() {
		const b = this.mesh.box || [[-1, -1, -1], [1, 1, 1]];
		this.camera = {target: [0, 1, 2].map(i => (b[0][i] + b[1][i]) / 2), distance: 1.3 * this.extent(), yaw: 0.6, pitch: 0.35};
	}

	// Looks at the middle of a finding, from the side to which its surface faces, else from outside.
	focus(finding) {
		if (!this.count || !finding.box) return;
		const [low, high] = finding.box, size = Math.hypot(...sub(high, low));
		this.camera.target = [0, 1, 2].map(i => (low[i] + high[i]) / 2);
		this.camera.distance = Math.max(1.4 * size, 0.15 * this.extent());
		const b = this.mesh.box, out = sub(this.camera.target, [0, 1, 2].map(i => (b[0][i] + b[1][i]) / 2));
		if (finding.facing || Math.hypot(...out) > 0.01 * this.extent()) {
			const [x, y, z] = finding.facing || unit(out);
			this.camera.yaw = Math.atan2(x, z);
			this.camera.pitch = Math.max(-1.4, Math.min(1.4, Math.asin(Math.max(-1, Math.min(1, y)))));
		}
		this.draw();
	}

	eye() {
		const c = this.camera, r = c.distance * Math.cos(c.pitch);
		return [c.target[0] + r * Math.sin(c.yaw), c.target[1] + c.distance * Math.sin(c.pitch),
			c.target[2] + r * Math.cos(c.yaw)];
	}

	draw() {
		const gl = this.gl, canvas = this.canvas;
		const scale = window.devicePixelRatio || 1;
		canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
		canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
		gl.viewport(0, 0, canvas.width, canvas.height);
		gl.clearColor(0.5, 0.52, 0.54, 1);
		gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
		if (!this.count) return;
		gl.enable(gl.DEPTH_TEST);
		const eye = this.eye(), far = this.camera.distance + 2 * this.extent();
		const matrix = multiply(perspective(0.7, canvas.width / canvas.height, far / 2000, far),
			lookAt(eye, this.camera.target));
		const light = unit(unit(sub(eye, this.camera.target)).map((x, i) => x + [0.35, 0.6, 0.1][i]));
		gl.useProgram(this.surface);
		const at = name => gl.getUniformLocation(this.surface, name);
		gl.uniformMatrix4fv(at('camera'), false, matrix);
		gl.uniform3fv(at('light'), light);
		gl.uniform3fv(at('eye'), eye);
		gl.uniform1i(at('show'), this.show);
		gl.uniform1i(at('frame'), this.frame);
		gl.uniform1i(at('stored'), this.tangents ? 1 : 0);
		gl.uniform1i(at('normals'), this.normals ? 1 : 0);
		gl.bindTexture(gl.TEXTURE_2D, this.bump);
		gl.bindVertexArray(this.array);
		gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
		gl.useProgram(this.lines);
		gl.uniformMatrix4fv(gl.getUniformLocation(this.lines, 'camera'), false, matrix);
		for (const [on, lines] of [[this.seams, this.seamLines], [this.vectors, this.vectorLines]]) {
			if (!on || !lines.count) continue;
			gl.bindVertexArray(lines.array);
			gl.drawArrays(gl.LINES, 0, lines.count);
		}
		gl.bindVertexArray(null);
	}

	turn(dx, dy) {
		this.camera.yaw -= dx;
		this.camera.pitch = Math.max(-1.5, Math.min(1.5, this.camera.pitch + dy));
		this.draw();
	}

	zoom(factor) {
		this.camera.distance = Math.max(1e-3 * this.extent(), Math.min(20 * this.extent(), this.camera.distance * factor));
		this.draw();
	}

	listen() {
		const canvas = this.canvas;
		canvas.addEventListener('pointermove', e => { if (e.buttons & 1) this.turn(e.movementX / 150, e.movementY / 150); });
		canvas.addEventListener('pointerdown', e => canvas.setPointerCapture(e.pointerId));
		canvas.addEventListener('wheel', e => { e.preventDefault(); this.zoom(Math.exp(e.deltaY / 600)); }, {passive: false});
		canvas.addEventListener('keydown', e => {
			const keys = {ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
			if (keys[e.key]) this.turn(...keys[e.key]);
			else if (e.key === '+' || e.key === '=') this.zoom(0.85);
			else if (e.key === '-') this.zoom(1.18);
			else if (e.key === 'Home') { this.home(); this.draw(); }
			else return;
			e.preventDefault();
		});
	}
}

// ---- start ----

let view = null;
try {
	view = new View($('view'));
} catch (error) {
	$('view').replaceWith(element('p', 'No 3D view: ' + error.message + '.', 'note'));
}
meshes.forEach((mesh, i) => $('mesh').append(new Option((data.files.length > 1 ? mesh.file + ': ' : '') + mesh.label, i)));
$('mesh').addEventListener('change', e => showMesh(Number(e.target.value)));
for (const [id, field] of [['show', 'show'], ['frame', 'frame']])
	$(id).addEventListener('change', e => { if (view) { view[field] = Number(e.target.value); view.draw(); } });
for (const id of ['vectors', 'seams'])
	$(id).addEventListener('change', e => { if (view) { view[id] = e.target.checked; view.draw(); } });
$('home').addEventListener('click', () => { if (view && view.mesh) { view.home(); view.draw(); } });
$('theme').addEventListener('click', () => {
	const root = document.documentElement, dark = root.dataset.theme ? root.dataset.theme === 'dark'
		: matchMedia('(prefers-color-scheme: dark)').matches;
	root.dataset.theme = dark ? 'light' : 'dark';
});
makeTable();
if (meshes.length) showMesh(Math.max(0, meshes.findIndex(m => m.geometry)));
// What the tests look at.
window.nmtanView = view && Object.freeze({camera: () => ({...view.camera}), triangles: () => view.count / 3});
})();
