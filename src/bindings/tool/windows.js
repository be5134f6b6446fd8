// SPDX-License-Identifier: MIT
//
// Windows: the tool knows POSIX's paths alone. Inside of it C:\a is /C:/a, and \\server\share\a is /UNC:/server/share/a: no
// name of Windows has a colon. Node gets paths as Windows has them, and its errors come back as POSIX's.
import path from 'node:path';
import tty from 'node:tty';

const failure = (code) => Object.assign(new Error(code), {code});

// A path, or a word of the command line that ends with one, as --report=C:\a does.
export const inside = (text) => text
	.replace(/(^|=)\\(?!\\)|^\/(?!\/)/, (all, before) => (before ?? '') + path.win32.parse(process.cwd()).root)
	.replace(/(^|^-[a-z]|=)\\\\[?.]\\(UNC\\)?/i, (all, before, share) => before + (share ? '\\\\' : ''))
	.replace(/(^|^-[a-z]|=)\\\\|^\/\/(?=[^/])/i, '$1/UNC:/')
	.replaceAll('\\', '/')
	.replace(/(^|^-[a-z]|=)(?=[a-z]:\/)/i, '$1/');

export const cwd = () => inside(process.cwd()).replace(/\/$/, '');

// A backslash is no separator inside. With one a name is not found, as elsewhere, but where node itself asks.
export function outside(name) {
	if (/^(?![a-z]:\\|\\\\).*\\/i.test(name))
		throw failure('ENOENT');
	// from one drive to another
	const whole = /\.\.\/.*:/.test(name) ? path.posix.resolve(cwd(), name) : name;
	return whole.replace(/^\/UNC:(?=\/)/i, '/').replace(/^\/([a-z]:)$/i, '$1/').replace(/^\/(?=[a-z]:\/)/i, '');
}

// Refuses to make names that Windows takes for a device, part of a file or another name.
function checkNew(name) {
	const parts = name.replace(/^\/(UNC|[a-z]):/i, '').split('/').filter((part) => part !== '.' && part !== '..');
	if (parts.some((part) => /^(con|prn|aux|nul|(com|lpt)\d) *(\.|$)|[<>:"|?*]|[. ]$/i.test(part)))
		throw failure('EINVAL');
}

// Lists are made with Windows' paths and ends of lines. The tool says why one cannot be read.
export const words = (fs, given) => given.flatMap((word) => {
	const [, list] = /^--files-from=(.+)/s.exec(word) ?? [];
	try {
		if (!list)
			return inside(word);
		const names = String(fs.readFileSync(list === '-' ? 0 : outside(inside(list))));
		return names.split(names.includes('\0') ? '\0' : /\r?\n/).filter((name) => name)
			.map((name) => inside(name).replace(/^-/, './-'));
	} catch {
		return inside(word);
	}
});

export function install(fs) {
	const {fstatSync, writeSync} = fs, made = {mkdirSync: 0, linkSync: 1, renameSync: 1};
	for (const name of ['chmod', 'chown', 'fsync', 'link', 'lstat', 'mkdir', 'open', 'readdir', 'readlink', 'rename', 'rmdir', 'stat',
		'truncate', 'unlink', 'utimes'].map((word) => word + 'Sync')) {
		const call = fs[name];
		fs[name] = (...given) => {
			if (name === 'openSync' ? given[1] & fs.constants.O_CREAT : name in made)
				checkNew(given[made[name] ?? 0]);
			try {
				return call(...given.map((word) => (typeof word === 'string' ? outside(word) : word)));
			} catch (error) {
				if (name === 'fsyncSync' && error.code === 'EPERM')
					return undefined; // folders, and what is open for reading, are not synchronised there
				throw error.code === 'UNKNOWN' ? Object.assign(error, {code: 'EIO'}) : error;
			}
		};
	}
	// Not all its file systems answer what is no link in the same way, and servers are no folders.
	const {readlinkSync} = fs;
	fs.readlinkSync = (name) => {
		if (/^\/UNC:(\/[^/]*)?$/i.test(name) || !fs.lstatSync(name).isSymbolicLink())
			throw failure('EINVAL');
		return inside(readlinkSync(name));
	};
	// Consoles, and for old versions of node pipes, have no status.
	fs.fstatSync = (fd, options) => {
		try {
			return fstatSync(fd, options);
		} catch (error) {
			if (fd > 2)
				throw error;
			return {dev: 0n, ino: 0n, mode: tty.isatty(fd) ? 0o20666n : 0o10666n, nlink: 1n, uid: 0n, gid: 0n, size: 0n, mtimeNs: 0n, ctimeNs: 0n};
		}
	};
	// Messages name files as they are named outside.
	fs.writeSync = (fd, bytes, at, length, ...where) => {
		if (fd !== 2 || typeof bytes === 'string')
			return writeSync(fd, bytes, at, length, ...where);
		const text = Buffer.from(bytes.buffer, bytes.byteOffset + at, length).toString('latin1');
		writeSync(fd, Buffer.from(text.replace(/\/(?=[a-z]:\/)|(?<=\/)UNC:(?=\/)/gi, ''), 'latin1'));
		return length;
	};
}
