// SPDX-License-Identifier: MIT
//
// web.mjs WEB MODULES MESH OUT.png: the page of make web with a mesh in it.
import {existsSync, readFileSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {createRequire} from 'node:module';
import {extname, join, resolve} from 'node:path';

const [web, modules, mesh, out] = process.argv.slice(2), types = {'.html': 'text/html', '.css': 'text/css', '.js': 'text/javascript'};
const {chromium} = createRequire(resolve(modules) + '/')('playwright-core');
const server = createServer(({url}, response) => {
	const path = join(web, url === '/' ? 'index.html' : url);
	response.writeHead(existsSync(path) ? 200 : 404, {'Content-Type': types[extname(path)] || 'application/octet-stream'}).end(existsSync(path) ? readFileSync(path) : '');
}).listen(0);
const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
const page = await browser.newPage({viewport: {width: 1260, height: 560}});
await page.goto(`http://localhost:${server.address().port}/`);
await page.setInputFiles('#choose-files', mesh);
await page.waitForSelector('[data-state=report]');
await page.waitForTimeout(2500);
writeFileSync(out, await page.screenshot());
await browser.close();
server.close();
