// SPDX-License-Identifier: MIT
//
// render.mjs PLAYWRIGHT THREE OUT.png LEFT.glb RIGHT.glb: signs.html with the two files, rendered by three.js in
// headless Chromium. PLAYWRIGHT and THREE are node_modules folders. Nothing is asked of the network. A file without tangents
// is refused, unless DERIVATIVES is set: then three.js makes them of screen derivatives.
import {createRequire} from 'node:module';
import {readFileSync, writeFileSync} from 'node:fs';
import {resolve} from 'node:path';

const [playwright, three, out, ...models] = process.argv.slice(2);
const {chromium} = createRequire(resolve(playwright) + '/')('playwright-core');
const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
const page = await browser.newPage({viewport: {width: 1040, height: 520}});
const complaints = [];
page.on('console', m => { if (m.type() === 'error') complaints.push(m.text()); });
page.on('pageerror', e => complaints.push(e.message));

// Modules cannot be loaded from file:, so that the page gets an address that does not exist.
function answer(path) {
	if (path === '/') return [readFileSync(new URL('signs.html', import.meta.url)), 'text/html'];
	if (path.startsWith('/three/')) return [readFileSync(three + path), 'text/javascript'];
	return [readFileSync(models[Number(path.slice(1))]), 'model/gltf-binary'];
}
await page.route('http://signs.invalid/**', route => {
	const [body, contentType] = answer(new URL(route.request().url()).pathname);
	route.fulfill({body, contentType});
});
await page.goto('http://signs.invalid/' + (process.env.DERIVATIVES ? '#derivatives' : ''));
await page.waitForFunction(() => window.done, null, {timeout: 120000}).catch(e => complaints.push(e.message));
writeFileSync(out, await page.screenshot());
await browser.close();
for (const text of complaints) console.error('render.mjs: ' + text);
process.exit(complaints.length ? 1 : 0);
