// SPDX-License-Identifier: MIT
//
// One job of the tool: {tool: compiled WebAssembly, files: [{path, blob}], options, save: null or {format, name}} comes
// in; {stage}s go out while it runs, then {names, report} of a check, or {name, blob, said} of what is to be saved, or
// {failure}. The page ends the worker after its job, which gives back all memory.
import createTool from './tool.js';
import {run} from './run.js';
import {Refusal, checkSize, cleanPath, isHidden, isMesh, isZip, optionsOfFormat} from './files.js';
import {openZip, writeZip} from './zip.js';

const STATUS_OK = 0, STATUS_MEMORY = 4, STATUS_FINDINGS = 6;
const tooLarge = 'There is not enough memory for this in a web page. The program nmtan has no such limit.';

// The dropped files, archives unpacked: Map of path to bytes.
async function read(files) {
	const wanted = [];
	for (const {path, blob} of files)
		if (isZip(path)) wanted.push(...await openZip(blob));
		else wanted.push({path: cleanPath(path), size: blob.size, read: async () => new Uint8Array(await blob.arrayBuffer())});
	const kept = wanted.filter(file => !isHidden(file.path)), bytes = new Map();
	checkSize(kept.reduce((sum, file) => sum + file.size, 0), 'The files have');
	for (const file of kept) {
		postMessage({stage: 'read ' + file.path});
		bytes.set(file.path, await file.read());
	}
	return bytes;
}

// A lone file goes to the tool whatever it is called: the tool knows files by their content, and says what it does not read.
function meshesOf(paths) {
	const meshes = paths.filter(isMesh);
	if (!meshes.length && paths.length !== 1)
		throw new Refusal('There is no mesh here: no .glb, .gltf, .obj, .ply or .drc.');
	return meshes.length ? meshes : paths;
}

// The deepest folder that has all of them, with a slash at its end.
function commonFolder(paths) {
	let folder = paths[0].slice(0, paths[0].lastIndexOf('/') + 1);
	while (!paths.every(path => path.startsWith(folder))) folder = folder.slice(0, folder.lastIndexOf('/', folder.length - 2) + 1);
	return folder;
}

function outputArguments({format, name}, count) {
	const files = optionsOfFormat(format);
	return count > 1 ? ['-d', '/out', '--keep-tree=.', '--output-format=' + format, ...files] : ['-o', '/out/' + name + '.' + format, ...files];
}

async function work({tool: compiled, files, options, save}) {
	const bytes = await read(files), meshes = meshesOf([...bytes.keys()]), folder = commonFolder(meshes);
	const names = meshes.map(path => path.slice(folder.length)), said = [];
	const task = save ? outputArguments(save, names.length) : ['--check', '--report=/out/report.html', '--fail-on=never'];
	const {status, files: made} = await run(createTool, compiled, {
		argv: [...task, '--progress=on', ...options, '--', ...names], files: Object.fromEntries(bytes), folder,
		say(line) {
			const stage = /: (map|parse|decode|textures|normals|tangents|write|report)$|^nmtan: (\d+ of \d+ files)/.exec(line)?.slice(1).find(word => word);
			if (stage) postMessage({stage});
			else said.push(line.replace(/^nmtan: /, '').replaceAll('/out/', ''));
		},
	});
	if (status === STATUS_MEMORY) throw new RangeError();
	if (status !== STATUS_OK && status !== STATUS_FINDINGS && (save || names.length === 1)) throw new Refusal(said.join('\n'));
	if (!save) return {names, report: new TextDecoder().decode(made['report.html'])};
	const results = Object.entries(made).map(([path, bytes]) => ({path, bytes})), [first] = results;
	return results.length === 1 ? {name: first.path, blob: new Blob([first.bytes]), said} : {name: save.name + '.zip', blob: writeZip(results), said};
}

function explain(error) {
	if (error instanceof Refusal) return error.message;
	if (error instanceof RangeError || error instanceof WebAssembly.RuntimeError) return tooLarge;
	return error.name === 'NotReadableError' || error.name === 'NotFoundError' ? 'A file cannot be read; has it changed since?' : String(error.message ?? error);
}

onmessage = ({data}) => work(data).then(postMessage, error => postMessage({failure: explain(error)}));
