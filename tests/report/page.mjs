// SPDX-License-Identifier: MIT
//
// page.mjs PAGE.html FACT...: opens an HTML report in Chromium and checks what a reader does with it. The
// page is that of test_page.sh: object "plain" (blue, u 0 to 0.4), object "<script>window.broken=1</script>"
// (mirrored, u 0.6 to 1). Prints one line per check that fails, and the number of checks that passed.
import {createRequire} from 'node:module';
import {pathToFileURL} from 'node:url';

const [page_path, modules, shot] = process.argv.slice(2);
const {chromium} = createRequire(modules + '/')('playwright-core');
let passed = 0, failed = 0;

function check(condition, text) {
	if (condition) { passed++; return; }
	failed++;
	console.log('wrong: ' + text);
}

const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
const complaints = [], requests = [];

async function open(options) {
	const page = await browser.newPage({viewport: {width: 1400, height: 1000}, ...options});
	page.on('console', m => { if (['error', 'warning'].includes(m.type())) complaints.push(m.text()); });
	page.on('pageerror', e => complaints.push(e.message));
	page.on('request', r => requests.push(r.url()));
	await page.goto(pathToFileURL(page_path).href);
	await page.waitForFunction(() => window.nmtanView && document.querySelector('#rows tr'));
	return page;
}

// Colours of a PNG at places given as fractions, decoded by the browser itself.
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
			const d = context.getImageData(x * image.width - 10, y * image.height - 10, 20, 20).data, c = [0, 0, 0];
			for (let i = 0; i < d.length; i += 4) for (let k = 0; k < 3; k++) c[k] += d[i + k] / (d.length / 4);
			return c;
		});
	}, {source: 'data:image/png;base64,' + png.toString('base64'), places});
}

const rows = page => page.locator('#rows tr').count();
const camera = page => page.evaluate(() => JSON.stringify(window.nmtanView.camera()));

const page = await open({});
const all = await rows(page);
check(all >= 3, 'three findings or more, has ' + all);
check(await page.locator('#summary').textContent() === '0 errors, 2 warnings, 4 infos', 'the summary');

// filters
await page.uncheck('#show-info');
check(await rows(page) === 2, 'two warnings');
await page.uncheck('#show-warning');
check(await rows(page) === 0, 'no errors');
await page.check('#show-info');
await page.check('#show-warning');
await page.selectOption('#code', 'UV_MIRROR_LONE');
check(await rows(page) === 1, 'one lone island');
await page.selectOption('#code', '');
await page.fill('#text', 'no area in uv');
check(await rows(page) === 1, 'one finding says "no area in UV space"');
check((await page.locator('#shown').textContent()).startsWith('1 of ' + all), 'how many are shown');
await page.fill('#text', '');
check(await rows(page) === all, 'all again');

// sorting
await page.click('th[data-column=code] button');
const codes = await page.locator('td.code').allTextContents();
check(codes.join() === [...codes].sort().join(), 'sorted by code: ' + codes);
await page.click('th[data-column=code] button');
check((await page.locator('td.code').allTextContents()).join() === [...codes].reverse().join(), 'and backwards');
check(await page.getAttribute('th[data-column=code]', 'aria-sort') === 'descending', 'aria-sort');

// a click goes there, in both views, and so does the keyboard
const before = await camera(page);
await page.click('td.code button:has-text("UV_MIRROR_LONE")');
const after = await camera(page);
check(before !== after, 'the camera moves');
const target = JSON.parse(after).target;
check(target.every((x, i) => Math.abs(x - [10.5, 0.5, 0][i]) < 1e-5), 'to the island: ' + target);
check((await page.locator('#mesh option:checked').textContent()).includes('<script>'), 'the mesh is chosen');
check(await page.locator('#uv .marker').count() > 0, 'a ring in the UV layout');
check(await page.locator('tr.chosen .remedy').count() === 1, 'the remedy is there');
await page.focus('td.code button:has-text("UV_DEGENERATE")');
await page.keyboard.press('Enter');
check(await camera(page) !== after, 'Enter moves the camera too');
await page.focus('#view');
const turned = await camera(page);
await page.keyboard.press('ArrowLeft');
check(await camera(page) !== turned, 'arrow keys turn');

// the UV picture: red where it must be
for (const [option, place, red] of [[1, [0.8, 0.5], true], [0, [0.2, 0.35], false]]) {
	await page.selectOption('#mesh', String(option));
	const [c] = await colours(page, await page.locator('#uv svg').screenshot(), [place]);
	check(red ? c[0] > c[2] + 30 : c[2] > c[0] + 30, (red ? 'red' : 'blue') + ' expected, is ' + c);
}

// the 3D view shows something, and another thing in each mode; frames differ where tangents are stored
await page.click('#home');
const pictures = new Set();
for (const show of ['0', '1', '2', '3', '4', '5']) {
	await page.selectOption('#show', show);
	const png = await page.locator('#view').screenshot();
	const [centre, corner] = await colours(page, png, [[0.5, 0.5], [0.03, 0.03]]);
	check(centre.some((x, i) => Math.abs(x - corner[i]) > 8), 'mode ' + show + ' shows the mesh');
	pictures.add(centre.map(Math.round).join());
}
check(pictures.size >= 5, 'modes look different: ' + [...pictures].join(' '));
await page.selectOption('#show', '0');
for (const frame of ['1', '2']) await page.selectOption('#frame', frame);
await page.check('#vectors');

// names are text
check(await page.evaluate(() => window.broken === undefined), 'a name was run as a script');
check(await page.locator('script').count() === 2, 'two script elements');
if (shot) await page.screenshot({path: shot});

// dark, and narrow
const background = p => p.evaluate(() => getComputedStyle(document.body).backgroundColor);
const dark = await open({colorScheme: 'dark', viewport: {width: 700, height: 900}});
const light = await background(page), night = await background(dark);
check(light !== night, 'dark is dark');
await dark.click('#theme');
check(await background(dark) === light, 'and can be made light');

check(complaints.length === 0, 'the console complains: ' + complaints.join('; '));
check(requests.every(url => url.startsWith('data:') || url === pathToFileURL(page_path).href), 'it asks for: ' + requests);
await browser.close();
console.log(passed + ' passed, ' + failed + ' failed');
process.exit(failed ? 1 : 0);
