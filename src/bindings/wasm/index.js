// SPDX-License-Identifier: MIT
//
// nmtan with the WebAssembly inside, for every page, worker, bundler and Node.
import { generateCornerTangents, generateRepairedTangents, generateTangents, generateTangentsIndexed, install } from './core.js';
import { wasm } from './wasm.js'; // base64

export let isReady = false;
export const ready = WebAssembly.compile(Uint8Array.from(atob(wasm), (c) => c.charCodeAt(0))).then((compiled) => {
	install(compiled);
	isReady = true;
});
export { generateCornerTangents, generateRepairedTangents, generateTangents, generateTangentsIndexed };
