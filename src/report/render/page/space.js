// SPDX-License-Identifier: MIT
//
// The mesh in space: WebGL2. One camera turns around a target; what is chosen is filled, and the camera is turned to a
// side from which it is seen. Two frames can be looked at beside each other, or with a wipe between them.

const MOST_REPEATED = 2e6; // triangles in other tiles that lie on what is seen: half a second
const MOST_TURNED = 20000; // triangles that are drawn while it moves, if that is slow
const MOST_OUTLINED = 8; // as many as a finding has places
const HALF_VIEW = 0.35; // half the angle of view, of the shorter side: a sphere that fits it fits the other
const WHOLE = 0.5 / Math.sin(HALF_VIEW); // from here a sphere fits whose diameter is 1
const SELECTED = [1.0, 0.83, 0.1];
const SEAM = [1.0, 0.58, 0.0], HARD = [0.1, 0.85, 0.72];
const AXES = [[0.93, 0.2, 0.2], [0.1, 0.72, 0.25], [0.25, 0.45, 1]];

// A field of domes: a test pattern for meshes without a normal map, green up, as glTF has it.
function domes() {
	const size = 512, pixels = new Uint8Array(4 * size * size);
	for (let y = 0; y < size; y++) for (let x = 0; x < size; x++) {
		const u = (x % 128 + 0.5) / 64 - 1, v = 1 - (y % 128 + 0.5) / 64, r = Math.hypot(u, v);
		const n = r < 0.85 ? unit([u, v, Math.sqrt(Math.max(1.2 - r * r, 0.05))]) : [0, 0, 1];
		pixels.set([127.5 + 127.5 * n[0], 127.5 + 127.5 * n[1], 127.5 + 127.5 * n[2], 255], 4 * (y * size + x));
	}
	return {size, pixels};
}

// The direction of a pair of codes: see pack.h.
function decodeDirection(codes, at) {
	let x = codes[at] / 2047 - 1, y = codes[at + 1] / 2047 - 1;
	const z = 1 - Math.abs(x) - Math.abs(y);
	if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
	return unit([x, y, z]);
}

// Half the height of what is seen at distance 1.
const halfHeight = aspect => Math.tan(HALF_VIEW) * Math.max(1, 1 / aspect);

class Space {
	constructor(canvas) {
		const gl = canvas.getContext('webgl2', {antialias: false, alpha: false});
		if (!gl) throw new Error('this browser has no WebGL 2, or it is turned off');
		Object.assign(this, {gl, canvas, mode: 0, frame: 0, other: -1, layout: 'wipe', wipe: 0.5, showVectors: false,
			showSeams: true, camera: {target: [0, 0, 0], distance: 3, yaw: 0.6, pitch: 0.35}, buffers: [],
			part: [0, 1], flip: false, showBase: true, moving: false, quality: 0.8, slow: 0, took: 0});
		this.surfaces = new Map();
		this.fill = this.program(surfaceVertex([]), fillFragment);
		this.seen = this.program(surfaceVertex([]), seenFragment);
		this.lines = this.program(lineVertex, lineFragment);
		this.cover = this.program(coverVertex, coverFragment);
		this.textures = {bump: gl.createTexture(), base: gl.createTexture()};
		this.images = {};
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
		if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error('shader: ' + gl.getProgramInfoLog(program));
		const at = {};
		for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; i--) {
			const {name} = gl.getActiveUniform(program, i);
			at[name] = gl.getUniformLocation(program, name);
		}
		return {program, at};
	}

	// Colours of the mode, with a frame.
	surface(frame) {
		// a client lights what has no tangents by screen derivatives
		if (this.mode === 0 && !this.geometry[FRAMES[frame][0]]) frame = 2;
		const other = this.mode === 7 && this.other >= 0 ? this.other : 2, {normals, texcoords} = this.geometry;
		const what = [this.mode, frame, other, !!normals, !!texcoords, this.mode === 0 && this.showBase && !!this.images.base], key = what.join();
		if (!this.surfaces.has(key)) {
			const used = surfaceUses(...what);
			this.surfaces.set(key, this.program(surfaceVertex(used), surfaceFragment(used, ...what)));
		}
		return this.surfaces.get(key);
	}

	// ---- what is shown ----

	attribute(index, array, size, stride) {
		const gl = this.gl;
		if (!array) { // a constant one
			gl.disableVertexAttribArray(index);
			gl.vertexAttrib4f(index, 2047, 2047, 0, 0);
			return;
		}
		const buffer = gl.createBuffer();
		gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
		gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
		gl.enableVertexAttribArray(index);
		gl.vertexAttribPointer(index, size, array instanceof Float32Array ? gl.FLOAT : gl.UNSIGNED_SHORT, false, stride, 0);
		this.buffers.push(buffer);
	}

	elements(indices, kept) {
		const gl = this.gl, buffer = kept || gl.createBuffer();
		gl.bindVertexArray(null); // an array object would take the buffer for its own
		gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
		gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
		if (!kept) this.buffers.push(buffer);
		return {buffer, count: indices.length};
	}

	load(mesh, geometry) {
		const gl = this.gl, g = geometry;
		this.coarse = null;
		this.buffers.forEach(b => gl.deleteBuffer(b));
		this.buffers = [];
		this.mesh = mesh;
		this.geometry = g;
		this.chosen = null;
		this.vectorLines = null;
		if (g) {
			gl.deleteVertexArray(this.array || null);
			this.array = gl.createVertexArray();
			gl.bindVertexArray(this.array);
			this.attribute(0, g.positions, 3, 8);
			this.attribute(1, g.normals, 2, 4);
			this.attribute(2, g.texcoords, 2, 8);
			this.attribute(3, g.authored, 3, 8);
			this.attribute(4, g.computed, 3, 8);
			this.whole = this.elements(g.indices);
			this.covering = g.covering === g.indices ? this.whole : this.elements(g.covering);
			this.box = [0, 1, 2].map(i => g.step[i] * 65535);
			this.extent = Math.hypot(...this.box) || 1;
			this.centre = [0, 1, 2].map(i => g.origin[i] + this.box[i] / 2);
			this.images = {};
			this.fillTexture('bump', gl => { const {size, pixels} = domes(); gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, size, size, 0, gl.RGBA, gl.UNSIGNED_BYTE, pixels); });
			this.loadImage('bump', mesh.pictures[0].source);
			this.loadImage('base', mesh.pictures[1].source);
			this.seamLines = this.lineArray(g.seams.flatMap((_, i) => this.seamSegments([i], i < g.firstHard ? SEAM : HARD)));
			this.home();
		}
		this.draw();
	}

	// As the sampler of the normal map repeats it: wrap is 0 for repeated, 1 for mirrored, 2 for clamped, 3 for UDIM.
	fillTexture(name, fill) {
		const gl = this.gl, wraps = [gl.REPEAT, gl.MIRRORED_REPEAT, gl.CLAMP_TO_EDGE, gl.REPEAT];
		gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
		fill(gl);
		gl.generateMipmap(gl.TEXTURE_2D);
		gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
		gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wraps[this.mesh.wrap[0]]);
		gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wraps[this.mesh.wrap[1]]);
	}

	// Images in the page alone: a file beside it is not the page's to read.
	loadImage(name, source) {
		if (!source) return;
		const image = new Image(), {mesh} = this;
		image.onload = () => {
			if (mesh !== this.mesh) return;
			this.images[name] = image;
			this.fillTexture(name, gl => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, image));
			this.draw();
			this.onimage?.();
		};
		image.src = source;
	}

	// ---- lines ----

	// Segments as from, to, colour: nine numbers each.
	seamSegments(seams, colour) {
		const g = this.geometry, list = [];
		for (const seam of seams) {
			const edges = g.seams[seam] || [];
			for (let i = 0; i < edges.length; i += 4)
				list.push(...positionOf(g, edges[i]), ...positionOf(g, edges[i + 1]), ...colour);
		}
		return list;
	}

	vectorSegments() {
		const g = this.geometry, list = [], size = 0.018 * this.extent, step = Math.max(1, Math.ceil(g.vertices / 12000));
		const tangents = this.frame === 0 ? g.authored : g.computed;
		for (let v = 0; v < g.vertices; v += step) {
			const p = positionOf(g, v), n = g.normals && decodeDirection(g.normals, 2 * v);
			const arrow = (d, colour) => list.push(...p, ...add(p, times(d, size)), ...colour);
			if (tangents && tangents[4 * v + 2]) {
				const t = decodeDirection(tangents, 4 * v);
				arrow(t, AXES[0]);
				if (n) arrow(times(cross(n, t), tangents[4 * v + 2] === 1 ? 1 : -1), AXES[1]);
			}
			if (n) arrow(n, AXES[2]);
		}
		return list;
	}

	lineArray(list) {
		const gl = this.gl, array = gl.createVertexArray(), buffer = gl.createBuffer();
		gl.bindVertexArray(array);
		gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
		gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(list), gl.STATIC_DRAW);
		for (let i = 0; i < 3; i++) {
			gl.enableVertexAttribArray(i);
			gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 36, 12 * i);
			gl.vertexAttribDivisor(i, 1);
		}
		gl.bindVertexArray(null);
		this.buffers.push(buffer);
		return {array, count: list.length / 9};
	}

	// ---- what is chosen ----

	// triangles: the page's numbers; seams: their numbers.
	choose(triangles, seams) {
		const gl = this.gl, g = this.geometry;
		this.chosen = null;
		if (!g) return;
		if (triangles.length || seams.length) {
			const indices = new Uint32Array(3 * triangles.length);
			triangles.forEach((t, i) => indices.set(g.indices.subarray(3 * t, 3 * t + 3), 3 * i));
			// one buffer for ever: a new one with the number of a deleted one is taken for that one by array objects
			this.chosen = {triangles, elements: this.elements(indices, this.chosenBuffer ||= gl.createBuffer()),
				lines: this.lineArray(this.seamSegments(seams, SELECTED).concat(this.outlines(triangles)))};
		}
		this.draw();
	}

	// An outline of a few triangles, which may be too narrow to be seen.
	outlines(triangles) {
		const g = this.geometry;
		return triangles.length > MOST_OUTLINED ? [] : triangles.flatMap(t => [0, 1, 2].flatMap(k =>
			[...positionOf(g, g.indices[3 * t + k]), ...positionOf(g, g.indices[3 * t + (k + 1) % 3]), ...SELECTED]));
	}

	// The middle of the chosen triangles, how far they reach, and where they look.
	chosenPlace() {
		const g = this.geometry, low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
		let facing = [0, 0, 0];
		for (const t of this.chosen.triangles) {
			const [a, b, c] = [0, 1, 2].map(k => positionOf(g, g.indices[3 * t + k]));
			facing = add(facing, cross(sub(b, a), sub(c, a)));
			for (const p of [a, b, c]) for (let i = 0; i < 3; i++) {
				low[i] = Math.min(low[i], p[i]);
				high[i] = Math.max(high[i], p[i]);
			}
		}
		const middle = times(add(low, high), 0.5);
		return {middle, radius: length(sub(high, low)) / 2, facing: length(facing) > 1e-9 * this.extent ** 2 ? unit(facing) : null};
	}

	// Looks at what is chosen from outside: of some directions the one from which most of it is seen, those that it
	// faces first.
	focus() {
		if (!this.chosen?.elements.count) return;
		const {middle, radius, facing} = this.chosenPlace(), out = sub(middle, this.centre);
		const wanted = facing || (length(out) > 0.01 * this.extent ? unit(out) : [0.5, 0.3, 0.8]);
		const whole = WHOLE * this.extent, near = clamp(4.5 * radius, 0.01 * this.extent, whole);
		const distances = [near, Math.min(4 * near, whole)];
		const directions = [wanted, unit(out)];
		for (const yaw of [0, 1, 2, 3, 4, 5, 6, 7]) for (const pitch of [0.1, 0.75, -0.6])
			directions.push([Math.sin(yaw * Math.PI / 4) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw * Math.PI / 4) * Math.cos(pitch)]);
		directions.sort((a, b) => dot(b, wanted) - dot(a, wanted));
		const cameraAt = (d, distance) => ({target: middle, distance, yaw: Math.atan2(d[0], d[2]), pitch: clamp(Math.asin(clamp(d[1], -1, 1)), -1.4, 1.4)});
		// where it is hidden from all sides it shines through
		let best = {score: 0.006, camera: cameraAt(wanted, near)};
		for (const d of directions.slice(0, this.geometry.triangles > 300000 ? 4 : 12)) for (const distance of distances) {
			const camera = cameraAt(d, distance), score = this.visible(camera) * (1.2 + dot(d, wanted)) * (distance / near) ** 1.5;
			if (score > best.score * 1.05) best = {score, camera};
		}
		this.camera = best.camera;
		this.draw();
	}

	// The share of the chosen triangles that shows its front in a small picture.
	visible(camera) {
		const gl = this.gl, size = 96;
		this.small ||= this.framebuffer(size, size, true);
		gl.bindFramebuffer(gl.FRAMEBUFFER, this.small.buffer);
		gl.viewport(0, 0, size, size);
		gl.disable(gl.SCISSOR_TEST);
		gl.clearColor(0, 0, 0, 1);
		gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
		gl.enable(gl.DEPTH_TEST);
		const {matrix} = this.matrices(camera, 1);
		this.use(this.seen, matrix);
		gl.uniform4f(this.seen.at.tint, 0, 0, 0, 1);
		this.drawElements(this.whole);
		gl.enable(gl.POLYGON_OFFSET_FILL);
		gl.polygonOffset(-1, -2);
		gl.uniform4f(this.seen.at.tint, 1, 0, 0, 1);
		this.drawElements(this.chosen.elements);
		gl.disable(gl.POLYGON_OFFSET_FILL);
		this.drawLines(this.chosen.lines, matrix, [size, size], 1.5); // triangles may be smaller than a pixel
		const pixels = new Uint8Array(4 * size * size);
		gl.readPixels(0, 0, size, size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
		gl.bindFramebuffer(gl.FRAMEBUFFER, null);
		let seen = 0;
		for (let i = 0; i < pixels.length; i += 4) seen += pixels[i] < 128 ? 0 : pixels[i + 1] < 128 ? 1 : 0.2;
		return seen / (size * size);
	}

	framebuffer(width, height, depth) {
		const gl = this.gl, buffer = gl.createFramebuffer(), colour = gl.createRenderbuffer();
		gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
		gl.bindRenderbuffer(gl.RENDERBUFFER, colour);
		gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, width, height);
		gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, colour);
		if (depth) {
			const z = gl.createRenderbuffer();
			gl.bindRenderbuffer(gl.RENDERBUFFER, z);
			gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT16, width, height);
			gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, z);
		}
		return {buffer, colour, width, height};
	}

	// Draws the triangles that the sampler repeats on a window of the texture, those that lie there themselves left out; returns
	// how many, or null: too many. The window, and what it repeats, are texture coordinates behind the material's map.
	drawRepeated(low, high, draw) {
		const {map, wrap} = this.mesh, g = this.geometry, uv = g.texcoords, all = uvBox(g);
		const whole = mapBox(map, all.low, all.high), least = 1e-6 * (1 + Math.max(whole[1][0] - whole[0][0], whole[1][1] - whole[0][1]));
		const window = mapBox(map, [0, 1].map(i => Math.max(low[i], all.low[i])), [0, 1].map(i => Math.min(high[i], all.high[i])));
		// of what lies from `from` to `to` along an axis: calls on(s, t) for each x: s x + t that is in the window
		const eachMove = (axis, from, to, on) => {
			if (wrap[axis] > 1) { on(1, 0); return; }
			const step = wrap[axis] === 1 ? 2 : 1;
			for (let s = 1; s >= (wrap[axis] === 1 ? -1 : 1); s -= 2) {
				const last = Math.floor((window[1][axis] - (s < 0 ? -to : from) - least) / step);
				for (let t = Math.ceil((window[0][axis] - (s < 0 ? -from : to) + least) / step); t <= last; t++) on(s, t * step);
			}
		};
		const corners = new Float32Array(6), batch = new Float32Array(6 * 65536);
		let count = 0, filled = 0;
		const flush = () => { if (filled) draw(batch.subarray(0, filled)); filled = 0; };
		for (let t = 0; 3 * t < g.covering.length && count <= MOST_REPEATED; t++) {
			for (let k = 0; k < 3; k++) {
				const v = 2 * g.covering[3 * t + k];
				for (let i = 0; i < 2; i++) corners[2 * k + i] = map[3 * i] * uv[v] + map[3 * i + 1] * uv[v + 1] + map[3 * i + 2];
			}
			const [a, b, c, d, e, f] = corners;
			eachMove(0, Math.min(a, c, e), Math.max(a, c, e), (s, x) => eachMove(1, Math.min(b, d, f), Math.max(b, d, f), (r, y) => {
				if (count > MOST_REPEATED || s === 1 && x === 0 && r === 1 && y === 0) return;
				count++;
				for (let k = 0; k < 6; k += 2) { batch[filled++] = s * corners[k] + x; batch[filled++] = r * corners[k + 1] + y; }
				if (filled === batch.length) flush();
			}));
		}
		flush();
		return count > MOST_REPEATED ? null : count;
	}

	// How often each pixel of a window of the texture is covered, as bytes of 64 for each time: red by the mesh where it
	// lies, alpha by all that the sampler shows there. repeated: how many triangles are there again; null: too many to be counted.
	coverage(low, high, width, height) {
		const gl = this.gl;
		if (!this.geometry || !this.geometry.texcoords || width < 1 || height < 1) return null;
		if (!this.layer || this.layer.width !== width || this.layer.height !== height) {
			if (this.layer) { gl.deleteFramebuffer(this.layer.buffer); gl.deleteRenderbuffer(this.layer.colour); }
			this.layer = this.framebuffer(width, height, false);
		}
		gl.bindFramebuffer(gl.FRAMEBUFFER, this.layer.buffer);
		gl.viewport(0, 0, width, height);
		gl.disable(gl.SCISSOR_TEST);
		gl.disable(gl.DEPTH_TEST);
		gl.clearColor(0, 0, 0, 0);
		gl.clear(gl.COLOR_BUFFER_BIT);
		gl.enable(gl.BLEND);
		gl.blendFunc(gl.ONE, gl.ONE);
		gl.useProgram(this.cover.program);
		const [x, y] = [0, 1].map(i => 2 / (high[i] - low[i])), window = [x, 0, -1 - x * low[0], 0, y, -1 - y * low[1]];
		const place = (m, red) => {
			gl.uniformMatrix3fv(this.cover.at.place, false, [m[0], m[3], 0, m[1], m[4], 0, m[2], m[5], 1]);
			gl.uniform4f(this.cover.at.tint, red, 0, 0, 0.25);
		};
		place(window, 0.25);
		this.drawElements(this.covering);
		place(mapAfter(window, mapBack(this.mesh.map)), 0);
		gl.bindVertexArray(this.again ||= gl.createVertexArray());
		gl.bindBuffer(gl.ARRAY_BUFFER, this.againBuffer ||= gl.createBuffer());
		gl.enableVertexAttribArray(2);
		gl.vertexAttribPointer(2, 2, gl.FLOAT, false, 8, 0);
		const repeated = this.drawRepeated(low, high, corners => {
			gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STREAM_DRAW);
			gl.drawArrays(gl.TRIANGLES, 0, corners.length / 2);
		});
		gl.bindVertexArray(null);
		gl.disable(gl.BLEND);
		const pixels = new Uint8ClampedArray(4 * width * height);
		gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
		gl.bindFramebuffer(gl.FRAMEBUFFER, null);
		return {pixels, repeated};
	}

	// ---- drawing ----

	eye(camera) {
		const r = camera.distance * Math.cos(camera.pitch);
		return add(camera.target, [r * Math.sin(camera.yaw), camera.distance * Math.sin(camera.pitch), r * Math.cos(camera.yaw)]);
	}

	// Whether two pictures share the canvas, each with half of its width.
	halved() {
		return this.other >= 0 && this.mode !== 7 && this.layout === 'side';
	}

	// Width by height of a picture.
	aspect() {
		const {clientWidth: w, clientHeight: h} = this.canvas;
		return Math.max(1, w) / Math.max(1, h) / (this.halved() ? 2 : 1);
	}

	matrices(camera, aspect) {
		const eye = this.eye(camera), far = camera.distance + 2 * this.extent;
		const near = Math.max(far / 5000, 0.02 * camera.distance);
		return {eye, matrix: multiply(perspective(halfHeight(aspect), aspect, near, far), lookAt(eye, camera.target))};
	}

	use(program, matrix) {
		const gl = this.gl, g = this.geometry;
		gl.useProgram(program.program);
		gl.uniformMatrix4fv(program.at.camera, false, matrix);
		gl.uniform3fv(program.at.origin, g.origin);
		gl.uniform3fv(program.at.step_, g.step);
	}

	drawElements({buffer, count}) {
		const gl = this.gl;
		gl.bindVertexArray(this.array);
		for (const [index, there] of [[1, this.geometry.normals], [2, this.geometry.texcoords], [3, this.geometry.authored], [4, this.geometry.computed]])
			if (!there) gl.vertexAttrib4f(index, 2047, 2047, 0, 0);
		gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
		gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
		gl.bindVertexArray(null);
	}

	drawLines(lines, matrix, size, width, lift = 0.0015) {
		const gl = this.gl;
		if (!lines || !lines.count) return;
		gl.useProgram(this.lines.program);
		gl.uniformMatrix4fv(this.lines.at.camera, false, matrix);
		gl.uniform2fv(this.lines.at.size, size);
		gl.uniform1f(this.lines.at.width, width);
		gl.uniform1f(this.lines.at.lift, lift);
		gl.bindVertexArray(lines.array);
		gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
		gl.bindVertexArray(null);
	}

	drawSurface(eye, matrix, frame) {
		const gl = this.gl, surface = this.surface(frame), {at} = surface;
		const [right, up, back] = axesOf(eye, this.camera.target);
		this.use(surface, matrix);
		gl.uniform3fv(at.light, unit(add(back, add(times(right, -0.35), times(up, 0.55)))));
		gl.uniform3fv(at.eye, eye);
		gl.uniform1f(at.green, this.flip && this.images.bump ? -1 : 1);
		for (const [name, m] of [['map', this.mesh.map], ['baseMap', this.mesh.pictures[1].map]])
			gl.uniformMatrix3fv(at[name] ?? null, false, [m[0], m[3], 0, m[1], m[4], 0, m[2], m[5], 1]);
		for (const name of ['plain', 'mirrored', 'degenerate']) gl.uniform3fv(at[name], lightOf(name));
		['bump', 'base'].forEach((name, unit) => {
			gl.activeTexture(gl.TEXTURE0 + unit);
			gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
			gl.uniform1i(at[name] ?? null, unit);
		});
		gl.activeTexture(gl.TEXTURE0);
		this.shown = this.moving && this.coarse || this.whole;
		this.drawElements(this.shown);
	}

	// One picture, with one frame, into a part of the canvas.
	drawPart(frame, viewport, scissor, scale) {
		const gl = this.gl;
		gl.viewport(...viewport);
		gl.enable(gl.SCISSOR_TEST);
		gl.scissor(...scissor);
		const {eye, matrix} = this.matrices(this.camera, viewport[2] / viewport[3]);
		gl.enable(gl.DEPTH_TEST);
		gl.depthFunc(gl.LEQUAL);
		this.drawSurface(eye, matrix, frame);
		if (this.chosen?.elements.count) {
			gl.enable(gl.BLEND);
			gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
			gl.enable(gl.POLYGON_OFFSET_FILL);
			gl.polygonOffset(-1, -2);
			this.use(this.fill, matrix);
			gl.uniform3fv(this.fill.at.eye, eye);
			for (const [test, alpha] of [[gl.GREATER, 0.12], [gl.LEQUAL, 0.6]]) { // faint where something lies before it
				gl.depthFunc(test);
				gl.depthMask(test === gl.LEQUAL);
				gl.uniform4f(this.fill.at.tint, ...SELECTED, alpha);
				this.drawElements(this.chosen.elements);
			}
			gl.disable(gl.POLYGON_OFFSET_FILL);
			gl.disable(gl.BLEND);
		}
		const size = [viewport[2], viewport[3]];
		if (this.showSeams) this.drawLines(this.seamLines, matrix, size, 2.5 * scale);
		if (this.showVectors) this.drawLines(this.vectorLines ||= this.lineArray(this.vectorSegments()), matrix, size, 1.3 * scale);
		if (this.chosen) {
			gl.depthFunc(gl.GREATER); // thin where something lies before it
			this.drawLines(this.chosen.lines, matrix, size, 1.5 * scale);
			gl.depthFunc(gl.LEQUAL);
			this.drawLines(this.chosen.lines, matrix, size, 5 * scale, 0.003);
		}
	}

	draw() {
		if (this.pending) return;
		this.pending = true;
		requestAnimationFrame(() => { this.pending = false; this.drawNow(); });
	}

	// While it moves, as many triangles and pixels as it is quick with, in steps, since another size is another buffer; at rest all,
	// and four pixels for each of the page's, where edges are smooth. Without a GPU triangles take the time.
	pixelScale() {
		const ratio = window.devicePixelRatio || 1;
		if (!this.moving) return ratio < 2 ? 2 : ratio;
		this.slow = this.took > 2000 ? 0 : this.took > 36 ? this.slow + 1 : Math.max(0, this.slow - 1);
		if (this.slow > 1 && !this.coarse && this.geometry?.triangles > MOST_TURNED) {
			this.coarse = this.elements(coarseIndices(this.geometry));
			this.slow = 0;
		} else if (this.slow > 1 && this.quality > 0.3) { this.quality *= 0.7; this.slow = 0; }
		return ratio * this.quality;
	}

	move() {
		this.moving = true;
		this.draw();
	}

	drawNow() {
		const gl = this.gl, canvas = this.canvas, scale = this.pixelScale(), begun = performance.now();
		requestAnimationFrame(() => { this.took = performance.now() - begun; }); // until a next picture may be, whenever it is asked for
		const w = Math.max(1, Math.round(canvas.clientWidth * scale)), h = Math.max(1, Math.round(canvas.clientHeight * scale));
		if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
		gl.bindFramebuffer(gl.FRAMEBUFFER, null);
		gl.disable(gl.SCISSOR_TEST);
		gl.clearColor(...lightOf('stage'), 1);
		gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
		if (!this.geometry) return;
		const two = this.other >= 0 && this.mode !== 7, half = Math.round(w / 2), cut = Math.round(this.wipe * w);
		if (!two) {
			const [from, to] = this.part.map(x => Math.round(x * w)); // what of its width is looked at
			this.drawPart(this.frame, [0, 0, w, h], [from, 0, to - from, h], scale);
		} else if (this.layout === 'wipe') {
			this.drawPart(this.frame, [0, 0, w, h], [0, 0, cut, h], scale);
			this.drawPart(this.other, [0, 0, w, h], [cut, 0, w - cut, h], scale);
		} else {
			this.drawPart(this.frame, [0, 0, half, h], [0, 0, half, h], scale);
			this.drawPart(this.other, [half, 0, w - half, h], [half, 0, w - half, h], scale);
		}
		this.ondraw?.();
		clearTimeout(this.rest);
		if (this.moving) this.rest = setTimeout(() => { this.moving = false; this.draw(); }, 180);
	}

	// ---- moving ----

	home() {
		this.camera = {target: this.centre, distance: WHOLE * this.extent, yaw: 0.6, pitch: 0.3};
		this.draw();
	}

	turn(dx, dy) {
		this.camera.yaw -= dx;
		this.camera.pitch = clamp(this.camera.pitch + dy, -1.55, 1.55);
		this.move();
	}

	pan(dx, dy) { // in pixels of the page
		const [right, up] = axesOf(this.eye(this.camera), this.camera.target);
		const {clientHeight: h} = this.canvas, unitsPerPixel = 2 * halfHeight(this.aspect()) * this.camera.distance / Math.max(1, h);
		this.camera.target = add(this.camera.target, add(times(right, -dx * unitsPerPixel), times(up, dy * unitsPerPixel)));
		this.move();
	}

	zoom(factor) {
		this.camera.distance = clamp(this.camera.distance * factor, 0.002 * this.extent, 20 * this.extent);
		this.move();
	}

	// The triangle under a place of the canvas, in pixels of the page; -1: none.
	pick(x, y) {
		const g = this.geometry, {clientWidth: w, clientHeight: h} = this.canvas, eye = this.eye(this.camera);
		const aspect = this.aspect(), t = halfHeight(aspect), at = this.halved() ? x / w * 2 % 1 : x / w;
		const [right, up, back] = axesOf(eye, this.camera.target);
		const ray = unit(add(add(times(right, (2 * at - 1) * t * aspect), times(up, (1 - 2 * y / h) * t)), times(back, -1)));
		// in codes, so that positions need not be decoded: a step is never 0 where a triangle spans
		const s = g.step.map(x => x || 1), o = [0, 1, 2].map(i => (eye[i] - g.origin[i]) / s[i]), d = [0, 1, 2].map(i => ray[i] / s[i]);
		let nearest = Infinity, found = -1;
		for (let i = 0, p = g.positions, n = g.indices; i < n.length; i += 3) {
			const a = 4 * n[i], b = 4 * n[i + 1], c = 4 * n[i + 2], ax = p[a], ay = p[a + 1], az = p[a + 2];
			const e1x = p[b] - ax, e1y = p[b + 1] - ay, e1z = p[b + 2] - az, e2x = p[c] - ax, e2y = p[c + 1] - ay, e2z = p[c + 2] - az;
			const hx = d[1] * e2z - d[2] * e2y, hy = d[2] * e2x - d[0] * e2z, hz = d[0] * e2y - d[1] * e2x;
			const det = e1x * hx + e1y * hy + e1z * hz;
			if (det === 0) continue;
			const sx = o[0] - ax, sy = o[1] - ay, sz = o[2] - az, u = (sx * hx + sy * hy + sz * hz) / det;
			if (!(u >= 0 && u <= 1)) continue;
			const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
			const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
			if (!(v >= 0 && u + v <= 1)) continue;
			const far = (e2x * qx + e2y * qy + e2z * qz) / det;
			if (far > 0 && far < nearest) { nearest = far; found = i / 3; }
		}
		return found;
	}

	listen() {
		trackPointers(this.canvas, {
			drag: (dx, dy, second) => second ? this.pan(dx, dy) : this.turn(dx / 150, dy / 150),
			zoom: (factor, x, y, dx, dy) => { this.zoom(1 / factor); if (dx || dy) this.pan(dx, dy); },
			twist: angle => this.turn(-angle, 0),
			click: (x, y, again) => { if (this.geometry) this.onpick?.(this.pick(x, y), again); },
			arrow: (x, y, shift) => shift ? this.pan(40 * x, 40 * y) : this.turn(0.1 * x, 0.1 * y),
			home: () => this.home(),
		});
	}
}

// Drags, pinches, wheels and clicks of a canvas, in pixels of the page. drag(dx, dy, second): second button, shift or
// space; zoom(factor, x, y, dx, dy); twist(radians, clockwise): two fingers; click(x, y, again). Keys: arrow(x, y, shift), and
// home() for all of it.
function trackPointers(canvas, on) {
	const points = new Map();
	let moved = 0;
	canvas.addEventListener('contextmenu', e => e.preventDefault());
	canvas.addEventListener('pointerdown', e => {
		canvas.setPointerCapture(e.pointerId);
		canvas.focus({preventScroll: true});
		points.set(e.pointerId, [e.offsetX, e.offsetY]);
		moved = points.size === 1 ? 0 : Infinity; // two fingers never click
	});
	canvas.addEventListener('pointermove', e => {
		const from = points.get(e.pointerId);
		if (!from) { on.hover?.(e.offsetX, e.offsetY); return; }
		const to = [e.offsetX, e.offsetY], [dx, dy] = [to[0] - from[0], to[1] - from[1]];
		moved += Math.hypot(dx, dy);
		points.set(e.pointerId, to);
		if (points.size === 1) {
			if (moved > 3) on.drag(dx, dy, (e.buttons & 6) !== 0 || e.shiftKey);
			return;
		}
		const other = [...points].find(([id]) => id !== e.pointerId)[1];
		const [ax, ay, bx, by] = [from[0] - other[0], from[1] - other[1], to[0] - other[0], to[1] - other[1]];
		on.zoom(Math.max(Math.hypot(bx, by), 1) / Math.max(Math.hypot(ax, ay), 1), (to[0] + other[0]) / 2, (to[1] + other[1]) / 2, dx / 2, dy / 2);
		on.twist?.(Math.atan2(ax * by - ay * bx, ax * bx + ay * by));
	});
	const end = e => {
		if (points.delete(e.pointerId) && e.type === 'pointerup' && moved <= 3 && points.size === 0 && e.button === 0)
			on.click(e.offsetX, e.offsetY, e.altKey);
	};
	canvas.addEventListener('pointerup', end);
	canvas.addEventListener('pointercancel', end);
	canvas.addEventListener('pointerleave', () => on.leave?.());
	canvas.addEventListener('keydown', e => {
		const arrow = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[e.key];
		const factor = {'+': 1.25, '=': 1.25, '-': 0.8}[e.key];
		if (arrow) on.arrow(...arrow, e.shiftKey);
		else if (factor) on.zoom(factor, canvas.clientWidth / 2, canvas.clientHeight / 2, 0, 0);
		else if (e.key === 'Home' || e.key === '0') on.home();
		else return;
		e.preventDefault();
	});
	canvas.addEventListener('wheel', e => {
		e.preventDefault();
		on.zoom(Math.exp(-e.deltaY * (e.deltaMode ? 20 : 1) / (e.ctrlKey ? 120 : 500)), e.offsetX, e.offsetY, 0, 0);
	}, {passive: false});
}
