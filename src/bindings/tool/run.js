// SPDX-License-Identifier: MIT
//
// run(createNmtan, module, request): one run of the tool over files in memory, for a page's worker; README.md. A run has an
// instance of its own, whose memory goes with it.

// [path, bytes] of what was written below a folder: files that came in are of the first second of time.
const GIVEN = 1;
function* written(FS, top, folder = top) {
	for (const name of FS.readdir(folder).filter((name) => name !== '.' && name !== '..').sort()) {
		const path = `${folder}/${name}`, {mode, mtime} = FS.stat(path);
		if (FS.isDir(mode))
			yield* written(FS, top, path);
		else if (mtime.getTime() !== GIVEN)
			yield [path.slice(top.length + 1), FS.readFile(path)];
	}
}

// Bytes of a stream, one at a time as the file system brings them.
class Gathered {
	pieces = [];
	piece = [];
	put = (byte) => {
		if (byte !== null && this.piece.push(byte & 255) === 65536)
			this.flush();
	};
	flush() {
		this.pieces.push(Uint8Array.from(this.piece));
		this.piece = [];
	}
	get bytes() {
		this.flush();
		const bytes = new Uint8Array(this.pieces.reduce((sum, piece) => sum + piece.length, 0));
		this.pieces.reduce((at, piece) => (bytes.set(piece, at), at + piece.length), 0);
		return bytes;
	}
}

export async function run(createNmtan, module, {argv, files = {}, stdin = new Uint8Array(0), folder = '', say = () => {}}) {
	const out = new Gathered(), err = new Gathered(), line = [], text = (bytes) => new TextDecoder().decode(Uint8Array.from(bytes));
	const hear = (byte) => {
		err.put(byte);
		byte === 10 ? say(text(line.splice(0))) : line.push(byte);
	};
	let at = 0;
	const {FS, callMain} = await createNmtan({
		thisProgram: 'nmtan',
		instantiateWasm: (imports, done) => {
			WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
			return {};
		},
		preRun: ({FS}) => FS.init(() => (at < stdin.length ? stdin[at++] : null), out.put, hear),
		quit: (status, reason) => {
			throw reason;
		},
	});
	for (const [name, bytes] of Object.entries(files)) {
		const path = `/in/${name}`;
		try {
			FS.mkdirTree(path.slice(0, path.lastIndexOf('/')));
			FS.writeFile(path, bytes, {canOwn: true});
			FS.utime(path, GIVEN, GIVEN);
		} catch {
			throw new Error(`“${name}” cannot be beside the other files.`);
		}
	}
	['/out', `/in/${folder}`].forEach((path) => FS.mkdirTree(path));
	FS.chdir(`/in/${folder}`);
	const status = callMain(argv);
	return {status, files: Object.fromEntries([...written(FS, '/in'), ...written(FS, '/out')]), stdout: out.bytes, stderr: text(err.bytes)};
}
