// SPDX-License-Identifier: MIT
//
// make_tile.mjs DIR: the asset of data/signs.png: tile.obj, tile.mtl and tile_normal.png.
//
// A domed tile with a raised rim (both are geometry) and letters and studs that are in the normal map alone,
// made from a height field: whoever gets the tangent frames wrong shows them as dents.
import {writeFileSync} from 'node:fs';
import {deflateSync} from 'node:zlib';

const dir = process.argv[2];

// ---- the height field, on the unit square, y up

const polyline = (...points) => points.slice(1).map((b, i) => [...points[i], ...b]);
const arc = (x, y, r, from, to) => polyline(...Array.from({length: 13}, (_, i) => {
	const a = (from + (to - from) * i / 12) * Math.PI / 180;
	return [x + r * Math.cos(a), y + r * Math.sin(a)];
}));

// Letters as strokes; the x-height is 1.
const arch = (x, r) => [...arc(x + r, 1 - r, r, 180, 0), ...polyline([x + 2 * r, 1 - r], [x + 2 * r, 0])];
const n = x => [...polyline([x, 1], [x, 0]), ...arch(x, 0.4)];
const m = x => [...polyline([x, 1], [x, 0]), ...arch(x, 0.38), ...arch(x + 0.76, 0.38)];
const t = x => [...polyline([x + 0.24, 1.42], [x + 0.24, 0.22]), ...arc(x + 0.46, 0.22, 0.22, 180, 280),
	...polyline([x - 0.06, 1], [x + 0.62, 1])];
const a = x => [...polyline([x + 0.8, 1], [x + 0.8, 0]), ...arc(x + 0.4, 0.6, 0.4, 0, 180),
	...polyline([x, 0.6], [x, 0.4]), ...arc(x + 0.4, 0.4, 0.4, 180, 360)];
const word = [...n(0), ...m(1.5), ...t(3.62), ...a(4.8), ...n(6.3)];
const width = 7.1, scale = 0.7 / width;
const strokes = word.map(([x0, y0, x1, y1]) => [x0, y0, x1, y1].map((c, i) =>
	i % 2 ? 0.5 + (c - 0.6) * scale : 0.5 + (c - width / 2) * scale));

const studs = [];
for (let i = 0; i < 7; i++)
	for (const y of [0.22, 0.78]) studs.push([0.5 + (i - 3) * 0.11, y, 0.034]);

function distance(x, y, [x0, y0, x1, y1]) {
	const dx = x1 - x0, dy = y1 - y0;
	const k = Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy)));
	return Math.hypot(x - x0 - k * dx, y - y0 - k * dy);
}

function height(x, y) {
	let h = 0;
	const r = 0.023;
	if (Math.abs(y - 0.5) < 0.2) {
		const d = Math.min(...strokes.map(s => distance(x, y, s)));
		if (d < r) h = Math.max(h, 0.55 * Math.sqrt(r * r - d * d));
	}
	for (const [sx, sy, sr] of studs) {
		const d = Math.hypot(x - sx, y - sy);
		if (d < sr) h = Math.max(h, 0.75 * Math.sqrt(sr * sr - d * d));
	}
	return h;
}

// ---- the normal map: red along u, green up

const size = 1024, heights = new Float64Array(size * size);
for (let row = 0; row < size; row++)
	for (let column = 0; column < size; column++)
		heights[row * size + column] = height((column + 0.5) / size, 1 - (row + 0.5) / size);
const at = (row, column) => heights[Math.min(size - 1, Math.max(0, row)) * size + Math.min(size - 1, Math.max(0, column))];

const raw = Buffer.alloc(size * (3 * size + 1));
for (let row = 0, o = 0; row < size; row++) {
	o++;
	for (let column = 0; column < size; column++) {
		const gx = (at(row, column + 1) - at(row, column - 1)) * size / 2;
		const gy = (at(row - 1, column) - at(row + 1, column)) * size / 2;
		const most = Math.min(1, 1.6 / Math.hypot(gx, gy, 1e-9)); // the foot of a round stroke is a wall
		const nx = -gx * most, ny = -gy * most, length = Math.hypot(nx, ny, 1);
		for (const c of [nx, ny, 1]) raw[o++] = Math.round(127.5 + 127.5 * c / length);
	}
}
function crc32(bytes) {
	let c = ~0;
	for (const byte of bytes) {
		c ^= byte;
		for (let k = 0; k < 8; k++) c = c >>> 1 ^ (c & 1 ? 0xedb88320 : 0);
	}
	return ~c >>> 0;
}
function chunk(kind, body) {
	const part = Buffer.concat([Buffer.from(kind), body]), out = Buffer.alloc(part.length + 8);
	out.writeUInt32BE(body.length, 0);
	part.copy(out, 4);
	out.writeUInt32BE(crc32(part), part.length + 4);
	return out;
}
const head = Buffer.alloc(13);
head.writeUInt32BE(size, 0);
head.writeUInt32BE(size, 4);
head.set([8, 2, 0, 0, 0], 8);
writeFileSync(`${dir}/tile_normal.png`, Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'),
	chunk('IHDR', head), chunk('IDAT', deflateSync(raw, {level: 9})), chunk('IEND', Buffer.alloc(0))]));

// ---- the mesh: a square grid in (s, t) pushed into a domed tile with rounded corners, textured from the front

const cells = 192, lines = ['mtllib tile.mtl', 'o tile', 'usemtl glaze', 's 1'];
// Squares become curves of |x|^6 + |y|^6 = q^6; the height is a dome, a rim at q = 0.9 and a rounded edge.
function place(s, t) {
	const q = Math.max(Math.abs(s), Math.abs(t)), corner = 6;
	const round = q === 0 ? 0 : q / Math.pow(Math.pow(Math.abs(s), corner) + Math.pow(Math.abs(t), corner), 1 / corner);
	const x = s * round, y = t * round;
	let z = 0.15 * (1 - (x * x + y * y) / 2);
	const rim = (q - 0.9) / 0.055;
	if (Math.abs(rim) < 1) z += 0.055 * Math.pow(Math.cos(rim * Math.PI / 2), 2);
	const edge = (q - 0.93) / 0.07;
	if (edge > 0) z -= 0.2 * (1 - Math.sqrt(Math.max(0, 1 - edge * edge)));
	return [x, y, z];
}
const step = i => 2 * i / cells - 1;
for (let j = 0; j <= cells; j++)
	for (let i = 0; i <= cells; i++) {
		const s = step(i), t = step(j), e = 1e-4;
		const p = place(s, t);
		const [sa, sb, ta, tb] = [place(s - e, t), place(s + e, t), place(s, t - e), place(s, t + e)];
		const u = sb.map((c, k) => c - sa[k]), v = tb.map((c, k) => c - ta[k]);
		const N = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
		const l = Math.hypot(...N);
		lines.push('v ' + p.map(c => c.toFixed(6)).join(' '), `vt ${((p[0] + 1) / 2).toFixed(6)} ${((p[1] + 1) / 2).toFixed(6)}`,
			'vn ' + N.map(c => (c / l).toFixed(6)).join(' '));
	}
for (let j = 0; j < cells; j++)
	for (let i = 0; i < cells; i++) {
		const c = j * (cells + 1) + i + 1;
		lines.push('f ' + [c, c + 1, c + cells + 2, c + cells + 1].map(k => `${k}/${k}/${k}`).join(' '));
	}
writeFileSync(`${dir}/tile.obj`, lines.join('\n') + '\n');
writeFileSync(`${dir}/tile.mtl`, 'newmtl glaze\nKd 0.1 0.35 0.4\nPr 0.35\nPm 0\nnorm tile_normal.png\n');
