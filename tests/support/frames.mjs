// SPDX-License-Identifier: MIT
//
// answer.mjs frames FILE...: reads the tangents of .glb and .gltf files by itself and counts what a renderer would see,
// one line a file. Nothing of nmtan takes part, and w is held against the exact determinant of the stored texture
// coordinates (V points down, so that w is +1 where it is negative).
//
//   corners   of triangles with TANGENT, NORMAL and texture coordinates
//   degree    more than one degree off perpendicular to the stored normal, made unit
//   lean      more than 2^-10 (and what a normal within 2^-11 of unit length adds); with integer tangents their step
//   unit      length off by more than 2e-6, integers and what an exponential filter gives: 0.00674
//   w         w neither 1 nor -1
//   mixed     triangles with two values of w
//   wrong     triangles with one, but not that of their orientation
import { open, packing } from './gltf.mjs';

const widths = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const readers = { 5120: ['readInt8', 1, 127], 5121: ['readUInt8', 1, 255], 5122: ['readInt16LE', 2, 32767],
	5123: ['readUInt16LE', 2, 65535], 5125: ['readUInt32LE', 4, 1], 5126: ['readFloatLE', 4, 1] };

// All components of an accessor in one array; null where it is sparse.
function values(file, number) {
	const accessor = file.g.accessors[number], view = file.g.bufferViews?.[accessor.bufferView];
	if (accessor.sparse || !view)
		return null;
	const [method, size, most] = readers[accessor.componentType], width = widths[accessor.type];
	const data = file.bytes[view.buffer], stride = view.byteStride ?? width * size;
	const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0), out = new Float64Array(accessor.count * width);
	const scale = accessor.normalized ? most : 1;
	for (let row = 0, to = 0; row < accessor.count; row++)
		for (let k = 0; k < width; k++)
			out[to++] = Math.max(data[method](start + row * stride + k * size) / scale, accessor.normalized ? -1 : -Infinity);
	return out;
}

// A float as an integer times 2^-149.
const bits = new DataView(new ArrayBuffer(4));
function integer(x) {
	bits.setFloat32(0, x);
	const b = bits.getUint32(0), exponent = b >>> 23 & 255, fraction = b & 0x7fffff;
	const size = exponent ? BigInt(fraction | 0x800000) << BigInt(exponent - 1) : BigInt(fraction);
	return b >>> 31 ? -size : size;
}

// The sign of (b - a) x (c - a): by doubles where they are beyond doubt, else by integers.
function orientation(uv, a, b, c) {
	const p = (uv[2 * b] - uv[2 * a]) * (uv[2 * c + 1] - uv[2 * a + 1]);
	const q = (uv[2 * b + 1] - uv[2 * a + 1]) * (uv[2 * c] - uv[2 * a]);
	if (!Number.isFinite(p - q))
		return 0;
	if (Math.abs(p - q) > 1e-14 * (Math.abs(p) + Math.abs(q)) && Math.abs(p - q) > 1e-290)
		return Math.sign(p - q);
	const [ax, ay, bx, by, cx, cy] = [a, b, c].flatMap((i) => [integer(uv[2 * i]), integer(uv[2 * i + 1])]);
	const d = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
	return d > 0n ? 1 : d < 0n ? -1 : 0;
}

function dot(a, i, b, j) {
	return a[i] * b[j] + a[i + 1] * b[j + 1] + a[i + 2] * b[j + 2];
}

// The set of texture coordinates that the tangents are for; null where a transform moves them.
function texcoordSet(g, primitive) {
	const texture = g.materials?.[primitive.material]?.normalTexture;
	return texture?.extensions?.KHR_texture_transform ? null : texture?.texCoord ?? 0;
}

function countPrimitive(file, primitive, n) {
	const a = primitive.attributes, set = texcoordSet(file.g, primitive);
	if (a.TANGENT === undefined || a.NORMAL === undefined || (primitive.mode ?? 4) !== 4 || primitive.extensions?.KHR_draco_mesh_compression)
		return;
	const T = values(file, a.TANGENT), N = values(file, a.NORMAL);
	const uv = set !== null && a[`TEXCOORD_${set}`] !== undefined ? values(file, a[`TEXCOORD_${set}`]) : null;
	if (!T || !N)
		return;
	const filter = packing(file.g.bufferViews[file.g.accessors[a.TANGENT].bufferView])?.filter;
	const unit = filter === 'EXPONENTIAL' ? 0.00674 : 2e-6;
	const type = file.g.accessors[a.TANGENT].componentType, step = type === 5126 ? 0 : 1 / readers[type][2];
	const indices = primitive.indices === undefined ? Uint32Array.from({ length: N.length / 3 }, (_, i) => i) : values(file, primitive.indices);
	for (const v of indices) {
		const square = dot(T, 4 * v, T, 4 * v), normal = dot(N, 3 * v, N, 3 * v);
		n.corners++;
		n.unit += !(Math.abs(Math.sqrt(square) - 1) <= (step ? 0.00674 : unit));
		n.w += Math.abs(T[4 * v + 3]) !== 1;
		if (!(normal > 0))
			continue;
		const along = Math.abs(dot(T, 4 * v, N, 3 * v)) / Math.sqrt(square * normal);
		n.degree += !(along <= Math.sin(Math.PI / 180));
		n.lean += !(along <= 2 ** -10 * (1 + 2 ** -10) + 0.9 * step);
	}
	for (let t = 0; t + 2 < indices.length; t += 3) {
		const [i, j, k] = [indices[t], indices[t + 1], indices[t + 2]], w = T[4 * i + 3];
		const mixed = w !== T[4 * j + 3] || w !== T[4 * k + 3], sign = uv ? -orientation(uv, i, j, k) : 0;
		n.mixed += mixed;
		n.wrong += !mixed && sign !== 0 && w !== sign;
	}
}

export default function answer(paths, say) {
	for (const path of paths) {
		const file = open(path), n = { corners: 0, degree: 0, lean: 0, unit: 0, w: 0, mixed: 0, wrong: 0 };
		for (const mesh of file.g.meshes ?? [])
			for (const primitive of mesh.primitives)
				countPrimitive(file, primitive, n);
		say(Object.entries(n).map(([name, count]) => `${name} ${count}`).join(' '));
	}
	return true;
}
