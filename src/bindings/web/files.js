// SPDX-License-Identifier: MIT
//
// Files as they come in: from a drop, with whole folders, or from a dialog, as [{path, blob}], where path is below the folder that
// was dropped. A blob is a handle: nothing is read here. Also what page and worker have to agree on: which paths are
// taken, which files are meshes, how much is too much.

// WebAssembly has 4 GB, and a mesh takes several times its file's size there.
export const MOST_BYTES = 1e9;

// An error whose text the reader sees as it stands.
export class Refusal extends Error {}

export const sizeText = bytes => bytes >= 1e9 ? (bytes / 1e9).toFixed(1) + ' GB' : bytes >= 1e6 ? (bytes / 1e6).toFixed(1) + ' MB' : Math.ceil(bytes / 1e3) + ' kB';

export function checkSize(bytes, what) {
	if (bytes > MOST_BYTES)
		throw new Refusal(`${what} ${sizeText(bytes)}; this page takes at most ${sizeText(MOST_BYTES)}. The program nmtan has no such limit.`);
}

export const isMesh = path => /\.(obj|gltf|glb|ply|drc)$/i.test(path);
export const isZip = path => /\.zip$/i.test(path);

// A path with slashes that stays below its folder; refused if it does not.
export function cleanPath(path) {
	const parts = path.replaceAll('\\', '/').split('/').filter(part => part !== '.');
	if (!parts[0] || /^[a-z]:/i.test(path) || parts.includes('..') || path.includes('\0'))
		throw new Refusal(`“${path}” is a name outside of its folder. Nothing was read.`);
	return parts.filter(part => part).join('/');
}

// Options that copy what a file of this format refers to.
export const optionsOfFormat = format => format === 'gltf' ? ['--images=copy', '--buffers=copy'] : [];

// Files that systems leave in folders and archives.
export const isHidden = path => path.split('/').some(part => part.startsWith('.') || part === '__MACOSX' || part === 'Thumbs.db');

export const filesOfList = list => [...list].map(file => ({path: file.webkitRelativePath || file.name, blob: file}));

// Lists all files of a folder. readEntries() gives some at a time, and none at the end.
async function filesOfEntry(entry) {
	if (entry.isFile)
		return [{path: entry.fullPath.slice(1), blob: await new Promise((done, failed) => entry.file(done, failed))}];
	const reader = entry.createReader(), found = [];
	for (;;) {
		const entries = await new Promise((done, failed) => reader.readEntries(done, failed));
		if (!entries.length) return found;
		for (const each of entries) found.push(...await filesOfEntry(each));
	}
}

// Entries have to be asked for before the event is over.
export async function filesOfDrop(transfer) {
	const entries = [...transfer.items].map(item => item.webkitGetAsEntry?.()).filter(entry => entry);
	if (!entries.length) return filesOfList(transfer.files);
	return (await Promise.all(entries.map(filesOfEntry))).flat();
}
