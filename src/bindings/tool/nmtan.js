#!/usr/bin/env node
// SPDX-License-Identifier: MIT
//
// npx nmtan: the tool over the files of this machine. This file and system.c put right what emscripten's files do
// otherwise than the system calls that the tool was written for.
import fs from 'node:fs';
import {createRequire} from 'node:module';
import tty from 'node:tty';
import {cwd, install, words} from './windows.js';

const create = createRequire(import.meta.url)('./nmtan-tool.cjs');
const wasmBinary = fs.readFileSync(new URL('./nmtan-tool.wasm', import.meta.url));

// Pipes that others have made non-blocking are waited for. On Windows the end of one is an error.
function patient(call) {
	return (...given) => {
		for (;;)
			try {
				return call(...given);
			} catch (error) {
				if (error.code === 'EOF')
					return 0;
				if (error.code !== 'EAGAIN')
					throw error;
				Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, 5);
			}
	};
}
fs.readSync = patient(fs.readSync);
fs.writeSync = patient(fs.writeSync);

// The tool closes what it was started with; node needs it still, and a second descriptor may stand for the same.
const {closeSync} = fs;
fs.closeSync = (fd) => fd > 2 && closeSync(fd);

const windows = process.platform === 'win32';
if (windows)
	install(fs);

const fields = (s) => [s.dev, s.ino & 0xffffffffn, s.ino >> 32n, s.mode, s.nlink, s.uid, s.gid, s.size,
	s.mtimeNs / 1000000000n, s.mtimeNs % 1000000000n, s.ctimeNs / 1000000000n, s.ctimeNs % 1000000000n].map(Number);

const system = {
	process: process.pid,
	status(path, fd, follow) {
		if (path === null)
			return fields(fs.fstatSync(fd, {bigint: true}));
		return fields((follow ? fs.statSync : fs.lstatSync)(path, {bigint: true}));
	},
	sync: (from, to, fd) => fs.fsyncSync(fd),
	link: (from, to) => fs.linkSync(from, to),
	touch(path) {
		const now = Date.now() / 1000;
		fs.utimesSync(path, now, now);
	},
};

const tool = await create({
	wasmBinary,
	system,
	thisProgram: 'nmtan',
	preRun: ({ENV}) => Object.assign(ENV, process.env),
});
for (let fd = 0; fd < 3; fd++)
	tool.FS.streams[fd].tty = tty.isatty(fd);
if (windows)
	tool.FS.cwd = cwd;
process.exitCode = tool.callMain(windows ? words(fs, process.argv.slice(2)) : process.argv.slice(2));
