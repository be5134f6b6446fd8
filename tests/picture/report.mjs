// SPDX-License-Identifier: MIT
//
// report.mjs PAGE MODULES OUT.png: the HTML report of data/head.obj as a reader sees it who has chosen a mirror seam.
import {createRequire} from 'node:module';
import {writeFileSync} from 'node:fs';
import {resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [page_path, modules, out] = process.argv.slice(2);
const {chromium} = createRequire(resolve(modules) + '/')('playwright-core');
const browser = await chromium.launch({executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
	args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
const page = await browser.newPage({viewport: {width: 1360, height: 780}});
await page.goto(pathToFileURL(page_path).href);
await page.evaluate(() => window.nmtanReport.ready());
await page.click('[data-code=UV_MIRROR_SEAM] .finding >> nth=0');
await page.waitForFunction(() => window.nmtanReport.selection());
await page.evaluate(() => window.nmtanReport.turn(0.55, 0.12));
await page.check('#vectors', {force: true});
await page.waitForTimeout(2500);
writeFileSync(out, await page.screenshot());
await browser.close();
