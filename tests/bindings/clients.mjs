// SPDX-License-Identifier: MIT
//
// node clients.mjs PACKAGE MODULES PLAYWRIGHT FOLDER FILE...: real programs with the npm package in them. FOLDER takes
// what is built; each FILE is a GLB or glTF that nmtan wrote with --raw, or a repaired.glb.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import { equalBytes, triangleGoldens } from './golden.mjs';
import { done, test } from './tap.mjs';

const [npm, modules, playwright, folder, ...files] = process.argv.slice(2);
const from = (place) => (name) => import(pathToFileURL(createRequire(`${place}/`).resolve(name)).href);
const peer = from(modules);
const nmtan = await import(pathToFileURL(`${npm}/index.js`).href);
await nmtan.ready;

const corners = (primitive, semantic) => {
	const accessor = primitive.getAttribute(semantic), indices = primitive.getIndices();
	const count = indices ? indices.getCount() : accessor.getCount(), found = [];
	for (let corner = 0; corner < count; corner++)
		found.push(...accessor.getElement(indices ? indices.getScalar(corner) : corner, []));
	return found;
};

for (const file of files) {
	const name = file.endsWith('repaired.glb') ? 'generateRepairedTangents' : 'generateTangents';
	await test(`glTF-Transform's tangents() with ${name} has nmtan's own: ${file.split('/').pop()}`, async () => {
		const { NodeIO } = await peer('@gltf-transform/core');
		const { tangents, unweld } = await peer('@gltf-transform/functions');
		const io = new NodeIO();
		const [own, made] = [await io.read(file), await io.read(file)];
		await made.transform(unweld(), tangents({generateTangents: nmtan[name], overwrite: true}));
		const primitives = (doc) => doc.getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives());
		const [mine, theirs] = [own, made].map(primitives);
		assert.ok(mine.length > 0);
		mine.forEach((primitive, i) => {
			// 0 and -0 are one tangent to a split
			const [expected, found] = [primitive, theirs[i]].map((p) => corners(p, 'TANGENT').map((x) => x + 0));
			assert.ok(expected.length > 0);
			assert.deepEqual(found, expected);
		});
	});
}

await test('the package mikktspace has the bytes of the unfinished sort, three\'s module those of the completed one', async () => {
	const { default: published } = await peer('mikktspace');
	const sorted = await peer('three/examples/jsm/libs/mikktspace.module.js');
	await sorted.ready;
	for (const [module, folder] of [[published, 'published'], [sorted, 'sorted']]) {
		const goldens = triangleGoldens(new URL(`../../data/golden/edge_sort/${folder}`, import.meta.url).pathname);
		assert.ok(goldens.size > 5);
		for (const [name, g] of goldens)
			assert.ok(equalBytes(Float32Array.from(module.generateTangents(g.positions, g.normals, g.texcoords)), g.tangents),
				`${folder}/${name}`);
	}
});

// A bundle of `entry` that finds three in MODULES and nmtan in PACKAGE.
async function bundle(entry, outfile, format) {
	const esbuild = (await peer('esbuild')).default;
	await esbuild.build({stdin: entry, outfile, bundle: true, format, logLevel: 'silent', nodePaths: [`${modules}/node_modules`],
		alias: {nmtan: `${npm}/index.js`}, target: 'es2022'});
}

await test('a bundle of esbuild\'s loads and works', async () => {
	const contents = `import { ready, generateTangents } from 'nmtan';
		export const answer = ready.then(() => generateTangents([0,0,0, 1,0,0, 0,1,0], [0,0,1, 0,0,1, 0,0,1], [0,0, 1,0, 0,1]));`;
	await bundle({contents, resolveDir: folder}, `${folder}/bundle.mjs`, 'esm');
	const { answer } = await import(pathToFileURL(`${folder}/bundle.mjs`).href);
	assert.deepEqual([...await answer].slice(0, 4).map((x) => x + 0), [1, 0, 0, 1]);
});

// A project that has installed the package.
mkdirSync(`${folder}/node_modules`);
symlinkSync(npm, `${folder}/node_modules/nmtan`);
const external = `${folder}/external.mjs`, places = {};
writeFileSync(external, `import { ready, generateTangents } from 'nmtan/external';
	export const answer = ready.then(() => generateTangents([0,0,0, 1,0,0, 0,1,0], [0,0,1, 0,0,1, 0,0,1], [0,0, 1,0, 0,1]));`);
for (const name of ['esbuild', 'rollup', 'webpack']) {
	places[name] = `${folder}/${name}`;
	mkdirSync(places[name]);
	if (name !== 'webpack') // which brings the file itself
		copyFileSync(`${npm}/nmtan.wasm`, `${places[name]}/nmtan.wasm`);
}
const bundlers = {
	esbuild: async (outfile) => (await peer('esbuild')).build({entryPoints: [external], outfile, bundle: true, format: 'esm',
		platform: 'browser', target: 'es2022', logLevel: 'silent'}),
	rollup: async (file) => {
		const { rollup } = await peer('rollup'), { nodeResolve } = await peer('@rollup/plugin-node-resolve');
		const made = await rollup({input: external, plugins: [nodeResolve({browser: true})],
			onwarn: (warning) => assert.fail(warning.message)});
		await made.write({file, format: 'es'});
	},
	webpack: async (file) => {
		const { default: webpack } = await peer('webpack');
		const stats = await new Promise((resolve, reject) => webpack({entry: external, mode: 'development', devtool: false,
			target: ['web', 'es2022'], experiments: {outputModule: true}, output: {path: places.webpack, filename: 'bundle.mjs',
				publicPath: `${pathToFileURL(places.webpack)}/`, library: {type: 'module'}}},
		(error, found) => (error ? reject(error) : resolve(found))));
		assert.deepEqual(stats.toJson().errors, []);
		assert.ok(readFileSync(file).length > 0);
	},
};
for (const [name, make] of Object.entries(bundlers))
	await test(`nmtan/external in a bundle of ${name}'s for browsers`, async () => {
		const file = `${places[name]}/bundle.mjs`;
		await make(file);
		assert.doesNotMatch(readFileSync(file, 'utf8'), /node:/);
		const fetched = globalThis.fetch;
		globalThis.fetch = async (url) => new Response(readFileSync(new URL(url))); // Node's has no files
		try {
			const { answer } = await import(pathToFileURL(file).href);
			assert.deepEqual([...await answer].slice(0, 4).map((x) => x + 0), [1, 0, 0, 1]);
		} finally {
			globalThis.fetch = fetched;
		}
	});

await test('TypeScript takes what the functions take, and nothing else', () => {
	writeFileSync(`${folder}/types.mts`, `import { generateCornerTangents, generateTangents, generateTangentsIndexed, ready } from 'nmtan';
		import type { Counts } from 'nmtan/external';
		const f = new Float32Array(9), all = {array: f, stride: 9, offset: 1};
		const t: Float32Array = generateTangents(f, [0, 0, 1], all, {vDown: true});
		const r = generateTangentsIndexed(new Uint16Array(3), all, new Int8Array(9), f, {faceSizes: [3], angularThreshold: 90,
			method: 'mikktspace-sorted', repair: false});
		const counts: Counts = r.counts, n: number = counts.normalsNotUnit;
		const faults: Uint8Array | undefined = generateCornerTangents(null, f, f, f, {cornerFaults: true}).cornerFaults;
		export const done: Promise<void> = ready.then(() => console.log(t, n, faults));
		const wide: Uint32Array[] = [generateTangentsIndexed(new Uint32Array(3), f, f, f).indices,
			generateTangentsIndexed(new Uint8Array(3), f, f, f).indices, generateTangentsIndexed([0, 1, 2], f, f, f).indices];
		// @ts-expect-error
		wide.push(generateTangentsIndexed(new Uint16Array(3), f, f, f).indices);
		// @ts-expect-error
		wide.push(generateTangentsIndexed(f as ArrayLike<number>, f, f, f).indices);
		// @ts-expect-error
		generateTangentsIndexed([0], f, f, f, {convention: 'gltf'});
		// @ts-expect-error
		generateTangentsIndexed([0], f, f, f, {method: 'best'});
		// @ts-expect-error
		generateTangents(f, f, f, {repair: true});
		// @ts-expect-error
		generateTangents(f, f, new BigInt64Array(2));
		// @ts-expect-error
		generateTangentsIndexed([0], f, f, f, {vDown: 1});
		// @ts-expect-error
		generateTangentsIndexed(null, f, f, f);`);
	try {
		execFileSync(process.execPath, [`${modules}/node_modules/typescript/bin/tsc`, '--noEmit', '--strict', '--module', 'nodenext',
			'--target', 'es2022', '--typeRoots', `${folder}/none`, `${folder}/types.mts`], {encoding: 'utf8'});
	} catch (error) {
		assert.fail(error.stdout);
	}
});

await test('three.js draws the same pixels with it as with its own module', async () => {
	const here = new URL('page.js', import.meta.url).pathname;
	await bundle({contents: readFileSync(here, 'utf8'), resolveDir: folder}, `${folder}/page.js`, 'iife');
	writeFileSync(`${folder}/page.html`, '<!doctype html><script src="page.js"></script>');
	const { chromium } = createRequire(`${playwright}/`)('playwright-core');
	const browser = await chromium.launch({timeout: 300000, executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
		args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
	try {
		const page = await browser.newPage();
		page.setDefaultTimeout(300000);
		await page.goto(pathToFileURL(`${folder}/page.html`).href);
		const result = await (await page.waitForFunction(() => window.result)).jsonValue();
		assert.equal(result.error, undefined);
		assert.ok(result.painted > 5000, `${result.painted} pixels are painted`);
		assert.equal(result.differ, 0);
		assert.equal(result.equal, true);
	} finally {
		await browser.close();
	}
});
done();
