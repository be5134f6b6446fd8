// SPDX-License-Identifier: MIT
//
// nmtan with the WebAssembly in a file beside this one: browsers, and bundlers that serve it as it is.
import { install } from './core.js';

async function load() {
	const url = new URL('./nmtan.wasm', import.meta.url);
	const answer = await fetch(url);
	if (!answer.ok)
		throw new Error(`nmtan: ${url}: ${answer.status} ${answer.statusText}`);
	return WebAssembly.compile(await answer.arrayBuffer());
}

export let isReady = false;
export const ready = load().then((compiled) => {
	install(compiled);
	isReady = true;
});
export { generateCornerTangents, generateRepairedTangents, generateTangents, generateTangentsIndexed } from './core.js';
