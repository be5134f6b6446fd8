// SPDX-License-Identifier: MIT
//
// card.mjs CARD.glb BUILD OUT.png [BABYLON]: the card in three.js, which BUILD/clients has, as it is, with each mistake
// that a renderer can make, and with each way to interpolate the frame; and in Babylon.js, where BABYLON is the folder of
// its packages. Writes pictures of both as they are: OUT.png, OUT-babylon.png. Exit 1 where three.js does not show what
// it should; the answers of Babylon.js are printed.
import {createRequire} from 'node:module';
import {readFileSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';

const [card, build, out, babylon] = process.argv.slice(2);
const WIDTH = 512, HEIGHT = 704, TOP = 2.75; // 128 pixels a unit, five strips of 1.1
const {chromium} = createRequire(resolve(build, 'node') + '/')('playwright-core');
const three = resolve(build, 'clients/node_modules/three');
const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
const page = await browser.newPage({viewport: {width: WIDTH, height: HEIGHT}});
page.on('pageerror', (error) => { throw error; });
await page.route('**/*', (route) => {
	const path = new URL(route.request().url()).pathname;
	const types = {'/card.glb': 'model/gltf-binary', '/': 'text/html'};
	const [, top, ...rest] = path.split('/');
	const body = path === '/' ? `<body style="margin:0"><script type="importmap">{"imports": {
		"three": "/three/build/three.module.js"}}</script>` :
		readFileSync(path === '/card.glb' ? card : join({babylon, three}[top], ...rest));
	route.fulfill({contentType: types[path] || 'text/javascript', body});
});
await page.goto('http://card/');

// Readings of strips: the brightness of the left strokes of P and F, which begin at columns 5 and 37, beside the
// ground's.
function read(pixels) {
	const at = (strip, column) => {
		const row = HEIGHT - 1 - Math.floor((TOP - 2.2 + 1.1 * strip - 0.5 + 8.5 / 16) * 128);
		return pixels[4 * (WIDTH * row + Math.floor((column + 0.5) * 8))];
	};
	return [0, 1, 2, 3, 4].map((strip) => (at(strip, 5) > at(strip, 3) + 60 ? 'PASS' : '') +
		(at(strip, 37) > at(strip, 35) + 60 ? 'FAIL' : '') || '-').join(' ');
}

// The pixels that three.js shows, rows from the bottom.
const shown = (mistake) => page.evaluate(async ([mistake, width, height, top]) => {
	const THREE = await import('three');
	const {GLTFLoader} = await import('/three/examples/jsm/loaders/GLTFLoader.js');
	const {scene} = await new GLTFLoader().loadAsync('/card.glb');
	// the frame of a fragment: T, B and N as they are interpolated, or made units again; B by vertex or by fragment
	const w = 'sign( dot( cross( vNormal, vTangent ), vBitangent ) )';
	const frame = {
		'per fragment, as interpolated': `mat3( vTangent, ${w} * cross( vNormal, vTangent ), vNormal )`,
		'per vertex, as interpolated': 'mat3( vTangent, vBitangent, vNormal )',
		'per fragment, units': `mat3( normalize( vTangent ), ${w} * normalize( cross( vNormal, vTangent ) ), normal )`,
	}[mistake];
	scene.traverse((node) => {
		if (!node.isMesh)
			return;
		const tangent = node.geometry.getAttribute('tangent');
		for (let i = 0; i < tangent.count; i++) {
			if (mistake === 'no w' || mistake === 'no tangents')
				tangent.setW(i, 1);
			if (mistake === 'no tangents')
				tangent.setXYZ(i, 1, 0, 0);
		}
		if (mistake === 'green down')
			node.material.normalScale.y *= -1;
		if (frame)
			node.material.onBeforeCompile = (shader) => {
				const chunk = THREE.ShaderChunk.normal_fragment_begin;
				const own = 'mat3( normalize( vTangent ), normalize( vBitangent ), normal )';
				if (!chunk.includes(own))
					throw new Error('three.js has another frame than this file knows');
				shader.fragmentShader = shader.fragmentShader.replace('#include <normal_fragment_begin>',
					chunk.replace(own, frame));
			};
	});
	const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
	renderer.setSize(width, height);
	document.querySelector('canvas')?.remove();
	document.body.append(renderer.domElement);
	const camera = new THREE.OrthographicCamera(-2, 2, top, top - height / 128, 0.1, 100);
	camera.position.z = 8;
	renderer.render(scene, camera);
	const gl = renderer.getContext(), pixels = new Uint8Array(4 * width * height);
	gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
	return Array.from(pixels);
}, [mistake, WIDTH, HEIGHT, TOP]).then(read);

const shownByBabylon = async () => {
	for (const name of ['babylonjs/babylon.js', 'babylonjs-loaders/babylonjs.loaders.min.js'])
		await page.addScriptTag({url: `/babylon/${name}`});
	return read(await page.evaluate(async ([width, height, top]) => {
		document.querySelector('canvas')?.remove();
		const canvas = document.createElement('canvas');
		Object.assign(canvas, {width, height});
		document.body.append(canvas);
		const engine = new BABYLON.Engine(canvas, false, {preserveDrawingBuffer: true});
		const scene = new BABYLON.Scene(engine);
		scene.clearColor = new BABYLON.Color4(0, 0, 0, 1);
		await BABYLON.SceneLoader.AppendAsync('/', 'card.glb', scene);
		const camera = new BABYLON.FreeCamera('front', new BABYLON.Vector3(0, 0, 8), scene);
		camera.setTarget(BABYLON.Vector3.Zero());
		camera.mode = BABYLON.Camera.ORTHOGRAPHIC_CAMERA;
		Object.assign(camera, {orthoLeft: -2, orthoRight: 2, orthoTop: top, orthoBottom: top - height / 128});
		scene.activeCamera = camera;
		await scene.whenReadyAsync();
		scene.render();
		const gl = canvas.getContext('webgl2'), pixels = new Uint8Array(4 * width * height);
		gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
		return Array.from(pixels);
	}, [WIDTH, HEIGHT, TOP]));
};

const cases = [['none', 'PASS PASS PASS FAIL FAIL'], ['green down', 'FAIL FAIL FAIL'], ['no w', 'PASS FAIL PASS'],
	['no tangents', 'PASS PASS FAIL'], ['per fragment, as interpolated', 'PASS PASS PASS PASS PASS'],
	['per vertex, as interpolated', 'PASS PASS PASS FAIL PASS'], ['per fragment, units', 'PASS PASS PASS PASS FAIL']];
let failed = 0;
for (const [mistake, expected] of cases) {
	const found = await shown(mistake);
	console.log(`three.js, ${mistake === 'none' ? 'as it is' : mistake}: ${found}`);
	failed += !found.startsWith(expected);
	if (mistake === 'none')
		writeFileSync(out, await page.screenshot());
}
if (babylon) {
	console.log(`Babylon.js, as it is: ${await shownByBabylon()}`);
	writeFileSync(out.replace(/\.png$/, '-babylon.png'), await page.screenshot());
}
await browser.close();
console.log(`${cases.length - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
