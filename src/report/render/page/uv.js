// SPDX-License-Identifier: MIT
//
// The texture as islands lie on it: outlines of islands, filled, at any zoom. Shown as an image editor shows the texture: u to
// the right, the top of the image above. Labels give way: one that would lie on another is left out until there is room.

const LEAST_VOTE = 20; // percent, from which on a block counts

// Closed by lines back to the first points, since to close a path takes Chromium time for all of it.
function outlinePath(uv, loops) {
	const path = new Path2D();
	for (const loop of loops) {
		const last = 2 * loop[loop.length - 1];
		path.moveTo(uv[last], uv[last + 1]);
		for (const vertex of loop) path.lineTo(uv[2 * vertex], uv[2 * vertex + 1]);
	}
	return path;
}

class Layout {
	constructor(canvas) {
		this.canvas = canvas;
		this.context = canvas.getContext('2d');
		this.geometry = null;
		this.view = {u: 0.5, v: 0.5, scale: 400}; // the middle, and pixels of the page a unit
		this.chosen = null;
		this.picture = -1; // of the mesh's pictures, that is wanted below the islands; -1: none
		this.showOverlaps = true;
		this.votes = null; // of blocks of the normal map, rows from the top, in percent: green up above 0
		this.fill = null; // how opaque islands are, 0 to 1; null: as is best with an image below, or without
		this.overlaps = null;
		this.listen();
		new ResizeObserver(() => { if (this.fitted) this.fit(); else this.draw(); }).observe(canvas);
	}

	load(mesh, geometry) {
		this.votes = null;
		this.mesh = mesh;
		this.geometry = geometry && geometry.texcoords ? geometry : null;
		this.chosen = null;
		this.overlaps = null;
		this.loadPicture();
		if (this.geometry) this.makePaths();
		this.fit();
	}

	// ---- the image below ----

	get opacity() { return this.fill ?? (this.image ? 0.3 : 1); }

	get shown() { return this.picture; }
	set shown(picture) {
		if (picture === this.picture) return;
		this.picture = picture;
		this.loadPicture();
	}

	// A file may be missing, or of a format that the browser does not know: then `missing` is its name.
	loadPicture() {
		const picture = this.geometry && this.mesh.pictures[this.picture], source = picture?.source || picture?.file;
		this.image = this.missing = this.loading = null;
		this.overlaps = null;
		if (source) {
			const image = this.loading = new Image();
			const done = (loaded, missing) => {
				if (this.loading !== image) return;
				Object.assign(this, {image: loaded, missing, overlaps: null});
				this.onpicture?.();
				this.draw();
			};
			image.onload = () => done(image, null);
			image.onerror = () => done(null, picture.file ? decodeURIComponent(picture.file) : 'the image');
			image.src = source;
		}
		this.onpicture?.();
		this.draw();
	}

	// ---- paths ----

	makePaths() {
		const g = this.geometry, uv = g.texcoords, drawn = g.regions.filter(r => !r.buried);
		// beyond some thousand islands some of one winding are one path: fewer calls, the same picture but where they overlap
		const many = drawn.length > 4000 ? 64 : 1;
		this.shapes = [false, true].flatMap(mirrored => {
			const loops = drawn.filter(r => r.mirrored === mirrored).map(r => r.loops), shapes = [];
			for (let i = 0; i < loops.length; i += many) shapes.push({mirrored, path: outlinePath(uv, loops.slice(i, i + many).flat())});
			return shapes;
		});
		Object.assign(this, uvBox(g));
		this.seams = g.seams.map(edges => [0, 1].map(side => {
			const path = new Path2D();
			let last = -1;
			for (let i = 0; i < edges.length; i += 4) {
				const [a, b] = [edges[i + 2 * side], edges[i + 2 * side + 1]];
				if (a !== last) path.moveTo(uv[2 * a], uv[2 * a + 1]);
				path.lineTo(uv[2 * b], uv[2 * b + 1]);
				last = b;
			}
			const middle = edges[4 * (edges.length >> 3) + 2 * side];
			return {path, at: edges.length ? [uv[2 * middle], uv[2 * middle + 1]] : null};
		}));
		// long seams are labelled first
		this.labelled = this.seams.map((_, i) => i).sort((a, b) => g.seams[b].length - g.seams[a].length || a - b);
	}

	// ---- where things are ----

	x(u) { return (u - this.view.u) * this.view.scale + this.width / 2; }
	y(v) { return (v - this.view.v) * this.view.scale + this.height / 2; }
	u(x) { return (x - this.width / 2) / this.view.scale + this.view.u; }
	v(y) { return (y - this.height / 2) / this.view.scale + this.view.v; }
	get width() { return this.canvas.clientWidth; }
	get height() { return this.canvas.clientHeight; }

	fitBox(low, high, margin) {
		const size = [0, 1].map(i => Math.max(high[i] - low[i], 1e-6));
		this.view = {u: (low[0] + high[0]) / 2, v: (low[1] + high[1]) / 2,
			scale: clamp(margin * Math.min(this.width / size[0], this.height / size[1]), 1e-3, 4e5)};
		this.draw();
	}

	fit() {
		this.fitted = true;
		if (this.geometry) this.fitBox(this.low, this.high, 0.88);
		else this.draw();
	}

	// ---- what is chosen ----

	choose(triangles, seams) {
		const g = this.geometry;
		this.chosen = null;
		if (g && (triangles.length || seams.length)) {
			const path = new Path2D(), uv = g.texcoords, low = [Infinity, Infinity], high = [-Infinity, -Infinity];
			for (const t of triangles) for (let k = 0; k < 3; k++) {
				const v = 2 * g.indices[3 * t + k];
				for (let i = 0; i < 2; i++) {
					low[i] = Math.min(low[i], uv[v + i]);
					high[i] = Math.max(high[i], uv[v + i]);
				}
			}
			const island = triangles.length ? g.islands[triangles[0]] : 0;
			const islandWhole = triangles.length > 1 && island && triangles.every(t => g.islands[t] === island) &&
				g.islands.reduce((n, i) => n + (i === island), 0) === triangles.length;
			const paths = islandWhole ? [outlinePath(uv, g.regions.filter(r => r.island === island - 1).flatMap(r => r.loops))] : [];
			if (!islandWhole && !seams.length) {
				for (const t of triangles) {
					for (let k = 0; k < 3; k++) {
						const v = 2 * g.indices[3 * t + k];
						if (k) path.lineTo(uv[v], uv[v + 1]); else path.moveTo(uv[v], uv[v + 1]);
					}
					path.closePath();
				}
				paths.push(path);
			}
			this.chosen = {paths, seams, low, high};
		}
		this.draw();
	}

	// Shows what is chosen, with its surroundings.
	focus() {
		if (this.votes) {
			const [low, high] = mapBox(this.imageMap(), [0, 0], [1, 1]);
			this.fitted = false;
			this.fitBox(low, high, 0.9);
			return;
		}
		if (!this.chosen || !(this.chosen.low[0] <= this.chosen.high[0])) return;
		const {low, high} = this.chosen, extent = Math.max(this.high[0] - this.low[0], this.high[1] - this.low[1]);
		const size = Math.max(high[0] - low[0], high[1] - low[1]), room = Math.max(0.004 * extent, size > 0.1 * extent ? 0.35 * size : size);
		if (size > 0.55 * extent) { this.fit(); return; }
		this.fitted = false;
		this.fitBox(low.map(x => x - room), high.map(x => x + room), 0.95);
	}

	// ---- drawing ----

	draw() {
		if (this.pending) return;
		this.pending = true;
		requestAnimationFrame(() => { this.pending = false; this.drawNow(); });
	}

	toTexture(c) {
		const {scale} = this.view, ratio = this.ratio;
		c.setTransform(ratio * scale, 0, 0, ratio * scale, ratio * this.x(0), ratio * this.y(0));
	}

	toPage(c) { c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0); }

	hatch(colour) {
		const tile = document.createElement('canvas'), size = 8 * this.ratio;
		tile.width = tile.height = size;
		const c = tile.getContext('2d');
		c.strokeStyle = colour;
		c.lineWidth = 1.5 * this.ratio;
		c.beginPath();
		for (const d of [-size, 0, size]) { c.moveTo(d, size); c.lineTo(d + size, 0); }
		c.stroke();
		return this.context.createPattern(tile, 'repeat');
	}

	drawTexture(c) {
		const low = [this.u(0), this.v(0)].map(Math.floor), high = [this.u(this.width), this.v(this.height)].map(Math.ceil);
		const m = this.mesh.pictures[this.picture]?.map;
		if (!this.image || (high[0] - low[0]) * (high[1] - low[1]) > 64) return;
		c.save();
		c.globalAlpha = 0.85;
		const plain = m.join() === '1,0,0,0,1,0';
		if (plain) {
			this.toTexture(c);
			for (let u = low[0]; u < high[0]; u++) for (let v = low[1]; v < high[1]; v++)
				if (u < Math.max(1, this.high[0]) && u + 1 > this.low[0] && v < Math.max(1, this.high[1]) && v + 1 > this.low[1])
					c.drawImage(this.image, u, v, 1, 1);
		} else { // the image lies where the transform puts it, and repeats
			const pattern = c.createPattern(this.image, 'repeat'), to = new DOMMatrix([m[0], m[3], m[1], m[4], m[2], m[5]]);
			this.toTexture(c);
			pattern.setTransform(to.inverse().scale(1 / this.image.width, 1 / this.image.height));
			c.fillStyle = pattern;
			c.fillRect(this.u(0), this.v(0), this.u(this.width) - this.u(0), this.v(this.height) - this.v(0));
		}
		c.restore();
	}

	drawGrid(c) {
		const {scale} = this.view, low = [this.u(0), this.v(0)], high = [this.u(this.width), this.v(this.height)];
		this.toPage(c);
		const lines = (step, colour) => {
			if (step * scale < 14) return;
			c.strokeStyle = colour;
			c.lineWidth = 1;
			c.beginPath();
			for (let u = Math.ceil(low[0] / step); u * step <= high[0]; u++) { const x = Math.round(this.x(u * step)) + 0.5; c.moveTo(x, 0); c.lineTo(x, this.height); }
			for (let v = Math.ceil(low[1] / step); v * step <= high[1]; v++) { const y = Math.round(this.y(v * step)) + 0.5; c.moveTo(0, y); c.lineTo(this.width, y); }
			c.stroke();
		};
		lines(1 / 8, ink('grid-faint'));
		lines(1, ink('grid'));
		this.toTexture(c);
		c.lineWidth = 1.5 / scale;
		c.strokeStyle = ink('soft');
		c.strokeRect(0, 0, 1, 1);
	}

	// UDIM numbers: 1001 + u + 10 v, v counted upwards from the tile of the image.
	drawTiles(c, taken) {
		const {scale} = this.view;
		if (scale < 46) return;
		this.toPage(c);
		c.font = '600 11px ' + fontFamily();
		c.textBaseline = 'bottom';
		c.textAlign = 'left';
		const [low, high] = [[0, 1].map(i => Math.min(0, Math.floor(this.low[i] + 1e-4))), [0, 1].map(i => Math.max(1, Math.ceil(this.high[i] - 1e-4)))];
		for (let u = Math.max(low[0], Math.floor(this.u(0))); u < Math.min(high[0], this.u(this.width)); u++)
			for (let v = Math.max(low[1], Math.floor(this.v(0))); v < Math.min(high[1], this.v(this.height)); v++) {
				const up = -v, name = u >= 0 && u <= 9 && up >= 0 ? String(1001 + u + 10 * up) : u + ', ' + up;
				const x = Math.max(this.x(u), 0) + 6, y = Math.min(this.y(v + 1), this.height) - 4, wide = c.measureText(name).width;
				if (x + wide > Math.min(this.x(u + 1), this.width) || y - 14 < Math.max(this.y(v), 0)) continue;
				c.fillStyle = ink('soft');
				c.fillText(name, x, y);
				taken.push([x - 2, y - 14, x + wide + 2, y + 2]);
			}
	}

	drawShapes(c) {
		const {scale} = this.view, pattern = this.hatch(ink('mirrored-line', 0.6));
		pattern.setTransform(new DOMMatrix().scale(1 / (scale * this.ratio)));
		this.toTexture(c);
		c.lineJoin = c.lineCap = 'round';
		for (const shape of this.opacity ? this.shapes : []) {
			c.globalAlpha = this.opacity;
			c.fillStyle = shape.mirrored ? ink('mirrored', 0.4) : ink('plain', 0.4);
			c.fill(shape.path, 'nonzero');
			c.globalAlpha = Math.sqrt(this.opacity); // lines hide less than areas
			if (shape.mirrored) { c.fillStyle = pattern; c.fill(shape.path, 'nonzero'); }
		}
		c.globalAlpha = 1;
		c.lineWidth = (this.geometry.regions.length > 600 ? 0.6 : 1.1) / scale;
		for (const shape of this.shapes) {
			c.strokeStyle = shape.mirrored ? ink('mirrored-line') : ink('plain-line');
			c.stroke(shape.path);
		}
	}

	// The place of the normal map: its repetition in the middle of the mesh.
	imageMap() {
		const {map} = this.mesh, [low, high] = mapBox(map, this.low, this.high);
		return mapAfter(mapBack(map), [1, 0, Math.floor((low[0] + high[0]) / 2), 0, 1, Math.floor((low[1] + high[1]) / 2)]);
	}

	// Which blocks of the normal map say that green points up, and which down, as far as they are sure.
	drawVotes(c) {
		const rows = this.votes, side = rows.length, m = this.imageMap(), {scale} = this.view;
		this.toTexture(c);
		c.transform(m[0], m[3], m[1], m[4], m[2], m[5]);
		const each = draw => rows.forEach((row, r) => row.forEach((vote, k) => { if (Math.abs(vote) >= LEAST_VOTE) draw(vote, k / side, r / side); }));
		each((vote, u, v) => {
			c.fillStyle = vote > 0 ? '#1d9a4b' : '#d43c9c';
			c.globalAlpha = 0.25 + 0.5 * Math.abs(vote) / 100;
			c.fillRect(u, v, 1 / side, 1 / side);
		});
		c.globalAlpha = 1;
		if (Math.sqrt(Math.abs(determinant(m))) * scale / side < 14) return;
		this.toPage(c);
		c.font = '600 12px ' + fontFamily();
		c.textAlign = 'center';
		c.textBaseline = 'middle';
		c.fillStyle = '#ffffff';
		each((vote, u, v) => {
			const x = u + 0.5 / side, y = v + 0.5 / side;
			c.fillText(vote > 0 ? '▲' : '▼', this.x(m[0] * x + m[1] * y + m[2]), this.y(m[3] * x + m[4] * y + m[5]));
		});
	}

	// The triangles themselves, once they are large enough to be picked.
	drawTriangles(c) {
		const g = this.geometry, uv = g.texcoords, {scale} = this.view, area = (this.high[0] - this.low[0]) * (this.high[1] - this.low[1]);
		if (area * scale * scale / g.triangles < 120) return;
		const [u0, v0, u1, v1] = [this.u(0), this.v(0), this.u(this.width), this.v(this.height)], path = new Path2D();
		for (let t = 0; t < g.triangles; t++) {
			const [a, b, d] = [0, 1, 2].map(k => 2 * g.indices[3 * t + k]);
			if (Math.max(uv[a], uv[b], uv[d]) < u0 || Math.min(uv[a], uv[b], uv[d]) > u1 ||
				Math.max(uv[a + 1], uv[b + 1], uv[d + 1]) < v0 || Math.min(uv[a + 1], uv[b + 1], uv[d + 1]) > v1) continue;
			path.moveTo(uv[a], uv[a + 1]);
			path.lineTo(uv[b], uv[b + 1]);
			path.lineTo(uv[d], uv[d + 1]);
			path.closePath();
		}
		this.toTexture(c);
		c.strokeStyle = ink('wire');
		c.lineWidth = 0.6 / scale;
		c.stroke(path);
	}

	drawChosen(c) {
		const {scale} = this.view;
		this.toTexture(c);
		for (const path of this.chosen?.paths || []) {
			c.fillStyle = ink('chosen', 0.69);
			c.fill(path, 'nonzero');
			c.strokeStyle = ink('chosen-line');
			c.lineWidth = 2.2 / scale;
			c.stroke(path);
		}
		// what is too small to be seen is pointed at
		if (!this.chosen || !(Math.max(this.chosen.high[0] - this.chosen.low[0], this.chosen.high[1] - this.chosen.low[1]) * scale < 12)) return;
		this.toPage(c);
		c.beginPath();
		c.arc(this.x((this.chosen.low[0] + this.chosen.high[0]) / 2), this.y((this.chosen.low[1] + this.chosen.high[1]) / 2), 13, 0, 7);
		c.lineWidth = 2.5;
		c.strokeStyle = ink('chosen-line');
		c.stroke();
	}

	drawSeams(c) {
		const {scale} = this.view, chosen = new Set(this.chosen?.seams || []);
		this.toTexture(c);
		c.lineJoin = c.lineCap = 'round';
		for (const pass of [0, 1]) this.seams.forEach((sides, i) => sides.forEach(({path}) => {
			const wide = chosen.has(i) ? 4.5 : 2.6;
			c.lineWidth = (pass ? wide : wide + 4) / scale;
			c.strokeStyle = !pass ? ink('chosen-line') : chosen.has(i) ? ink('chosen') : i < this.geometry.firstHard ? ink('seam') : ink('hard');
			if (!pass && !chosen.has(i)) return;
			c.stroke(path);
		}));
	}

	drawLabels(c, taken) {
		const chosen = new Set(this.chosen?.seams || []);
		const order = [...chosen, ...this.labelled.filter(i => !chosen.has(i))];
		this.labels = [];
		this.toPage(c);
		c.font = '600 11px ' + fontFamily();
		c.textAlign = 'center';
		c.textBaseline = 'middle';
		for (const i of order.slice(0, 3000)) for (const {at} of this.seams[i] || []) {
			if (!at) continue;
			const text = String(i), x = this.x(at[0]), y = this.y(at[1]) - 14, half = c.measureText(text).width / 2 + 6;
			if (x < -half || y < -9 || x > this.width + half || y > this.height + 9) continue;
			const box = [x - half, y - 9, x + half, y + 9];
			if (taken.some(b => box[0] < b[2] + 2 && box[2] > b[0] - 2 && box[1] < b[3] + 2 && box[3] > b[1] - 2)) continue;
			taken.push(box);
			this.labels.push({seam: i, box});
			c.beginPath();
			c.roundRect(box[0], box[1], 2 * half, 18, 9);
			c.fillStyle = chosen.has(i) ? ink('chosen') : ink('label');
			c.fill();
			c.fillStyle = chosen.has(i) ? '#16181d' : ink('label-text');
			c.fillText(text, x, y + 0.5);
		}
	}

	// Marks places where two triangles lie on each other, as the sampler repeats them, once the picture rests.
	drawOverlaps(c) {
		const {u, v, scale} = this.view, key = [u, v, scale, this.width, this.height].join();
		if (!this.showOverlaps || !this.oncoverage) return;
		if (this.overlaps?.key === key) {
			this.toPage(c);
			c.globalAlpha = Math.sqrt(this.opacity);
			c.drawImage(this.overlaps.canvas, 0, 0, this.width, this.height);
			c.globalAlpha = 1;
			return;
		}
		clearTimeout(this.timer);
		this.timer = setTimeout(() => this.findOverlaps(key), 80);
	}

	findOverlaps(key) {
		const w = Math.round(this.width), h = Math.round(this.height);
		const found = this.geometry && this.oncoverage([this.u(0), this.v(0)], [this.u(w), this.v(h)], w, h);
		if (!found) return;
		const {pixels, repeated} = found;
		const [r, g, b] = colourOf('twice');
		this.overlapPixels = 0;
		for (let i = 0; i < pixels.length; i += 4) {
			const twice = pixels[i] > 32 && pixels[i + 3] > 96;
			this.overlapPixels += twice;
			pixels[i] = r;
			pixels[i + 1] = g;
			pixels[i + 2] = b;
			pixels[i + 3] = twice ? 95 : 0;
		}
		const canvas = document.createElement('canvas');
		canvas.width = w;
		canvas.height = h;
		canvas.getContext('2d').putImageData(new ImageData(pixels, w, h), 0, 0);
		this.overlaps = {key, canvas, repeated};
		this.onoverlaps?.(repeated);
		this.draw();
	}

	drawNow() {
		const canvas = this.canvas, c = this.context;
		this.ratio = window.devicePixelRatio || 1;
		const w = Math.max(1, Math.round(canvas.clientWidth * this.ratio)), h = Math.max(1, Math.round(canvas.clientHeight * this.ratio));
		if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
		c.setTransform(1, 0, 0, 1, 0, 0);
		c.fillStyle = ink('stage');
		c.fillRect(0, 0, w, h);
		if (!this.geometry) return;
		const taken = [];
		this.drawTexture(c);
		this.drawGrid(c);
		this.drawShapes(c);
		this.drawOverlaps(c);
		if (this.votes) this.drawVotes(c);
		this.drawTriangles(c);
		this.drawChosen(c);
		this.drawSeams(c);
		this.drawTiles(c, taken);
		this.drawLabels(c, taken);
		this.ondraw?.();
	}

	// ---- moving and picking ----

	pan(dx, dy) {
		this.fitted = false;
		this.view.u -= dx / this.view.scale;
		this.view.v -= dy / this.view.scale;
		this.draw();
	}

	zoom(factor, x = this.width / 2, y = this.height / 2) {
		const u = this.u(x), v = this.v(y);
		this.fitted = false;
		this.view.scale = clamp(this.view.scale * factor, 1e-3, 4e5);
		this.view.u = u - (x - this.width / 2) / this.view.scale;
		this.view.v = v - (y - this.height / 2) / this.view.scale;
		this.draw();
	}

	// The seam within some pixels of a place, -1: none.
	seamAt(x, y) {
		const g = this.geometry, uv = g.texcoords, label = (this.labels || []).find(({box}) => x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3]);
		if (label) return label.seam;
		let nearest = 6, found = -1;
		g.seams.forEach((edges, seam) => {
			for (let i = 0; i < edges.length; i += 2) {
				const ax = this.x(uv[2 * edges[i]]), ay = this.y(uv[2 * edges[i] + 1]), bx = this.x(uv[2 * edges[i + 1]]), by = this.y(uv[2 * edges[i + 1] + 1]);
				const l = (bx - ax) ** 2 + (by - ay) ** 2, t = l ? clamp(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / l, 0, 1) : 0;
				const d = Math.hypot(ax + t * (bx - ax) - x, ay + t * (by - ay) - y);
				if (d < nearest) { nearest = d; found = seam; }
			}
		});
		return found;
	}

	listen() {
		trackPointers(this.canvas, {
			drag: (dx, dy) => this.pan(dx, dy),
			zoom: (factor, x, y, dx, dy) => { this.zoom(factor, x, y); if (dx || dy) this.pan(dx, dy); },
			hover: (x, y) => this.onhover?.(this.u(x), this.v(y)),
			leave: () => this.onhover?.(null),
			click: (x, y, again) => {
				if (!this.geometry) return;
				const seam = this.seamAt(x, y);
				if (seam >= 0) this.onseam?.(seam);
				else this.onpick?.(triangleAtTexcoord(this.geometry, this.u(x), this.v(y)), again);
			},
			arrow: (x, y) => this.pan(60 * x, 60 * y),
			home: () => this.fit(),
		});
	}
}
