// SPDX-License-Identifier: MIT
//
// page.mjs MODULES FOLDER [WEB]: opens HTML reports in Chromium and does what readers do. The pages are those of test_page.sh:
//
//   two.html    object "plain" (unmirrored, u 0 to 0.4) and object "</script>..." (mirrored, u 0.6 to 1)
//   head.html   data/head.obj, whose mirror seams lie in x = 0
//   large.html  a grid of 180 000 triangles, mirrored at its middle
//   stacked.html  20 000 quads, each with all of the texture
//   many.html   500 files
//   pages/      index.html, and a page of each of head.obj, bad.obj, 30 quads and a name that tries to be a script
//   bad.html    meshes with nothing to show, and a position that is not finite
//   diff.html   two squares, of which the second was mirrored in the old version
//   pictures.html  a quad with a normal map and a base colour: in the page, a file that nmtan does not decode, a lost one, a data URI, of
//               other texture coordinates
//   tiles.html  two quads in neighbouring tiles: repeated, mirrored by the sampler, that with an offset, over 500 tiles, over 900 x 900
//   twelve.html twelve meshes with a triangle without area each
//   lit.html    a quad with a normal map that leans up, with the wrong w in the old version, which names.html has by another name
//
// With WEB, the folder of make web, its report shows the same.
//
// Prints one line per check that fails, and the number of checks that passed.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {pathToFileURL} from 'node:url';

const [modules, folder, web, shots] = process.argv.slice(2);
const {chromium} = createRequire(modules + '/')('playwright-core');
let passed = 0, failed = 0;

function check(condition, text) {
	if (condition) { passed++; return; }
	failed++;
	console.log('wrong: ' + text);
}

// A page does what it is told when it comes to it, which takes long where others want the same processor: what is expected may
// come within a minute. `text`: a string, or what is asked for one then. Checks that something does *not* happen come
// after rest().
async function expect(holds, text) {
	let thrown = '';
	for (const end = Date.now() + 60000; ;) {
		try {
			if (await holds()) { passed++; return; }
			thrown = '';
		} catch (error) { thrown = ' (' + error.message + ')'; }
		if (Date.now() > end) break;
		await new Promise(done => setTimeout(done, 20));
	}
	check(false, (typeof text === 'function' ? await text() : text) + thrown);
}

// WebGL is drawn by SwiftShader; all else without it: that takes a quarter of the processor time.
const browser = await chromium.launch({timeout: 300000, executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
		'--disable-gpu-compositing', '--disable-gpu-rasterization', '--disable-accelerated-2d-canvas']});
const complaints = [], requests = [];

async function open(name, {hash = '', before = () => {}, ...options} = {}) {
	const page = await browser.newPage({viewport: {width: 1400, height: 900}, ...options});
	await page.addInitScript(before);
	page.setDefaultTimeout(120000);
	const address = pathToFileURL(folder + '/' + name).href;
	// pixels are read here, not by the page: Chromium would have them read otherwise
	const ours = text => text.includes('GPU stall') || text.includes('willReadFrequently');
	page.on('console', m => { if (['error', 'warning'].includes(m.type()) && !ours(m.text())) complaints.push(name + ': ' + m.text()); });
	page.on('pageerror', e => complaints.push(name + ': ' + e.message));
	page.on('request', r => { if (!r.url().startsWith('data:') && r.url() !== address + hash && r.url() !== address) requests.push(r.url()); });
	await page.goto(address + hash);
	await ready(page);
	return page;
}

const ready = page => page.evaluate(() => window.nmtanReport.ready());
const ask = (page, what, argument) => page.evaluate(([what, argument]) => window.nmtanReport[what](argument), [what, argument]);
const selection = page => ask(page, 'selection');
const camera = async page => JSON.stringify(await ask(page, 'camera'));
const visible = page => page.locator('.finding').count();
// Until what is to be drawn is drawn; and until the page's timers, of at most 180 ms, and what these draw are over, too. A
// machine that is slow waits longer.
const frames = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done)))));
const rest = page => frames(page).then(() => page.evaluate(() => new Promise(done => setTimeout(done, 200)))).then(() => frames(page));
// The mean colour of patches of a picture, at places given as fractions, decoded by the browser itself.
async function colours(page, png, places) {
	return page.evaluate(async ({source, places}) => {
		const image = new Image();
		image.src = source;
		await image.decode();
		const canvas = document.createElement('canvas');
		canvas.width = image.width;
		canvas.height = image.height;
		const context = canvas.getContext('2d', {willReadFrequently: true});
		context.drawImage(image, 0, 0);
		return places.map(([x, y]) => { // the mean of a patch, since the hatch is dark
			const d = context.getImageData(x * image.width - 8, y * image.height - 8, 16, 16).data, c = [0, 0, 0];
			for (let i = 0; i < d.length; i += 4) for (let k = 0; k < 3; k++) c[k] += d[i + k] / (d.length / 4);
			return c;
		});
	}, {source: 'data:image/png;base64,' + png.toString('base64'), places});
}

// A click at a place of the texture.
async function clickTexture(page, u, v) {
	const [x, y] = await page.evaluate(([u, v]) => window.nmtanReport.place(u, v), [u, v]);
	await page.click('#layout', {position: {x, y}});
	await frames(page);
}

// ---- two small meshes ----

{
	const page = await open('two.html'), all = await visible(page);
	check(all === 4, 'four findings, has ' + all);
	await expect(async () => /0 errors.*1 warning\b.*3 infos/.test(await page.locator('#summary').innerText().then(t => t.replace(/\s+/g, ' '))), 'the summary');
	const kinds = await page.locator('.group').evaluateAll(g => g.map(x => x.classList[1]));
	check(kinds.join() === [...kinds].sort((a, b) => (a === 'warning' ? 0 : 1) - (b === 'warning' ? 0 : 1)).join(), 'the most severe first: ' + kinds);

	await expect(async () => /^Export again: ./.test(await page.locator('#verdict').innerText()), 'the verdict');

	// filters
	await page.uncheck('#show-info', {force: true});
	await expect(async () => await visible(page) === 1, 'one warning');
	await page.uncheck('#show-warning', {force: true});
	await expect(async () => await visible(page) === 0 && await page.locator('#groups .empty').count() === 1, 'nothing, and it says so');
	await page.check('#show-info', {force: true});
	await page.check('#show-warning', {force: true});
	await page.fill('#text', 'no area in uv');
	await expect(async () => await visible(page) === 1, 'one finding says "no area in UV space"');
	await expect(async () => (await page.locator('#shown').textContent()).startsWith('1 of 4'), 'how many are shown');
	await page.fill('#text', '');

	// a click goes there, in both views
	const before = await camera(page), layout = await ask(page, 'layout');
	await page.click('[data-code=UV_MIRROR_LONE] .finding');
	await page.waitForFunction(() => window.nmtanReport.selection());
	await rest(page);
	const target = async () => (await ask(page, 'camera')).target;
	await expect(async () => before !== await camera(page) && (await target()).every((x, i) => Math.abs(x - [10.5, 0.5, 0][i]) < 1e-3),
		async () => 'the camera goes to the island: ' + await target());
	await expect(async () => (await page.locator('#mesh option:checked').textContent()).includes('<script>'), 'the mesh is opened');
	await expect(async () => Math.abs((await ask(page, 'layout')).u - 0.8) < 0.01 && layout.u !== 0.8, 'and the texture view to its place');
	await expect(async () => (await selection(page))?.triangles === 2, 'both its triangles are chosen');
	await expect(async () => await page.locator('.finding[aria-current]').count() === 1, 'one row is marked');
	await expect(async () => page.url().endsWith('#finding-' + (await selection(page))?.finding), 'the address says which: ' + page.url());
	// mirrored is red, and what is chosen is yellow
	const filled = async () => (await colours(page, await page.locator('#layout').screenshot(), [[0.5, 0.4]]))[0];
	await expect(async () => { const [r, g, b] = await filled(); return r > 180 && g > 140 && b < 140; }, async () => 'the island is filled yellow, is ' + await filled());
	await page.keyboard.press('Escape');
	await rest(page);
	await expect(async () => await selection(page) === null, 'Escape chooses nothing');
	await expect(async () => { const [r, , b] = await filled(); return r > b + 30; }, async () => 'red expected, is ' + await filled());

	// picking in the texture: the island, then the triangle, and the list follows
	await clickTexture(page, 0.8, 0.4);
	await expect(async () => (await selection(page))?.island === 0 && await page.locator('.finding.related').count() > 0, 'a click chooses the island and marks its finding');
	await clickTexture(page, 0.8, 0.4);
	await expect(async () => (await selection(page))?.triangles === 1, 'another one the triangle');
	// and in space
	await page.keyboard.press('Escape');
	await page.click('#space-fit');
	const box = await page.locator('#space').boundingBox();
	await page.click('#space', {position: {x: box.width / 2, y: box.height / 2}});
	await frames(page);
	await expect(async () => (await selection(page))?.island === 0, 'a click in space chooses the island');
	await page.click('#space', {position: {x: 4, y: 4}});
	await frames(page);
	await expect(async () => await selection(page) === null, 'one beside the mesh nothing');

	// keys
	await page.focus('[data-code=UV_DEGENERATE_TRIANGLE] .finding, [data-code^=UV_DEGENERATE] .finding');
	await page.keyboard.press('Enter');
	await rest(page);
	await expect(async () => (await selection(page))?.finding !== undefined, 'Enter chooses');
	await page.focus('#space');
	for (const key of ['ArrowLeft', 'ArrowUp', '+', '-', 'Home']) {
		const was = await camera(page);
		await page.keyboard.press(key);
		await expect(async () => await camera(page) !== was, key + ' moves the camera');
	}
	await page.focus('#layout');
	for (const key of ['ArrowLeft', '+', '0']) {
		const was = JSON.stringify(await ask(page, 'layout'));
		await page.keyboard.press(key);
		await expect(async () => JSON.stringify(await ask(page, 'layout')) !== was, key + ' moves the texture');
	}
	await page.evaluate(() => document.activeElement.blur());
	const first = await page.locator('.group[open] .finding').first().getAttribute('data-finding');
	await page.keyboard.press('Escape');
	await page.keyboard.press('j');
	await rest(page);
	await expect(async () => String((await selection(page))?.finding) === first, 'j chooses the first finding');

	// wheel and drag
	const view = await ask(page, 'layout');
	await page.mouse.move(...await page.locator('#layout').boundingBox().then(b => [b.x + 100, b.y + 100]));
	await page.mouse.wheel(0, -300);
	await rest(page);
	await expect(async () => (await ask(page, 'layout')).scale > view.scale * 1.2, 'the wheel zooms');
	const held = await ask(page, 'layout');
	await page.mouse.down();
	await page.mouse.move(...await page.locator('#layout').boundingBox().then(b => [b.x + 160, b.y + 100]), {steps: 3});
	await page.mouse.up();
	await expect(async () => Math.abs((await ask(page, 'layout')).u - held.u + 60 / held.scale) < 1e-6, 'dragging moves by what it drags');

	// each mode shows something else; frames can be compared
	await page.keyboard.press('Escape');
	await page.selectOption('#mesh', '0');
	await ready(page);
	const pictures = new Set();
	await expect(async () => {
		pictures.clear();
		for (let mode = 0; mode < 9; mode++) {
			await page.selectOption('#mode', String(mode));
			await rest(page);
			const [centre, corner] = await colours(page, await page.locator('#space').screenshot(), [[0.46, 0.55], [0.03, 0.2]]);
			if (centre.some((x, i) => Math.abs(x - corner[i]) > 6)) pictures.add(centre.map(Math.round).join());
			else pictures.add('mode ' + mode + ' shows nothing');
		}
		return pictures.size >= 7 && ![...pictures].some(p => p.includes('nothing'));
	}, () => 'modes show the mesh, and look different: ' + [...pictures].join(' '));
	await page.selectOption('#mode', '4');
	await page.selectOption('#other', '2');
	await expect(async () => await page.locator('#wipe').isVisible() && await page.locator('#left-name').textContent() === 'by nmtan', 'two frames with a wipe');
	await page.focus('#wipe');
	await page.keyboard.press('ArrowLeft');
	await expect(async () => await page.getAttribute('#wipe', 'aria-valuenow') === '48', 'which keys move');
	await page.click('[data-layout=side]');
	await expect(async () => !await page.locator('#wipe').isVisible(), 'or side by side');
	await page.check('#vectors', {force: true});
	await expect(async () => (await page.locator('#space-note').textContent()) === '' , 'no note where none is needed');
	await page.selectOption('#mode', '0');
	await expect(async () => (await page.locator('#space-note').textContent()).includes('test pattern'), 'bumps that nobody made are called a test pattern');

	// names are text
	await expect(async () => await page.evaluate(() => window.broken === undefined), 'a name was run as a script');
	await expect(async () => await page.locator('script').count() === 4, 'four script elements: data, script and two meshes');
	if (shots) await page.screenshot({path: shots + '/two.png'});
	await page.close();
}

// ---- dark and light, wide and narrow, print, a link to a finding ----

{
	const background = p => p.evaluate(() => getComputedStyle(document.body).backgroundColor);
	const light = await open('two.html', {hash: '#finding-1'}), dark = await open('two.html', {colorScheme: 'dark', viewport: {width: 500, height: 900}});
	await expect(async () => (await selection(light))?.finding === 1, 'a link leads to its finding');
	const day = await background(light), night = await background(dark);
	check(day !== night, 'dark is dark');
	await dark.click('#theme [data-theme=light]');
	await expect(async () => await background(dark) === day, 'and can be made light');
	const forced = await open('two.html', {hash: '#finding-1', forcedColors: 'active'});
	for (const part of ['#layout', '.key >> nth=0']) {
		const picture = page => page.locator(part).screenshot();
		await expect(async () => (await picture(forced)).equals(await picture(light)), 'forced colours leave ' + part);
	}
	await forced.close();
	// without light-dark(): the same light colours
	const [palettes, fallback] = await light.evaluate(() => [...document.styleSheets[0].cssRules].flatMap(r => [r, ...r.cssRules || []])
		.filter(r => r.selectorText === ':root' && r.style.getPropertyValue('--bg').length > 4)
		.map(r => [...r.style].filter(n => n.startsWith('--')).map(n => n + r.style.getPropertyValue(n).replaceAll(/light-dark\(([^,]+), [^)]+\)/g, '$1'))));
	const same = palettes.filter(colour => fallback.includes(colour)).length;
	check(same > 30 && same === fallback.length, 'all colours of old browsers are those of light: ' + same + ' of ' + fallback.length);
	for (const width of [500, 700, 1000, 1900]) {
		await dark.setViewportSize({width, height: 900});
		await expect(async () => await dark.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing hangs over at ' + width);
		const narrowest = () => dark.locator('.message').evaluateAll(m => Math.min(...m.map(x => x.clientWidth)));
		await expect(async () => await narrowest() > 150, async () => 'messages have room at ' + width + ': ' + await narrowest());
	}
	// WCAG AA: 4.5 to 1 for all text
	for (const [p, scheme] of [[light, 'light'], [dark, 'dark']]) {
		await p.click('#theme [data-theme=' + scheme + ']');
		const poor = () => p.evaluate(() => {
			const canvas = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
			const parse = text => { canvas.clearRect(0, 0, 1, 1); canvas.fillStyle = text; canvas.fillRect(0, 0, 1, 1); return [...canvas.getImageData(0, 0, 1, 1).data]; };
			const under = e => { for (; e; e = e.parentElement) { const c = parse(getComputedStyle(e).backgroundColor); if (c[3] > 200) return c; } return [255, 255, 255]; };
			const light = c => c.slice(0, 3).map(x => x / 255).map(x => x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4).reduce((s, x, i) => s + x * [0.2126, 0.7152, 0.0722][i], 0);
			return [...document.querySelectorAll('body *')].filter(e => e.checkVisibility() && [...e.childNodes].some(n => n.nodeType === 3 && n.data.trim()) && !e.closest('script, style, option')).map(e => {
				const a = light(parse(getComputedStyle(e).color)), b = light(under(e));
				return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), e.className || e.tagName, e.textContent.slice(0, 20)];
			}).filter(x => x[0] < 4.5);
		});
		await expect(async () => (await poor()).length === 0, async () => 'contrast in ' + scheme + ': ' + JSON.stringify((await poor()).slice(0, 5)));
	}
	await light.emulateMedia({media: 'print'});
	await expect(async () => !await light.locator('#text').isVisible() && await light.locator('.finding').first().isVisible(), 'on paper there are findings and no controls');
	await dark.emulateMedia({media: 'print'});
	const [onPaper, inDark] = await Promise.all([light, dark].map(p => p.evaluate(() => getComputedStyle(document.body).color)));
	check(onPaper === inDark, 'the ink is dark on paper whatever the theme: ' + inDark);
	await light.close();
	await dark.close();
}

// ---- a stranger finds a seam within three actions ----

{
	const page = await open('head.html');
	await page.click('[data-code=UV_MIRROR_SEAM] .finding >> nth=0');
	await page.waitForFunction(() => window.nmtanReport.selection());
	await rest(page);
	await expect(async () => Math.abs((await ask(page, 'camera')).target[0]) < 0.02, async () => 'the camera looks at x = 0, where the seam is: ' + await camera(page));
	await expect(async () => await ask(page, 'visible') > 0.01, async () => 'the seam is seen: ' + await ask(page, 'visible'));
	check(Math.hypot(...(await ask(page, 'camera')).eye) > 1.2, 'from outside of the head');
	await expect(async () => (await ask(page, 'labels')).some(l => l.seam === 0), 'and has its number in the texture');
	const labels = await ask(page, 'labels');
	check(labels.every((a, i) => labels.every((b, k) => k <= i || a.box[0] >= b.box[2] || b.box[0] >= a.box[2] || a.box[1] >= b.box[3] || b.box[1] >= a.box[3])),
		'numbers do not lie on each other');
	// the reverse: a click on the other seam, at u = 0
	await page.click('#layout-fit');
	await clickTexture(page, 0, 0.31);
	await expect(async () => (await selection(page))?.seam === 1 && await page.locator('.finding.related').count() === 1, 'a click on a seam chooses it and marks its finding');
	await expect(async () => await ask(page, 'overlapPixels') > 0, 'the mirrored half lies on the other: overlaps are tinted');
	// the frames of the file and of nmtan: an OBJ has none of its own
	await expect(async () => await page.evaluate(() => document.querySelector('#frame').options[0].disabled), 'an OBJ has no frames of its own');
	if (shots) await page.screenshot({path: shots + '/head.png'});
	await page.close();
}

// ---- a large mesh ----

{
	// a picture seems to take long, whatever the machine is: then a part of the triangles is drawn while they turn, which is there all over
	const page = await open('large.html', {before: () => { let now = 0; performance.now = () => now += 100; }}), g = await page.evaluate(() => {
		const g = window.nmtanReport.geometry();
		// the area that the outlines enclose is that of the triangles
		const area = loops => loops.reduce((sum, loop) => sum + loop.reduce((s, v, i) => {
			const w = loop[(i + 1) % loop.length], uv = g.texcoords;
			return s + (uv[2 * v] * uv[2 * w + 1] - uv[2 * w] * uv[2 * v + 1]) / 2;
		}, 0), 0);
		return {triangles: g.triangles, whole: g.whole, regions: g.regions.length, loops: g.regions.map(r => r.loops.length),
			points: g.regions.map(r => r.loops[0].length), areas: g.regions.map(r => area(r.loops))};
	});
	check(g.triangles === 180000 && g.whole, 'all triangles are there: ' + g.triangles);
	check(g.regions === 2 && g.loops.join() === '1,1' && g.points.join() === '900,900', 'two outlines of 2 (150 + 300) points: ' + g.points);
	check(g.areas.every(a => Math.abs(Math.abs(a) - 0.5) < 1e-4), 'each encloses half of the texture: ' + g.areas);
	await page.click('[data-code=UV_MIRROR_SEAM] .finding');
	await page.waitForFunction(() => window.nmtanReport.selection());
	await expect(async () => await ask(page, 'visible') > 0, 'its seam is seen');
	let turned;
	await expect(async () => {
		turned = await page.evaluate(async () => {
			const drawn = [];
			for (let i = 0; i < 8; i++) {
				window.nmtanReport.turn(0.01);
				await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
				drawn.push(window.nmtanReport.drawn());
			}
			return Math.min(...drawn);
		});
		return turned > 4000 && turned < 40000;
	}, () => 'few triangles turn: ' + turned);
	await expect(async () => await ask(page, 'drawn') === 180000, 'all of them rest');
	if (shots) await page.screenshot({path: shots + '/large.png'});
	await page.close();
}

// ---- 20 000 islands on each other ----

{
	const page = await open('stacked.html');
	const {covering, regions} = await page.evaluate(() => (({covering, regions}) => ({covering: covering.length, regions: regions.length}))(window.nmtanReport.geometry()));
	check(regions === 20000 && covering === 8 * 6, 'eight of equal islands are drawn: ' + covering / 6);
	await expect(async () => { const {scale} = await ask(page, 'layout'); return Math.abs(await ask(page, 'overlapPixels') / scale ** 2 - 1) < 0.05; }, 'and tinted');
	await clickTexture(page, 0.5, 0.4);
	await expect(async () => (await selection(page))?.island === 19999, 'a click chooses the last one');
	await page.close();
}

// ---- 500 files ----

{
	const page = await open('many.html'), rows = () => page.locator('#file-rows tr').count();
	await expect(async () => /File.*Errors.*Warnings.*Infos/s.test(await page.locator('#file-columns').innerText()), async () => 'severities have one name: ' + await page.locator('#file-columns').innerText());
	await expect(async () => await rows() === 500, async () => '500 rows: ' + await rows());
	await expect(async () => (await page.locator('header').innerText()).length < 200, 'and a short header');
	await expect(async () => /bad.obj[^]*–\s+–\s+–\s+–\s+–\s+–$/.test(await page.locator('#file-rows tr >> nth=0').innerText()), 'the worst first, without counts that nobody made');
	await page.click('[data-column=triangles] button');
	await expect(async () => (await page.locator('#file-rows tr >> nth=0').innerText()).includes('head.obj') &&
		await page.getAttribute('[data-column=triangles]', 'aria-sort') === 'descending', 'the largest first');
	await page.fill('#file-text', 'head');
	await expect(async () => await rows() === 1, 'one is called head');
	await page.click('#file-rows a');
	await page.waitForFunction(() => document.querySelector('#title').textContent.includes('head.obj'));
	await ready(page);
	await expect(async () => (await page.evaluate(() => window.nmtanReport.geometry().triangles)) === 672, 'a row opens its file');
	await page.goBack();
	await page.waitForFunction(() => !document.querySelector('#overview').hidden);
	await expect(async () => await rows() === 1, 'and back');
	if (shots) { await page.fill('#file-text', ''); await rest(page); await page.screenshot({path: shots + '/many.png'}); }
	await page.fill('#file-text', 'bad');
	await page.click('#file-rows a');
	await expect(async () => (await page.locator('#verdict').innerText()).startsWith('Not judged') && !await page.locator('#levels').isVisible(), 'its page has no counts either');
	await page.close();
}

// ---- a folder of pages ----

{
	const page = await open('pages/index.html'), rows = () => page.locator('#file-rows tr').count();
	const first = async () => page.locator('#file-rows tr >> nth=0').innerText();
	await expect(async () => await rows() === 33, async () => '33 rows: ' + await rows());
	await expect(async () => (await page.locator('#file-rows tr.error').allInnerTexts()).join().includes('bad.obj') && /bad|broken/.test(await first()), 'the worst first');
	await page.click('[data-column=triangles] button');
	await expect(async () => (await first()).includes('head.obj'), 'the largest first');
	await expect(() => page.evaluate(() => { // the quads are blue, the mirrored half of the head lies on the other and is red
		let blue = 0, red = 0;
		for (const canvas of document.querySelectorAll('#file-rows canvas')) {
			const d = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
			for (let i = 0; i < d.length; i += 4) if (d[i + 3] > 100) { if (d[i] > d[i + 2]) red++; else blue++; }
		}
		return blue > 3000 && red > 3000;
	}), 'with layouts');
	await expect(() => page.evaluate(() => { // the head stands in the middle of its picture
		const canvas = document.querySelector('#file-rows tr .thumb'), d = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
		return d[4 * (40 * 112 + 56) + 3] === 255 && d[3] === 0;
	}), 'and models');
	await page.fill('#file-text', 'broken');
	await expect(async () => await rows() === 1 && await page.evaluate(() => window.broken === undefined), 'a name is text');
	await page.click('#file-rows a');
	await page.waitForFunction(() => document.title.includes('broken'));
	await expect(async () => await page.evaluate(() => window.broken === undefined), 'and in its page');
	await page.click('#title a');
	await page.waitForFunction(() => !document.querySelector('#overview').hidden);
	await page.fill('#file-text', 'head');
	await page.click('#file-rows tr');
	await page.waitForFunction(() => document.title.includes('head.obj'));
	await ready(page);
	await expect(async () => (await page.evaluate(() => window.nmtanReport.geometry().triangles)) === 672, 'a row opens its page');
	check(requests.every(r => /^file:.*\/pages\/([^\/]*\.html|nmtan-[0-9a-f]{16}\.(js|css))$/.test(r)), 'pages ask for nothing but each other and their parts');
	await expect(async () => await page.evaluate(() => getComputedStyle(document.querySelector('#layout')).touchAction === 'none'), 'and have their style');
	requests.length = 0;
	await page.close();
}

// ---- what lies on each other across tiles ----

{
	const page = await open('tiles.html'), note = page.locator('#layout-note');
	// u modulo 1 both quads have 0.1 to 0.4; folded, 1.1 to 1.6 is 0.9 to 0.4; moved by 0.35, 0.45 to 0.75 and 0.55 to 0.05
	for (const [file, area] of [0.48, 0, 0.16].entries()) {
		await page.evaluate(file => { location.hash = 'file-' + file; }, file);
		await page.waitForFunction(name => document.querySelector('#title').textContent.endsWith(name), ['tiles.obj', 'mirrored.gltf', 'shifted.gltf'][file]);
		await ready(page);
		await rest(page);
		const {scale} = await ask(page, 'layout'), tinted = async () => await ask(page, 'overlapPixels') / scale ** 2;
		await expect(async () => Math.abs(await tinted() - area) < 0.01, async () => 'tinted are ' + area + ' of file ' + file + ': ' + await tinted());
		if (file === 0) await expect(async () => (await note.textContent()).includes('count all tiles as one'), async () => 'and it says so: ' + await note.textContent());
		if (shots) await page.screenshot({path: shots + '/tiles' + file + '.png'});
	}
	// over 500 tiles all of both lie on something
	await page.evaluate(() => { location.hash = 'file-3'; });
	await page.waitForFunction(() => document.querySelector('#title').textContent.endsWith('far.obj'));
	await ready(page);
	await rest(page);
	for (let i = 0; i < 14; i++) await page.locator('#layout').press('+'); // so near that it fills the width
	await rest(page);
	const share = async () => { const {scale, width} = await ask(page, 'layout'); return await ask(page, 'overlapPixels') / (0.8 * scale * width); };
	await expect(async () => Math.abs(await share() - 1) < 0.15, async () => 'all of a quad over 500 tiles is tinted: ' + await share());
	await page.evaluate(() => { location.hash = 'file-4'; });
	await page.waitForFunction(() => document.querySelector('#layout-note').textContent.includes('too many are in view'));
	for (let i = 0; i < 30; i++) await page.locator('#layout').press('+');
	await page.waitForFunction(() => document.querySelector('#layout-note').textContent.includes('count all tiles as one'));
	await page.uncheck('#overlaps', {force: true});
	await expect(async () => await note.textContent() === '', 'nothing is said of what is not shown');
	await page.close();
}

// ---- the image below the islands ----

{
	const page = await open('pictures.html'), note = page.locator('#layout-note');
	const go = async (file, name) => {
		await page.evaluate(file => { location.hash = 'file-' + file; }, file);
		await page.waitForFunction(name => document.querySelector('#title').textContent.endsWith(name), name);
		await ready(page);
		await rest(page);
	};
	// beside the quad, in the right half of the texture
	const colour = async () => {
		const [x, y] = await page.evaluate(() => window.nmtanReport.place(0.6, 0.5)), box = await page.locator('#layout').boundingBox();
		return colours(page, await page.locator('#layout').screenshot(), [[x / box.width, y / box.height]]).then(([c]) => c[0] > c[1] + 80 ? 'red' : c[2] > c[0] + 40 ? 'blue' : 'grey');
	};
	await go(0, 'red.gltf');
	await page.click('#layout-fit');
	await rest(page);
	await expect(async () => (await page.locator('#texture option').allTextContents()).join() === 'No image,Normal map,Base colour', 'what can be chosen');
	await expect(async () => await page.inputValue('#texture') === '0' && await colour() === 'blue', async () => 'the normal map lies below, is ' + await colour());
	check(requests.length === 0, 'no file is asked for unless it is chosen');
	// how much the islands hide of it
	const inside = async () => {
		const [x, y] = await page.evaluate(() => window.nmtanReport.place(0.25, 0.55)), box = await page.locator('#layout').boundingBox();
		return colours(page, await page.locator('#layout').screenshot(), [[x / box.width, y / box.height]]).then(([c]) => c.map(Math.round));
	};
	const bare = c => c[0] > 140; // 128 at 0.85 over the grey
	const veiled = await inside();
	await page.fill('#fill', '0');
	await expect(async () => bare(await inside()), async () => 'islands without fill show the image: ' + await inside());
	await page.fill('#fill', '100');
	await expect(async () => { const c = await inside(); return !bare(c) && c[0] < veiled[0] - 10; }, async () => 'full ones hide more of it than they do at first: ' + veiled + ', then ' + await inside());
	await page.selectOption('#texture', '1');
	await rest(page);
	await expect(async () => await colour() === 'red' && await note.textContent() === '', async () => 'the base colour is ' + await colour());
	check(requests.length === 0, 'it is in the page');
	const model = async () => colours(page, await page.locator('#space').screenshot(), [[0.5, 0.5]]).then(([c]) => c[0] > c[1] + 60 ? 'red' : 'grey');
	await expect(async () => await model() === 'red', async () => 'and on the model, is ' + await model());
	await page.uncheck('#base', {force: true});
	await expect(async () => await model() === 'grey', async () => 'which can do without, is ' + await model());
	if (shots) await page.screenshot({path: shots + '/picture.png'});
	await page.selectOption('#texture', '-1');
	await rest(page);
	await expect(async () => await colour() === 'grey', async () => 'none is none, is ' + await colour());
	await page.selectOption('#texture', '1');
	await go(1, 'file.gltf');
	await expect(async () => await colour() === 'red' && requests.length === 1, async () => 'a base colour from a file is ' + await colour());
	await go(2, 'lost.gltf');
	const said = 'tex/lost.gif is not beside this page';
	await expect(async () => (await note.textContent()).includes(said) && await colour() === 'grey', async () => 'a file that is not there is said: ' + await note.textContent());
	if (shots) await page.screenshot({path: shots + '/lost.png'});
	await go(3, 'inside.gltf');
	await expect(async () => await colour() === 'red' && await note.textContent() === '', async () => 'a base colour in the page, is ' + await colour());
	await go(4, 'other.gltf');
	await expect(async () => (await page.locator('#texture option').allTextContents()).join() === 'No image,Normal map', 'none of other texture coordinates');
	check(requests.every(r => /\/tex\/(red|lost)\.gif$/.test(r)) && new Set(requests).size === 2, 'only its images are asked for: ' + requests);
	requests.length = 0;
	complaints.splice(0, complaints.length, ...complaints.filter(c => !c.includes('ERR_FILE_NOT_FOUND')));
	await page.close();
}

// ---- which way green points ----

{
	const page = await open('votes.html', {hash: '#finding-0'}), box = await page.locator('#layout').boundingBox();
	const blocks = async () => {
		const at = await page.evaluate(() => [[0.2, 0.2], [0.8, 0.2], [0.2, 0.8], [0.8, 0.8]].map(([u, v]) => window.nmtanReport.place(u, v)));
		return colours(page, await page.locator('#layout').screenshot(), at.map(([x, y]) => [x / box.width, y / box.height]))
			.then(list => list.map(c => c[1] > c[0] + 20 && c[1] > c[2] ? 'up' : c[0] > c[1] + 40 ? 'down' : '-').join());
	};
	await expect(async () => await blocks() === 'up,down,-,down' && (await page.locator('#layout-note').textContent()).includes('green points up'), async () => 'blocks are coloured as they vote: ' + await blocks());
	await page.keyboard.press('Escape');
	await expect(async () => await blocks() === '-,-,-,-', async () => 'while their finding is chosen: ' + await blocks());
	await page.close();
}

// ---- fingers ----

{
	const page = await open('two.html', {hasTouch: true}), session = await page.context().newCDPSession(page);
	const touch = (type, ...points) => session.send('Input.dispatchTouchEvent', {type, touchPoints: points.map(([x, y], id) => ({x, y, id}))});
	const middle = async id => page.locator(id).boundingBox().then(b => [b.x + b.width / 2, b.y + b.height / 2]);
	// moves two fingers from places to others, in steps, and lifts them
	const pinch = async (from, to) => {
		await touch('touchStart', from[0]);
		await touch('touchStart', ...from);
		for (let i = 1; i <= 10; i++) await touch('touchMove', ...from.map((p, k) => p.map((x, j) => x + (to[k][j] - x) * i / 10)));
		await touch('touchEnd');
		await frames(page);
	};
	const beside = ([x, y], dx, dy) => [[x - dx, y - dy], [x + dx, y + dy]];

	// the texture: twice as far apart, and 30 pixels to the right
	const at = await middle('#layout'), layout = await ask(page, 'layout');
	await pinch(beside(at, 50, 0), beside([at[0] + 30, at[1]], 100, 0));
	let zoomed, near, twisted;
	await expect(async () => Math.abs((zoomed = await ask(page, 'layout')).scale / layout.scale - 2) < 0.01, () => 'two fingers zoom the texture: ' + zoomed.scale / layout.scale);
	check(Math.abs(zoomed.u + 30 / zoomed.scale - layout.u) < 0.01 && Math.abs(zoomed.v - layout.v) < 0.01, 'what is between them stays there');
	await expect(async () => await selection(page) === null, 'and choose nothing');

	// the model
	const there = await middle('#space'), before = await ask(page, 'camera');
	await pinch(beside(there, 40, 0), beside(there, 80, 0));
	await expect(async () => Math.abs(before.distance / (near = await ask(page, 'camera')).distance - 2) < 0.01 && near.yaw === before.yaw,
		() => 'two fingers zoom the model: ' + before.distance / near.distance);
	const arc = k => beside(there, 80 * Math.cos(k), 80 * Math.sin(k));
	await touch('touchStart', ...arc(0));
	for (let k = 1; k <= 6; k++) await touch('touchMove', ...arc(k * 0.1));
	await rest(page);
	await expect(async () => Math.abs((twisted = await ask(page, 'camera')).yaw - near.yaw - 0.6) < 0.01 && Math.abs(twisted.distance / near.distance - 1) < 0.01,
		() => 'and turn it: ' + (twisted.yaw - near.yaw));
	await touch('touchEnd');
	await touch('touchStart', ...beside(there, 5, 0));
	await touch('touchEnd');
	await rest(page);
	await expect(async () => await selection(page) === null, 'a tap of two fingers chooses nothing');
	await page.click('#space-fit');
	await page.touchscreen.tap(...there);
	await frames(page);
	await expect(async () => (await selection(page))?.triangles > 0, 'a tap of one chooses');
	await page.close();
}

// ---- nothing to show ----

{
	const page = await open('bad.html'), names = await page.locator('#file-rows a').allTextContents();
	for (let i = 0; i < names.length; i++) {
		await page.evaluate(i => { location.hash = 'file-' + i; }, i);
		await page.waitForFunction(i => document.querySelector('#title').textContent.endsWith([...document.querySelectorAll('#file-rows a')].find(a => a.hash === '#file-' + i).textContent), i);
		await ready(page);
		await rest(page);
	}
	check(names.length === 4, 'four files: ' + names);
	await expect(async () => await page.evaluate(() => window.broken === undefined), 'no name runs');
	await page.close();
}

// ---- two versions ----

{
	const page = await open('diff.html');
	// codes of (1,0,0) and (-1,0,0) with w: those of the new version, of the old one in its places, and the reverse
	const tangents = await page.evaluate(() => {
		const {geometry, twin} = window.nmtanReport, codes = list => Array.from({length: list.length / 4}, (_, v) => list.slice(4 * v, 4 * v + 3).join());
		return [geometry(), twin().geometry].flatMap(g => [g.authored, g.computed]).map(list => [...new Set(codes(list))].sort().join(' '));
	});
	const both = '0,2047,2 4094,2047,1', plain = '4094,2047,1';
	check(tangents.join() === [plain, both, both, plain].join(), 'each version has the other one\'s tangents too: ' + tangents);
	await expect(async () => await page.locator('#twin-layout h2').textContent() === 'Texture, old' && await page.inputValue('#mode') === '0' && await page.locator('#wipe').isVisible(), 'lit, with a wipe');
	for (const [moved, canvas] of [['the twin', '#space'], ['the view', '#space + canvas']]) {
		const was = await camera(page);
		await page.focus(canvas);
		await page.keyboard.press('ArrowLeft');
		await rest(page);
		await expect(async () => {
			const {yaw} = await ask(page, 'camera'), twin = await ask(page, 'twin');
			return await camera(page) !== was && yaw === twin.camera.yaw && twin.mode === 0;
		}, moved + ' follows');
	}
	// a wipe between them: the second square is red in the old version, blue in the new one, at the same place
	await page.selectOption('#mode', '6');
	await page.click('[data-layout=wipe]');
	await rest(page);
	const boxes = async () => [await page.locator('#space').boundingBox(), await page.locator('#space + canvas').boundingBox()];
	await expect(async () => {
		const [a, b] = await boxes();
		return JSON.stringify(a) === JSON.stringify(b) && a.width > 800;
	}, async () => 'both are in one frame: ' + JSON.stringify(await boxes()));
	const [box] = await boxes();
	await expect(async () => await page.locator('#left-name').textContent() === 'old' && await page.getAttribute('#wipe', 'aria-label') === 'Border between the old and the new version', 'with names');
	const square = [[0.62, 0.55]], redness = async () => colours(page, await page.locator('#space-frame .canvas').screenshot(), square).then(([c]) => c[0] - c[2]);
	await page.mouse.move(box.x + box.width / 2, box.y + 60);
	await page.mouse.down();
	await page.mouse.move(box.x + box.width * 0.9, box.y + 60, {steps: 4});
	await page.mouse.up();
	await rest(page);
	await expect(async () => await page.getAttribute('#wipe', 'aria-valuenow') === '90' && await redness() > 30, async () => 'left of the border is the old version: ' + await redness());
	await page.focus('#wipe');
	await page.keyboard.press('Home');
	await rest(page);
	await expect(async () => await redness() < -30, async () => 'right of it the new one: ' + await redness());
	for (let i = 0; i < 25; i++) await page.keyboard.press('ArrowRight');
	if (shots) await page.screenshot({path: shots + '/wipe.png'});
	await page.mouse.click(box.x + 40, box.y + 40); // beside the mesh, on the old side: nothing
	await expect(async () => await page.locator('#layout-frame h2').textContent() === 'Texture, new', 'the new version is open');
	await rest(page);
	// one view and then what both share, before either is drawn: neither change is lost
	await page.evaluate(() => {
		const key = (where, key) => document.querySelector(where).dispatchEvent(new KeyboardEvent('keydown', {key}));
		key('#space + canvas', 'Home');
		key('#wipe', 'End');
	});
	await rest(page);
	await expect(async () => await redness() > 30, async () => 'the old version is in all of the frame: ' + await redness());
	await page.mouse.click(box.x + box.width * square[0][0], box.y + box.height * square[0][1]);
	await page.waitForFunction(() => document.querySelector('#layout-frame h2').textContent === 'Texture, old');
	await rest(page);
	await expect(async () => (await selection(page))?.triangles === 2, 'a click on the old side opens the old version');
	await expect(async () => await page.locator('#space + canvas').count() === 1 && await redness() > 0, 'and the wipe stays');
	await page.keyboard.press('Escape');
	await page.click('[data-layout=side]');
	await rest(page);
	await expect(async () => await page.locator('#twin-space canvas').count() === 1 && await page.locator('#twin-space').isVisible() && !await page.locator('#wipe').isVisible(), 'side by side again');
	await page.selectOption('#mode', '7');
	await page.click('.change .more');
	await page.waitForFunction(() => document.querySelector('#layout-frame h2').textContent === 'Texture, new');
	await page.click('[data-code=UV_MIRROR_OVERLAP] .finding');
	await page.waitForFunction(() => document.querySelector('#twin-layout h2').textContent === 'Texture, new');
	await rest(page);
	await expect(async () => (await selection(page))?.triangles === 2, 'what is gone is shown in the old version');
	await page.keyboard.press('Escape');
	await expect(async () => await page.evaluate(() => window.broken === undefined), 'no name runs');
	await expect(async () => await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing hangs over');
	if (shots) await page.screenshot({path: shots + '/diff.png'});
	await page.close();
}

// ---- dents beside bumps ----

{
	const page = await open('lit.html');
	const grey = async () => colours(page, await page.locator('#space-frame .canvas').screenshot(), [[0.47, 0.5], [0.53, 0.5]]).then(c => c.map(x => Math.round(x[1])));
	let first;
	await expect(async () => { const [old, now] = first = await grey(); return Math.abs(old - now) > 25; }, () => 'the wrong w is lit otherwise than the right one: ' + first);
	await page.check('#flip', {force: true});
	await expect(async () => { const [old, now] = await grey(); return Math.abs(old - first[1]) < 6 && Math.abs(now - first[0]) < 6; }, async () => 'with green flipped each is as the other was: ' + first + ', then ' + await grey());
	await expect(async () => (await page.locator('#space-note').textContent()).includes('not in the file'), 'and that is said');
	await expect(async () => await page.locator('[data-code=TAN_SIGN_MISMATCH]').count() === 1 && await page.locator('.command').count() === 0, 'what is gone needs no command');
	if (shots) await page.screenshot({path: shots + '/lit.png'});
	await page.close();
	const named = await open('names.html'), words = () => named.locator('.command code').innerText();
	await expect(async () => await words() === String.raw`nmtan --fix './-$(touch broken)'\''.gltf' './-$(touch broken)'\''-repaired.gltf'`, async () => 'a name is one word of a shell: ' + await words());
	const button = named.locator('.command button');
	await button.click();
	await expect(async () => await button.innerText() === 'Copied' || await named.evaluate(() => getSelection().toString()).then(t => t.startsWith('nmtan ')), 'and the command is copied, or marked');
	await named.close();
}

// ---- more than ten, place after place, without WebGL, 400 pixels wide ----

{
	const page = await open('twelve.html'), rows = () => page.locator('[data-code=POS_DEGENERATE_TRIANGLE] .finding').count();
	if (!await page.locator('[data-code=POS_DEGENERATE_TRIANGLE]').getAttribute('open')) await page.click('[data-code=POS_DEGENERATE_TRIANGLE] summary >> nth=0');
	await expect(async () => await rows() === 10, async () => 'ten of a code: ' + await rows());
	await page.click('[data-code=POS_DEGENERATE_TRIANGLE] .more');
	await expect(async () => await rows() === 12, 'and all when asked');
	await page.close();

	const head = await open('head.html');
	const finding = await head.evaluate(() => JSON.parse(document.querySelector('#data').textContent).files[0].findings.findIndex(f => f.at.length > 2));
	await head.evaluate(finding => { location.hash = 'finding-' + finding; }, finding);
	await expect(async () => /^\d+ places/.test(await head.locator('#spot-text').textContent()), 'a finding says how many places it has');
	for (const [key, number] of [['n', 0], ['n', 1], ['p', 0], ['p', -1]]) {
		await head.keyboard.press(key);
		await rest(head);
		const {spots, spot} = await selection(head), {target} = await ask(head, 'camera');
		check(spot === (number + spots.length) % spots.length, key + ' goes to the next place, or back: ' + spot);
		check(await head.evaluate(([t, target]) => {
			const g = window.nmtanReport.geometry(), corners = [0, 1, 2].map(k => [0, 1, 2].map(i => g.origin[i] + g.positions[4 * g.indices[3 * t + k] + i] * g.step[i]));
			return target.every((x, i) => x >= Math.min(...corners.map(c => c[i])) - 1e-6 && x <= Math.max(...corners.map(c => c[i])) + 1e-6);
		}, [spots[spot], target]), 'and the camera looks there');
	}
	await head.close();

	const flat = await open('head.html', {before: () => { HTMLCanvasElement.prototype.getContext = (get => function(kind, ...rest) { return kind === 'webgl2' ? null : get.call(this, kind, ...rest); })(HTMLCanvasElement.prototype.getContext); }});
	await expect(async () => (await flat.locator('#space-empty').textContent()).includes('no WebGL 2') && !await flat.locator('#mode').isVisible(), 'without WebGL the model\'s place says so');
	await flat.click('.finding >> nth=0');
	await expect(async () => (await selection(flat))?.finding !== undefined, 'and findings are chosen all the same');
	await flat.close();
	const old = await open('head.html', {before: () => { delete window.DecompressionStream; }});
	for (const place of ['#layout-empty', '#space-empty'])
		await expect(async () => (await old.locator(place).textContent()).includes('no DecompressionStream'), 'without DecompressionStream ' + place + ' says so');
	await old.click('.finding >> nth=0');
	await expect(async () => (await selection(old))?.finding !== undefined, 'and findings are chosen without it, too');
	await old.close();

	for (const name of ['pictures.html#file-0', 'lit.html', 'many.html#file-0', 'two.html']) {
		const [file, hash] = name.split('#'), narrow = await open(file, {viewport: {width: 400, height: 800}, hash: hash ? '#' + hash : ''});
		const cut = () => narrow.evaluate(() => {
			const c = document.createElement('canvas').getContext('2d');
			return [...document.querySelectorAll('select')].filter(s => s.checkVisibility()).filter(s => {
				c.font = getComputedStyle(s).font;
				return s.id !== 'mesh' && Math.max(...[...s.options].map(o => c.measureText(o.text).width)) > s.clientWidth - 26;
			}).map(s => s.id);
		});
		await expect(async () => (await cut()).length === 0, async () => 'selects are cut in ' + name + ': ' + await cut());
		await expect(async () => await narrow.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing hangs over at 400');
		await narrow.close();
	}
}

// ---- sizes ----

for (const [width, height] of [[1440, 900], [1260, 1100], [1024, 768], [390, 844]]) {
	const size = width + ' x ' + height, page = await open('names.html', {viewport: {width, height}});
	// the verdict: its command in full, at whatever length
	const told = () => page.evaluate(() => {
		const code = document.querySelector('#verdict code'), cut = [];
		for (let e = code; e && e !== document.body; e = e.parentElement) if (e.scrollHeight > e.clientHeight + 1 && getComputedStyle(e).overflow !== 'visible') cut.push(e.id);
		return (code?.innerText ?? 'none') + cut.join();
	});
	await expect(async () => await told() === String.raw`nmtan --fix './-$(touch broken)'\''.gltf' './-$(touch broken)'\''-repaired.gltf'`, async () => 'the command of the verdict is cut at ' + size + ': ' + await told());
	// nothing lies over something else, and no word is broken
	const faults = () => page.evaluate(() => {
		const box = e => e.getBoundingClientRect(), figures = [...document.querySelectorAll('figure')], [a, b] = figures.map(box);
		return [a.right > b.left + 1 && a.bottom > b.top + 1 ? 'views overlap' : '',
			...figures.map(f => [...f.children].some((e, i, all) => i && box(e).top < box(all[i - 1]).bottom - 1) || box(f.lastElementChild).bottom > box(f).bottom + 1 ? f.id + ' is cut' : ''),
			...[...document.querySelectorAll('#summary .verdict, .legend > span')].map(e => box(e).height > 28 ? e.innerText + ' is broken' : '')].filter(text => text).join();
	});
	await expect(async () => await faults() === '', async () => 'at ' + size + ': ' + await faults());
	// the model: the stage's colour all along the border, from every side
	const border = async () => {
		const places = [0.1, 0.3, 0.5, 0.7].flatMap(y => [[0.03, y], [0.97, y]]).concat([[0.3, 0.03], [0.5, 0.03], [0.7, 0.03]]);
		const found = await colours(page, await page.locator('#space').screenshot(), places);
		return Math.max(...found.flatMap(c => c.map((x, k) => Math.abs(x - found[0][k])))).toFixed(1);
	};
	for (const turned of [0, 0.6, 0.8]) {
		if (turned) await page.evaluate(by => window.nmtanReport.turn(by, 0), turned);
		await rest(page);
		await expect(async () => await border() < 1, async () => 'the model leaves the view at ' + size + ', turned by ' + turned + ': ' + await border());
	}
	await page.close();
}
{
	const page = await open('many.html', {viewport: {width: 1024, height: 768}}), ends = () => page.locator('header > :not([hidden])').evaluateAll(all => all.map(e => e.getBoundingClientRect().right));
	await expect(async () => (await ends()).at(-1) === Math.max(...await ends()), async () => 'the colours are chosen at the end of the line: ' + await ends());
	await page.close();
}

// ---- the page of make web ----

// The report of a page in the frame of make web, as src/bindings/web/app.js puts it there.
async function openFramed(name) {
	const page = await browser.newPage({viewport: {width: 500, height: 500}}), origin = 'http://nmtan.test/';
	page.setDefaultTimeout(120000);
	page.on('console', m => { if (m.type() === 'error') complaints.push('framed ' + name + ': ' + m.text()); });
	page.on('pageerror', e => complaints.push('framed ' + name + ': ' + e.message));
	const types = {html: 'text/html', css: 'text/css', js: 'text/javascript'};
	await page.route(origin + '**', route => {
		const path = new URL(route.request().url()).pathname.slice(1);
		route.fulfill({contentType: types[path.split('.').pop()], body: readFileSync(web + '/' + path)});
	});
	await page.goto(origin + 'report.html');
	await page.evaluate(html => {
		const content = html.slice(html.indexOf('<script type="application/json"'));
		const report = new DOMParser().parseFromString(content, 'text/html'), script = document.createElement('script');
		document.body.append(...report.querySelectorAll('script[type="application/json"], script[id^="g-"]'));
		document.body.append(Object.assign(script, {src: 'report.js'}));
		return new Promise((done, failed) => Object.assign(script, {onload: done, onerror: failed}));
	}, readFileSync(folder + '/' + name, 'utf8'));
	await ready(page);
	return page;
}

// All text of a page, hidden or not, but that of scripts.
const text = page => page.evaluate(() => {
	const body = document.body.cloneNode(true);
	body.querySelectorAll('script').forEach(script => script.remove());
	return body.textContent.replace(/\s+/g, ' ').trim();
});

for (const name of web ? ['two.html', 'many.html', 'diff.html'] : []) {
	const pages = [await open(name, {viewport: {width: 500, height: 500}}), await openFramed(name)];
	const both = async what => {
		await Promise.all(pages.map(rest));
		const [own, framed] = await Promise.all(pages.map(text));
		const at = [...own].findIndex((letter, i) => letter !== framed[i]);
		check(own === framed, `${name}, ${what}: make web's page has “${framed.slice(at < 0 ? own.length : at).slice(0, 80)}”`);
	};
	await both('as it opens');
	const {files, findings} = await pages[0].evaluate(() => {
		const data = JSON.parse(document.getElementById('data').textContent);
		return {files: data.files.length, findings: data.files.reduce((sum, file) => sum + file.findings.length, 0)};
	});
	const hashes = [...Array(Math.min(files, 2)).keys()].map(i => '#file-' + i).concat([...Array(Math.min(findings, 2)).keys()].map(i => '#finding-' + i), '#');
	for (const hash of hashes) {
		for (const page of pages) await page.evaluate(hash => { location.hash = hash; }, hash);
		await both(hash);
	}
	const modes = name === 'two.html' // their notes are the same script's for all pages
		? await pages[0].locator('#mode option').evaluateAll(options => options.map(option => option.value)) : [];
	for (const mode of modes) {
		for (const page of pages) await page.selectOption('#mode', mode);
		await both('mode ' + mode);
	}
	for (const page of pages) await page.close();
}

// ---- for everybody ----

const asked = requests.length; // an index asks for its own style and script
const axe = createRequire(modules + '/').resolve('axe-core/axe.min.js');
for (const name of ['head.html', 'diff.html', 'pictures.html#file-0', 'pages/index.html']) {
	const [file, hash] = name.split('#'), page = await open(file, {hash: hash ? '#' + hash : '', bypassCSP: true});
	if (await visible(page)) await page.locator('.finding').first().click(); // an index has none
	await page.addScriptTag({path: axe});
	for (const look of ['light and wide', 'dark and narrow']) {
		if (look !== 'light and wide') {
			await page.emulateMedia({colorScheme: 'dark'});
			await page.setViewportSize({width: 400, height: 800});
		}
		await rest(page);
		const {violations} = await page.evaluate(() => window.axe.run({preload: false}));
		check(violations.length === 0, `axe on ${name}, ${look}: ` +
			violations.map(v => v.id + ' ' + v.nodes.map(n => n.target.join(' ')).slice(0, 3)).join('; '));
	}
	await page.close();
}
requests.length = asked;

check(complaints.length === 0, 'the console complains: ' + complaints.slice(0, 4).join('; '));
check(requests.length === 0, 'it asks for: ' + requests.slice(0, 3));
await browser.close();
console.log(passed + ' passed, ' + failed + ' failed');
process.exit(failed ? 1 : 0);
