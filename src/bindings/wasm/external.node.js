// SPDX-License-Identifier: MIT
//
// nmtan with the WebAssembly in a file beside this one: Node and what has its file system.
import { readFile } from 'node:fs/promises';
import { install } from './core.js';

export let isReady = false;
export const ready = readFile(new URL('./nmtan.wasm', import.meta.url)).then(WebAssembly.compile).then((compiled) => {
	install(compiled);
	isReady = true;
});
export { generateCornerTangents, generateRepairedTangents, generateTangents, generateTangentsIndexed } from './core.js';
