// SPDX-License-Identifier: MIT
//
// Cases in TAP: test(name, body), where body throws if something is wrong, and done() at the end.
let cases = 0, bad = 0;

export async function test(name, body) {
	cases++;
	try {
		await body();
		console.log(`ok - ${name}`);
	} catch (error) {
		bad++;
		console.log(`# ${String(error.stack ?? error).split('\n').join('\n# ')}`);
		console.log(`not ok - ${name}`);
	}
}

export function done() {
	console.log(`1..${cases}`);
	process.exitCode = bad ? 1 : 0;
}
