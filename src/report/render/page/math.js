// SPDX-License-Identifier: MIT
//
// Vectors of three and column-major matrices of sixteen numbers.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, k) => [a[0] * k, a[1] * k, a[2] * k];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const length = a => Math.hypot(a[0], a[1], a[2]);
const unit = a => times(a, 1 / (length(a) || 1));
const clamp = (x, low, high) => Math.max(low, Math.min(high, x));

// The axes of a camera that looks from `eye` to `target`: right, up, back.
function axesOf(eye, target) {
	const back = unit(sub(eye, target)), right = unit(cross([0, 1, 0], back));
	return [right, cross(back, right), back];
}

function lookAt(eye, target) {
	const [x, y, z] = axesOf(eye, target);
	return [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, eye), -dot(y, eye), -dot(z, eye), 1];
}

// half: half the height of what is seen at distance 1
function perspective(half, aspect, near, far) {
	const f = 1 / half;
	return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
}

// The map that is `second` after `first`, both as data.js has maps of texture coordinates; and the one back.
function mapAfter(second, first) {
	const [a, b, c, d, e, f] = second, [g, h, i, j, k, l] = first;
	return [a * g + b * j, a * h + b * k, a * i + b * l + c, d * g + e * j, d * h + e * k, d * i + e * l + f];
}

function mapBack(m) {
	const [a, b, c, d, e, f] = m, s = determinant(m);
	return [e / s, -b / s, (b * f - c * e) / s, -d / s, a / s, (c * d - a * f) / s];
}

// The box around a box that a map moves: [low, high].
function mapBox(m, low, high) {
	const corners = [low, high].flatMap(p => [low, high].map(q => [m[0] * p[0] + m[1] * q[1] + m[2], m[3] * p[0] + m[4] * q[1] + m[5]]));
	return [Math.min, Math.max].map(f => [0, 1].map(i => f(...corners.map(c => c[i]))));
}

function multiply(a, b) {
	const c = new Array(16).fill(0);
	for (let i = 0; i < 4; i++) for (let k = 0; k < 4; k++) for (let j = 0; j < 4; j++)
		c[4 * i + k] += a[4 * j + k] * b[4 * i + j];
	return c;
}
