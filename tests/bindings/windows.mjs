// SPDX-License-Identifier: MIT
//
// windows.mjs TOOL DRIVES: TOOL/windows.js between the tool's paths and node's, by node's own rules for Windows (path.win32).
// pretend() makes node's files look as they do there: C: and \\server\share are folders of DRIVES, case makes no difference,
// the current folder is C:\desk. NT_DRIVES=DIR node windows.mjs PROGRAM WORDS... runs a program so.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {pathToFileURL} from 'node:url';
import {done, test} from './tap.mjs';

const failure = (code) => Object.assign(new Error(code), {code});

function pretend(drives) {
	const {lstatSync, readdirSync, readlinkSync, fsyncSync, fstatSync} = fs, own = path.dirname(process.argv[1]) + '/';
	const entry = (folder, part) => {
		try {
			return readdirSync(folder).find((name) => name.toLowerCase() === part.toLowerCase());
		} catch {
			return undefined;
		}
	};
	const real = (name) => {
		if (typeof name !== 'string' || name.startsWith(own))
			return name;
		const [device, ...parts] = path.win32.resolve(name).replace(/^\\\\([^\\]+)\\([^\\]+)/, '$1+$2').split('\\');
		if (parts.some((part) => /[<>:"|?*]/.test(part)))
			throw failure('ENOENT');
		return parts.reduce((folder, part) => path.join(folder, entry(folder, part) ?? part), path.join(drives, device.replace(':', '').toUpperCase()));
	};
	Object.defineProperty(process, 'platform', {value: 'win32'});
	process.cwd = () => 'C:\\desk';
	for (const name of ['chmod', 'chown', 'link', 'lstat', 'mkdir', 'open', 'readdir', 'rename', 'rmdir', 'stat', 'truncate',
		'unlink', 'utimes'].map((word) => word + 'Sync')) {
		const call = fs[name];
		fs[name] = (...given) => call(...given.map((word, i) => (i < (/^(link|rename)/.test(name) ? 2 : 1) ? real(word) : word)));
	}
	fs.readlinkSync = (name) => {
		if (!lstatSync(real(name)).isSymbolicLink())
			throw failure('UNKNOWN');
		return readlinkSync(real(name)).replaceAll('/', '\\');
	};
	fs.fsyncSync = (fd) => {
		if (fstatSync(fd).isDirectory())
			throw failure('EPERM');
		fsyncSync(fd);
	};
	fs.fstatSync = (fd, options) => {
		if (fd < 3 && !fstatSync(fd).isFile())
			throw failure('EISDIR');
		return fstatSync(fd, options);
	};
}

if (process.env.NT_DRIVES) {
	process.argv.splice(1, 1);
	pretend(process.env.NT_DRIVES);
	await import(pathToFileURL(process.argv[1]));
} else {
	const [tool, drives] = process.argv.slice(2), {cwd, inside, install, outside, words} = await import(tool + '/windows.js');

	process.cwd = () => 'C:\\desk';
	await test('paths of Windows, within and back', () => {
		for (const [given, within, back] of [
			['C:\\a\\b.obj', '/C:/a/b.obj', 'C:/a/b.obj'], ['d:/x', '/d:/x', 'd:/x'], ['C:\\', '/C:/', 'C:/'],
			['..\\x', '../x', '../x'], ['a\\b', 'a/b', 'a/b'], ['-', '-', '-'], ['\\b', '/C:/b', 'C:/b'],
			['\\\\server\\share\\m.obj', '/UNC:/server/share/m.obj', '//server/share/m.obj'],
			['//server/share/m.obj', '/UNC:/server/share/m.obj', '//server/share/m.obj'],
			['\\\\?\\C:\\long', '/C:/long', 'C:/long'], ['\\\\?\\UNC\\server\\share', '/UNC:/server/share', '//server/share'],
		]) {
			assert.equal(inside(given), within);
			assert.equal(outside(within), back);
			assert.equal(path.win32.resolve(back), path.win32.resolve(given.replace(/^\\\\\?\\(UNC\\)?/, (all, share) => (share ? '\\\\' : ''))));
		}
		assert.equal(outside('/C:'), 'C:/');
		assert.equal(outside('../../D:/a/../b'), 'D:/b');
		assert.equal(outside('/C:/a/../../UNC:/server/b'), '//server/b');
		assert.throws(() => outside('/C:/a/..\\b'), {code: 'ENOENT'});
	});

	await test('words of the command line', () => {
		for (const [given, within] of [
			['--report=C:\\r.html', '--report=/C:/r.html'], ['-oC:\\x.glb', '-o/C:/x.glb'],
			['--report=\\\\s\\t\\r', '--report=/UNC:/s/t/r'], ['--include=*.obj', '--include=*.obj'],
			['--method=area', '--method=area'], ['--uri=https://host/c:/x', '--uri=https://host/c:/x'],
		])
			assert.deepEqual(words(fs, [given]), [within]);
		fs.writeFileSync('list', 'C:\\a.obj\r\n\r\nb\\-c.obj\r\n-d.obj');
		assert.deepEqual(words(fs, ['--files-from=\\missing']), ['--files-from=/C:/missing']);
		assert.deepEqual(words(fs, ['-d', 'out', '--files-from=list']), ['-d', 'out', '/C:/a.obj', 'b/-c.obj', './-d.obj']);
		fs.writeFileSync('list', 'C:\\a.obj\0b\\c d.obj\0-e.obj\0');
		assert.deepEqual(words(fs, ['--files-from=list']), ['/C:/a.obj', 'b/c d.obj', './-e.obj']);
	});

	await test('files', () => {
		for (const folder of ['C/desk/sub', 'SERVER+SHARE'])
			fs.mkdirSync(`${drives}/${folder}`, {recursive: true});
		fs.symlinkSync('sub', drives + '/C/desk/link');
		fs.writeFileSync(drives + '/C/desk/sub/a.obj', 'v');
		pretend(drives);
		install(fs);
		assert.equal(cwd(), '/C:/desk');
		assert.ok(fs.statSync('/c:/DESK/Sub/A.OBJ').isFile());
		assert.ok(fs.statSync('sub/a.obj').isFile());
		assert.throws(() => fs.statSync('sub\\a.obj'), {code: 'ENOENT'});
		assert.equal(fs.readlinkSync('/C:/desk/link'), 'sub');
		for (const plain of ['/C:', '/C:/desk', '/UNC:', '/UNC:/server', '/UNC:/server/share', 'sub/a.obj'])
			assert.throws(() => fs.readlinkSync(plain), {code: 'EINVAL'});
		assert.throws(() => fs.readlinkSync('missing'), {code: 'ENOENT'});
		for (const name of ['con.obj', 'sub/AUX', '/C:/nul.glb', 'Com1.x.glb', 'lpt9 .glb', 'prn/a', 'a.glb:stream', 'a?', 'a.', 'a ', 'b./c'])
			assert.throws(() => fs.openSync(name, fs.constants.O_CREAT | fs.constants.O_WRONLY), {code: 'EINVAL'}, name);
		assert.throws(() => fs.renameSync('sub/a.obj', 'con'), {code: 'EINVAL'});
		assert.throws(() => fs.mkdirSync('nul'), {code: 'EINVAL'});
		fs.fsyncSync(fs.openSync('sub', 0));
		fs.renameSync('sub/a.obj', '/UNC:/server/share/console.obj');
		assert.ok(fs.existsSync.call(null, drives + '/SERVER+SHARE/console.obj'));
	});
	done();
}
