// SPDX-License-Identifier: MIT
//
// node answer.mjs KIND WORDS...    what KIND.mjs of this folder says: gltf, validate, frames
// node answer.mjs --serve FOLDER   the same for all questions of one shell script: see `ask` in cli.sh
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

async function answer([kind, ...words], say) {
	try {
		return await (await import(`./${kind}.mjs`)).default(words, say) ? 0 : 1;
	} catch (error) {
		say(`# ${kind} ${words.join(' ')}: ${error.stack}`);
		return 1;
	}
}

const words = process.argv.slice(2), folder = words[1];
if (words[0] !== '--serve')
	process.exit(await answer(words, console.log));
writeFileSync(join(folder, 'pid'), `${process.pid}`);
for (;;) {
	const [, place, ...question] = readFileSync(join(folder, 'ask'), 'utf8').split('\0').slice(0, -1);
	let text = '';
	process.chdir(place);
	const status = await answer(question, (line) => { text += `${line}\n`; });
	writeFileSync(join(folder, 'out'), text);
	writeFileSync(join(folder, 'said'), `${status}\n`);
}
