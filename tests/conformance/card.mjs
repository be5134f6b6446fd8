// SPDX-License-Identifier: MIT
//
// card.mjs CARD.glb BUILD OUT.png: the card in three.js, which BUILD/clients has, as it is and with each mistake
// that a renderer can make. Writes a picture of the first; exit 1 where a strip does not show what it should.
import {createRequire} from 'node:module';
import {readFileSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';

const [card, build, out] = process.argv.slice(2);
const {chromium} = createRequire(resolve(build, 'node') + '/')('playwright-core');
const three = resolve(build, 'clients/node_modules/three');
const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
const page = await browser.newPage({viewport: {width: 512, height: 420}});
page.on('pageerror', (error) => { throw error; });
await page.route('**/*', (route) => {
	const path = new URL(route.request().url()).pathname;
	const types = {'/card.glb': 'model/gltf-binary', '/': 'text/html'};
	const body = path === '/' ? `<body style="margin:0"><script type="importmap">{"imports": {
		"three": "/three/build/three.module.js"}}</script>` : readFileSync(path === '/card.glb' ? card :
		join(three, path.slice('/three'.length)));
	route.fulfill({contentType: types[path] || 'text/javascript', body});
});
await page.goto('http://card/');

// The brightness of the middle of each letter's first stroke, and of the ground, in each strip.
const shown = (mistake) => page.evaluate(async (mistake) => {
	const THREE = await import('three');
	const {GLTFLoader} = await import('/three/examples/jsm/loaders/GLTFLoader.js');
	const {scene} = await new GLTFLoader().loadAsync('/card.glb');
	scene.traverse((node) => {
		if (!node.isMesh)
			return;
		const tangent = node.geometry.getAttribute('tangent');
		for (let i = 0; i < tangent.count; i++) {
			if (mistake !== 'none' && mistake !== 'green down')
				tangent.setW(i, 1);
			if (mistake === 'no tangents')
				tangent.setXYZ(i, 1, 0, 0);
		}
		if (mistake === 'green down')
			node.material.normalScale.y *= -1;
	});
	const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
	renderer.setSize(512, 420);
	document.querySelector('canvas')?.remove();
	document.body.append(renderer.domElement);
	const camera = new THREE.OrthographicCamera(-2, 2, 1.540625, -1.740625, 0.1, 100);
	camera.position.z = 5;
	renderer.render(scene, camera);
	const gl = renderer.getContext();
	const at = (strip, column, row) => {
		const pixel = new Uint8Array(4), y = 1.5 - 1.1 * strip - (row + 0.5) / 16;
		gl.readPixels((column + 0.5) * 8, Math.floor((y + 1.740625) * 128), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
		return pixel[0];
	};
	// the left strokes of P and F, which begin at columns 5 and 37, row 4
	return [0, 1, 2].map((strip) => {
		const ground = at(strip, 32, 8);
		return (at(strip, 5, 8) > ground + 60 ? 'PASS' : '') + (at(strip, 37, 8) > ground + 60 ? 'FAIL' : '');
	}).join(' ');
}, mistake);

let failed = 0;
for (const [mistake, expected] of [['none', 'PASS PASS PASS'], ['green down', 'FAIL FAIL FAIL'], ['no w', 'PASS FAIL PASS'],
	['no tangents', 'PASS PASS FAIL']]) {
	const found = await shown(mistake);
	console.log(`three.js, mistake: ${mistake}: ${found}`);
	failed += found !== expected;
	if (mistake === 'none')
		writeFileSync(out, await page.screenshot());
}
await browser.close();
console.log(`${4 - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
