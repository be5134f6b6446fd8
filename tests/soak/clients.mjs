// SPDX-License-Identifier: MIT
//
// clients.mjs PACKAGES BUILD FOLDER...: what clients make of outputs. Every mesh file below the folders is converted by
// BUILD/nmtan with each row of `options`; three.js, Babylon.js and PlayCanvas (in Chromium), assimp and the Khronos
// validator read what comes of it. A fault is an error that the input does not have (numbers and names apart), other
// counts of indices than the input's, and fewer primitives with TANGENT than the document has. Outputs of equal bytes
// are read once, those without meshes by the validator alone. PACKAGES is the folder of npm's packages: see clients.sh.
import {execFileSync, fork} from 'node:child_process';
import {createHash} from 'node:crypto';
import {existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, mkdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {basename, dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const [packages, build, ...folders] = process.argv.slice(2);
const options = [['', 'glb'], ['--existing=replace', 'glb'], ['--existing=repair --only=all', 'glb'],
	['--existing=replace --only=all --draco=off', 'glb'], ['--existing=replace --only=all --draco=edgebreaker', 'glb'],
	['--existing=replace --only=all --quads=pairs --meshopt=off', 'glb'], ['--only=all', 'gltf']];
const PATIENCE = 60000, PAGES_END = 300; // milliseconds for a file; files that a page reads before the next one

// ---- what runs in a page: window.read(url) is [[indices, has tangents], ...] ----

async function startThree() {
	const [{GLTFLoader}, {DRACOLoader}, {KTX2Loader}, {MeshoptDecoder}] = await Promise.all(['loaders/GLTFLoader',
		'loaders/DRACOLoader', 'loaders/KTX2Loader', 'libs/meshopt_decoder.module']
		.map((name) => import(`/npm/three/examples/jsm/${name}.js`)));
	const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder)
		.setDRACOLoader(new DRACOLoader().setDecoderPath('/npm/three/examples/jsm/libs/draco/gltf/'))
		.setKTX2Loader(new KTX2Loader().setTranscoderPath('/npm/three/examples/jsm/libs/basis/')
			.detectSupport({extensions: {has: () => false, get: () => null}, capabilities: {}}));
	window.read = async (url) => {
		const {parser} = await loader.loadAsync(url);
		return (await parser.getDependencies('mesh')).flatMap((mesh) => mesh.isGroup ? mesh.children : [mesh])
			.map(({geometry}) => [(geometry.index ?? geometry.attributes.position)?.count ?? 0,
				'tangent' in geometry.attributes]);
	};
}

async function startBabylon() {
	for (const src of ['babylonjs/babylon.js', 'babylonjs-loaders/babylonjs.loaders.min.js'])
		await new Promise((done) => document.head.append(Object.assign(document.createElement('script'),
			{src: `/npm/${src}`, onload: done})));
	const engine = new BABYLON.NullEngine();
	window.read = async (url) => {
		const scene = new BABYLON.Scene(engine);
		try {
			const {meshes} = await BABYLON.LoadAssetContainerAsync(url, scene);
			return meshes.filter((mesh) => !mesh.isAnInstance && mesh.geometry).map((mesh) => [
				mesh.getTotalIndices() || mesh.getTotalVertices(), mesh.isVerticesDataPresent('tangent')]);
		} finally {
			scene.dispose();
		}
	};
}

async function startPlayCanvas() {
	const pc = await import('/npm/playcanvas/build/playcanvas.mjs');
	const draco = '/npm/three/examples/jsm/libs/draco/gltf/draco_';
	pc.dracoInitialize({jsUrl: `${draco}wasm_wrapper.js`, wasmUrl: `${draco}decoder.wasm`, numWorkers: 1, lazyInit: true});
	const canvas = document.body.appendChild(document.createElement('canvas'));
	const app = new pc.AppBase(canvas), settings = new pc.AppOptions();
	Object.assign(settings, {graphicsDevice: new pc.NullGraphicsDevice(canvas),
		componentSystems: [pc.RenderComponentSystem], resourceHandlers: [pc.ContainerHandler, pc.TextureHandler]});
	app.init(settings);
	window.read = (url) => new Promise((done, fail) => app.assets.loadFromUrl(url, 'container', (error, asset) => {
		if (error)
			return fail(error);
		const meshes = asset.resource.renders.flatMap((render) => render.resource.meshes);
		done(meshes.map((mesh) => [mesh.primitive[0].count,
			mesh.vertexBuffer.format.elements.some((element) => element.name === pc.SEMANTIC_TANGENT)]));
		asset.unload();
		app.assets.remove(asset);
	}));
}

// ---- a client: read(file) is {facts, errors} or {errors} ----

let browser;
const atMost = (promise) => new Promise((done, fail) => {
	const timer = setTimeout(() => fail(new Error('no answer')), PATIENCE);
	promise.then(done, fail).finally(() => clearTimeout(timer));
});

// Decoders that Babylon.js takes from its makers' server.
const elsewhere = {'draco_wasm_wrapper_gltf.js': 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js',
	'draco_decoder_gltf.wasm': 'three/examples/jsm/libs/draco/gltf/draco_decoder.wasm',
	'meshopt_decoder.js': 'meshoptimizer/meshopt_decoder.cjs'};

async function openPage(start) {
	const page = await browser.newPage();
	await page.route('**/*', (route) => {
		const path = decodeURIComponent(new URL(route.request().url()).pathname), type = path.split('.').pop();
		if (path === '/')
			return route.fulfill({contentType: 'text/html', body: `<script type="importmap">{"imports": {
				"three": "/npm/three/build/three.module.js"}}</script><body>`});
		const file = basename(path) in elsewhere && !path.startsWith('/npm') ? join(packages, elsewhere[basename(path)]) :
			path.startsWith('/npm/') ? join(packages, path.slice(5)) : path.replace(/^\/file/, '');
		const contentType = {js: 'text/javascript', mjs: 'text/javascript', wasm: 'application/wasm'}[type] ??
			'application/octet-stream';
		try {
			return route.fulfill({contentType, headers: {'access-control-allow-origin': '*'}, body: readFileSync(file)});
		} catch {
			return route.fulfill({status: 404});
		}
	});
	await page.goto('http://clients/');
	await page.evaluate(start);
	return page;
}

function inPage(start) {
	let page, count = 0, said = [];
	return async (file) => {
		if (!page || count++ % PAGES_END === 0) {
			await page?.close();
			page = await openPage(start);
			page.on('console', (message) => message.type() === 'error' && said.push(message.text()));
		}
		said = [];
		try {
			const url = `/file${file.split('/').map(encodeURIComponent).join('/')}`;
			const facts = await atMost(page.evaluate((name) => window.read(name), url));
			return {facts, errors: said};
		} catch (error) {
			if (/no answer|crash|closed/.test(error.message)) {
				page.close().catch(() => {});
				page = undefined;
			}
			return {errors: [error.message.split('\n    at ')[0]]};
		}
	};
}

// assimp in a process of its own, which it may end: it runs out of memory after some files.
function inProcess() {
	let child;
	return async function read(file) {
		const fresh = !child;
		child ??= fork(fileURLToPath(import.meta.url), ['--assimp', packages],
			{stdio: ['ignore', 'ignore', 'ignore', 'ipc']});
		try {
			return await atMost(new Promise((done, fail) => {
				child.removeAllListeners();
				child.on('message', done).on('exit', () => fail(new Error('ended'))).send(file);
			}));
		} catch (error) {
			child.removeAllListeners();
			child.kill('SIGKILL');
			child = undefined;
			return fresh ? {errors: [error.message]} : read(file);
		}
	};
}

async function serveAssimp() {
	const assimp = await createRequire(join(resolve(build), 'x'))('assimpjs')();
	process.on('message', (file) => {
		const list = new assimp.FileList(), data = readFileSync(file);
		list.AddFile(basename(file), data);
		let text = /\.gltf$/i.test(file) ? JSON.parse(data) : {};
		for (const {uri} of text.buffers ?? [])
			if (uri && !uri.startsWith('data:') && existsSync(join(dirname(file), decodeURIComponent(uri))))
				list.AddFile(uri, readFileSync(join(dirname(file), decodeURIComponent(uri))));
		const result = assimp.ConvertFileList(list, 'assjson');
		if (!result.IsSuccess())
			return process.send({errors: [result.GetErrorCode()]});
		text = JSON.parse(new TextDecoder().decode(result.GetFile(0).GetContent()));
		// triangles that JoinIdenticalVertices makes lines are in a mesh of their own
		process.send({facts: [[(text.meshes ?? []).reduce((sum, {faces}) => sum + (faces ?? []).length, 0)]], errors: []});
	});
}

// ---- the loop ----

function primitivesOf(file) {
	const data = readFileSync(file);
	const glb = data.toString('latin1', 0, 4) === 'glTF';
	const g = JSON.parse(glb ? data.toString('utf8', 20, 20 + data.readUInt32LE(12)) : data);
	return (g.meshes ?? []).flatMap((mesh) => (mesh.primitives ?? []).map(({attributes}) => 'TANGENT' in attributes));
}

// Without names and numbers; how a loader's own code fails is not said twice in the same words.
const classOf = (error) => error.replace(/[^\s"']*[/.][a-z][^\s"']*/gi, 'FILE').replace(/[0-9.]+/g, 'N')
	.replace(/(Type|Range)Error: .*/s, 'exception').slice(0, 200);

// The fault of an output, in words, or nothing. `before` is what the client makes of the input, if it reads such.
function faultOf(before, after, file) {
	const known = new Set((before?.errors ?? []).map(classOf)), error = after.errors.find((e) => !known.has(classOf(e)));
	if (error)
		return `${error.slice(0, 200)} (before: ${before?.errors.join(' ').slice(0, 200)})`;
	if (!after.facts)
		return '';
	const counts = ({facts}) => String(facts.map(([count]) => count));
	if (before?.facts && counts(before) !== counts(after))
		return `counts ${counts(before).slice(0, 100)} are ${counts(after).slice(0, 100)}`;
	const expected = primitivesOf(file), found = after.facts.map(([, tangents]) => tangents);
	const [have, wanted] = [found, expected].map((list) => list.filter(Boolean).length);
	return found[0] !== undefined && found.length === expected.length && have < wanted ?
		`${have} primitives have tangents, not ${wanted}` : '';
}

async function main() {
	const {default: validate} = await import('../support/validate.mjs');
	const {chromium} = createRequire(resolve('build/node') + '/')('playwright-core');
	browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium', args: ['--no-sandbox']});
	const clients = {'three.js': inPage(startThree), 'Babylon.js': inPage(startBabylon),
		PlayCanvas: inPage(startPlayCanvas), assimp: inProcess()};
	const tally = Object.fromEntries([...Object.keys(clients), 'validator']
		.map((name) => [name, {read: 0, left: 0, faults: 0}]));
	const fault = (name, file, words, text) => {
		tally[name].faults++;
		console.log(`${name}: ${file} ${words}: ${text}`);
	};
	const files = folders.flatMap((folder) => readdirSync(folder, {recursive: true, withFileTypes: true})
		.filter((entry) => entry.isFile() && /\.(gltf|glb|vrm|obj|ply|drc)$/i.test(entry.name))
		.map((entry) => resolve(entry.parentPath ?? entry.path, entry.name))).sort();
	const work = mkdtempSync(join(tmpdir(), 'clients-'));
	let converted = 0, outputs = 0, alike = 0, crashed = 0;
	for (const [number, file] of files.entries()) {
		const known = /\.(gltf|glb|vrm)$/i.test(file), seen = new Set();
		let before;
		for (const [row, [words, ending]] of options.entries()) {
			const output = join(work, `${number}`, `${row}`, `out.${ending}`);
			mkdirSync(dirname(output), {recursive: true});
			try {
				execFileSync(join(build, 'nmtan'), ['-q', ...words.split(' ').filter(Boolean), file, output],
					{stdio: 'ignore', timeout: 600000});
			} catch (error) {
				if (error.signal) {
					crashed++;
					console.log(`nmtan: ${file} ${words}: ${error.signal}`);
				}
				continue;
			}
			outputs++;
			const digest = createHash('sha256').update(readFileSync(output)).digest('hex');
			if (seen.has(digest) && ++alike)
				continue;
			seen.add(digest);
			const said = [];
			tally.validator.read++;
			if (!await validate([output, file], (line) => said.push(line)))
				fault('validator', file, words, said[0]);
			if (!primitivesOf(output).length)
				continue;
			before ??= Object.fromEntries(await Promise.all(Object.entries(clients).map(async ([name, read]) =>
				[name, known ? await read(file) : undefined])));
			await Promise.all(Object.entries(clients).map(async ([name, read]) => {
				if (name === 'assimp' && words.includes('=edgebreaker')) // its build for npm has no Draco
					return;
				const text = faultOf(before[name], await read(output), output);
				tally[name][before[name] && !before[name].facts ? 'left' : 'read']++;
				if (text)
					fault(name, file, words, text);
			}));
		}
		converted += seen.size > 0;
		rmSync(join(work, `${number}`), {recursive: true});
		if (process.env.NT_PROGRESS && number % 50 === 49)
			console.log(`${number + 1} of ${files.length} files, ${outputs} outputs`);
	}
	rmSync(work, {recursive: true});
	await browser.close();
	console.log(`${files.length} files, ${converted} converted, ${outputs} outputs, ${alike} like one before`);
	for (const [name, {read, left, faults}] of Object.entries(tally))
		console.log(`${name}: ${read} read, ${left} whose input it does not read, ${faults} faults`);
	const faults = crashed + Object.values(tally).reduce((sum, {faults}) => sum + faults, 0);
	console.log(`${outputs - faults} passed, ${faults} failed`);
	process.exit(faults ? 1 : 0);
}

await (packages === '--assimp' ? serveAssimp() : main());
