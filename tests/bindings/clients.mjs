// SPDX-License-Identifier: MIT
//
// node clients.mjs PACKAGE MODULES PLAYWRIGHT FOLDER FILE...: real programs with the npm package in them. FOLDER takes
// what is built; each FILE is a GLB or glTF that nmtan wrote with --repair=off, or a repaired.glb.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
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

await test('three.js draws the same pixels with it as with its own module', async () => {
	const here = new URL('page.js', import.meta.url).pathname;
	const { readFileSync } = await import('node:fs');
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
