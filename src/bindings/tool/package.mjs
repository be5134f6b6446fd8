// SPDX-License-Identifier: MIT
//
// package.mjs PACKAGE.JSON: the library's package, with the tool in it.
import {readFileSync} from 'node:fs';

const it = JSON.parse(readFileSync(process.argv[2], 'utf8'));
it.bin = {nmtan: './nmtan.js'};
it.engines = {node: '>=18'};
it.files.push('nmtan.js', 'windows.js', 'nmtan-tool.cjs', 'nmtan-tool.wasm');
console.log(JSON.stringify(it, null, '\t'));
