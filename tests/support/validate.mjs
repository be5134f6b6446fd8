// SPDX-License-Identifier: MIT
//
// answer.mjs validate OUTPUT [INPUT]   one pair
// answer.mjs validate --pairs FILE     a list: one "OUTPUT<tab>INPUT" or "OUTPUT" per line
//
// Runs the Khronos validator (npm gltf-validator, installed by `make check` into build/node) and fails
// when an output has an error its input did not have. Errors are told apart by code and number: an
// input with three errors of one code may give an output with three, and more at the same place, since
// a vertex that is copied takes its faults along. Prints the new errors only.
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '..', '..');
const require = createRequire(join(root, 'build', 'node', 'package.json'));
const validator = require('gltf-validator');

async function errorsOf(path) {
	const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
		uri: path,
		maxIssues: 100000,
		externalResourceFunction: async (uri) =>
			new Uint8Array(readFileSync(resolve(dirname(path), decodeURIComponent(uri)))),
	});
	return report.issues.messages.filter((message) => message.severity === 0);
}

function countCodes(messages) {
	const counts = new Map();
	for (const { code } of messages)
		counts.set(code, (counts.get(code) ?? 0) + 1);
	return counts;
}

// An input is looked at only where its output has errors that it may have had.
async function judge(output, input, say) {
	const after = await errorsOf(output);
	const before = after.length && input && /\.(gltf|glb)$/i.test(input) ? await errorsOf(input) : [];
	const allowed = countCodes(before);
	const places = new Set(before.map((m) => `${m.code} ${m.pointer}`));
	const fresh = [];
	for (const message of after) {
		if (places.has(`${message.code} ${message.pointer}`))
			continue;
		const left = allowed.get(message.code) ?? 0;
		if (left > 0)
			allowed.set(message.code, left - 1);
		else
			fresh.push(message);
	}
	for (const { code, pointer, message } of fresh.slice(0, 5))
		say(`# ${output}: ${code} ${pointer ?? ''}: ${message}`);
	if (fresh.length > 5)
		say(`# ${output}: ${fresh.length - 5} more`);
	return fresh.length === 0;
}

export default async function answer(words, say) {
	const pairs = words[0] === '--pairs'
		? readFileSync(words[1], 'utf8').split('\n').filter(Boolean).map((line) => line.split('\t'))
		: [words];
	let good = true;
	for (const [output, input] of pairs) {
		try {
			good = await judge(output, input, say) && good;
		} catch (error) {
			say(`# ${output}: the validator could not read it: ${error}`);
			good = false;
		}
	}
	return good;
}
