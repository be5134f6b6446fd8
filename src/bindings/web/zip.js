// SPDX-License-Identifier: MIT
//
// ZIP archives. openZip() reads the directory and judges it before anything is unpacked: names stay below the archive, no two
// are equal, all together are not too large. Size and CRC-32 that an entry states are then compared with its output,
// so that an archive takes no more memory than it says. writeZip() stores what does not get smaller anyway. Not read:
// ZIP64, encryption, methods other than stored and deflated.
import {Refusal, checkSize, cleanPath} from './files.js';

const LOCAL = 0x04034b50, CENTRAL = 0x02014b50, END = 0x06054b50;
const LOCAL_BYTES = 30, CENTRAL_BYTES = 46, END_BYTES = 22, MOST_COMMENT = 65535;
const STORED = 0, DEFLATED = 8, ENCRYPTED = 1, UTF8 = 1 << 11;

const refuse = text => { throw new Refusal('The .zip cannot be read: ' + text + '.'); };

const table = Uint32Array.from({length: 256}, (_, n) => {
	for (let bit = 0; bit < 8; bit++) n = n & 1 ? 0xedb88320 ^ n >>> 1 : n >>> 1;
	return n;
});

export function crc32(bytes) {
	let crc = -1;
	for (let i = 0; i < bytes.length; i++) crc = table[(crc ^ bytes[i]) & 255] ^ crc >>> 8;
	return ~crc >>> 0;
}

async function view(zip, begin, size) {
	if (begin + size > zip.size) refuse('it is not complete');
	return new DataView(await zip.slice(begin, begin + size).arrayBuffer());
}

// The last record, in front of a comment: how many entries, and where their directory is.
async function findDirectory(zip) {
	const size = Math.min(zip.size, END_BYTES + MOST_COMMENT), tail = await view(zip, zip.size - size, size);
	for (let at = size - END_BYTES; at >= 0; at--) {
		if (tail.getUint32(at, true) !== END || at + END_BYTES + tail.getUint16(at + 20, true) !== size) continue;
		const [count, bytes, begin] = [tail.getUint16(at + 10, true), tail.getUint32(at + 12, true), tail.getUint32(at + 16, true)];
		if (count === 0xffff || bytes === 0xffffffff || begin === 0xffffffff) refuse('it is a ZIP64, of more than 65 534 files or 4 GB');
		return {count, bytes, begin};
	}
	return refuse('it is damaged, or no .zip at all');
}

function decodeName(bytes) {
	try {
		return new TextDecoder('utf-8', {fatal: true}).decode(bytes);
	} catch {
		return new TextDecoder('windows-1252').decode(bytes);
	}
}

async function inflate(blob, size, path) {
	const reader = blob.stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader(), bytes = new Uint8Array(size);
	let at = 0;
	for (;;) {
		const {value, done} = await reader.read().catch(() => refuse(`“${path}” is damaged`));
		if (done) break;
		if (at + value.length > size) {
			await reader.cancel();
			refuse(`“${path}” holds more than it says`);
		}
		bytes.set(value, at);
		at += value.length;
	}
	if (at < size) refuse(`“${path}” holds less than it says`);
	return bytes;
}

async function readEntry(zip, {path, method, crc, packed, size, local}) {
	const head = await view(zip, local, LOCAL_BYTES);
	if (head.getUint32(0, true) !== LOCAL) refuse(`“${path}” is not where the directory says`);
	const begin = local + LOCAL_BYTES + head.getUint16(26, true) + head.getUint16(28, true);
	if (begin + packed > zip.size) refuse('it is not complete');
	const blob = zip.slice(begin, begin + packed);
	const bytes = method === DEFLATED ? await inflate(blob, size, path) : new Uint8Array(await blob.arrayBuffer());
	if (bytes.length !== size || crc32(bytes) !== crc) refuse(`“${path}” is damaged`);
	return bytes;
}

// [{path, size, read(): promise of bytes}] of the files in it.
export async function openZip(zip) {
	const {count, bytes, begin} = await findDirectory(zip), directory = await view(zip, begin, bytes);
	const entries = new Map();
	for (let i = 0, at = 0; i < count; i++) {
		if (at + CENTRAL_BYTES > bytes || directory.getUint32(at, true) !== CENTRAL) refuse('its directory is damaged');
		const [nameBytes, extra, comment] = [28, 30, 32].map(field => directory.getUint16(at + field, true));
		const next = at + CENTRAL_BYTES + nameBytes + extra + comment;
		if (next > bytes) refuse('its directory is damaged');
		const name = decodeName(new Uint8Array(directory.buffer, at + CENTRAL_BYTES, nameBytes));
		const [crc, packed, size] = [16, 20, 24].map(field => directory.getUint32(at + field, true));
		const entry = {path: cleanPath(name), method: directory.getUint16(at + 10, true), crc, packed, size, local: directory.getUint32(at + 42, true)};
		if (directory.getUint16(at + 8, true) & ENCRYPTED) refuse(`“${name}” is encrypted`);
		if (entry.method !== STORED && entry.method !== DEFLATED) refuse(`“${name}” is packed by method ${entry.method}; deflate is read`);
		if (entries.has(entry.path)) refuse(`“${name}” is in it twice`);
		if (!/[\\/]$/.test(name)) entries.set(entry.path, {...entry, read: () => readEntry(zip, entry)});
		at = next;
	}
	checkSize([...entries.values()].reduce((sum, entry) => sum + entry.size, 0), 'Unpacked, the .zip has');
	return [...entries.values()];
}

// [{path, bytes}] as a blob. All files are of the first day that a .zip knows: equal files make an equal archive.
export function writeZip(files) {
	const parts = [], directory = [];
	let at = 0, directoryBytes = 0;
	for (const {path, bytes} of files) {
		const name = new TextEncoder().encode(path), crc = crc32(bytes);
		const record = (size, signature, from, offset) => {
			const head = new DataView(new ArrayBuffer(size));
			head.setUint32(0, signature, true);
			if (offset !== undefined) head.setUint16(4, 20, true);
			[20, UTF8, STORED, 0, 0x21].forEach((value, i) => head.setUint16(from + 2 * i, value, true));
			[crc, bytes.length, bytes.length].forEach((value, i) => head.setUint32(from + 10 + 4 * i, value, true));
			head.setUint16(from + 22, name.length, true);
			if (offset !== undefined) head.setUint32(42, offset, true);
			return head;
		};
		parts.push(record(LOCAL_BYTES, LOCAL, 4), name, bytes);
		directory.push(record(CENTRAL_BYTES, CENTRAL, 6, at), name);
		at += LOCAL_BYTES + name.length + bytes.length;
		directoryBytes += CENTRAL_BYTES + name.length;
	}
	const end = new DataView(new ArrayBuffer(END_BYTES));
	end.setUint32(0, END, true);
	[files.length, files.length].forEach((value, i) => end.setUint16(8 + 2 * i, value, true));
	end.setUint32(12, directoryBytes, true);
	end.setUint32(16, at, true);
	return new Blob([...parts, ...directory, end], {type: 'application/zip'});
}
