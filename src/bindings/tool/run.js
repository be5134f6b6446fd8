// SPDX-License-Identifier: MIT
//
// run(createNmtan, module, request): one run of the tool over files in memory, for a page's worker; README.md. A run has an
// instance of its own, whose memory goes with it.

function makeFolders(FS, path) {
	const names = path.split('/').slice(1, -1);
	names.reduce((above, name) => {
		const folder = `${above}/${name}`;
		if (!FS.analyzePath(folder).exists)
			FS.mkdir(folder);
		return folder;
	}, '');
}

// [path, bytes] of all files below a folder.
function* filesBelow(FS, folder) {
	for (const name of FS.readdir(folder)) {
		const path = `${folder}/${name}`;
		if (name === '.' || name === '..')
			continue;
		if (FS.isDir(FS.stat(path).mode))
			yield* filesBelow(FS, path);
		else
			yield [path, FS.readFile(path)];
	}
}

const joined = (pieces) => {
	const bytes = new Uint8Array(pieces.reduce((sum, piece) => sum + piece.length, 0));
	pieces.reduce((at, piece) => (bytes.set(piece, at), at + piece.length), 0);
	return bytes;
};

// Bytes of a stream, one at a time as the file system brings them.
class Gathered {
	pieces = [];
	piece = [];
	put = (byte) => {
		if (byte === null)
			return;
		this.piece.push(byte & 255);
		if (this.piece.length === 65536)
			this.flush();
	};
	flush() {
		this.pieces.push(Uint8Array.from(this.piece));
		this.piece = [];
	}
	get bytes() {
		this.flush();
		return joined(this.pieces);
	}
}

export async function run(createNmtan, module, {argv, files = {}, stdin = new Uint8Array(0), folder = '/work'}) {
	const out = new Gathered(), err = new Gathered();
	let at = 0;
	const tool = await createNmtan({
		thisProgram: 'nmtan',
		instantiateWasm: (imports, done) => {
			WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
			return {};
		},
		preRun: ({FS}) => FS.init(() => (at < stdin.length ? stdin[at++] : null), out.put, err.put),
		quit: (status, reason) => {
			throw reason;
		},
	});
	const {FS} = tool;
	FS.mkdir(folder);
	for (const [name, bytes] of Object.entries(files)) {
		const path = `${folder}/${name}`;
		makeFolders(FS, path);
		FS.writeFile(path, bytes);
	}
	FS.chdir(folder);
	const status = tool.callMain(argv);
	const results = {};
	for (const [path, bytes] of filesBelow(FS, folder))
		if (files[path.slice(folder.length + 1)] === undefined || !same(bytes, files[path.slice(folder.length + 1)]))
			results[path.slice(folder.length + 1)] = bytes;
	return {status, files: results, stdout: out.bytes, stderr: new TextDecoder().decode(err.bytes)};
}

function same(a, b) {
	return a.length === b.length && a.every((byte, i) => byte === b[i]);
}
