// SPDX-License-Identifier: MIT
//
// Bundled by clients.mjs and opened in a browser: three.js draws a normal-mapped torus knot with tangents of its own
// module and of ours. window.result is {painted, differ, equal}: pixels that are not background, pixels that differ,
// and whether the tangents have the same bytes.
import * as three from 'three';
import { computeMikkTSpaceTangents } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import * as theirs from 'three/examples/jsm/libs/mikktspace.module.js';
import * as nmtan from 'nmtan';

const SIZE = 256;

// Bumps in rows and columns, with a slope of up to 0.5.
function bumps() {
	const side = 64, bytes = new Uint8Array(4 * side * side);
	for (let y = 0; y < side; y++)
		for (let x = 0; x < side; x++) {
			const n = new three.Vector3(0.5 * Math.sin(x / 2), 0.5 * Math.sin(y / 3), 1).normalize();
			bytes.set([n.x, n.y, n.z, 1].map((c) => Math.round(127.5 + 127.5 * c)), 4 * (y * side + x));
		}
	const texture = new three.DataTexture(bytes, side, side);
	texture.wrapS = texture.wrapT = three.RepeatWrapping;
	texture.needsUpdate = true;
	return texture;
}

function draw(geometry) {
	const renderer = new three.WebGLRenderer({preserveDrawingBuffer: true});
	renderer.setSize(SIZE, SIZE);
	const scene = new three.Scene(), camera = new three.PerspectiveCamera(40, 1, 0.1, 10);
	camera.position.z = 5;
	const light = new three.DirectionalLight(0xffffff, 3);
	light.position.set(1, 2, 3);
	const material = new three.MeshStandardMaterial({normalMap: bumps()});
	scene.add(new three.Mesh(geometry, material), light);
	renderer.render(scene, camera);
	const gl = renderer.getContext(), pixels = new Uint8Array(4 * SIZE * SIZE);
	gl.readPixels(0, 0, SIZE, SIZE, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
	return pixels;
}

async function main() {
	await nmtan.ready;
	const knot = () => new three.TorusKnotGeometry(1, 0.35, 96, 24); // each its own: the function changes it
	const both = [theirs, nmtan].map((module) => computeMikkTSpaceTangents(knot(), module));
	const [a, b] = both.map((geometry) => geometry.attributes.tangent.array);
	const [p, q] = both.map(draw);
	let painted = 0, differ = 0;
	for (let i = 0; i < p.length; i += 4) {
		painted += p[i] + p[i + 1] + p[i + 2] > 0;
		differ += p[i] !== q[i] || p[i + 1] !== q[i + 1] || p[i + 2] !== q[i + 2];
	}
	return {painted, differ, equal: a.length === b.length && a.every((x, i) => Object.is(x, b[i]))};
}
main().then((result) => { window.result = result; }, (error) => { window.result = {error: String(error.stack)}; });
