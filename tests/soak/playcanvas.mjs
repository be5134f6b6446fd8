// SPDX-License-Identifier: MIT
//
// playcanvas.mjs PLAYCANVAS BUILD FOLDER...: every glTF below the folders is made a .glb by BUILD/nmtan, and both are loaded
// by PlayCanvas, whose package is in PLAYCANVAS (npm i playcanvas), in Chromium. What loads before loads after, with as many
// meshes and triangles, and every mesh that has TANGENT in the output has it in PlayCanvas. Without Draco, whose decoder
// PlayCanvas takes from elsewhere.
import {createRequire} from 'node:module';
import {execFileSync} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, readdirSync, rmSync} from 'node:fs';
import {basename, dirname, join, resolve} from 'node:path';
import {tmpdir} from 'node:os';

const [playcanvas, build, ...folders] = process.argv.slice(2);
const {chromium} = createRequire(resolve('build/node') + '/')('playwright-core');
const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium', args: ['--no-sandbox']});
const page = await browser.newPage();
let root = '';
await page.route('**/*', (route) => {
	const path = decodeURIComponent(new URL(route.request().url()).pathname).replace(/^\/\d+\//, '/');
	const file = path === '/pc.mjs' ? join(playcanvas, 'build/playcanvas.mjs') : join(root, path);
	if (path === '/')
		return route.fulfill({contentType: 'text/html', body: '<canvas></canvas>'});
	return existsSync(file) ? route.fulfill({contentType: path === '/pc.mjs' ? 'text/javascript' : 'application/octet-stream',
		body: readFileSync(file)}) : route.fulfill({status: 404});
});
await page.goto('http://pc/');
await page.evaluate(async () => {
	const pc = await import('/pc.mjs');
	const app = new pc.AppBase(document.querySelector('canvas'));
	const options = new pc.AppOptions();
	options.graphicsDevice = new pc.NullGraphicsDevice(document.querySelector('canvas'));
	options.componentSystems = [pc.RenderComponentSystem];
	options.resourceHandlers = [pc.ContainerHandler, pc.TextureHandler];
	app.init(options);
	window.load = (name) => new Promise((done) => {
		const limit = setTimeout(() => done('no answer'), 20000);
		app.assets.loadFromUrl(name, 'container', (error, asset) => {
			clearTimeout(limit);
			if (error)
				return done(String(error));
			const meshes = asset.resource.renders.flatMap((render) => render.resource.meshes);
			done(meshes.map((mesh) => [mesh.primitive[0].count,
				mesh.vertexBuffer.format.elements.some((e) => e.name === pc.SEMANTIC_TANGENT)]));
		});
	});
});
let count = 0; // PlayCanvas keeps what it loaded by its name
const load = (file) => {
	root = dirname(file);
	return page.evaluate((name) => load(name), `/${count++}/${basename(file)}`);
};

const work = mkdtempSync(join(tmpdir(), 'playcanvas-')), output = join(work, 'out.glb');
const files = folders.flatMap((folder) => readdirSync(folder, {recursive: true, withFileTypes: true})
	.filter((entry) => /\.gl(tf|b)$/i.test(entry.name)).map((entry) => resolve(entry.parentPath ?? entry.path, entry.name)));
let passed = 0, failed = 0, left = 0;
for (const file of files.sort()) {
	try {
		execFileSync(join(build, 'nmtan'), ['-q', '--only=all', '--draco=off', file, output], {stdio: 'ignore'});
	} catch {
		continue;
	}
	const data = readFileSync(output), g = JSON.parse(data.toString('utf8', 20, 20 + data.readUInt32LE(12)));
	const before = await load(file), after = await load(output);
	const drawn = (g.meshes ?? []).flatMap((mesh) => mesh.primitives);
	if (!Array.isArray(before) || JSON.stringify(g).includes('draco_mesh_compression')) {
		left++;
	} else if (!Array.isArray(after) || String(after.map(([n]) => n)) !== String(before.map(([n]) => n)) ||
		after.length === drawn.length && drawn.some((p, i) => 'TANGENT' in p.attributes && !after[i][1])) {
		failed++;
		console.log(`${file}: ${JSON.stringify(before).slice(0, 100)} is ${JSON.stringify(after).slice(0, 100)}`);
	} else {
		passed++;
	}
}
rmSync(work, {recursive: true});
await browser.close();
console.log(`${passed} passed, ${failed} failed; ${left} are not loaded by PlayCanvas`);
process.exitCode = failed ? 1 : 0;
