// SPDX-License-Identifier: MIT
//
// zip.mjs WEB PYTHON.zip OUT.zip: the page's archives. PYTHON.zip is of Python's zipfile (test_web.sh): a stored file, a
// deflated one of 100 000 bytes, a folder, one whose name is not ASCII, and a comment. Damage is done to its bytes.
// OUT.zip is written for Python to read.
import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {pathToFileURL} from 'node:url';
import {done, test} from './tap.mjs';

const [web, from_python, out] = process.argv.slice(2);
const {openZip, writeZip} = await import(pathToFileURL(web + '/zip.js'));
const {Refusal, checkSize, cleanPath, isHidden, isMesh} = await import(pathToFileURL(web + '/files.js'));
const original = readFileSync(from_python), text = bytes => new TextDecoder().decode(bytes);
const CENTRAL = Buffer.from([0x50, 0x4b, 1, 2]), END = Buffer.from([0x50, 0x4b, 5, 6]);

// The beginning of the directory's record whose name contains a word.
function record(bytes, word) {
	for (let at = bytes.indexOf(CENTRAL); at >= 0; at = bytes.indexOf(CENTRAL, at + 1))
		if (bytes.toString('latin1', at + 46, at + 46 + bytes.readUInt16LE(at + 28)).includes(word)) return at;
	throw new Error('no ' + word);
}

// The archive after a change is refused, in words that match, when it is opened or when all of it is read.
async function refuses(change, words) {
	const bytes = Buffer.from(original), changed = change(bytes) ?? bytes;
	await assert.rejects(async () => {
		for (const entry of await openZip(new Blob([changed]))) await entry.read();
	}, error => error instanceof Refusal && words.test(error.message) || assert.fail(error.message));
}

await test('what zipfile wrote is read: stored, deflated, other names, with a comment; folders are no files', async () => {
	const entries = await openZip(new Blob([original]));
	assert.deepEqual(entries.map(entry => entry.path), ['a/stored.txt', 'a/letter.txt', 'a/fünf.obj']);
	assert.deepEqual(entries.map(entry => entry.size), [6, 100000, 2]);
	assert.equal(text(await entries[0].read()), 'stored');
	assert.equal(text(await entries[1].read()), 'abcdefghij'.repeat(10000));
	assert.equal(text(await entries[2].read()), 'v\n');
});

await test('what is written, and read again', async () => {
	const files = [{path: 'a/größe.bin', bytes: Uint8Array.from({length: 70000}, (_, i) => i * i >> 3)}, {path: 'b.gltf', bytes: new Uint8Array(0)}];
	const zip = writeZip(files), entries = await openZip(zip);
	assert.deepEqual(entries.map(entry => entry.path), files.map(file => file.path));
	for (const [i, entry] of entries.entries()) assert.deepEqual(await entry.read(), files[i].bytes);
	writeFileSync(out, new Uint8Array(await zip.arrayBuffer()));
	assert.equal((await openZip(writeZip([]))).length, 0);
});

await test('names that would leave the folder are refused; what stays in it is taken', async () => {
	for (const name of ['../x', 'a/../../x', 'a/..', '/etc/x', '\\x', '..\\x', 'a\\..\\x', 'C:\\x', 'c:x', 'a\0b', '', '..'])
		assert.throws(() => cleanPath(name), Refusal, name);
	for (const [name, clean] of [['a/b', 'a/b'], ['a\\b', 'a/b'], ['./a//b', 'a/b'], ['..a/b..', '..a/b..'], ['-x<b>.obj', '-x<b>.obj']])
		assert.equal(cleanPath(name), clean);
	await refuses(bytes => { bytes.write('../../tored.t', record(bytes, 'stored') + 46); }, /outside of its folder/);
	await refuses(bytes => { bytes.write('/', record(bytes, 'stored') + 46); }, /outside of its folder/);
});

await test('a bomb is refused: by what it says before anything is unpacked, by what it holds as soon as it is more than that', async () => {
	await refuses(bytes => { bytes.writeUInt32LE(4000000000, record(bytes, 'letter') + 24); }, /4\.0 GB.*at most 1\.0 GB/);
	await refuses(bytes => {
		for (const word of ['stored', 'letter']) bytes.writeUInt32LE(500000000, record(bytes, word) + 24);
	}, /at most 1\.0 GB/);
	await refuses(bytes => { bytes.writeUInt32LE(99999, record(bytes, 'letter') + 24); }, /letter.* holds more than it says/);
	await refuses(bytes => { bytes.writeUInt32LE(100001, record(bytes, 'letter') + 24); }, /letter.* holds less than it says/);
	assert.throws(() => checkSize(2 ** 31, 'This file has'), /This file has 2\.1 GB; .*1\.0 GB/);
	checkSize(1e9, 'This file has');
});

await test('what is damaged, and what is not read, is told', async () => {
	await refuses(bytes => bytes.subarray(0, 0), /no \.zip at all/);
	await refuses(bytes => bytes.subarray(0, bytes.length - 10), /no \.zip at all/);
	await refuses(bytes => bytes.subarray(100), /directory|not complete/);
	await refuses(bytes => Buffer.concat([bytes.subarray(0, 60), bytes.subarray(90)]), /./);
	for (let size = 1; size < original.length; size += 37) await refuses(bytes => bytes.subarray(0, size), /./);
	await refuses(bytes => { bytes[bytes.indexOf('storedPK') + 1] ^= 1; }, /“a\/stored\.txt” is damaged/);
	await refuses(bytes => { bytes.writeUInt32LE(1, record(bytes, 'letter') + 16); }, /“a\/letter\.txt” is damaged/);
	await refuses(bytes => { bytes.fill(0xff, bytes.indexOf('letter.txt') + 10, bytes.indexOf('letter.txt') + 20); }, /letter.*damaged/);
	await refuses(bytes => { bytes.writeUInt32LE(0xfffffff0, record(bytes, 'stored') + 42); }, /not complete/);
	await refuses(bytes => { bytes.writeUInt32LE(3, record(bytes, 'stored') + 42); }, /not where/);
	await refuses(bytes => { bytes.writeUInt16LE(12, record(bytes, 'letter') + 10); }, /method 12/);
	await refuses(bytes => { bytes.writeUInt16LE(1, record(bytes, 'letter') + 8); }, /encrypted/);
	await refuses(bytes => { bytes.write('a/letter.txt', record(bytes, 'stored') + 46); }, /twice/);
	await refuses(bytes => { bytes.writeUInt16LE(0xffff, bytes.indexOf(END) + 10); }, /ZIP64/);
	await refuses(bytes => { bytes.writeUInt16LE(9, bytes.indexOf(END) + 10); }, /directory/);
	await refuses(bytes => { bytes.writeUInt32LE(0xfffffff0, bytes.indexOf(END) + 16); }, /not complete/);
});

await test('meshes, and what systems leave beside them', () => {
	assert.deepEqual(['a.OBJ', 'b.glb', 'c.mtl', 'obj', 'd.obj.png', 'e.drc', 'f.gltf', 'g.ply'].filter(isMesh), ['a.OBJ', 'b.glb', 'e.drc', 'f.gltf', 'g.ply']);
	assert.deepEqual(['a/b.obj', '__MACOSX/a/._b.obj', 'a/.DS_Store', '.git/x.obj', 'a.b/c'].filter(isHidden), ['__MACOSX/a/._b.obj', 'a/.DS_Store', '.git/x.obj']);
});
done();
