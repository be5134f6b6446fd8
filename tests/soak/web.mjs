// SPDX-License-Identifier: MIT
//
// web.mjs MODULES WEB NMTAN FOLDER: the page in Chromium, served from WEB, with files of FOLDER (web.sh made them) that are
// dropped as a hand would. Its texts and outputs are compared with the native tool. Prints what is wrong, times, and
// how much was checked.
import {execFileSync, spawnSync} from 'node:child_process';
import {createServer} from 'node:http';
import {existsSync, mkdtempSync, readFileSync, readdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';

const [modules, web, nmtan, folder] = process.argv.slice(2), require = createRequire(modules + '/');
const {chromium} = require('playwright-core'), axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const out = mkdtempSync(folder + '.out-');
let passed = 0, failed = 0;

function check(condition, text) {
	if (condition) { passed++; return; }
	failed++;
	console.log('wrong: ' + text);
}

const types = {html: 'text/html', css: 'text/css', js: 'text/javascript', wasm: 'application/wasm'}, asked = [], complaints = [];
const server = createServer((request, response) => {
	const name = request.url === '/' ? 'index.html' : request.url.slice(1);
	asked.push(name);
	if (!existsSync(join(web, name))) { response.writeHead(404).end(); return; }
	response.writeHead(200, {'Content-Type': types[name.split('.').pop()] || 'application/octet-stream'}).end(readFileSync(join(web, name)));
}).listen(0);
const origin = `http://localhost:${server.address().port}/`;
const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
const context = await browser.newContext({viewport: {width: 1360, height: 780}, acceptDownloads: true, bypassCSP: false});
const page = await context.newPage(), devtools = await context.newCDPSession(page);
page.setDefaultTimeout(30000);
const ours = text => text.includes('GPU stall') || text.includes('willReadFrequently');
page.on('console', m => { if (['error', 'warning'].includes(m.type()) && !ours(m.text())) complaints.push(m.text()); });
page.on('pageerror', e => complaints.push(e.message));
page.on('request', r => { if (!r.url().startsWith(origin) && !/^(data|blob):/.test(r.url())) complaints.push('asks for ' + r.url()); });

const native = (...words) => spawnSync(nmtan, words, {cwd: folder, encoding: 'utf8'});
const state = (...names) => page.waitForSelector(names.map(name => `[data-state=${name}]`).join());
const report = () => page.frames().find(frame => frame.url().endsWith('report.html'));
const inReport = selector => report().locator(selector);
const failure = () => page.locator('#failure').textContent();

async function drop(...names) {
	const data = {items: [], files: names.map(name => join(folder, name)), dragOperationsMask: 1};
	for (const type of ['dragEnter', 'dragOver', 'drop']) await devtools.send('Input.dispatchDragEvent', {type, x: 600, y: 300, data});
}

// Until the report, or an error, is there.
async function opened(...names) {
	await page.evaluate(() => { document.body.dataset.state = 'dropping'; document.getElementById('failure').hidden = true; });
	await drop(...names);
	await page.waitForFunction(() => document.body.dataset.state === 'report' || !document.getElementById('failure').hidden);
	if (!await page.locator('#failure').isHidden()) return;
	await report().evaluate(() => window.nmtanReport.ready());
}

async function saved() {
	const [download] = await Promise.all([page.waitForEvent('download'), page.click('#save')]);
	await state('report');
	const path = join(out, download.suggestedFilename());
	await download.saveAs(path);
	return path;
}

// The report has the native one's first sentence and findings; what is saved has the native output's bytes.
async function compare(input, output, ...options) {
	await opened(input);
	native('--check', '--fail-on=never', `--report=${out}/native.html`, '--', input);
	const data = text => JSON.parse(/id="data">(.*?)<\/script>/s.exec(text)[1]).files[0];
	const expected = data(readFileSync(`${out}/native.html`, 'utf8'));
	check(await inReport('#verdict').textContent() === expected.verdict, `${input}: the first sentence is “${expected.verdict}”`);
	const shown = await report().evaluate(() => JSON.parse(document.getElementById('data').textContent).files[0].findings);
	check(JSON.stringify(shown) === JSON.stringify(expected.findings), `${input}: the native findings`);
	const {status} = native('-q', ...options, '-o', join(out, 'native-' + output), '--', input), path = await saved();
	check(status === 0 && path.endsWith('/' + output), `${input}: becomes ${output}, is ${path}`);
	check(readFileSync(path).equals(readFileSync(join(out, 'native-' + output))), `${input}: ${output} has the native bytes`);
}

async function accessible(what) {
	for (const frame of page.frames().filter(frame => frame.url().startsWith(origin))) await frame.evaluate(axe);
	const {violations} = await page.evaluate(() => window.axe.run());
	check(!violations.length, `axe, ${what}: ` + violations.map(v => v.id + ' ' + v.nodes.map(n => n.target).join(' ')).join('; '));
	for (const frame of page.frames().filter(frame => frame.url().startsWith(origin)))
		check(await frame.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${what}: nothing is wider than the window`);
}

// ---- what it opens, says and gives ----

await page.goto(origin);
await page.evaluate(() => navigator.serviceWorker.ready);
await accessible('the first page');
await compare('head.obj', 'head.glb');
check(await page.locator('#command').textContent() === 'nmtan head.obj head.glb', 'the command');
await accessible('a report');
await compare('plates.glb', 'plates-repaired.glb');
await compare('draco.glb', 'draco-repaired.glb');
if (existsSync(join(folder, 'DamagedHelmet.glb'))) {
	await compare('Helmet.glb', 'Helmet-repaired.glb');
	await compare('DamagedHelmet.glb', 'DamagedHelmet-repaired.glb', '--fix');
	check(/TAN_SIGN_MISMATCH/.test(native('--check', 'DamagedHelmet.glb').stdout), 'gltfpack is as it was');
	check(!/ TAN_/.test(native('--check', join(out, 'DamagedHelmet-repaired.glb')).stdout), 'DamagedHelmet is repaired');
}
await compare('<img src=x onerror=window.broken=1>.obj', '<img src=x onerror=window.broken=1>.glb'.replaceAll(/[<>]/g, '_'));
await compare('-\'"$(x).obj', '-\'"$(x).glb'.replaceAll('"', '_'));
check(!await page.evaluate(() => window.broken), 'a name is text');

// sets: a .zip of an OBJ, a folder of a glTF and an OBJ
const unpack = path => { execFileSync('python3', ['-m', 'zipfile', '-e', path, path + '.d']); return path + '.d'; };
const equal = (a, b) => spawnSync('diff', ['-r', a, b], {encoding: 'utf8'});
await opened('set.zip');
check(await report().evaluate(() => JSON.parse(document.getElementById('data').textContent).images.length) === 1, 'the TGA is in the report');
await page.selectOption('#format', 'gltf');
const set = unpack(await saved());
execFileSync('python3', ['-m', 'zipfile', '-e', join(folder, 'set.zip'), out]);
execFileSync('mkdir', [join(out, 'set-native')]);
const [, ...shown] = (await page.locator('#command').textContent()).split(' '); // without a space in a name
check(shown.join(' ') === '--images=copy --buffers=copy set.obj set.gltf', 'the command copies what the page copies: ' + shown.join(' '));
execFileSync(nmtan, ['-q', ...shown.slice(0, -1), '../set-native/' + shown.at(-1)], {cwd: join(out, 'set')});
check(equal(set, join(out, 'set-native')).status === 0, 'the set: ' + equal(set, join(out, 'set-native')).stdout);
await page.selectOption('#format', 'glb');
await opened('folder');
check((await inReport('#file-rows tr').count()) === 2, 'two meshes are two rows');
await accessible('two meshes');
const two = unpack(await saved());
execFileSync(nmtan, ['-q', '-d', join(out, 'two-native'), '--keep-tree=.', '--output-format=glb', 'another.obj', 'plates.gltf'], {cwd: join(folder, 'folder')});
check(equal(two, join(out, 'two-native')).status === 0, 'two files: ' + equal(two, join(out, 'two-native')).stdout);

// options
await opened('head.obj');
await page.click('#options summary');
await page.selectOption('[name=method]', 'area');
await page.selectOption('[name=precision]', 'short');
await page.setViewportSize({width: 390, height: 844});
await page.locator('#save').evaluate(e => { e.textContent = 'Repair and save'; });
check((await page.locator('#save').boundingBox()).height < 40, 'the button has one line on a telephone');
await page.setViewportSize({width: 1360, height: 780});
await accessible('the options');
native('-q', '--method=area', '--precision=short', 'head.obj', join(out, 'area.glb'));
check(readFileSync(await saved()).equals(readFileSync(join(out, 'area.glb'))), 'options do what they do natively');
for (const name of ['method', 'precision']) await page.selectOption(`[name=${name}]`, '', {force: true}).catch(() => {});
await page.reload();

// ---- what it refuses ----

for (const [name, words] of [['damaged.glb', /damaged\.glb: .*(byte|bytes)/], ['large.glb', /2\.2 GB; .*at most 1\.0 GB/], ['outside.zip', /“\.\.\/evil” is a name outside/],
	['bomb.zip', /1\.1 GB; .*at most 1\.0 GB/], ['bumps.png', /bumps\.png/], ['plates.gltf', /plates\.bin/]]) {
	await opened(name);
	check(words.test(await failure()), `${name}: ${await failure()}`);
}
await accessible('an error');

// ---- a million triangles: the page answers meanwhile, and lets go ----

await page.evaluate(() => {
	window.gap = 0;
	window.stages = new Set();
	new MutationObserver(() => window.stages.add(document.getElementById('stage').textContent)).observe(document.getElementById('stage'), {childList: true});
	let last = performance.now();
	const tick = () => { const now = performance.now(); window.gap = Math.max(window.gap, now - last); last = now; requestAnimationFrame(tick); };
	tick();
});
await drop('million.obj');
await state('busy');
await page.waitForFunction(() => document.querySelector('progress').value > 0 || /read|Tangents/.test(document.getElementById('stage').textContent));
check(await page.evaluate(() => window.gap) < 500, `the page waited ${await page.evaluate(() => window.gap)} ms`);
await page.click('#cancel');
await state('empty');
await page.waitForTimeout(4000); // Chromium ends a busy one after two seconds
check(page.workers().length === 0, 'a worker that was given up is gone');
const from = Date.now();
await opened('million.obj');
const seconds = (Date.now() - from) / 1000, start = Date.now();
native('--check', '--fail-on=never', '--threads=1', `--report=${out}/million.html`, 'million.obj');
console.log(`a million triangles: ${seconds} s from the drop to the model, natively ${(Date.now() - start) / 1000} s with one thread; the longest wait of the page ` +
	`${Math.round(await page.evaluate(() => window.gap))} ms`);
check(page.workers().length === 0, 'no worker is left');
await saved();
const stages = await page.evaluate(() => [...window.stages].join(' '));
check(/Starting… read million\.obj… Opening… Reading… .*Tangents… .*Writing… Report…/.test(stages), 'progress: ' + stages);

// ---- keys, colours, a narrow window, no network ----

await page.reload();
for (let i = 0; i < 9 && await page.evaluate(() => document.activeElement.id) !== 'example'; i++) await page.keyboard.press('Tab');
await page.keyboard.press('Enter');
await state('report');
await page.click('#theme [data-theme=dark]');
check(await report().evaluate(() => document.documentElement.dataset.theme) === 'dark', 'the report is dark with the page');
await page.setViewportSize({width: 400, height: 800});
await accessible('400 pixels, dark');
await page.click('#options summary');
await accessible('400 pixels, options');
const before = asked.length;
await context.setOffline(true);
server.close();
await page.reload();
await page.click('#example');
await state('report');
check((await saved()).endsWith('head.glb') && asked.length === before, 'it works offline');
check(asked.every(name => existsSync(join(web, name))), 'nothing is asked for but its files: ' + [...new Set(asked)].join(' '));
check(!/unsafe-eval'|unsafe-inline/.test(readFileSync(join(web, 'index.html'), 'utf8').replace("'wasm-unsafe-eval'", '')), 'its policy');
check(!complaints.length, 'the console: ' + [...new Set(complaints)].join(' | '));
console.log(`${passed} passed, ${failed} failed`);
await browser.close();
process.exitCode = failed ? 1 : 0;
process.exit();
