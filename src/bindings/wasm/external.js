// SPDX-License-Identifier: MIT
//
// nmtan with the WebAssembly in a file beside this one, for servers and bundlers that serve it as it is.
import { generateRepairedTangents, generateTangents, generateTangentsIndexed, install } from './core.js';

async function load() {
	const url = new URL('./nmtan.wasm', import.meta.url);
	if (url.protocol === 'file:') {
		const { readFile } = await import('node:fs/promises');
		return WebAssembly.compile(await readFile(url));
	}
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
export { generateRepairedTangents, generateTangents, generateTangentsIndexed };
